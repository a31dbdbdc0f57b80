/* What became of each intervention of a drive, in the words of pldf/outcome_words.py. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "prepared.h"
#include "run.h"

typedef struct {
    char text[2048];
    int size;
} Line;

typedef struct {
    char text[24];
} Number;

static void add(Line *line, const char *format, ...) {
    int room = (int)sizeof line->text - line->size;
    va_list values;
    va_start(values, format);
    int size = vsnprintf(line->text + line->size, (size_t)room, format, values);
    va_end(values);
    line->size += size < room ? size : room - 1;
}

/* Rounded as in Python, and with a point whatever the locale. */
static int whole(double value) { return (int)floor(value + 0.5); }

static Number tenths(const char *sign, double value) {
    Number number;
    int count = whole(10.0 * fabs(value));
    snprintf(number.text, sizeof number.text, "%s%d.%d", sign, count / 10, count % 10);
    return number;
}

static Number signed_kmh(double mps) {
    double value = KMH_PER_MPS * mps;
    return tenths(whole(10.0 * value) < 0 ? "-" : "+", value);
}

static const double *trace(const State *state, const Run *run, int32_t column) {
    return run->block + (model.learning->trace_column + column) * state->nodes;
}

static const double *next(const State *state, const Run *run, int32_t column) {
    return run->block + (model.learning->next_column + column) * state->nodes;
}

#define TRACE(COLUMN) trace(state, run, TRACE_##COLUMN)[k]
#define NEXT(COLUMN) next(state, run, NEXT_##COLUMN)[k]

static bool is_told(const State *state, const Run *run, int64_t k) {
    int bound = (int)NEXT(HOLD_BOUND);
    return bound == BOUND_LATERAL_ACCEL || bound == BOUND_LEGAL_LIMIT ||
           NEXT(HOLD_TO_M) - NEXT(HOLD_FROM_M) >= TRANSITION_MIN_M;
}

static void add_hold(Line *line, const State *state, const Run *run, int64_t k) {
    int from = whole(NEXT(HOLD_FROM_M)), to = whole(NEXT(HOLD_TO_M));
    int low = whole(KMH_PER_MPS * NEXT(HOLD_LOW_MPS)), high = whole(KMH_PER_MPS * NEXT(HOLD_HIGH_MPS));
    const char *by = bound_words[(int)NEXT(HOLD_BOUND)];
    if (low == high) add(line, TEXT_HELD, low, from, to, by);
    else add(line, TEXT_HELD_BETWEEN, low, high, from, to, by);
}

/* Of the lesson of this intervention, 0: of the set speed. Returns how many were found. */
static int add_holds(Line *line, const State *state, const Run *run, int64_t intervention) {
    int found = 0;
    for (int64_t k = 0; k < state->record[model.learning->holds].integer; k++) {
        if ((int64_t)NEXT(HOLD_INTERVENTION) != intervention || !is_told(state, run, k)) continue;
        if (found < HOLDS_TOLD && (found || intervention)) add(line, TEXT_SEPARATOR);
        if (found++ < HOLDS_TOLD) add_hold(line, state, run, k);
    }
    if (found > HOLDS_TOLD) add(line, TEXT_SEPARATOR TEXT_MORE, found - HOLDS_TOLD);
    return found;
}

static void add_barred(Line *line, double metres) {
    if (metres > 0.0) add(line, TEXT_BARRED, whole(metres));
}

static Number accept(const State *state) {
    return tenths("", state->record[model.learning->accept].real);
}

typedef struct {
    char text[2 * sizeof(Name) + 32];
} Roads;

static int64_t millimetres(double s_m) { return (int64_t)floor(1000.0 * s_m + 0.5); }

/* On which roads of the file a piece of the route lies; empty if there is one only. */
static Roads roads(const Run *run, double from_m, double to_m) {
    Roads words = {""};
    Name first, last;
    if (mark_road(run->marks, millimetres(from_m), &first) < 2) return words;
    mark_road(run->marks, millimetres(to_m), &last);
    if (strcmp(first.text, last.text) == 0) snprintf(words.text, sizeof words.text, TEXT_ROAD, first.text);
    else snprintf(words.text, sizeof words.text, TEXT_ROADS, first.text, last.text);
    return words;
}

static void add_pedal(Line *line, const State *state, const Run *run, int64_t k) {
    const Learning *l = model.learning;
    add(line, TEXT_PEDAL, (int)k + 1, whole(TRACE(START_M)), whole(TRACE(END_M)),
        roads(run, TRACE(START_M), TRACE(END_M)).text);
    if (state->record[l->intervening].integer && k == state->record[l->interventions].integer - 1)
        add(line, TEXT_TRUNCATED);
    switch ((int)NEXT(OUTCOME)) {
    case OUTCOME_LEARNED:
        add(line, TEXT_LEARNED, whole(NEXT(TAUGHT_FROM_M)), whole(NEXT(TAUGHT_TO_M)),
            signed_kmh(NEXT(MEAN_CHANGE_MPS)).text, signed_kmh(NEXT(LARGEST_CHANGE_MPS)).text);
        add_barred(line, NEXT(BARRED_M));
        add_holds(line, state, run, k + 1);
        break;
    case OUTCOME_HOLE: add(line, TEXT_HOLE, tenths("", NEXT(HOLE_S)).text, whole(NEXT(HOLE_M))); break;
    case OUTCOME_STOP: add(line, TEXT_STOP, whole(KMH_PER_MPS * state->record[l->speed_min].real)); break;
    case OUTCOME_NOT_ELIGIBLE: add(line, TEXT_NOT_ELIGIBLE); break;
    case OUTCOME_FOLLOWING: add(line, TEXT_FOLLOWING); break;
    case OUTCOME_PENDING: add(line, TEXT_PENDING, tenths("", NEXT(PROOF)).text, accept(state).text); break;
    case OUTCOME_FORGOTTEN: add(line, TEXT_FORGOTTEN); break;
    case OUTCOME_UNDONE: add(line, TEXT_UNDONE); break;
    default: add(line, TEXT_NOT_MOVED);
    }
}

static void add_set_speed(Line *line, const State *state, const Run *run, int64_t k) {
    double wish = NEXT(SET_WISH_MPS), offset = NEXT(SET_OFFSET_MPS);
    double gain = state->record[model.learning->set_speed_gain].real;
    add(line, TEXT_SET_SPEED, whole(NEXT(SET_FROM_M)), whole(NEXT(SET_TO_M)),
        roads(run, NEXT(SET_FROM_M), NEXT(SET_TO_M)).text);
    switch ((int)NEXT(SET_OUTCOME)) {
    case OUTCOME_TAKEN_BACK: add(line, TEXT_SET_TAKEN_BACK); break;
    case OUTCOME_NOT_ELIGIBLE: add(line, TEXT_SET_NOT_ELIGIBLE, signed_kmh(wish).text); break;
    case OUTCOME_FORGOTTEN: add(line, TEXT_SET_FORGOTTEN, signed_kmh(wish).text); break;
    case OUTCOME_UNDONE: add(line, TEXT_SET_UNDONE, signed_kmh(wish).text); break;
    case OUTCOME_PENDING:
        add(line, TEXT_SET_PENDING, signed_kmh(wish).text, tenths("", NEXT(SET_PROOF)).text,
            accept(state).text);
        break;
    default:
        if (offset < wish - SAME_OFFSET_MPS)
            add(line, TEXT_SET_CUT, signed_kmh(offset).text, signed_kmh(wish).text);
        else add(line, TEXT_SET_LEARNED, signed_kmh(offset).text);
        if (gain < 1.0) add(line, TEXT_SET_SHARE, whole(100.0 * gain));
        add_barred(line, NEXT(SET_BARRED_M));
    }
}

static void add_place(Line *line, const State *state, const Run *run, int64_t k) {
    bool faster = NEXT(PLACE_SIGN) > 0.0, lever = (int)NEXT(PLACE_BY) == BY_LEVER;
    const char *test = lever ? faster ? TEXT_FASTER_BY_LEVER : TEXT_SLOWER_BY_LEVER
                             : faster ? TEXT_FASTER_BY_PEDALS : TEXT_SLOWER_BY_PEDALS;
    add(line, test, whole(NEXT(PLACE_FROM_M)), whole(NEXT(PLACE_TO_M)),
        roads(run, NEXT(PLACE_FROM_M), NEXT(PLACE_TO_M)).text);
    Number evidence = tenths("", NEXT(PLACE_EVIDENCE));
    switch ((int)NEXT(PLACE_CHANGE)) {
    case EVIDENCE_GAINED: add(line, TEXT_EVIDENCE_GAINED, evidence.text, accept(state).text); break;
    case EVIDENCE_LOST: add(line, TEXT_EVIDENCE_LOST, evidence.text, accept(state).text); break;
    case EVIDENCE_DROPPED: add(line, TEXT_EVIDENCE_DROPPED); break;
    case EVIDENCE_ACCEPTED: add(line, TEXT_EVIDENCE_ACCEPTED); break;
    default: add(line, TEXT_EVIDENCE_PUT_BACK);
    }
}

static void tell_places(const Importer *importer, const State *state, const Run *run) {
    for (int64_t k = 0; k < state->record[model.learning->places].integer; k++) {
        Line line = {.size = 0};
        if (NEXT(PLACE_TO_M) - NEXT(PLACE_FROM_M) < TRANSITION_MIN_M) continue;
        add_place(&line, state, run, k);
        importer_tell(importer, INFO, "%s", line.text);
    }
}

void outcome_tell(const Importer *importer, const State *state, const Run *run) {
    const Learning *l = model.learning;
    for (int64_t k = 0; k < state->record[l->interventions].integer; k++) {
        Line line = {.size = 0};
        add_pedal(&line, state, run, k);
        importer_tell(importer, INFO, "%s", line.text);
    }
    for (int64_t k = 0; k < state->record[l->set_series].integer; k++) {
        Line line = {.size = 0};
        add_set_speed(&line, state, run, k);
        importer_tell(importer, INFO, "%s", line.text);
    }
    Line line = {.size = 0};
    add(&line, TEXT_PLAN);
    if (add_holds(&line, state, run, 0)) importer_tell(importer, INFO, "%s", line.text);
    tell_places(importer, state, run);
}
