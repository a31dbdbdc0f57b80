/* One instance between instantiation and release, whatever version of FMI calls it
   (as pldf/fmi/session.py). Every function that returns false has told why. */
#ifndef PLDF_SESSION_H
#define PLDF_SESSION_H

#include <stddef.h>

#include "model.h"
#include "store.h"

typedef enum { INSTANTIATED, INITIALIZING, STEPPING, TERMINATED } Phase;
typedef void Tell(void *host, Level level, const char *text);

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

typedef struct {
    State state;
    Run run;
    bool prepared, finished;
    char resources[PATH_SIZE];
    Tell *tell;
    void *host;
} Session;

Session *session_new(const char *resources, Tell *tell, void *host);
void session_free(Session *s);
void session_reset(Session *s);

bool session_allows(Session *s, const char *call, unsigned phases); /* sum of 1 << Phase */
bool session_set_start(Session *s, double time);
bool session_exit_initialization(Session *s);
bool session_step(Session *s, double time, double step_s);
void session_terminate(Session *s);

/* The variable with this value reference and one of these kinds, else NULL. */
const Variable *session_variable(Session *s, uint32_t reference, int kinds);
bool session_before_get(Session *s, const uint32_t *references, size_t count, int kinds);
bool session_before_set(Session *s, const uint32_t *references, size_t count, int kinds);
bool session_set_text(Session *s, const Variable *variable, const char *text);

State *session_save(const Session *s); /* NULL: no memory */
bool session_restore(Session *s, const State *state);
/* False unless these bytes are a saved state of this build. */
bool session_is_state(Session *s, const void *bytes, size_t size);

void session_complain(Session *s, Level level, const char *format, ...);
/* Path of a file:// address (or a plain path). */
void path_of_address(const char *address, char *path);

#endif
