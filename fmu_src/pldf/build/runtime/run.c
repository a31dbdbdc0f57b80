/* What a run needs from the disk: route, script, stored profile; and what it leaves there. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "session.h"

enum { PROFILE_BASE, PROFILE_LOADED, PROFILE_REFUSED, PROFILE_NOT_PERSISTED, XY = 1 };

void run_release(Run *run) {
    free(run->block);
    profile_free(&run->stored);
    memset(run, 0, sizeof *run);
}

void run_call(Entry *entry, State *state, Run *run, double step_s) {
    if (entry) entry(state->record, run->block, state->nodes, state->rows, step_s);
}

/* Routes and scripts */

static bool wants(const State *state, int32_t cell, int64_t value) {
    return cell == -1 || (cell >= 0 && state->record[cell].integer == value);
}

static bool load(Session *s, const State *state, const char *kind, int32_t text, int32_t id,
                 int64_t columns, Prepared *found) {
    char path[PATH_SIZE + 64], why[REASON_SIZE] = "there is no such file", help[REASON_SIZE];
    const char *given = text >= 0 ? state->texts[text] : "";
    long long number = (long long)state->record[id].integer;
    snprintf(help, sizeof help, "a native FMU reads prepared files, see 'pldf %s --help'", kind);
    if (!*given && !*s->resources)
        return session_tell(s, ERROR_LEVEL, "no %s: the importer named no folder of resources, or "
                            "one with a path of more than %d bytes", kind, PATH_SIZE - 1);
    if (*given) snprintf(path, sizeof path, "%s", given);
    else snprintf(path, sizeof path, "%s/%s/%lld.prepared", s->resources, kind, number);
    return (disk_read(path, &found->bytes, &found->size, why) == READ_DONE &&
            prepared_parse(found, kind, columns, why)) ||
           session_tell(s, ERROR_LEVEL, "%s: %s; %s", path, why,
                        *given ? help : "choose another number, or unpack the FMU again");
}

static bool load_both(Session *s, const State *state, Prepared *route, Prepared *script) {
    if (wants(state, model.route_if, model.route_if_value)) {
        if (!load(s, state, "route", model.route_text, model.route_id, 5, route)) return false;
        if (model.learn && state->record[model.localization].integer == XY && !route->has_line)
            return session_tell(s, ERROR_LEVEL,
                                "the route has no x_m and y_m, so localization must be ARC_LENGTH");
    }
    return !wants(state, model.script_if, model.script_if_value) ||
           load(s, state, "script", model.script_text, model.script_id, model.script_columns, script);
}

static void copy_columns(double *to, const Prepared *from) {
    if (from->bytes) memcpy(to, from->bytes + from->head, (size_t)(8 * from->columns * from->rows));
}

/* Gives the block its size and fills in what was prepared. */
static bool fill_block(Session *s, State *state, Run *run, const Prepared *route,
                       const Prepared *script) {
    state->nodes = route->bytes ? route->rows : 2;
    state->rows = script->rows;
    int64_t values = model.node_columns * state->nodes + model.script_columns * state->rows;
    run->block = calloc((size_t)values, sizeof(double));
    if (!run->block) return session_tell(s, ERROR_LEVEL, "not enough memory for this route");
    for (int64_t i = 0; i < values; i += 512) /* the system gives every page now, not in a step */
        *(volatile double *)(run->block + i) = 0.0;
    copy_columns(run->block + model.route_column * state->nodes, route);
    copy_columns(run->block + model.node_columns * state->nodes, script);
    memcpy(run->stored.route, route->key, sizeof run->stored.route);
    return true;
}

/* The stored profile */

static bool learns(const State *state) {
    return state->record[model.learn_if[0]].integer || state->record[model.learn_if[1]].integer;
}

/* Fills in the folder; if there is none, returns and tells why. */
static int64_t find_store(Session *s, const State *state, Run *run) {
    char found[PATH_SIZE] = "", why[REASON_SIZE];
    const char *given = state->texts[model.store_text];
    if (*given || disk_environment("PLDF_PROFILE_STORE", found)) {
        if (!*given) given = found;
        if (disk_absolute(given, run->folder, why)) return PROFILE_BASE;
        run->folder[0] = 0;
        session_tell(s, WARNING, "%s: not a possible profile store: %s; nothing is loaded or saved",
                     given, why);
        return PROFILE_REFUSED;
    }
    if (learns(state) || state->record[model.apply_learned].integer)
        session_tell(s, WARNING, "no profile store: nothing is loaded or saved. Set the parameter "
                     "profile_store or the environment variable PLDF_PROFILE_STORE to a folder.");
    return PROFILE_NOT_PERSISTED;
}

static int64_t load_profile(Session *s, const State *state, Run *run) {
    char message[MESSAGE_SIZE];
    int64_t status = find_store(s, state, run);
    if (status != PROFILE_BASE) return status;
    StoreResult found = store_load(run->folder, &run->stored, message);
    if (found == STORE_LOADED && run->stored.count) return PROFILE_LOADED;
    if (found != STORE_REFUSED) return PROFILE_BASE;
    session_tell(s, WARNING, "%s", message);
    return PROFILE_REFUSED;
}

static void follow_stored(Session *s, State *state, Run *run) {
    Profile *p = &run->stored;
    int64_t nodes = state->nodes;
    p->driver = state->record[model.driver_id].integer;
    p->nodes = nodes;
    state->record[model.profile_status].integer = load_profile(s, state, run);
    int64_t count = p->bytes ? p->count : 0;
    state->record[model.profile_iteration].integer = count;
    if (!count || !state->record[model.apply_learned].integer) return;
    for (int column = 0; column < 4; column++)
        memcpy(run->block + (model.learned_column + column) * nodes,
               profile_block(p, 4 * count - 3 + column), (size_t)(8 * nodes));
    run_call(model.adopt, state, run, 0.0);
}

bool run_prepare(Session *s, State *state, Run *run) {
    Prepared route = {0}, script = {0};
    bool good = load_both(s, state, &route, &script) && fill_block(s, state, run, &route, &script);
    free(route.bytes);
    free(script.bytes);
    if (!good) return false;
    run_call(model.start, state, run, 0.0);
    if (model.learn) {
        follow_stored(s, state, run);
        run_call(model.refresh, state, run, 0.0);
    }
    return true;
}

Level run_learn(Session *s) {
    char message[MESSAGE_SIZE];
    State *state = &s->state;
    Cell *record = state->record;
    if (!model.learn || !s->run.block || !learns(state) || record[model.nodes].integer < 2)
        return INFO;
    if (s->finished) {
        session_tell(s, WARNING, "this drive had ended before its state was restored; it is not "
                     "learned a second time");
        return WARNING;
    }
    run_call(model.learn, state, &s->run, 0.0);
    Lesson lesson = {s->run.block + model.base_column * state->nodes,
                     s->run.block + model.following_column * state->nodes,
                     record[model.intervening].integer ? "drive, last intervention truncated" : "drive",
                     record[model.interventions].integer};
    if (!*s->run.folder) return INFO;
    Level level = store_save(s->run.folder, &s->run.stored, &lesson, message);
    session_tell(s, level, "%s", message);
    return level;
}
