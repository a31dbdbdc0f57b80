/* One instance between instantiation and release, whatever version of FMI calls it (as
   pldf/fmi/session.py): FMI's instance is this Session. What returns false has told why, unless it
   was given NULL. */
#pragma once

#include <stddef.h>

#include "model.h"
#include "store.h"

typedef enum { INSTANTIATED, INITIALIZING, STEPPING, TERMINATED } Phase;
enum { AT_START = 1 << INSTANTIATED, IN_INITIALIZATION = 1 << INITIALIZING, AT_STEP = 1 << STEPPING };

typedef struct { /* what is saved and restored, followed by the kept columns */
    char guid[40];
    int64_t size; /* in bytes, with the columns */
    int64_t nodes, rows, phase, ready, stale, told;
    double time;
    char texts[MODEL_TEXTS][PATH_SIZE];
    Cell record[MODEL_CELLS];
} State;

typedef struct { /* what follows from the parameters */
    double *block;
    Profile stored;
    char folder[PATH_SIZE]; /* of profiles; empty: nothing is persisted */
} Run;

typedef struct Session Session;
typedef struct { /* its logger, as it came, and the function that calls it by this version of FMI */
    void (*tell)(const Session *s, Level level, const char *category, const char *text);
    void (*logger)(void);
    void *environment;
    const char *doubled; /* characters that mean something else in its messages */
} Importer;

struct Session {
    State state;
    Run run;
    bool prepared; /* the run follows from the parameters of the state */
    bool finished, events; /* events: tell INFO messages too */
    double stop_time;
    char resources[PATH_SIZE];
    Importer importer;
    char name[];
};

/* NULL, and the importer is told, if there is a `problem` or no name. */
Session *session_new(const char *name, const char *resources, bool events, const char *problem,
                     const Importer *importer);
void session_free(Session *s);
bool session_reset(Session *s);
/* Returns whether it was no error. */
bool session_tell(Session *s, Level level, const char *format, ...);
bool session_log(Session *s, bool on, size_t count, const char *const categories[]);
bool session_unsupported(Session *s, const char *call);

bool session_allows(Session *s, const char *call, unsigned phases); /* sum of 1 << Phase */
bool session_set_times(Session *s, double start, double stop);
bool session_enter_initialization(Session *s);
bool session_exit_initialization(Session *s);
bool session_step(Session *s, double time, double step_s);
Level session_terminate(Session *s); /* as run_learn */

/* Check what a get or a set of these kinds was given. */
bool session_can_get(Session *s, const uint32_t *references, size_t count, const void *values,
                     size_t value_count, int kinds);
bool session_can_set(Session *s, const uint32_t *references, size_t count, const void *values,
                     size_t value_count, int kinds);
double session_time(const Session *s);
bool session_set_text(Session *s, uint32_t reference, const char *text);

/* FMU states; serialized, a checksum follows (state.c) */
bool session_get_state(Session *s, void **state);
bool session_set_state(Session *s, const void *state);
bool session_free_state(Session *s, void **state);
bool session_serialized_size(Session *s, const void *state, size_t *size);
bool session_serialize(Session *s, const void *state, void *bytes, size_t size);
bool session_deserialize(Session *s, const void *bytes, size_t size, void **state);

/* Makes the run that follows from a state's parameters, and the rest of that state. */
bool session_make_run(Session *s, State *state, Run *run);

/* What a run needs from the disk, and what it leaves there (run.c) */
bool run_prepare(Session *s, State *state, Run *run);
void run_call(Entry *entry, State *state, Run *run, double step_s); /* if the model has it */
Level run_learn(Session *s); /* INFO, unless something could not be kept, which was told */
void run_release(Run *run);
