/* FMU states: one piece of memory; serialized, with a checksum behind it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "session.h"
#include "text.h"

/* How many values per node and per script line belong to the state. */
static int64_t kept_values(int64_t nodes, int64_t rows) {
    return model.kept_columns * nodes + model.script_columns * rows;
}

static bool is_whole(const State *state) {
    return state->phase == STEPPING || state->phase == TERMINATED;
}

static void keep_columns(const Session *s, double *columns) {
    int64_t kept = model.kept_columns * s->state.nodes, script = model.script_columns * s->state.rows;
    memcpy(columns, s->run.block, (size_t)(8 * kept));
    memcpy(columns + kept, s->run.block + model.node_columns * s->state.nodes, (size_t)(8 * script));
}

static void take_columns(Session *s, const double *columns) {
    int64_t kept = model.kept_columns * s->state.nodes, script = model.script_columns * s->state.rows;
    memcpy(s->run.block, columns, (size_t)(8 * kept));
    memcpy(s->run.block + model.node_columns * s->state.nodes, columns + kept, (size_t)(8 * script));
}

bool session_get_state(Session *s, void **state) {
    if (!s || !state) return false;
    bool whole = s->run.block && is_whole(&s->state);
    int64_t size = (int64_t)sizeof(State) + 8 * (whole ? kept_values(s->state.nodes, s->state.rows) : 0);
    State *copy = malloc((size_t)size);
    if (!copy) return importer_tell(&s->importer, ERROR_LEVEL, "not enough memory for a state");
    *copy = s->state;
    copy->size = size;
    if (whole) keep_columns(s, (double *)(copy + 1));
    free(*state);
    *state = copy;
    return true;
}

static bool same_parameters(const State *a, const State *b) {
    for (int32_t i = 0; i < model.variable_count; i++) {
        const Variable *v = &model.variables[i];
        if (v->kind != KIND_STRING && v->causality == PARAMETER && !v->tunable &&
            a->record[v->cell].integer != b->record[v->cell].integer)
            return false;
    }
    return memcmp(a->texts, b->texts, sizeof a->texts) == 0;
}

/* What is not in the state of a drive follows from its parameters, unless it is there already. */
static bool restore_drive(Session *s, const State *state) {
    bool here = s->prepared && same_parameters(&s->state, state);
    State found = here ? s->state : *state;
    Run run = {0};
    if (!here && !run_make(&s->importer, &found, &run)) return false;
    if (found.nodes != state->nodes || found.rows != state->rows) {
        run_release(&run);
        return importer_tell(&s->importer, ERROR_LEVEL, "the route of this state has changed; not restored");
    }
    if (!here) {
        run_release(&s->run);
        s->run = run;
    }
    s->state = *state;
    s->prepared = true;
    take_columns(s, (const double *)(state + 1));
    return true;
}

bool session_set_state(Session *s, const void *state) {
    if (!s || !state) return false;
    if (is_whole(state)) return restore_drive(s, state);
    run_release(&s->run);
    s->state = *(const State *)state;
    s->state.nodes = s->state.rows = s->state.ready = s->prepared = 0;
    return true;
}

bool session_free_state(Session *s, void **state) {
    if (state) free(*state), *state = NULL;
    return s != NULL;
}

bool session_serialized_size(Session *s, const void *state, size_t *size) {
    if (!s || !state || !size) return false;
    *size = (size_t)((const State *)state)->size + sizeof(uint32_t);
    return true;
}

bool session_serialize(Session *s, const void *state, void *bytes, size_t size) {
    size_t needed;
    if (!bytes || !session_serialized_size(s, state, &needed)) return false;
    if (size < needed) return importer_tell(&s->importer, ERROR_LEVEL, "too little room for the state");
    uint32_t sum = checksum(state, (int64_t)(needed - sizeof sum));
    memcpy(bytes, state, needed - sizeof sum);
    memcpy((uint8_t *)bytes + needed - sizeof sum, &sum, sizeof sum);
    return true;
}

static bool within(int64_t value, int64_t low, int64_t high) { return value >= low && value <= high; }

static bool has_sound_size(const State *state) {
    int64_t room = state->size / 8, size = (int64_t)sizeof *state;
    if (!is_whole(state)) return state->size == size;
    return within(state->nodes, 0, room) && within(state->rows, 0, room) && /* nothing overflows */
           state->size == size + 8 * kept_values(state->nodes, state->rows);
}

static bool has_sound_watches(const State *state) {
    for (int i = 0; i < WATCHES; i++)
        if (!within(state->told[i], 0, model.watches[i].count - 1)) return false;
    return true;
}

static bool has_sound_head(const State *state) {
    for (int i = 0; i < MODEL_TEXTS; i++)
        if (!memchr(state->texts[i], 0, PATH_SIZE)) return false;
    return within(state->phase, INSTANTIATED, TERMINATED) && within(state->ready, 0, 1) &&
           within(state->stale, 0, 1) && has_sound_watches(state) &&
           (isfinite(state->time) || (!is_whole(state) && state->time == -INFINITY));
}

static double place_of(const State *state, int32_t cell) {
    if (cell == NODES) return (double)state->nodes;
    if (cell == LAST_NODE) return (double)state->nodes - 1.0;
    return cell == NOWHERE ? 0.0 : (double)state->record[cell].integer;
}

/* What depends on the route is meaningless without one, and computed anew with it. */
static bool is_in_range(const State *state, const Range *range, double value) {
    double high = range->high;
    if (range->at_most != NOWHERE && is_whole(state))
        high = fmin(high, place_of(state, range->at_most) - place_of(state, range->plus));
    return value >= range->low && value <= high; /* NaN is not */
}

static bool has_sound_record(const State *state) {
    for (int i = 0; i < MODEL_CELLS; i++) {
        const Range *range = &model.ranges[i];
        Cell cell = state->record[i];
        double value = range->kind == KIND_INTEGER ? (double)cell.integer : cell.real;
        if (range->kind && !is_in_range(state, range, value)) return false;
    }
    return true;
}

static bool has_sound_column(const State *state, const Range *range, const uint8_t *bytes, int64_t count) {
    double value;
    for (int64_t i = 0; i < count; i++) {
        memcpy(&value, bytes + 8 * i, sizeof value);
        if (!is_in_range(state, range, value)) return false;
    }
    return true;
}

static bool has_sound_columns(const State *state, const uint8_t *bytes) {
    if (!is_whole(state)) return true;
    for (int i = 0; i < model.kept_columns + model.script_columns; i++) {
        int64_t count = i < model.kept_columns ? state->nodes : state->rows;
        if (!has_sound_column(state, &model.column_ranges[i], bytes, count)) return false;
        bytes += 8 * count;
    }
    return true;
}

/* Whether these bytes, with a checksum behind them, are a state of this build. Anybody can write a
   checksum, so every value is checked as well. */
static bool is_state(const uint8_t *bytes, size_t size) {
    State state;
    uint32_t sum;
    if (size < sizeof state) return false;
    memcpy(&state, bytes, sizeof state);
    memcpy(&sum, bytes + size, sizeof sum);
    return sum == checksum(bytes, (int64_t)size) && state.size == (int64_t)size &&
           strncmp(state.guid, model.guid, sizeof state.guid) == 0 && has_sound_size(&state) &&
           has_sound_head(&state) && has_sound_record(&state) &&
           has_sound_columns(&state, bytes + sizeof state);
}

bool session_deserialize(Session *s, const void *bytes, size_t size, void **state) {
    if (!s || !bytes || !state) return false;
    if (size < sizeof(uint32_t) || !is_state(bytes, size - sizeof(uint32_t)))
        return importer_tell(&s->importer, ERROR_LEVEL, "these bytes are not a state of this FMU; not restored");
    State *copy = malloc(size);
    if (!copy) return importer_tell(&s->importer, ERROR_LEVEL, "not enough memory for a state");
    memcpy(copy, bytes, size - sizeof(uint32_t));
    free(*state);
    *state = copy;
    return true;
}
