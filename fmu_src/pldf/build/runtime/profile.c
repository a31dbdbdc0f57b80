/* As pldf/profiles/profile_file.py; a reader accepts exactly what a writer writes. */
#include "profile.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "text.h"

enum { LINE_MAX_BYTES = 128, NAME_MAX_BYTES = 40 };

static bool newer(Cursor *cursor, const char *what, const char *name, int length) {
    if (!cursor->why[0])
        snprintf(cursor->why, REASON_SIZE, "line %d: %s '%.*s', which a newer version wrote; update this "
                                           "one", cursor->line, what, length, name);
    return false;
}

/* Length of the word of small letters, digits and underlines that comes next. */
static int word_length(const Cursor *cursor) {
    int length = 0;
    while (cursor->at + length < cursor->end && length < NAME_MAX_BYTES &&
           memchr("abcdefghijklmnopqrstuvwxyz0123456789_", cursor->at[length], 37))
        length++;
    return length;
}

static bool is_word(const Cursor *cursor, int length, const char *word) {
    return strlen(word) == (size_t)length && memcmp(cursor->at, word, (size_t)length) == 0;
}

static bool take_kind(Cursor *cursor, IterationLine *line) {
    int length = word_length(cursor);
    for (int i = 0; i < PROFILE_KINDS; i++)
        if (is_word(cursor, length, profile_kinds[i])) {
            line->kind = profile_kinds[i];
            cursor->at += length;
            return take(cursor, " ");
        }
    return newer(cursor, "iteration of kind", (const char *)cursor->at, length);
}

static bool take_note(Cursor *cursor, IterationLine *line) {
    const uint8_t *note = cursor->at;
    if (cursor->at < cursor->end && *cursor->at == ' ') {
        note = ++cursor->at;
        while (cursor->at < cursor->end && *cursor->at >= ' ' && *cursor->at <= '~') cursor->at++;
        int64_t length = cursor->at - note;
        if (length < 1 || length > 80 || *note == ' ' || cursor->at[-1] == ' ')
            return refuse(cursor, "a note of 1 to 80 characters");
    }
    line->note = (const char *)note;
    line->note_length = cursor->at - note;
    return true;
}

/* Release 0.2.0 notes what it rolls back. */
static const char *kind_in_format_1(const IterationLine *line) {
    const char begin[] = "rollback of ";
    int64_t at = sizeof begin - 1;
    if (line->note_length <= at || memcmp(line->note, begin, (size_t)at) != 0) return "drive";
    while (at < line->note_length && line->note[at] >= '0' && line->note[at] <= '9') at++;
    return at == line->note_length ? "rollback" : "drive";
}

static bool take_iteration(Cursor *cursor, int64_t version, int64_t expected, IterationLine *line) {
    const uint8_t *first = cursor->at;
    if (!take(cursor, "iteration ") || !take_number(cursor, 9, &line->number) || !take(cursor, " ") ||
        (version > 1 && !take_kind(cursor, line)) || !take_number(cursor, 9, &line->interventions) ||
        line->number != expected)
        return refuse(cursor, "iteration NUMBER KIND INTERVENTIONS NOTE, counted from 1");
    if (!take_note(cursor, line)) return false;
    if (version == 1) line->kind = kind_in_format_1(line);
    return cursor->at - first < LINE_MAX_BYTES && take_line_end(cursor);
}

/* Takes a block line; its column must lie behind `column`, which becomes it. */
static bool take_block(Cursor *cursor, int *column) {
    if (!take(cursor, "block ")) return false;
    int length = word_length(cursor), last = *column;
    for (*column = 0; *column < PROFILE_COLUMNS; ++*column)
        if (is_word(cursor, length, profile_columns[*column].name)) break;
    if (*column == PROFILE_COLUMNS)
        return newer(cursor, "block", (const char *)cursor->at, length);
    cursor->at += length;
    if (*column <= last) return refuse(cursor, "blocks once, in a fixed order");
    return take(cursor, " ") && take(cursor, profile_columns[*column].unit) && take_line_end(cursor);
}

static bool is_next(const Cursor *cursor, const char *text) {
    size_t length = strlen(text);
    return (size_t)(cursor->end - cursor->at) >= length && memcmp(cursor->at, text, length) == 0;
}

/* Goes on to the next block of an iteration; format 1 has all blocks of its columns. */
static bool next_block(const Profile *p, Cursor *cursor, int *column) {
    if (p->version == 1) return ++*column <= FORMAT_1_COLUMNS;
    return is_next(cursor, "block ") && take_block(cursor, column);
}

/* Takes the lines of all iterations, and lets them be visited. */
static bool walk(const Profile *p, Cursor *cursor, int64_t *blocks, Visit *visit, void *context) {
    IterationLine line;
    *blocks = 1;
    for (int64_t i = 1; i <= p->count; i++) {
        if (!take_iteration(cursor, p->version, i, &line)) return false;
        if (visit && !visit(context, &line, -1, 0)) return false;
        int column = p->version == 1 ? COLUMN_BASE : -1;
        while (next_block(p, cursor, &column)) {
            if (visit && !visit(context, &line, column, *blocks)) return false;
            ++*blocks;
        }
        if (cursor->why[0]) return false;
    }
    return true;
}

bool profile_walk(const Profile *p, Visit *visit, void *context) {
    char why[REASON_SIZE] = "";
    int64_t blocks;
    Cursor cursor = {p->bytes + p->lines, p->bytes + p->head, 0, why};
    return walk(p, &cursor, &blocks, visit, context);
}

/* Values */

static const double *values_at(const Profile *p, int64_t byte) {
    return (const double *)(const void *)(p->bytes + byte);
}

static bool check_values(const Profile *p, int column, int64_t at, char *why) {
    const ProfileColumn *allowed = &profile_columns[column];
    const double *values = values_at(p, at);
    for (int64_t i = 0; i < p->nodes; i++)
        if (!(values[i] >= allowed->low && values[i] <= allowed->high) ||
            (allowed->whole && floor(values[i]) != values[i])) {
            snprintf(why, REASON_SIZE, "byte %lld: %s is %g at %lld m", (long long)(at + 8 * i),
                     allowed->name, values[i], (long long)i);
            return false;
        }
    for (int64_t i = at + 8 * p->nodes; i < at + p->stride; i++)
        if (p->bytes[i]) return snprintf(why, REASON_SIZE, "fill bytes are not zero"), false;
    return true;
}

typedef struct {
    Profile *p;
    char *why;
} Check;

/* Checks one block, which is then the newest of its column. */
static bool check_block(void *context, const IterationLine *line, int column, int64_t block) {
    Check *check = context;
    Profile *p = check->p;
    if (column < 0) return true;
    int64_t at = p->head + block * p->stride;
    if (!check_values(p, column, at, check->why)) return false;
    if (p->version > 1 && profile_same_values(profile_newest(p, column), values_at(p, at), p->nodes)) {
        snprintf(check->why, REASON_SIZE, "byte %lld: %s of iteration %lld is as before and must not stand "
                 "here", (long long)at, profile_columns[column].name, (long long)line->number);
        return false;
    }
    p->newest[column] = at;
    return true;
}

/* Parsing */

static bool take_version(Cursor *cursor, int64_t *version) {
    if (!take(cursor, "PLDF-PROFILE ") || !take_number(cursor, 9, version) || !take_line_end(cursor))
        return false;
    if (*version == 1 || *version == 2) return true;
    snprintf(cursor->why, REASON_SIZE, "line 1: format %lld; this one reads formats 1 and 2%s",
             (long long)*version, *version > 2 ? ", a newer version wrote it: update this one" : "");
    return false;
}

static bool take_start(Cursor *cursor, Profile *p) {
    int64_t step_m;
    if (!take_entry(cursor, "driver ", 9, &p->driver) || !take_key(cursor, "route ", p->route) ||
        !take_entry(cursor, "nodes ", 9, &p->nodes))
        return false;
    if (p->nodes < 3 || p->nodes > NODES_MAX) return refuse(cursor, "3 to 10000000 nodes");
    if (!take_entry(cursor, "step_m ", 1, &step_m) || step_m != 1) return refuse(cursor, "step_m 1");
    return take_entry(cursor, "iterations ", 6, &p->count);
}

static bool take_header(Cursor *cursor, Profile *p) {
    int64_t stated = 0;
    if (!take_version(cursor, &p->version) || !take_start(cursor, p)) return false;
    if (p->version > 1 && (!take_entry(cursor, "blocks ", 8, &stated) ||
                           !take(cursor, "block base_mps m/s") || !take_line_end(cursor)))
        return false;
    p->lines = cursor->at - p->bytes;
    if (!walk(p, cursor, &p->blocks, NULL, NULL)) return false;
    if (p->version > 1 && p->blocks != stated) return refuse(cursor, "as many blocks as line 7 says");
    p->lines_end = cursor->at - p->bytes;
    if (!take_end(cursor, p->bytes)) return false;
    p->head = cursor->at - p->bytes;
    p->stride = profile_stride(p->nodes);
    return true;
}

bool profile_parse(Profile *p, char *why) {
    Cursor cursor = {p->bytes, p->bytes + p->size, 1, why};
    Check check = {p, why};
    why[0] = 0;
    if (!take_header(&cursor, p) ||
        !check_end(p->bytes, p->size, p->head + p->blocks * p->stride + CHECKSUM_SIZE, why) ||
        !check_values(p, COLUMN_BASE, p->head, why))
        return false;
    memset(p->newest, 0, sizeof p->newest);
    p->newest[COLUMN_BASE] = p->newest[COLUMN_LEARNED] = p->head;
    return profile_walk(p, check_block, &check);
}

const double *profile_newest(const Profile *p, int column) {
    return p->bytes && p->newest[column] ? values_at(p, p->newest[column]) : NULL;
}
