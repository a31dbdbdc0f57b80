/* A whole drive in a thread that has no more stack than it is given. */
#include "host.h"
#include "library.h"

typedef struct {
    const Fmu *fmu;
    const char *script;
} Drive;

static void drive(void *given) {
    const Drive *d = given;
    static double row[2 + MANY], out[MANY];
    size_t width = 2 + d->fmu->input_count;
    FILE *from = fopen(d->script, "rb");
    CHECK(from);
    void *c = started(d->fmu, "little stack");
    while (fread(row, sizeof *row, width, from) == width) {
        CHECK(set_inputs(d->fmu, c, row + 2) == OK);
        if (row[1] != 0.0) CHECK(d->fmu->api->step(d->fmu, c, row[0], row[1]) == OK);
        CHECK(get_outputs(d->fmu, c, out) == OK);
    }
    fclose(from);
    CHECK(d->fmu->api->terminate(d->fmu, c) == OK);
    d->fmu->api->free(d->fmu, c);
}

void little_stack(const Fmu *fmu, const char *script, long kilobytes) {
    Drive d = {fmu, script};
    CHECK(run_in_thread(drive, &d, (size_t)kilobytes * 1024));
}
