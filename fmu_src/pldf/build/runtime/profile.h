/* The bytes of profile files, checked before they are used. */
#pragma once

#include "disk.h"
#include "model.h"

typedef struct { /* docs/profile-format.md */
    uint8_t *bytes; /* NULL: nothing stored yet; owned */
    int64_t size, version, driver, nodes, count, blocks, lines, lines_end, head, stride;
    int64_t newest[PROFILE_COLUMNS]; /* where the block of each column begins; 0: all its values are */
    char route[17];
} Profile;

typedef struct { /* what a drive leaves behind */
    const double *base, *columns; /* n values; those of the kernel, one column after the other */
    bool carried; /* the other columns are those of the newest iteration, else zero */
    const char *kind, *note;
    int64_t interventions;
} Lesson;

/* Fills the fields from bytes and size; false, and the reason, if the bytes are not sound. */
bool profile_parse(Profile *profile, char *why);

/* Values of the newest iteration, or of the base profile if there is none; NULL: all are zero. */
const double *profile_newest(const Profile *profile, int column);
bool profile_same_history(const Profile *a, const Profile *b);
/* Adds an iteration to the profile, whose driver, route and nodes are set; its bytes are then others,
   in the newest format, and those before are freed unless they are `stored`. False, and the reason: it is as it was. */
bool profile_add(Profile *profile, const uint8_t *stored, const Lesson *lesson, char *why);
/* Points to the values of each column behind iteration 0, 1, ...; NULL: all are zero. */
void profile_past(const Profile *profile, int64_t iteration, const double **columns);

typedef struct { /* what an iteration did to the history */
    int kind;
    int64_t named; /* which iteration it undoes or copies; -1: the note does not say */
    bool taught, undone;
} HistoryStep;

/* The newest iteration that taught and is in force, 0: there is none. `steps` has one per iteration, from
   0 on; `undone` says which were undone since the file was written, the rest is filled in. */
int64_t profile_lesson_in_force(const Profile *profile, HistoryStep *steps);

/* Between profile.c, which reads, and profile_history.c */

typedef struct {
    int64_t number, interventions;
    const char *kind, *note; /* the note has no zero behind it */
    int64_t note_length;
} IterationLine;

/* Looks at an iteration (column -1), then at each of its blocks; returns whether to go on. */
typedef bool Visit(void *context, const IterationLine *line, int column, int64_t block);
bool profile_walk(const Profile *profile, Visit *visit, void *context);

int64_t profile_stride(int64_t nodes);
bool profile_same_values(const double *a, const double *b, int64_t nodes); /* NULL: all are zero */
