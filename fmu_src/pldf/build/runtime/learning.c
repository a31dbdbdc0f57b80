/* What only a model that learns has: the stored profile, before a drive and after it. */
#include <math.h>
#include <stdlib.h>
#include <stdio.h>

#include "run.h"

bool learning_allows(const Importer *importer, const State *state) {
    const Learning *l = model.learning;
    for (int32_t i = 0; l && i < l->bound_count; i++) {
        const Variable *allowed = &model.variables[l->bounds[i].allowed];
        const Variable *used = &model.variables[l->bounds[i].used];
        double most = state->record[allowed->cell].real, value = state->record[used->cell].real;
        if (most != 0.0 && (value == 0.0 || fabs(value) > fabs(most))) /* 0 is no bound */
            return importer_tell(importer, ERROR_LEVEL,
                                 "parameter %s = %g: it bounds every profile, so it must not be weaker "
                                 "than %s = %g", allowed->name, most, used->name, value);
    }
    return true;
}

static bool learns(const State *state) {
    const Learning *l = model.learning;
    for (int i = 0; i < 3; i++)
        if (state->record[l->learn_if[i]].integer) return true;
    return false;
}

/* Whether it matters to this drive what is there. */
static bool uses_store(const State *state) {
    return learns(state) || state->record[model.learning->apply_learned].integer;
}

/* Fills in the folder; if there is none, returns and tells why. */
static int64_t find_store(const Importer *importer, const State *state, Run *run) {
    char found[PATH_SIZE] = "", why[REASON_SIZE];
    const char *given = state->texts[model.learning->store_text];
    if (*given || os_environment("PLDF_PROFILE_STORE", found)) {
        if (!*given) given = found;
        if (os_absolute(given, run->folder, why)) return PROFILE_STATUS_BASE;
        run->folder[0] = 0;
        importer_tell(importer, WARNING, "%s: not a possible profile store: %s; nothing is loaded or "
                                         "saved", given, why);
        return PROFILE_STATUS_REFUSED;
    }
    if (uses_store(state))
        importer_tell(importer, WARNING, "no profile store: nothing is loaded or saved. Set the "
                      "parameter profile_store or the environment variable PLDF_PROFILE_STORE to a "
                      "folder.");
    return PROFILE_STATUS_NOT_PERSISTED;
}

static int64_t load_profile(const Importer *importer, const State *state, Run *run) {
    int64_t status = find_store(importer, state, run);
    if (status != PROFILE_STATUS_BASE) return status;
    StoreResult found = store_load(importer, run->folder, &run->stored);
    if (found == STORE_NO_FOLDER) return PROFILE_STATUS_REFUSED;
    const double *base = run->block + model.learning->base_column * state->nodes;
    if (found == STORE_ABSENT && uses_store(state))
        store_tell_older(importer, run->folder, &run->stored, base);
    /* Told before the drive, not after it. */
    if (learns(state) && !store_writable(importer, run->folder)) return PROFILE_STATUS_NOT_WRITABLE;
    if (found == STORE_REFUSED || found == STORE_UNREADABLE) return PROFILE_STATUS_REFUSED;
    return found == STORE_LOADED && run->stored.count ? PROFILE_STATUS_LOADED : PROFILE_STATUS_BASE;
}

void learning_follow(const Importer *importer, State *state, Run *run) {
    const Learning *l = model.learning;
    Profile *p = &run->stored;
    if (!l) return;
    recording_open(importer, state, run);
    p->driver = state->record[l->driver_id].integer;
    p->nodes = state->nodes;
    state->record[l->profile_status].integer = load_profile(importer, state, run);
    if (p->bytes) run->history = calloc((size_t)p->count + 1, sizeof *run->history);
    words_follow(state, run);
    run_call(model.refresh, state, run, 0.0);
}

/* Adds what the drive taught to what its driver said. */
static bool add_lesson(const Importer *importer, State *state, Run *run, Profile *kept, char *why) {
    const Learning *l = model.learning;
    run_call(l->learn, state, run, 0.0);
    outcome_tell(importer, state, run);
    bool cut = state->record[l->intervening].integer;
    Lesson lesson = {run->block + l->base_column * state->nodes,
                     run->block + (l->next_column + NEXT_LEARNED_MPS) * state->nodes,
                     state->record[l->apply_learned].integer, "drive",
                     cut ? "drive, last intervention truncated" : "drive",
                     state->record[l->interventions].integer};
    return profile_add(kept, run->stored.bytes, &lesson, why);
}

static Level save(const Importer *importer, const State *state, const Run *run, Profile *kept,
                  bool taught, const char *why) {
    char what[REASON_SIZE];
    const Learning *l = model.learning;
    if (taught)
        snprintf(what, sizeof what, "drive %lld learned from %lld pedal interventions",
                 (long long)kept->count, (long long)state->record[l->interventions].integer);
    else snprintf(what, sizeof what, TEXT_WORDS_SAVED, (int)state->record[l->words].integer);
    return store_save(importer, run->folder, &run->stored, kept, what, why);
}

Level learning_finish(const Importer *importer, State *state, Run *run, bool before) {
    const Learning *l = model.learning;
    char why[REASON_SIZE] = "not enough memory";
    if (!l || !run->block) return INFO;
    bool taught = learns(state) && state->record[l->nodes].integer >= 2;
    if (!taught && !state->record[l->words].integer) return INFO;
    if (before) {
        importer_tell(importer, WARNING, "this drive had ended before its state was restored; it is not "
                                         "learned a second time");
        return WARNING;
    }
    Profile kept = run->stored;
    bool good = words_keep(state, run, &kept, why);
    good = (!taught || add_lesson(importer, state, run, &kept, why)) && good;
    if (good && kept.bytes == run->stored.bytes) return INFO;
    Level level = *run->folder ? save(importer, state, run, &kept, taught, good ? NULL : why) : INFO;
    if (kept.bytes != run->stored.bytes) profile_free(&kept);
    return level;
}
