/* Inputs and parameters that make no sense: every call is answered, no output is ever infinite. */
#include "host.h"

#include <math.h>
#include <string.h>

static uint32_t noise = SEED; /* the same on every platform, unlike rand() */

uint32_t dice(uint32_t sides) {
    noise = 1664525u * noise + 1013904223u;
    return (noise >> 8) % sides;
}

static double senseless(Kind kind) {
    static const double odd[] = {0, -0.0, 1, -1, 1e-300, 1e300, -1e300, 1e9, -1e9, NAN, INFINITY,
                                 -INFINITY, 4499.9, 4500, 20, 0.3};
    static const double whole[] = {0, 1, 2, 3, 4, 5, -1, 1000, 2147483647.0, -2147483648.0};
    if (kind == BOOLEAN) return dice(2);
    if (kind != REAL) return dice(3) ? dice(5) : whole[dice(10)];
    return dice(3) ? 30.0 * dice(1000001) / 1e6 : odd[dice(16)];
}

void senseless_inputs(const Fmu *fmu, double *values) {
    for (size_t i = 0; i < fmu->input_count; i++) values[i] = senseless(fmu->inputs[i].kind);
}

double senseless_step(void) { return dice(50) ? 1e-3 * (1 + dice(100)) : 1.7e-13; }

static double drive(const Fmu *fmu, void *c, long steps) {
    double in[MANY], out[MANY], time = 0.0;
    for (long k = 0; k < steps; k++) {
        double step = senseless_step();
        senseless_inputs(fmu, in);
        CHECK(set_inputs(fmu, c, in) == OK);
        if (dice(100) == 0) CHECK(get_outputs(fmu, c, out) == OK); /* without a step */
        CHECK(fmu->api->step(fmu, c, time, step) == OK);
        CHECK(get_outputs(fmu, c, out) == OK);
        for (size_t i = 0; i < fmu->output_count; i++) CHECK(isfinite(out[i]));
        time += step;
    }
    return time;
}

static void set_senseless_parameter(const Fmu *fmu, void *c) {
    static char long_text[5000];
    const char *const texts[] = {"", ".", "no/such/file", "\xff\xfe%n%s", long_text};
    Variable chosen = fmu->parameters[dice((uint32_t)fmu->parameter_count)];
    memset(long_text, 'a', sizeof long_text - 1);
    if (chosen.kind == TEXT) fmu->api->set_text(fmu, c, chosen.reference, texts[dice(5)]);
    else set_value(fmu, c, chosen, senseless(chosen.kind));
}

/* Most are refused in initialization; the instance stays usable. */
static void parameters(const Fmu *fmu, int rounds) {
    void *c = make(fmu, "senseless parameters"), *state = NULL;
    int driven = 0;
    for (int k = 0; k < rounds; k++) {
        for (uint32_t n = 1 + dice(2); n > 0; n--) set_senseless_parameter(fmu, c);
        CHECK(fmu->api->enter(fmu, c, 0.0) == OK);
        if (fmu->api->leave(fmu, c) == OK) {
            drive(fmu, c, 20);
            driven++;
            CHECK(fmu->api->get_state(fmu, c, &state) == OK);
            CHECK(fmu->api->terminate(fmu, c) <= WARNING); /* a store may be out of reach */
            if (dice(2)) CHECK(fmu->api->set_state(fmu, c, state) == OK);
        }
        CHECK(fmu->api->reset(fmu, c) == OK);
        make_settings(fmu, c);
    }
    CHECK(driven > 0 && driven < rounds);
    CHECK(fmu->api->free_state(fmu, c, &state) == OK && !state);
    fmu->api->free(fmu, c);
}

void hostile(const Fmu *fmu, long steps, uint32_t seed) {
    noise = seed;
    void *c = started(fmu, "hostile");
    drive(fmu, c, steps);
    CHECK(fmu->api->terminate(fmu, c) == OK);
    fmu->api->free(fmu, c);
    parameters(fmu, 300);
}

/* With files that may be damaged, whatever is answered. */
void attempt(const Fmu *fmu) {
    double in[MANY], out[MANY];
    void *c = make(fmu, "attempt");
    fmu->api->enter(fmu, c, 0.0);
    if (fmu->api->leave(fmu, c) == OK) {
        for (int k = 0; k < 100; k++) {
            senseless_inputs(fmu, in);
            set_inputs(fmu, c, in);
            fmu->api->step(fmu, c, k, 1.0);
            get_outputs(fmu, c, out);
        }
        CHECK(fmu->api->terminate(fmu, c) <= WARNING);
    }
    fmu->api->free(fmu, c);
}
