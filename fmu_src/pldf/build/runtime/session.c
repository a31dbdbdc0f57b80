#include "session.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double STEP_MAX_S = 60.0; /* longer ones are a mistake in units */
static const Variable TIME = {.name = "time", .kind = KIND_TIME, .causality = INPUT};

/* Messages */

bool session_tell(Session *s, Level level, const char *format, ...) {
    static const char *const categories[] = {
        [INFO] = "logEvents", [WARNING] = "logStatusWarning", [ERROR_LEVEL] = "logStatusError"};
    char text[MESSAGE_SIZE], safe[2 * MESSAGE_SIZE], *to = safe;
    va_list values;
    if (s->importer.logger && (level != INFO || s->events)) {
        va_start(values, format);
        vsnprintf(text, sizeof text, format, values);
        va_end(values);
        for (const char *at = text; *at; *to++ = *at++)
            if (strchr(s->importer.doubled, *at)) *to++ = *at;
        *to = 0;
        s->importer.tell(s, level, categories[level], safe);
    }
    return level != ERROR_LEVEL;
}

bool session_log(Session *s, bool on, size_t count, const char *const categories[]) {
    if (!s || (count && !categories)) return false;
    s->events = on && count == 0;
    for (size_t i = 0; on && i < count; i++)
        if (categories[i] && (!strcmp(categories[i], "logEvents") || !strcmp(categories[i], "logAll")))
            s->events = true;
    return true;
}

bool session_unsupported(Session *s, const char *call) {
    return s && session_tell(s, ERROR_LEVEL, "%s is not supported", call);
}

/* Creation */

static void clear(Session *s) {
    memset(&s->state, 0, sizeof s->state);
    snprintf(s->state.guid, sizeof s->state.guid, "%s", model.guid);
    memcpy(s->state.record, model.defaults, sizeof s->state.record);
    s->state.time = -INFINITY;
    s->stop_time = INFINITY;
    s->prepared = s->finished = false;
}

static bool is_hex(char c) { return c && strchr("0123456789abcdefABCDEF", c); }

/* Capitals or not; `with` has none. */
static bool starts(const char *text, const char *with) {
    while (*with && (*text | 0x20) == *with) text++, with++;
    return !*with;
}

static bool has_drive(const char *at) {
    return *at && (starts(at + 1, ":") || starts(at + 1, "%3a"));
}

/* Of file:///p, file:////p, file:/p, file://C:/p, or plain; with a slash at the end; with %20.
   Empty if it is too long. */
static void path_of_address(const char *address, char *path) {
    bool coded = address && starts(address, "file:");
    const char *at = !address ? "" : coded ? address + 5 : address;
    if (coded && !strncmp(at, "//", 2)) {
        bool local = starts(at, "//localhost/"), whole = at[2] == '/' || has_drive(at + 2);
        at += local ? 11 : whole ? 2 : 0; /* //server/share stays as it is */
    }
    if (coded && at[0] == '/' && has_drive(at + 1)) at++;
    size_t length = 0;
    for (; *at && length + 1 < PATH_SIZE; at++) {
        unsigned byte = 0;
        bool escaped = coded && *at == '%' && is_hex(at[1]) && is_hex(at[2]);
        if (escaped) sscanf(at + 1, "%2x", &byte);
        path[length++] = escaped ? (char)byte : *at;
        if (escaped) at += 2;
    }
    while (length > 1 && (path[length - 1] == '/' || path[length - 1] == '\\')) length--;
    path[*at ? 0 : length] = 0;
}

Session *session_new(const char *name, const char *resources, bool events, const char *problem,
                     const Importer *importer) {
    size_t length = name ? strlen(name) : 0;
    Session *s = calloc(1, sizeof *s + length + 1);
    if (!s) return NULL;
    clear(s);
    if (name) memcpy(s->name, name, length);
    path_of_address(resources, s->resources);
    s->importer = *importer;
    s->events = events;
    if (length == 0) problem = "the instance needs a name";
    if (!problem) return s;
    session_tell(s, ERROR_LEVEL, "%s", problem);
    free(s);
    return NULL;
}

/* Start of a run */

static void watch(Session *s, bool stepped) {
    Cell *record = s->state.record;
    int64_t now = record[model.watch].integer;
    if (model.watch_flag >= 0) { /* once per drive */
        if (!now || record[model.watch_flag].integer) return;
        record[model.watch_flag].integer = 1;
        session_tell(s, WARNING, "%s", model.watch_texts[now]);
    } else if (stepped && now != s->state.told) {
        s->state.told = now;
        session_tell(s, now ? WARNING : INFO, "t = %.3f s: %s",
                     1e-9 * (double)record[model.watch_time].integer, model.watch_texts[now]);
    }
}

static bool check_bounds(Session *s, const Cell *record) {
    for (int32_t i = 0; i < model.bound_count; i++) {
        const Variable *allowed = &model.variables[model.bounds[i].allowed];
        const Variable *used = &model.variables[model.bounds[i].used];
        double most = record[allowed->cell].real, value = record[used->cell].real;
        if (fabs(value) > fabs(most))
            return session_tell(s, ERROR_LEVEL, "parameter %s = %g: it bounds every profile, so it "
                                "must not be weaker than %s = %g",
                                allowed->name, most, used->name, value);
    }
    return true;
}

static bool check_parameters(Session *s, const Cell *record) {
    for (const Variable *v = model.variables; v < model.variables + model.variable_count; v++) {
        if (v->causality != PARAMETER || v->kind == KIND_STRING) continue;
        Cell cell = record[v->cell];
        double value = v->kind == KIND_REAL ? cell.real : (double)cell.integer;
        if (!(value >= v->low && value <= v->high))
            return session_tell(s, ERROR_LEVEL, "parameter %s = %.17g: it must lie between %g and %g",
                                v->name, value, v->low, v->high);
    }
    return check_bounds(s, record);
}

bool session_make_run(Session *s, State *state, Run *run) {
    Cell given[MODEL_CELLS];
    memcpy(given, state->record, sizeof given);
    memcpy(state->record, model.defaults, sizeof given);
    for (const Variable *v = model.variables; v < model.variables + model.variable_count; v++)
        if (v->causality != OUTPUT && v->kind != KIND_STRING) state->record[v->cell] = given[v->cell];
    return check_parameters(s, given) && run_prepare(s, state, run);
}

/* With what was set so far; the old one stays if that fails. */
static bool start_run(Session *s) {
    State fresh = s->state;
    Run run = {0};
    if (!session_make_run(s, &fresh, &run)) return false;
    run_release(&s->run);
    s->run = run;
    s->state = fresh;
    s->state.ready = s->prepared = true;
    s->state.stale = s->state.told = 0;
    watch(s, false);
    return true;
}

static bool bring_up_to_date(Session *s) {
    if (s->state.phase == INITIALIZING && !s->state.ready) return start_run(s);
    if (s->state.stale && (s->state.phase == INITIALIZING || s->state.phase == STEPPING)) {
        run_call(model.refresh, &s->state, &s->run, 0.0);
        s->state.stale = 0;
    }
    return true;
}

/* Life cycle */

bool session_allows(Session *s, const char *call, unsigned phases) {
    static const char *const names[] = {"INSTANTIATED", "INITIALIZING", "STEPPING", "TERMINATED"};
    return s && (phases >> s->state.phase & 1 ||
                 session_tell(s, ERROR_LEVEL, "%s is not allowed in phase %s", call,
                              names[s->state.phase]));
}

bool session_set_times(Session *s, double start, double stop) {
    if (!isfinite(start))
        return session_tell(s, ERROR_LEVEL, "the start time must be finite, not %g", start);
    s->state.time = start;
    s->stop_time = stop;
    return true;
}

bool session_enter_initialization(Session *s) {
    s->state.phase = INITIALIZING;
    return true;
}

bool session_exit_initialization(Session *s) {
    if (!bring_up_to_date(s)) return false;
    s->state.phase = STEPPING;
    return true;
}

/* Sums of steps drift; by less than this. */
static double drift(double time) { return 1e-9 * fmax(1.0, fabs(time)); }

bool session_step(Session *s, double time, double step_s) {
    double last = s->state.time;
    if (!(step_s > 0.0 && step_s <= STEP_MAX_S))
        return session_tell(s, ERROR_LEVEL, "a step must be above 0 and at most %g s, not %g",
                            STEP_MAX_S, step_s);
    if (!isfinite(time))
        return session_tell(s, ERROR_LEVEL, "a step must start at a finite time, not %g", time);
    if (time < last - drift(last))
        return session_tell(s, ERROR_LEVEL, "time went back from %.17g s to %.17g s", last, time);
    if (time + step_s > s->stop_time + drift(s->stop_time))
        return session_tell(s, ERROR_LEVEL, "a step to %.17g s is beyond the stop time %.17g s",
                            time + step_s, s->stop_time);
    run_call(model.step, &s->state, &s->run, step_s);
    s->state.time = time + step_s;
    s->state.stale = 0;
    watch(s, true);
    return true;
}

static Level finish(Session *s) {
    Level level = run_learn(s);
    s->finished = true;
    return level;
}

Level session_terminate(Session *s) {
    s->state.phase = TERMINATED;
    return finish(s);
}

bool session_reset(Session *s) {
    if (!s) return false;
    if (s->state.phase == STEPPING) finish(s);
    run_release(&s->run);
    clear(s);
    return true;
}

void session_free(Session *s) {
    session_reset(s);
    free(s);
}

/* Values */

static const Variable *find(Session *s, uint32_t reference, int kinds) {
    uint32_t count = (uint32_t)model.variable_count;
    if (reference < count && model.variables[reference].kind & kinds) return &model.variables[reference];
    if (reference == count && kinds & KIND_TIME) return &TIME;
    session_tell(s, ERROR_LEVEL, "there is no variable of this type with value reference %u",
                 (unsigned)reference);
    return NULL;
}

static bool fits(Session *s, const void *references, size_t count, const void *values,
                 size_t value_count) {
    if (s && count != value_count)
        return session_tell(s, ERROR_LEVEL, "%llu values for %llu variables",
                            (unsigned long long)value_count, (unsigned long long)count);
    return s && (count == 0 || (references && values) ||
                 session_tell(s, ERROR_LEVEL, "NULL in place of references or values"));
}

bool session_can_get(Session *s, const uint32_t *references, size_t count, const void *values,
                     size_t value_count, int kinds) {
    if (!fits(s, references, count, values, value_count)) return false;
    for (size_t i = 0; i < count; i++) {
        const Variable *v = find(s, references[i], kinds);
        if (!v) return false;
        if (v->causality != OUTPUT) continue;
        if ((s->state.stale || !s->state.ready) && !bring_up_to_date(s)) return false;
        if (v->kind == KIND_REAL && !isfinite(s->state.record[v->cell].real))
            return session_tell(s, ERROR_LEVEL, "%s is not a finite number", v->name);
    }
    return true;
}

bool session_can_set(Session *s, const uint32_t *references, size_t count, const void *values,
                     size_t value_count, int kinds) {
    bool parameters = false;
    if (!fits(s, references, count, values, value_count)) return false;
    for (size_t i = 0; i < count; i++) {
        const Variable *v = find(s, references[i], kinds);
        if (!v) return false;
        if (v->causality == OUTPUT)
            return session_tell(s, ERROR_LEVEL, "%s is an output, it cannot be set", v->name);
        unsigned late = v->causality == PARAMETER ? 0 : AT_STEP;
        if (!session_allows(s, v->name, AT_START | IN_INITIALIZATION | late)) return false;
        parameters = parameters || v->causality != INPUT;
    }
    s->state.stale = 1;
    if (parameters) s->state.ready = s->prepared = false;
    return true;
}

double session_time(const Session *s) {
    return isfinite(s->state.time) ? s->state.time : 0.0; /* -INFINITY: not known yet */
}

bool session_set_text(Session *s, uint32_t reference, const char *text) {
    const Variable *v = &model.variables[reference];
    char *place = s->state.texts[v->cell];
    size_t length = text ? strlen(text) : 0;
    if (length >= PATH_SIZE) return session_tell(s, ERROR_LEVEL, "%s is too long", v->name);
    memset(place, 0, PATH_SIZE); /* equal states have equal bytes */
    if (text) memcpy(place, text, length);
    return true;
}
