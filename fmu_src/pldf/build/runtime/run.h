/* What a drive consists of, and what it needs from the disk and leaves there. */
#pragma once

#include "importer.h"
#include "model.h"
#include "store.h"

typedef struct { /* what is saved and restored, followed by the kept columns */
    char guid[40];
    int64_t size; /* in bytes, with the columns */
    int64_t nodes, rows, phase, ready, stale, told[WATCHES];
    double time;
    char texts[MODEL_TEXTS][PATH_SIZE];
    Cell record[MODEL_CELLS];
} State;

typedef struct { /* what follows from the parameters */
    double *block;
    Profile stored;
    HistoryStep *history; /* of the stored profile: what an undo needs, so that no step allocates */
    char *marks; /* of the route, a line each (prepared.h); NULL: there are none */
    char folder[PATH_SIZE]; /* of profiles; empty: nothing is persisted */
    char recordings[PATH_SIZE]; /* folder of recordings; empty: none is written */
} Run;

/* Makes the run that follows from a state's parameters, and the rest of that state. */
bool run_make(const Importer *importer, State *state, Run *run);
void run_call(Entry *entry, State *state, Run *run, double step_s); /* if the model has it */
bool run_allows(const Importer *importer, const Variable *parameter, double value); /* its range */
void run_release(Run *run);

/* Of models that learn (learning.c); the others allow everything, follow and keep nothing. */
bool learning_allows(const Importer *importer, const State *state); /* the parameters */
void learning_follow(const Importer *importer, State *state, Run *run);
/* The function's own recording (recording.c): finds its folder; writes it, or tells why not. */
void recording_open(const Importer *importer, const State *state, Run *run);
Level recording_save(const Importer *importer, const State *state, const Run *run);
/* What the driver says (words.c): follow the newest iteration; answer what a step heard; add an
   iteration for each word of the drive to `kept`, a copy of the stored profile. */
void words_follow(State *state, Run *run);
void words_answer(const Importer *importer, State *state, Run *run);
bool words_keep(State *state, Run *run, Profile *kept, char *why);
/* One line per intervention of a drive that was learned from: what became of it (outcome.c). */
void outcome_tell(const Importer *importer, const State *state, const Run *run);
/* Of a drive that ends, and that ended `before`; INFO, or what was told of what could not be kept. */
Level learning_finish(const Importer *importer, State *state, Run *run, bool before);
