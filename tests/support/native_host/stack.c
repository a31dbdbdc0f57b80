/* Two whole drives side by side in a thread that has no more stack than it is given. The first one
   saves; the second one, which ends later, has to be kept beside it, and says so. */
#include "host.h"
#include "library.h"

typedef struct {
    const Fmu *fmu;
    const char *script;
} Drive;

static void step(const Fmu *fmu, void *c, const double *row) {
    static double out[MANY];
    CHECK(set_inputs(fmu, c, row + 2) == OK);
    if (row[1] != 0.0) CHECK(fmu->api->step(fmu, c, row[0], row[1]) == OK);
    CHECK(get_outputs(fmu, c, out) == OK);
}

static void drive(void *given) {
    const Drive *d = given;
    static double row[2 + MANY];
    size_t width = 2 + d->fmu->input_count;
    FILE *from = fopen(d->script, "rb");
    CHECK(from);
    void *one = started(d->fmu, "one"), *two = started(d->fmu, "two");
    while (fread(row, sizeof *row, width, from) == width) {
        step(d->fmu, one, row);
        step(d->fmu, two, row);
    }
    fclose(from);
    CHECK(d->fmu->api->terminate(d->fmu, one) == OK);
    CHECK(d->fmu->api->terminate(d->fmu, two) == WARNING);
    d->fmu->api->free(d->fmu, one);
    d->fmu->api->free(d->fmu, two);
}

void little_stack(const Fmu *fmu, const char *script, long kilobytes) {
    Drive d = {fmu, script};
    CHECK(run_in_thread(drive, &d, (size_t)kilobytes * 1024));
}
