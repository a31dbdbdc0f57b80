/* A scripted drive. The script is rows of float64: time in s, step in s (0: inputs are set and
   outputs read without a step), then the inputs. The results are rows of float64: all outputs, first
   after initialization, then after each row of the script. */
#include "host.h"

static void write_outputs(const Fmu *fmu, void *c, FILE *to) {
    double out[MANY];
    CHECK(get_outputs(fmu, c, out) == OK);
    CHECK(fwrite(out, sizeof *out, fmu->output_count, to) == fmu->output_count);
}

/* One instance for each file of results, side by side. */
void replay(const Fmu *fmu, const char *script, char **results, int count) {
    enum { MOST = 8 };
    void *instances[MOST];
    FILE *to[MOST], *from = fopen(script, "rb");
    double row[2 + MANY];
    size_t width = 2 + fmu->input_count;
    CHECK(from && count <= MOST);
    for (int i = 0; i < count; i++) {
        CHECK((to[i] = fopen(results[i], "wb")) != NULL);
        instances[i] = started(fmu, results[i]);
        write_outputs(fmu, instances[i], to[i]);
    }
    while (fread(row, sizeof *row, width, from) == width) {
        for (int i = 0; i < count; i++) {
            CHECK(set_inputs(fmu, instances[i], row + 2) == OK);
            if (row[1] != 0.0) CHECK(fmu->api->step(fmu, instances[i], row[0], row[1]) == OK);
            write_outputs(fmu, instances[i], to[i]);
        }
    }
    fclose(from);
    for (int i = 0; i < count; i++) {
        CHECK(fmu->api->terminate(fmu, instances[i]) <= WARNING); /* kept beside another drive's */
        fmu->api->free(fmu, instances[i]);
        CHECK(fclose(to[i]) == 0);
    }
}
