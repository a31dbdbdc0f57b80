/* What the standard asks of an FMU, and what simulators do to one. */
#include "host.h"

#include <math.h>
#include <string.h>

static void drive(const Fmu *fmu, void *c, int from, int to) {
    double in[MANY];
    for (int k = from; k < to; k++) {
        for (size_t i = 0; i < fmu->input_count; i++) {
            int n = (7 * k + 13 * (int)i) % 97;
            in[i] = fmu->inputs[i].kind == REAL ? n / 97.0 : n % 2;
        }
        in[0] = 0.2 * k;
        CHECK(set_inputs(fmu, c, in) == OK);
        CHECK(fmu->api->step(fmu, c, 0.01 * k, 0.01) == OK);
    }
}

static void expect(const Fmu *fmu, void *c, const double *expected) {
    double found[MANY];
    CHECK(get_outputs(fmu, c, found) == OK);
    CHECK(memcmp(found, expected, fmu->output_count * sizeof *found) == 0);
}

static void order_of_calls(const Fmu *fmu) {
    const Api *api = fmu->api;
    const double bad[] = {0.0, -1.0, NAN, INFINITY, 1e9};
    void *c = make(fmu, "wrong order/with a path");
    errors = 0;
    CHECK(api->step(fmu, c, 0.0, 0.01) == ERROR);
    CHECK(api->leave(fmu, c) == ERROR);
    CHECK(api->terminate(fmu, c) == ERROR);
    CHECK(api->enter(fmu, c, NAN) == ERROR);
    CHECK(api->unsupported(fmu, c) == ERROR);
    CHECK(errors >= 5);
    start(fmu, c);
    CHECK(api->enter(fmu, c, 0.0) == ERROR);
    for (int i = 0; i < 5; i++) CHECK(api->step(fmu, c, 0.0, bad[i]) == ERROR);
    CHECK(api->step(fmu, c, NAN, 0.01) == ERROR);
    drive(fmu, c, 0, 3);
    CHECK(api->step(fmu, c, 0.0, 0.01) == ERROR); /* back in time */
    CHECK(set_value(fmu, c, fmu->parameters[0], 0.0) == ERROR); /* fixed */
    drive(fmu, c, 3, 6);
    CHECK(api->terminate(fmu, c) == OK);
    CHECK(api->step(fmu, c, 0.06, 0.01) == ERROR);
    CHECK(api->terminate(fmu, c) == ERROR);
    CHECK(api->enter(fmu, c, 0.0) == ERROR);
    api->free(fmu, c);
}

static void what_is_not_there(const Fmu *fmu) {
    const Api *api = fmu->api;
    void *c = started(fmu, "unknown");
    uint32_t references[] = {fmu->outputs[0].reference, UNKNOWN};
    double values[2] = {0.0, 0.0};
    for (Kind kind = REAL; kind < TEXT; kind++) {
        CHECK(api->get(fmu, c, kind, references + 1, 1, values) == ERROR);
        CHECK(api->set(fmu, c, kind, references + 1, 1, values) == ERROR);
        CHECK(api->get(fmu, c, kind, references, 2, values) == ERROR); /* one good, one not */
        CHECK(api->get(fmu, c, kind, NULL, 0, NULL) == OK);
    }
    for (size_t i = 0; i < fmu->output_count; i++) {
        Variable v = fmu->outputs[i];
        Kind another = v.kind == REAL ? BOOLEAN : REAL;
        CHECK(set_value(fmu, c, v, 0.0) == ERROR);
        CHECK(api->get(fmu, c, another, &v.reference, 1, values) == ERROR);
    }
    CHECK(api->set_text(fmu, c, UNKNOWN, "x") == ERROR);
    CHECK(api->set_text(fmu, c, fmu->inputs[0].reference, "x") == ERROR);
    CHECK(api->get(fmu, c, fmu->outputs[0].kind, NULL, 1, values) == ERROR);
    drive(fmu, c, 0, 3); /* as if nothing had been */
    api->free(fmu, c);
    CHECK(!api->instantiate(fmu, "x", "{of another}"));
    CHECK(!api->instantiate(fmu, "", fmu->token));
    CHECK(api->other_kinds_refused(fmu));
    CHECK(api->step(fmu, NULL, 0.0, 0.01) == ERROR);
    CHECK(api->get(fmu, NULL, REAL, references, 1, values) == ERROR);
    CHECK(api->set_state(fmu, NULL, NULL) == ERROR);
    api->free(fmu, NULL);
}

/* Outputs are right in initialization mode, after it, and follow the inputs without a step. */
static void outputs_without_steps(const Fmu *fmu) {
    double first[MANY], moved[MANY] = {0.0}, zeros[MANY] = {0.0};
    void *c = make(fmu, "feedthrough");
    CHECK(fmu->api->enter(fmu, c, 0.0) == OK);
    CHECK(set_inputs(fmu, c, zeros) == OK);
    CHECK(get_outputs(fmu, c, first) == OK);
    CHECK(fmu->api->leave(fmu, c) == OK);
    expect(fmu, c, first);
    drive(fmu, c, 0, 5);
    CHECK(set_inputs(fmu, c, zeros) == OK);
    CHECK(get_outputs(fmu, c, first) == OK);
    moved[0] = 5.0;
    CHECK(set_inputs(fmu, c, moved) == OK);
    CHECK(get_outputs(fmu, c, moved) == OK);
    CHECK(set_inputs(fmu, c, zeros) == OK);
    expect(fmu, c, first);
    fmu->api->free(fmu, c);
}

/* Two at once are as one alone, and so is one after reset. */
static void instances(const Fmu *fmu) {
    double expected[MANY];
    void *one = started(fmu, "one"), *two = started(fmu, "two");
    drive(fmu, one, 0, 300);
    CHECK(get_outputs(fmu, one, expected) == OK);
    for (int k = 0; k < 300; k += 10) {
        drive(fmu, two, k, k + 10);
        drive(fmu, one, 300 + k, 310 + k);
    }
    expect(fmu, two, expected);
    CHECK(fmu->api->terminate(fmu, two) == OK);
    CHECK(fmu->api->reset(fmu, two) == OK);
    CHECK(fmu->api->reset(fmu, two) == OK); /* nothing to be done */
    make_settings(fmu, two);
    start(fmu, two);
    drive(fmu, two, 0, 300);
    expect(fmu, two, expected);
    fmu->api->free(fmu, one);
    drive(fmu, two, 300, 310);
    CHECK(fmu->api->reset(fmu, two) == OK); /* in the middle of a drive */
    fmu->api->free(fmu, two);
}

static void damaged_states(const Fmu *fmu, void *c, uint8_t *bytes, size_t size) {
    void *state = NULL;
    for (size_t at = 0; at < size; at += size / 200 + 1) {
        bytes[at] ^= 1;
        CHECK(fmu->api->deserialize(fmu, c, bytes, size, &state) == ERROR && !state);
        bytes[at] ^= 1;
        CHECK(fmu->api->deserialize(fmu, c, bytes, at, &state) == ERROR && !state);
    }
    CHECK(fmu->api->serialize(fmu, c, NULL, bytes, size) == ERROR);
    CHECK(fmu->api->set_state(fmu, c, NULL) == ERROR);
}

/* 200 steps at once are as 100, save, restore in another instance, 100 more. */
static void states(const Fmu *fmu) {
    const Api *api = fmu->api;
    void *one = started(fmu, "one"), *two = make(fmu, "two"), *state = NULL, *copy = NULL;
    double expected[MANY];
    size_t size = 0;
    drive(fmu, one, 0, 100);
    CHECK(api->get_state(fmu, one, &state) == OK);
    CHECK(api->state_size(fmu, one, state, &size) == OK);
    uint8_t *bytes = malloc(size);
    CHECK(bytes);
    CHECK(api->serialize(fmu, one, state, bytes, size - 1) == ERROR);
    CHECK(api->serialize(fmu, one, state, bytes, size) == OK);
    drive(fmu, one, 100, 200);
    CHECK(get_outputs(fmu, one, expected) == OK);
    CHECK(api->deserialize(fmu, two, bytes, size, &copy) == OK);
    CHECK(api->set_state(fmu, two, copy) == OK); /* was not even initialized */
    drive(fmu, two, 100, 200);
    expect(fmu, two, expected);
    CHECK(api->set_state(fmu, one, state) == OK); /* back in time in the same instance */
    drive(fmu, one, 100, 200);
    expect(fmu, one, expected);
    CHECK(api->terminate(fmu, one) == OK);
    CHECK(api->set_state(fmu, one, state) == OK); /* and from behind the end */
    drive(fmu, one, 100, 200);
    expect(fmu, one, expected);
    CHECK(api->get_state(fmu, two, &copy) == OK); /* into the memory of an older one */
    damaged_states(fmu, two, bytes, size);
    drive(fmu, two, 200, 210);
    CHECK(api->free_state(fmu, one, &state) == OK && !state);
    CHECK(api->free_state(fmu, two, &copy) == OK && !copy);
    CHECK(api->free_state(fmu, two, &copy) == OK);
    free(bytes);
    api->free(fmu, one);
    api->free(fmu, two);
}

static void refuse_state_of(const Fmu *fmu, void *c, const Fmu *other, void *d) {
    void *state = NULL, *copy = NULL;
    size_t size = 0;
    CHECK(other->api->get_state(other, d, &state) == OK);
    CHECK(other->api->state_size(other, d, state, &size) == OK);
    uint8_t *bytes = malloc(size);
    CHECK(bytes && other->api->serialize(other, d, state, bytes, size) == OK);
    CHECK(fmu->api->deserialize(fmu, c, bytes, size, &copy) == ERROR && !copy);
    CHECK(other->api->free_state(other, d, &state) == OK);
    free(bytes);
}

/* Neither disturbs the other; the first goes on when the second is gone. */
static void two_fmus(const Fmu *fmu, const char *description, bool same_model) {
    Fmu *other = fmu_open(description);
    void *a = started(fmu, "a"), *b = started(other, "b");
    double alone[MANY];
    drive(fmu, a, 0, 50);
    CHECK(get_outputs(fmu, a, alone) == OK);
    drive(other, b, 0, 50);
    if (same_model) expect(other, b, alone);
    else refuse_state_of(fmu, a, other, b);
    CHECK(!other->api->instantiate(other, "x", fmu->token));
    expect(fmu, a, alone);
    other->api->free(other, b);
    fmu_close(other);
    drive(fmu, a, 50, 60);
    fmu->api->free(fmu, a);
}

void check(const char *description, const char *other, bool same_model) {
    for (int round = 0; round < 2; round++) { /* loaded again after it was unloaded */
        Fmu *fmu = fmu_open(description);
        order_of_calls(fmu);
        what_is_not_there(fmu);
        outputs_without_steps(fmu);
        instances(fmu);
        states(fmu);
        two_fmus(fmu, other, same_model);
        fmu_close(fmu);
    }
}
