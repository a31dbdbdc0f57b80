#include "session.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double STEP_MAX_S = 60.0; /* longer ones are a mistake in units */
enum { PROFILE_BASE, PROFILE_LOADED, PROFILE_REFUSED, PROFILE_NOT_PERSISTED, XY = 1 };

void session_complain(Session *s, Level level, const char *format, ...) {
    char text[MESSAGE_SIZE];
    va_list values;
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    s->tell(s->host, level, text);
}

static void clear(Session *s) {
    memset(&s->state, 0, sizeof s->state);
    snprintf(s->state.guid, sizeof s->state.guid, "%s", model.guid);
    memcpy(s->state.record, model.defaults, sizeof s->state.record);
    s->state.time = -INFINITY;
    s->prepared = s->finished = false;
}

Session *session_new(const char *resources, Tell *tell, void *host) {
    Session *s = calloc(1, sizeof *s);
    if (!s) return NULL;
    clear(s);
    path_of_address(resources, s->resources);
    s->tell = tell;
    s->host = host;
    return s;
}

static void release(Run *run) {
    free(run->block);
    profile_free(&run->stored);
    memset(run, 0, sizeof *run);
}

static void call(Entry *entry, State *state, Run *run, double step_s) {
    if (entry) entry(state->record, run->block, state->nodes, state->rows, step_s);
}

/* Routes and scripts */

static bool wants(const State *state, int32_t cell, int64_t value) {
    return cell == -1 || (cell >= 0 && state->record[cell].integer == value);
}

static bool load(Session *s, const State *state, const char *kind, int32_t text, int32_t id,
                 int64_t columns, Prepared *found) {
    char path[PATH_SIZE + 64], why[REASON_SIZE] = "";
    const char *given = text >= 0 ? state->texts[text] : "";
    long long number = (long long)state->record[id].integer;
    if (*given) snprintf(path, sizeof path, "%s", given);
    else snprintf(path, sizeof path, "%s/%s/%lld.prepared", s->resources, kind, number);
    ReadResult result = disk_read(path, (int64_t)1 << 32, &found->bytes, &found->size, why);
    if (result == READ_ABSENT) snprintf(why, sizeof why, "there is no such file");
    if (result == READ_DONE && prepared_parse(found, kind, columns, why)) return true;
    if (result == READ_DONE) free(found->bytes);
    found->bytes = NULL;
    session_complain(s, ERROR_LEVEL, "%s: %s; %s", path, why,
                     *given ? "a native FMU reads prepared files, see 'pldf route --help'"
                            : "choose another number, or unpack the FMU again");
    return false;
}

/* Gives the block its size and fills in what was prepared; frees both files. */
static bool fill_block(Session *s, State *state, Run *run, Prepared *route, Prepared *script) {
    state->nodes = route->bytes ? route->rows : 2;
    state->rows = script->bytes ? script->rows : 0;
    int64_t values = model.node_columns * state->nodes + model.script_columns * state->rows;
    run->block = calloc((size_t)values, sizeof(double));
    if (run->block && route->bytes)
        memcpy(run->block + model.route_column * state->nodes, route->bytes + route->head,
               (size_t)(8 * route->columns * route->rows));
    if (run->block && script->bytes)
        memcpy(run->block + model.node_columns * state->nodes, script->bytes + script->head,
               (size_t)(8 * script->columns * script->rows));
    snprintf(run->stored.route, sizeof run->stored.route, "%s", route->key);
    free(route->bytes);
    free(script->bytes);
    if (!run->block) session_complain(s, ERROR_LEVEL, "not enough memory for this route");
    return run->block != NULL;
}

static bool load_all(Session *s, State *state, Run *run) {
    Prepared route = {0}, script = {0};
    if (wants(state, model.route_if, model.route_if_value)) {
        if (!load(s, state, "route", model.route_text, model.route_id, 5, &route)) return false;
        if (model.learn && state->record[model.localization].integer == XY && !route.has_line) {
            session_complain(s, ERROR_LEVEL,
                             "the route has no x_m and y_m, so localization must be ARC_LENGTH");
            free(route.bytes);
            return false;
        }
    }
    if (wants(state, model.script_if, model.script_if_value) &&
        !load(s, state, "script", model.script_text, model.script_id, model.script_columns, &script)) {
        free(route.bytes);
        return false;
    }
    return fill_block(s, state, run, &route, &script);
}

/* The stored profile */

static bool learns(const State *state) {
    return state->record[model.learn_if[0]].integer || state->record[model.learn_if[1]].integer;
}

static void find_store(Session *s, const State *state, Run *run) {
    char folder[PATH_SIZE] = "";
    const char *given = state->texts[model.store_text];
    if (*given || disk_environment("PLDF_PROFILE_STORE", folder))
        disk_absolute(*given ? given : folder, run->folder);
    if (!*run->folder && (learns(state) || state->record[model.apply_learned].integer))
        session_complain(s, WARNING, "no profile store: nothing is loaded or saved. Set the parameter "
                         "profile_store or the environment variable PLDF_PROFILE_STORE to a folder.");
}

static void follow_stored(Session *s, State *state, Run *run) {
    char message[MESSAGE_SIZE];
    Profile *p = &run->stored;
    p->driver = state->record[model.driver_id].integer;
    p->nodes = state->nodes;
    int64_t status = PROFILE_NOT_PERSISTED;
    find_store(s, state, run);
    if (*run->folder) {
        StoreResult found = store_load(run->folder, p, message);
        if (found == STORE_REFUSED) session_complain(s, WARNING, "%s", message);
        status = found == STORE_REFUSED                ? PROFILE_REFUSED
                 : found == STORE_LOADED && p->count   ? PROFILE_LOADED
                                                       : PROFILE_BASE;
    }
    state->record[model.profile_status].integer = status;
    int64_t count = p->bytes ? p->count : 0, nodes = state->nodes;
    state->record[model.profile_iteration].integer = count;
    if (!count || !state->record[model.apply_learned].integer) return;
    for (int column = 0; column < 4; column++)
        memcpy(run->block + (model.learned_column + column) * nodes,
               profile_block(p, 4 * count - 3 + column), (size_t)(8 * nodes));
    call(model.adopt, state, run, 0.0);
}

static void learn(Session *s) {
    char message[MESSAGE_SIZE];
    State *state = &s->state;
    Cell *record = state->record;
    if (!model.learn || !s->run.block || !learns(state) || record[model.nodes].integer < 2) return;
    call(model.learn, state, &s->run, 0.0);
    Lesson lesson = {s->run.block + model.base_column * state->nodes,
                     s->run.block + model.following_column * state->nodes,
                     record[model.intervening].integer ? "drive, last intervention truncated" : "drive",
                     record[model.interventions].integer};
    if (!*s->run.folder) return;
    Level level = store_save(s->run.folder, &s->run.stored, &lesson, message);
    session_complain(s, level, "%s", message);
}

/* Life cycle */

static void watch(Session *s, bool stepped) {
    Cell *record = s->state.record;
    int64_t now = record[model.watch].integer;
    if (model.watch_flag >= 0) { /* once per drive */
        if (!now || record[model.watch_flag].integer) return;
        record[model.watch_flag].integer = 1;
        session_complain(s, WARNING, "%s", model.watch_texts[now]);
    } else if (stepped && now != s->state.told) {
        s->state.told = now;
        session_complain(s, now ? WARNING : INFO, "t = %.3f s: %s",
                         1e-9 * (double)record[model.watch_time].integer, model.watch_texts[now]);
    }
}

static bool check_parameters(Session *s) {
    for (int32_t i = 0; i < model.variable_count; i++) {
        const Variable *v = &model.variables[i];
        if (v->causality > FIXED_PARAMETER || v->kind == KIND_STRING) continue;
        Cell cell = s->state.record[v->cell];
        double value = v->kind == KIND_REAL ? cell.real : (double)cell.integer;
        if (value >= v->low && value <= v->high) continue;
        session_complain(s, ERROR_LEVEL, "parameter %s = %.17g: it must lie between %g and %g", v->name,
                         value, v->low, v->high);
        return false;
    }
    return true;
}

/* Starts anew with what was set so far; the old run stays if that fails. */
static bool initialize(Session *s) {
    State fresh = s->state;
    Run run = {0};
    s->state.ready = s->prepared = false;
    memcpy(fresh.record, model.defaults, sizeof fresh.record);
    for (int32_t i = 0; i < model.variable_count; i++) {
        const Variable *v = &model.variables[i];
        if (v->causality != OUTPUT && v->kind != KIND_STRING)
            fresh.record[v->cell] = s->state.record[v->cell];
    }
    if (!check_parameters(s) || !load_all(s, &fresh, &run)) return false;
    call(model.start, &fresh, &run, 0.0);
    if (model.learn) {
        follow_stored(s, &fresh, &run);
        call(model.refresh, &fresh, &run, 0.0);
    }
    release(&s->run);
    s->run = run;
    s->state = fresh;
    s->state.ready = s->prepared = true;
    s->state.stale = s->state.told = 0;
    watch(s, false);
    return true;
}

static bool bring_up_to_date(Session *s) {
    if (s->state.phase == INITIALIZING && !s->state.ready) return initialize(s);
    if (s->state.stale && (s->state.phase == INITIALIZING || s->state.phase == STEPPING)) {
        call(model.refresh, &s->state, &s->run, 0.0);
        s->state.stale = 0;
    }
    return true;
}

bool session_allows(Session *s, const char *call_name, unsigned phases) {
    static const char *const names[] = {"INSTANTIATED", "INITIALIZING", "STEPPING", "TERMINATED"};
    if (phases >> s->state.phase & 1) return true;
    session_complain(s, ERROR_LEVEL, "%s is not allowed in phase %s", call_name, names[s->state.phase]);
    return false;
}

bool session_set_start(Session *s, double time) {
    if (!isfinite(time)) {
        session_complain(s, ERROR_LEVEL, "the start time must be finite, not %g", time);
        return false;
    }
    s->state.time = time;
    return true;
}

bool session_exit_initialization(Session *s) {
    if (!bring_up_to_date(s)) return false;
    s->state.phase = STEPPING;
    return true;
}

bool session_step(Session *s, double time, double step_s) {
    double last = s->state.time;
    if (!(step_s > 0.0 && step_s <= STEP_MAX_S))
        session_complain(s, ERROR_LEVEL, "a step must be above 0 and at most %g s, not %g", STEP_MAX_S,
                         step_s);
    else if (!isfinite(time))
        session_complain(s, ERROR_LEVEL, "a step must start at a finite time, not %g", time);
    else if (time < last - 1e-9 * fmax(1.0, fabs(last))) /* sums of steps drift, but not back */
        session_complain(s, ERROR_LEVEL, "time went back from %.17g s to %.17g s", last, time);
    else {
        call(model.step, &s->state, &s->run, step_s);
        s->state.time = time + step_s;
        s->state.stale = 0;
        watch(s, true);
        return true;
    }
    return false;
}

static void finish(Session *s) {
    if (s->finished) return;
    s->finished = true;
    learn(s);
}

void session_terminate(Session *s) {
    s->state.phase = TERMINATED;
    finish(s);
}

void session_reset(Session *s) {
    if (s->state.phase == STEPPING) finish(s);
    release(&s->run);
    clear(s);
}

void session_free(Session *s) {
    session_reset(s);
    free(s);
}

/* Values */

const Variable *session_variable(Session *s, uint32_t reference, int kinds) {
    if (reference < (uint32_t)model.variable_count && model.variables[reference].kind & kinds)
        return &model.variables[reference];
    session_complain(s, ERROR_LEVEL, "there is no variable of this type with value reference %u",
                     (unsigned)reference);
    return NULL;
}

bool session_before_get(Session *s, const uint32_t *references, size_t count, int kinds) {
    for (size_t i = 0; i < count; i++) {
        const Variable *v = session_variable(s, references[i], kinds);
        if (!v) return false;
        if (v->causality != OUTPUT) continue;
        if ((s->state.stale || !s->state.ready) && !bring_up_to_date(s)) return false;
        if (v->kind != KIND_REAL || isfinite(s->state.record[v->cell].real)) continue;
        session_complain(s, ERROR_LEVEL, "%s is not a finite number", v->name);
        return false;
    }
    return true;
}

bool session_before_set(Session *s, const uint32_t *references, size_t count, int kinds) {
    bool parameters = false;
    for (size_t i = 0; i < count; i++) {
        const Variable *v = session_variable(s, references[i], kinds);
        if (!v) return false;
        if (v->causality == OUTPUT) {
            session_complain(s, ERROR_LEVEL, "%s is an output, it cannot be set", v->name);
            return false;
        }
        unsigned late = v->causality == FIXED_PARAMETER ? 0 : 1 << STEPPING;
        if (!session_allows(s, v->name, 1 << INSTANTIATED | 1 << INITIALIZING | late)) return false;
        parameters = parameters || v->causality != INPUT;
    }
    s->state.stale = 1;
    if (parameters) s->state.ready = s->state.phase == STEPPING;
    return true;
}

bool session_set_text(Session *s, const Variable *variable, const char *text) {
    char *place = s->state.texts[variable->cell];
    if (text && strlen(text) >= PATH_SIZE) {
        session_complain(s, ERROR_LEVEL, "%s is too long", variable->name);
        return false;
    }
    memset(place, 0, PATH_SIZE); /* equal states have equal bytes */
    if (text) memcpy(place, text, strlen(text));
    return true;
}

/* State */

State *session_save(const Session *s) {
    bool whole = s->run.block && s->state.phase >= STEPPING;
    size_t nodes = whole ? (size_t)(model.kept_columns * s->state.nodes) : 0;
    size_t rows = whole ? (size_t)(model.script_columns * s->state.rows) : 0;
    State *copy = malloc(sizeof *copy + 8 * (nodes + rows));
    if (!copy) return NULL;
    *copy = s->state;
    copy->size = (int64_t)(sizeof *copy + 8 * (nodes + rows));
    double *columns = (double *)(copy + 1);
    if (nodes) memcpy(columns, s->run.block, 8 * nodes);
    if (rows) memcpy(columns + nodes, s->run.block + model.node_columns * s->state.nodes, 8 * rows);
    return copy;
}

bool session_is_state(Session *s, const void *bytes, size_t size) {
    State state;
    bool good = size >= sizeof state;
    if (good) memcpy(&state, bytes, sizeof state);
    good = good && state.size == (int64_t)size && !strncmp(state.guid, model.guid, sizeof state.guid);
    if (!good) session_complain(s, ERROR_LEVEL, "these bytes are not a state of this FMU; not restored");
    return good;
}

static bool same_parameters(const State *a, const State *b) {
    for (int32_t i = 0; i < model.variable_count; i++) {
        const Variable *v = &model.variables[i];
        if (v->kind != KIND_STRING && v->causality <= FIXED_PARAMETER &&
            a->record[v->cell].integer != b->record[v->cell].integer)
            return false;
    }
    return memcmp(a->texts, b->texts, sizeof a->texts) == 0;
}

bool session_restore(Session *s, const State *state) {
    State before = s->state;
    bool whole = state->phase == STEPPING || state->phase == TERMINATED;
    if (whole && !(s->prepared && same_parameters(&s->state, state))) {
        s->state = *state; /* what is not in it follows from its parameters */
        if (!initialize(s)) return s->state = before, false;
    }
    int64_t nodes = s->state.nodes, rows = s->state.rows;
    int64_t kept = model.kept_columns * nodes + model.script_columns * rows;
    if (whole && (nodes != state->nodes || rows != state->rows ||
                  state->size != (int64_t)sizeof *state + 8 * kept)) {
        session_complain(s, ERROR_LEVEL, "the route of this state has changed; not restored");
        s->state = before;
        s->state.nodes = nodes; /* those of the block */
        s->state.rows = rows;
        return false;
    }
    const double *columns = (const double *)(state + 1);
    s->state = *state;
    if (!whole) return s->state.ready = 0, s->state.nodes = nodes, s->state.rows = rows, true;
    memcpy(s->run.block, columns, (size_t)(8 * model.kept_columns * nodes));
    memcpy(s->run.block + model.node_columns * nodes, columns + model.kept_columns * nodes,
           (size_t)(8 * model.script_columns * rows));
    return true;
}

/* Addresses: file:///p, file:////p, file:/p, plain; a slash at the end; %20 */

static int hex_of(char c) {
    static const char digits[] = "0123456789abcdef0123456789ABCDEF";
    const char *found = c ? strchr(digits, c) : NULL;
    return found ? (int)((found - digits) % 16) : -1;
}

void path_of_address(const char *address, char *path) {
    bool coded = address && !strncmp(address, "file:", 5);
    const char *at = !address ? "" : coded ? address + 5 : address;
    if (coded && !strncmp(at, "//", 2)) {
        bool local = !strncmp(at, "//localhost/", 12);
        at += local ? 11 : at[2] == '/' ? 2 : 0; /* //server/share stays as it is */
    }
    if (coded && at[0] == '/' && at[1] && (at[2] == ':' || !strncmp(at + 2, "%3A", 3))) at++;
    size_t length = 0;
    for (; *at && length + 1 < PATH_SIZE; at++) {
        int high = coded && *at == '%' ? hex_of(at[1]) : -1, low = high >= 0 ? hex_of(at[2]) : -1;
        path[length++] = low >= 0 ? (char)(16 * high + low) : *at;
        if (low >= 0) at += 2;
    }
    while (length > 1 && (path[length - 1] == '/' || path[length - 1] == '\\')) length--;
    path[length] = 0;
}
