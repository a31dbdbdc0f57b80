/* Reading an output, or setting an input to the value that it has, changes nothing. */
#include "host.h"

#include <string.h>

static bool same(const Fmu *fmu, const double *a, const double *b) {
    return memcmp(a, b, fmu->output_count * sizeof *a) == 0;
}

static void set_some_again(const Fmu *fmu, void *c, const double *in) {
    for (size_t i = 0; i < fmu->input_count; i++)
        if (dice(2)) CHECK(set_value(fmu, c, fmu->inputs[i], in[i]) == OK);
}

/* What a curious importer does between two steps; outputs are those of the last one. */
static void disturb(const Fmu *fmu, void *c, const double *in, const double *out) {
    double found[MANY];
    for (uint32_t n = dice(4); n > 0; n--) {
        if (dice(2)) set_some_again(fmu, c, in);
        CHECK(get_outputs(fmu, c, found) == OK);
        CHECK(same(fmu, found, out));
    }
}

/* Inputs are set one by one, and outputs are read in between. */
static void set_inputs_curiously(const Fmu *fmu, void *c, const double *in) {
    double found[MANY];
    for (size_t i = 0; i < fmu->input_count; i++) {
        CHECK(set_value(fmu, c, fmu->inputs[i], in[i]) == OK);
        if (dice(3) == 0) CHECK(get_outputs(fmu, c, found) == OK);
    }
}

/* Every output of a drive that is disturbed is that of one that is not. */
void reads(const Fmu *fmu, const char *script) {
    double row[2 + MANY], expected[MANY], found[MANY];
    size_t width = 2 + fmu->input_count;
    void *calm = started(fmu, "calm"), *disturbed = started(fmu, "disturbed");
    FILE *from = fopen(script, "rb");
    CHECK(from);
    CHECK(get_outputs(fmu, calm, expected) == OK);
    while (fread(row, sizeof *row, width, from) == width) {
        if (row[1] == 0.0) continue;
        CHECK(set_inputs(fmu, calm, row + 2) == OK);
        set_inputs_curiously(fmu, disturbed, row + 2);
        CHECK(fmu->api->step(fmu, calm, row[0], row[1]) == OK);
        CHECK(fmu->api->step(fmu, disturbed, row[0], row[1]) == OK);
        CHECK(get_outputs(fmu, calm, expected) == OK);
        CHECK(get_outputs(fmu, disturbed, found) == OK);
        CHECK(same(fmu, found, expected));
        disturb(fmu, disturbed, row + 2, expected);
    }
    fclose(from);
    CHECK(fmu->api->terminate(fmu, calm) <= WARNING);
    CHECK(fmu->api->terminate(fmu, disturbed) <= WARNING);
    fmu->api->free(fmu, calm);
    fmu->api->free(fmu, disturbed);
}
