/* usage: native_host replay DESCRIPTION SCRIPT RESULTS [RESULTS ...]
          native_host check DESCRIPTION DESCRIPTION (of another model)
          native_host versions DESCRIPTION DESCRIPTION (of one model)
          native_host hostile DESCRIPTION STEPS [SEED]
          native_host reads DESCRIPTION SCRIPT
          native_host stack DESCRIPTION SCRIPT KILOBYTES
          native_host forge DESCRIPTION
          native_host attempt DESCRIPTION [DESCRIPTION ...]
   Ends with status 0 if all is well, and says on stderr which line is not. */
#include <string.h>

#include "host.h"

static void drive(const char *job, char **arguments, int count) {
    Fmu *fmu = fmu_open(arguments[0]);
    tells_warnings = !strcmp(job, "replay");
    if (!strcmp(job, "replay")) replay(fmu, arguments[1], arguments + 2, count - 2);
    else if (!strcmp(job, "hostile")) 
        hostile(fmu, atol(arguments[1]), count > 2 ? (uint32_t)atol(arguments[2]) : SEED);
    else if (!strcmp(job, "reads")) reads(fmu, arguments[1]);
    else if (!strcmp(job, "stack")) little_stack(fmu, arguments[1], atol(arguments[2]));
    else if (!strcmp(job, "forge")) forge(fmu);
    else attempt(fmu);
    fmu_close(fmu);
}

int main(int count, char **arguments) {
    CHECK(count >= 3);
    const char *job = arguments[1];
    if (!strcmp(job, "check")) check(arguments[2], arguments[3], false);
    else if (!strcmp(job, "versions")) check(arguments[2], arguments[3], true);
    else if (!strcmp(job, "attempt"))
        for (int i = 2; i < count; i++) drive(job, arguments + i, 1);
    else drive(job, arguments + 2, count - 2);
    return 0;
}
