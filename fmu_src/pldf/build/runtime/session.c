#include "session.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool session_log(Session *s, bool on, size_t count, const char *const categories[]) {
    return s && importer_log(&s->importer, on, count, categories);
}

bool session_unsupported(Session *s, const char *call) {
    return s && importer_tell(&s->importer, ERROR_LEVEL, "%s is not supported", call);
}

static void clear(Session *s) {
    memset(&s->state, 0, sizeof s->state);
    snprintf(s->state.guid, sizeof s->state.guid, "%s", model.guid);
    memcpy(s->state.record, model.defaults, sizeof s->state.record);
    s->state.time = -INFINITY;
    s->stop_time = INFINITY;
    s->prepared = s->finished = false;
}

Session *session_new(const char *name, const char *resources, bool events, const char *problem,
                     const Importer *importer) {
    size_t length = name ? strlen(name) : 0;
    Session *s = calloc(1, sizeof *s + length + 1);
    if (!s) return NULL;
    clear(s);
    if (name) memcpy(s->name, name, length);
    s->importer = *importer;
    s->importer.name = s->name;
    s->importer.events = events;
    importer_set_resources(&s->importer, resources);
    if (length == 0) problem = "the instance needs a name";
    if (!problem) return s;
    importer_tell(&s->importer, ERROR_LEVEL, "%s", problem);
    free(s);
    return NULL;
}

/* The run */

/* Called by steps alone: what is told does not depend on who read an output before. */
static void watch(Session *s, const Watch *watched, int64_t *told) {
    Cell *record = s->state.record;
    int64_t now = record[watched->cell].integer;
    const Said *said = &watched->said[now];
    if (watched->flag >= 0) { /* once per drive */
        if (!now || record[watched->flag].integer) return;
        record[watched->flag].integer = 1;
        importer_tell(&s->importer, said->level, "%s", said->text);
    } else if (now != *told) {
        *told = now;
        importer_tell(&s->importer, said->level, "t = %.3f s: %s",
                      1e-9 * (double)record[watched->time].integer, said->text);
    }
}

/* With what was set so far; the old one stays if that fails. */
static bool start_run(Session *s) {
    State fresh = s->state;
    Run run = {0};
    if (!run_make(&s->importer, &fresh, &run)) return false;
    run_release(&s->run);
    s->run = run;
    s->state = fresh;
    s->state.ready = s->prepared = true;
    s->state.stale = 0;
    memset(s->state.told, 0, sizeof s->state.told);
    return true;
}

bool session_bring_up_to_date(Session *s) {
    if (s->state.phase == INITIALIZING && !s->state.ready) return start_run(s);
    if (s->state.stale && (s->state.phase == INITIALIZING || s->state.phase == STEPPING)) {
        run_call(model.refresh, &s->state, &s->run, 0.0);
        s->state.stale = 0;
    }
    return true;
}

/* Calls */

bool session_allows(Session *s, const char *call, unsigned phases) {
    return s && (phases >> s->state.phase & 1 ||
                 importer_tell(&s->importer, ERROR_LEVEL, "%s is not allowed in phase %s", call,
                               phase_names[s->state.phase]));
}

bool session_set_times(Session *s, double start, double stop) {
    if (!isfinite(start))
        return importer_tell(&s->importer, ERROR_LEVEL, "the start time must be finite, not %g", start);
    s->state.time = start;
    s->stop_time = stop;
    return true;
}

bool session_enter_initialization(Session *s) {
    s->state.phase = INITIALIZING;
    return true;
}

bool session_exit_initialization(Session *s) {
    if (!session_bring_up_to_date(s)) return false;
    s->state.phase = STEPPING;
    return true;
}

/* Sums of steps drift; by less than this. */
static double drift(double time) { return 1e-9 * fmax(1.0, fabs(time)); }

static bool makes_sense(const Session *s, double time, double step_s) {
    double last = s->state.time;
    if (!(step_s > 0.0 && step_s <= STEP_MAX_S))
        return importer_tell(&s->importer, ERROR_LEVEL, "a step must be above 0 and at most %g s, not %g",
                             STEP_MAX_S, step_s);
    if (!isfinite(time))
        return importer_tell(&s->importer, ERROR_LEVEL, "a step must start at a finite time, not %g",
                             time);
    if (time < last - drift(last))
        return importer_tell(&s->importer, ERROR_LEVEL, "time went back from %.17g s to %.17g s", last,
                             time);
    if (time + step_s > s->stop_time + drift(s->stop_time))
        return importer_tell(&s->importer, ERROR_LEVEL,
                             "a step to %.17g s is beyond the stop time %.17g s", time + step_s,
                             s->stop_time);
    return true;
}

bool session_step(Session *s, double time, double step_s) {
    if (!makes_sense(s, time, step_s)) return false;
    run_call(model.step, &s->state, &s->run, step_s);
    words_answer(&s->importer, &s->state, &s->run);
    s->state.time = time + step_s;
    s->state.stale = 0;
    for (int i = 0; i < WATCHES; i++) watch(s, &model.watches[i], &s->state.told[i]);
    return true;
}

static Level finish(Session *s) {
    Level kept = s->finished ? INFO : recording_save(&s->importer, &s->state, &s->run);
    Level level = learning_finish(&s->importer, &s->state, &s->run, s->finished);
    s->finished = true;
    return level > kept ? level : kept;
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

double session_time(const Session *s) {
    return isfinite(s->state.time) ? s->state.time : 0.0; /* -INFINITY: not known yet */
}
