/* One instance between instantiation and release, whatever version of FMI calls it (as
   pldf/fmi/session.py): FMI's instance is this Session. What returns false has told why, unless it
   was given NULL. */
#pragma once

#include "run.h"

enum { AT_START = 1 << INSTANTIATED, IN_INITIALIZATION = 1 << INITIALIZING, AT_STEP = 1 << STEPPING };

typedef struct {
    State state;
    Run run;
    bool prepared; /* the run follows from the parameters of the state */
    bool finished;
    double stop_time;
    Importer importer;
    char text[SENTENCE_SIZE]; /* the String output that was read last */
    char name[];
} Session;

/* Life cycle (session.c). NULL, and the importer is told, if there is a `problem` or no name. */
Session *session_new(const char *name, const char *resources, bool events, const char *problem,
                     const Importer *importer);
void session_free(Session *s);
bool session_reset(Session *s);
bool session_log(Session *s, bool on, size_t count, const char *const categories[]);
bool session_unsupported(Session *s, const char *call);
bool session_allows(Session *s, const char *call, unsigned phases); /* sum of 1 << Phase */
bool session_set_times(Session *s, double start, double stop);
bool session_enter_initialization(Session *s);
bool session_exit_initialization(Session *s);
bool session_step(Session *s, double time, double step_s);
Level session_terminate(Session *s); /* as learning_finish */
bool session_bring_up_to_date(Session *s);
double session_time(const Session *s);

/* Values (values.c): check what a get or a set of these kinds was given. */
bool session_can_get(Session *s, const uint32_t *references, size_t count, const void *values,
                     size_t value_count, int kinds);
bool session_can_set(Session *s, const uint32_t *references, size_t count, const void *values,
                     size_t value_count, int kinds);
/* Of a tunable parameter; all others are checked before the drive. */
bool session_allows_value(Session *s, uint32_t reference, double value);
const char *session_text(Session *s, uint32_t reference); /* parameter or output (cluster.c) */
bool session_set_text(Session *s, uint32_t reference, const char *text);

/* FMU states; serialized, a checksum follows (state.c) */
bool session_get_state(Session *s, void **state);
bool session_set_state(Session *s, const void *state);
bool session_free_state(Session *s, void **state);
bool session_serialized_size(Session *s, const void *state, size_t *size);
bool session_serialize(Session *s, const void *state, void *bytes, size_t size);
bool session_deserialize(Session *s, const void *bytes, size_t size, void **state);
