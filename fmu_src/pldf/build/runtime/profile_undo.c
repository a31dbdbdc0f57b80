/* Which lessons of a profile are in force, as pldf/profiles/lessons.py; what an older iteration held. */
#include <string.h>

#include "profile.h"

/* Older iterations */

static const double *block_at(const Profile *p, int64_t block) {
    return (const double *)(const void *)(p->bytes + p->head + block * p->stride);
}

static void begin(const Profile *p, const double **columns) {
    memset(columns, 0, PROFILE_COLUMNS * sizeof *columns);
    columns[COLUMN_BASE] = columns[COLUMN_LEARNED] = block_at(p, 0);
}

typedef struct {
    const Profile *p;
    int64_t until;
    const double **columns;
} Past;

static bool add_block(void *context, const IterationLine *line, int column, int64_t block) {
    Past *past = context;
    if (line->number > past->until) return false;
    if (column >= 0) past->columns[column] = block_at(past->p, block);
    return true;
}

void profile_past(const Profile *p, int64_t iteration, const double **columns) {
    Past past = {p, iteration, columns};
    begin(p, columns);
    profile_walk(p, add_block, &past);
}

/* Lessons */

enum { LESSON, UNDO, ROLLBACK, OTHER };
typedef struct {
    const Profile *p;
    HistoryStep *steps;
    const double *columns[PROFILE_COLUMNS], *offset_before;
    int64_t number; /* of the iteration whose blocks are being looked at */
} Lessons;

static bool begins(const IterationLine *line, const char *word) {
    return (int64_t)strlen(word) <= line->note_length && memcmp(line->note, word, strlen(word)) == 0;
}

static int64_t number_named(const IterationLine *line) {
    const char *const words[] = {"undo of ", "rollback of "};
    for (int i = 0; i < 2; i++) {
        if (!begins(line, words[i])) continue;
        int64_t at = (int64_t)strlen(words[i]), digits = line->note_length - at, number = 0;
        if (digits < 1 || digits > 9) return -1;
        for (; at < line->note_length; at++) {
            if (line->note[at] < '0' || line->note[at] > '9') return -1;
            number = 10 * number + (line->note[at] - '0');
        }
        return number;
    }
    return -1;
}

static double value_at(const double *values, int64_t i) { return values ? values[i] : 0.0; }

/* What the iteration before the one that comes next, or the last, taught. */
static void judge(Lessons *l) {
    const double *drive = l->columns[COLUMN_DRIVE], *offset = l->columns[COLUMN_OFFSET];
    bool taught = false;
    for (int64_t i = 0; i < l->p->nodes && !taught; i++)
        taught = value_at(drive, i) == (double)l->number ||
                 value_at(offset, i) != value_at(l->offset_before, i);
    l->steps[l->number].taught = taught;
    l->offset_before = offset;
}

static bool look(void *context, const IterationLine *line, int column, int64_t block) {
    Lessons *l = context;
    if (column >= 0) return l->columns[column] = block_at(l->p, block), true;
    if (l->number) judge(l);
    l->number = line->number;
    bool lesson = strcmp(line->kind, "drive") == 0 || strcmp(line->kind, "learn") == 0;
    bool undo = strcmp(line->kind, "undo") == 0, rollback = strcmp(line->kind, "rollback") == 0;
    l->steps[l->number].kind = lesson ? LESSON : undo ? UNDO : rollback ? ROLLBACK : OTHER;
    l->steps[l->number].named = number_named(line);
    return true;
}

/* Along the history that is in force, from its end. */
static int64_t newest(HistoryStep *steps, int64_t count) {
    for (int64_t at = count; at > 0;) {
        const HistoryStep *e = &steps[at];
        if (e->kind == UNDO && e->named >= 0 && e->named <= count) steps[e->named].undone = true;
        if (e->kind == LESSON && e->taught && !e->undone) return at;
        at = e->kind == ROLLBACK && e->named >= 0 && e->named < at ? e->named : at - 1;
    }
    return 0;
}

int64_t profile_lesson_in_force(const Profile *p, HistoryStep *steps) {
    Lessons lessons = {.p = p, .steps = steps};
    if (!p->bytes || !p->count) return 0;
    begin(p, lessons.columns);
    profile_walk(p, look, &lessons);
    judge(&lessons);
    return newest(steps, p->count);
}
