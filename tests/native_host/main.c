/* usage: native_host replay DESCRIPTION SCRIPT RESULTS [RESULTS ...]
          native_host check DESCRIPTION DESCRIPTION (of another model)
          native_host versions DESCRIPTION DESCRIPTION (of one model)
          native_host hostile DESCRIPTION STEPS
   Ends with status 0 if all is well, and says on stderr which line is not. */
#include <string.h>

#include "host.h"

int main(int count, char **arguments) {
    CHECK(count >= 4);
    bool versions = !strcmp(arguments[1], "versions");
    if (versions || !strcmp(arguments[1], "check"))
        return check(arguments[2], arguments[3], versions), 0;
    Fmu *fmu = fmu_open(arguments[2]);
    if (!strcmp(arguments[1], "replay")) replay(fmu, arguments[3], arguments + 4, count - 4);
    else hostile(fmu, atol(arguments[3]));
    fmu_close(fmu);
    return 0;
}
