/* The driver's words, as pldf/driver_words.py: answered behind the step that heard them, kept as
   iterations at the end. */
#include <stdio.h>
#include <string.h>

#include "run.h"

static double *columns_of(const State *state, const Run *run, int32_t first) {
    return run->block + first * state->nodes;
}

static double *words_of(const State *state, const Run *run, int32_t column) {
    return columns_of(state, run, model.learning->trace_column + column);
}

/* What a profile keeps, into the columns from `to` on; what is NULL is zero. */
static void fill(double *to, const double *const *columns, int64_t nodes) {
    for (int column = 0; column < KERNEL_COLUMNS; column++, to += nodes) {
        const double *values = columns[COLUMN_LEARNED + column];
        if (values) memcpy(to, values, (size_t)(8 * nodes));
        else memset(to, 0, (size_t)(8 * nodes));
    }
}

void words_follow(State *state, Run *run) {
    const Learning *l = model.learning;
    const Profile *p = &run->stored;
    const double *columns[PROFILE_COLUMNS];
    int64_t count = p->bytes ? p->count : 0;
    state->record[l->profile_iteration].integer = count;
    if (!count || !state->record[l->apply_learned].integer) return;
    profile_past(p, count, columns);
    fill(columns_of(state, run, l->learned_column), columns, state->nodes);
    run_call(l->adopt, state, run, 0.0);
}

/* Number of the iteration that an undo takes back, 0: there is none. */
static int64_t lesson_to_undo(const State *state, const Run *run) {
    const Learning *l = model.learning;
    const double *kind = words_of(state, run, TRACE_WORD_KIND), *at = words_of(state, run, TRACE_WORD_AT);
    int64_t count = run->stored.bytes ? run->stored.count : 0, words = state->record[l->words].integer;
    if (!state->record[l->apply_learned].integer || words >= state->nodes) return 0;
    if (!count || !run->history) return 0;
    memset(run->history, 0, (size_t)(count + 1) * sizeof *run->history);
    for (int64_t k = 0; k < words; k++)
        if (kind[k] == WORD_UNDO && at[k] > 0.0 && at[k] <= (double)count)
            run->history[(int64_t)at[k]].undone = true;
    return profile_lesson_in_force(&run->stored, run->history);
}

/* Takes iteration `number` back; 0: there is nothing to take back. */
static void undo(State *state, Run *run, int64_t number) {
    const Learning *l = model.learning;
    const double *columns[PROFILE_COLUMNS];
    double *next = columns_of(state, run, l->next_column + NEXT_LEARNED_MPS);
    state->record[l->taken_back].integer = number;
    if (number) {
        profile_past(&run->stored, number, columns);
        fill(next, columns, state->nodes);
        run_call(l->mark, state, run, 0.0);
        profile_past(&run->stored, number - 1, columns);
        fill(next, columns, state->nodes);
    }
    run_call(l->take_back, state, run, 0.0);
}

static void tell(const Importer *importer, const State *state, const char *format, int64_t number) {
    char text[REASON_SIZE];
    snprintf(text, sizeof text, format, (int)number);
    importer_tell(importer, INFO, "t = %.3f s: %s", 1e-9 * (double)state->record[model.learning->time_ns].integer,
                  text);
}

void words_answer(const Importer *importer, State *state, Run *run) {
    const Learning *l = model.learning;
    if (!l || !state->record[l->teach_wanted].integer) return;
    int64_t wanted = state->record[l->teach_wanted].integer;
    state->record[l->teach_wanted].integer = 0;
    if (wanted & WORD_FORGET) {
        int64_t words = state->record[l->words].integer;
        run_call(l->forget, state, run, 0.0);
        bool forgotten = state->record[l->words].integer > words;
        tell(importer, state, forgotten ? TEXT_WORD_FORGOTTEN : TEXT_WORD_NOTHING_TO_FORGET,
             (int64_t)state->record[l->s_m].real);
    }
    if (wanted & WORD_UNDO) {
        int64_t number = lesson_to_undo(state, run);
        undo(state, run, number);
        tell(importer, state, number ? TEXT_WORD_UNDONE : TEXT_WORD_NOTHING_TO_UNDO, number);
    }
}

/* Keeping */

static bool keep(const State *state, const Run *run, Profile *kept, const char *kind, const char *format,
                 double at, char *why) {
    char note[64];
    const Learning *l = model.learning;
    snprintf(note, sizeof note, format, (int)at);
    Lesson lesson = {columns_of(state, run, l->base_column), columns_of(state, run, l->learned_column),
                     true, kind, note, 0};
    return profile_add(kept, run->stored.bytes, &lesson, why);
}

/* Says one word again and adds its iteration. */
static bool say(State *state, Run *run, Profile *kept, int kind, double at, char *why) {
    if (kind == WORD_UNDO && at > 0.0 && at <= (double)run->stored.count) {
        undo(state, run, (int64_t)at);
        return keep(state, run, kept, "undo", TEXT_UNDO_NOTE, at, why);
    }
    if (kind != WORD_FORGET) return true; /* of a state that this drive cannot have had */
    state->record[model.learning->s_m].real = at;
    run_call(model.learning->forget, state, run, 0.0);
    return keep(state, run, kept, "forget", TEXT_FORGET_NOTE, at, why);
}

bool words_keep(State *state, Run *run, Profile *kept, char *why) {
    const Learning *l = model.learning;
    int64_t words = state->record[l->words].integer;
    bool good = true;
    Cell at_the_end[MODEL_CELLS];
    if (!words) return true;
    memcpy(at_the_end, state->record, sizeof at_the_end);
    words_follow(state, run);
    state->record[l->words].integer = state->record[l->input_state].integer = 0;
    /* nothing recorded is barred a second time */
    state->record[l->nodes].integer = state->record[l->interventions].integer = 0;
    for (int64_t k = 0; good && k < words; k++)
        good = say(state, run, kept, (int)words_of(state, run, TRACE_WORD_KIND)[k],
                   words_of(state, run, TRACE_WORD_AT)[k], why);
    memcpy(state->record, at_the_end, sizeof at_the_end);
    return good;
}
