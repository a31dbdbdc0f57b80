/* States that somebody has changed, with a checksum that fits: refused, or driven like any other.
   Every word of a state in turn gets values that no drive has there. */
#include "host.h"

#include <math.h>
#include <string.h>

enum { WORD = 8, STEPS = 3 };

static long accepted, stepped;
static size_t place; /* of the word that is being changed, from the end of the state */

static uint32_t crc32(const uint8_t *bytes, size_t size) {
    static uint32_t table[256];
    uint32_t sum = ~0u;
    for (uint32_t i = 0; !table[255] && i < 256; i++) {
        table[i] = i;
        for (int bit = 0; bit < 8; bit++) table[i] = table[i] >> 1 ^ (table[i] & 1 ? 0xEDB88320u : 0);
    }
    for (size_t i = 0; i < size; i++) sum = sum >> 8 ^ table[(sum ^ bytes[i]) & 255];
    return ~sum;
}

static void seal(uint8_t *bytes, size_t size) {
    uint32_t sum = crc32(bytes, size - sizeof sum);
    memcpy(bytes + size - sizeof sum, &sum, sizeof sum);
}

static void sensible_inputs(const Fmu *fmu, int k, double *in) {
    for (size_t i = 0; i < fmu->input_count; i++) {
        int n = (7 * k + 13 * (int)i) % 97;
        in[i] = fmu->inputs[i].kind == REAL ? n / 97.0 : n % 2;
    }
    in[0] = 0.2 * k; /* the position, where there is one */
}

static double drive(const Fmu *fmu, void *c, int steps) {
    double in[MANY];
    for (int k = 0; k < steps; k++) {
        sensible_inputs(fmu, k, in);
        CHECK(set_inputs(fmu, c, in) == OK);
        CHECK(fmu->api->step(fmu, c, 0.01 * k, 0.01) == OK);
    }
    return 0.01 * steps;
}

static void check_finite(const Fmu *fmu, void *c) {
    double out[MANY];
    bool finite = get_outputs(fmu, c, out) == OK;
    for (size_t i = 0; finite && i < fmu->output_count; i++) finite = isfinite(out[i]);
    if (!finite) fprintf(stderr, "%zu bytes before the end of the state:\n", place);
    CHECK(finite);
}

/* The time of a changed state may lie behind this one: then the step is refused. */
static void go_on(const Fmu *fmu, void *c, double time) {
    double in[MANY];
    for (int k = 0; k < STEPS; k++) {
        sensible_inputs(fmu, 41 + k, in);
        if (set_inputs(fmu, c, in) != OK) return;
        if (fmu->api->step(fmu, c, time + k, 1.0) != OK) return;
        check_finite(fmu, c);
        stepped++;
    }
    CHECK(fmu->api->terminate(fmu, c) <= WARNING); /* with what it learned from this */
}

typedef struct {
    void *instance, *honest;
    double time, outputs[MANY];
} Driven;

static void unchanged(const Fmu *fmu, const Driven *d) {
    double out[MANY];
    CHECK(get_outputs(fmu, d->instance, out) == OK);
    CHECK(memcmp(out, d->outputs, fmu->output_count * sizeof *out) == 0);
}

static void try_bytes(const Fmu *fmu, const Driven *d, const uint8_t *bytes, size_t size) {
    void *state = NULL;
    int status = fmu->api->deserialize(fmu, d->instance, bytes, size, &state);
    if (status == OK) status = fmu->api->set_state(fmu, d->instance, state);
    if (status == OK) {
        accepted++;
        go_on(fmu, d->instance, d->time);
        CHECK(fmu->api->set_state(fmu, d->instance, d->honest) == OK);
    }
    unchanged(fmu, d);
    CHECK(fmu->api->free_state(fmu, d->instance, &state) == OK);
}

static void try_word(const Fmu *fmu, const Driven *d, uint8_t *bytes, size_t size, size_t at) {
    static const int64_t whole[] = {-1, 2, 9, 1000, 1LL << 31, 1LL << 60, INT64_MAX, INT64_MIN};
    static const double real[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e18, -1.0, 0.5};
    uint8_t good[WORD];
    memcpy(good, bytes + at, WORD);
    place = size - at;
    for (int i = 0; i < 8 + 8; i++) {
        if (i < 8) memcpy(bytes + at, &whole[i], WORD);
        else memcpy(bytes + at, &real[i - 8], WORD);
        seal(bytes, size);
        try_bytes(fmu, d, bytes, size);
    }
    memcpy(bytes + at, good, WORD);
}

/* Of the unused rest of a text one word in many will do. */
static bool is_worth_it(const uint8_t *bytes, size_t at) {
    static const uint8_t zeros[1024];
    return at < sizeof zeros || at % 512 == 0 || memcmp(bytes + at - sizeof zeros, zeros, sizeof zeros) != 0;
}

void forge(const Fmu *fmu) {
    const Api *api = fmu->api;
    Driven d = {.instance = started(fmu, "forged")};
    size_t size = 0;
    d.time = drive(fmu, d.instance, 40);
    CHECK(get_outputs(fmu, d.instance, d.outputs) == OK);
    CHECK(api->get_state(fmu, d.instance, &d.honest) == OK);
    CHECK(api->state_size(fmu, d.instance, d.honest, &size) == OK);
    uint8_t *bytes = malloc(size);
    CHECK(bytes && api->serialize(fmu, d.instance, d.honest, bytes, size) == OK);
    uint32_t sum;
    memcpy(&sum, bytes + size - sizeof sum, sizeof sum);
    CHECK(sum == crc32(bytes, size - sizeof sum)); /* else nothing is tried here */
    long words = 0;
    for (size_t at = 0; at + WORD + sizeof sum <= size; at += WORD) {
        if (!is_worth_it(bytes, at)) continue;
        try_word(fmu, &d, bytes, size, at);
        words++;
    }
    printf("forged %ld accepted %ld stepped %ld\n", 16 * words, accepted, stepped);
    CHECK(accepted > words && accepted < 15 * words && stepped > accepted);
    CHECK(api->free_state(fmu, d.instance, &d.honest) == OK);
    free(bytes);
    api->free(fmu, d.instance);
}
