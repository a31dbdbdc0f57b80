/* As docs/native.md describes it. */
#include "prepared.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"
#include "text.h"

static bool take_version(Cursor *cursor, const char *kind, int64_t *version) {
    if (!take(cursor, "PLDF-PREPARED ") || !take_number(cursor, 9, version) || !take_line_end(cursor))
        return false;
    if (*version == 1 || (*version == 2 && strcmp(kind, "route") == 0)) return true;
    snprintf(cursor->why, REASON_SIZE, "line 1: format %lld; this one reads formats 1 and 2%s",
             (long long)*version, *version > 2 ? ", a newer version wrote it: update this one" : "");
    return false;
}

static bool take_mark(Cursor *cursor, int64_t *at_mm, int64_t last_mm) {
    int64_t before_mm = *at_mm;
    if (!take(cursor, "mark ") || !take_number(cursor, 11, at_mm) || !take(cursor, " ")) return false;
    if (*at_mm < before_mm || *at_mm > last_mm) return refuse(cursor, "marks in order, on the route");
    for (int kind = 0; kind < MARK_KINDS; kind++) {
        size_t length = strlen(mark_kinds[kind]);
        if ((size_t)(cursor->end - cursor->at) > length && cursor->at[length] == ' ' &&
            memcmp(cursor->at, mark_kinds[kind], length) == 0)
            return take(cursor, mark_kinds[kind]) && take(cursor, " ") &&
                   take_name(cursor, NAME_BYTES_MAX) && take_line_end(cursor);
    }
    return refuse(cursor, "a kind of mark");
}

static bool take_marks(Cursor *cursor, Prepared *p) {
    int64_t count, at_mm = 0;
    if (!take_entry(cursor, "marks ", 6, &count)) return false;
    if (count < 1) return refuse(cursor, "marks, or format 1");
    p->marks = cursor->at - p->bytes;
    for (int64_t i = 0; i < count; i++)
        if (!take_mark(cursor, &at_mm, 1000 * p->rows)) return false;
    p->marks_end = cursor->at - p->bytes;
    return true;
}

bool prepared_parse(Prepared *p, const char *kind, int64_t columns, char *why) {
    Cursor cursor = {p->bytes, p->bytes + p->size, 1, why};
    int64_t version;
    why[0] = 0;
    if (!take_version(&cursor, kind, &version) || !take(&cursor, "kind ") || !take(&cursor, kind) ||
        !take_line_end(&cursor) || !take_key(&cursor, "key ", p->key) ||
        !take_entry(&cursor, "columns ", 2, &p->columns) ||
        !take_entry(&cursor, "rows ", 9, &p->rows) || !take_entry(&cursor, "line ", 1, &p->has_line) ||
        (version > 1 && !take_marks(&cursor, p)) || !take_end(&cursor, p->bytes))
        return false;
    int64_t fewest = strcmp(kind, "route") == 0 ? 3 : 1;
    if (p->columns != columns || p->rows < fewest || p->rows > NODES_MAX + 1)
        return refuse(&cursor, "the columns and rows of such a file");
    p->head = cursor.at - p->bytes;
    if (!check_end(p->bytes, p->size, p->head + 8 * p->columns * p->rows + CHECKSUM_SIZE, why))
        return false;
    const double *values = (const double *)(const void *)(p->bytes + p->head);
    for (int64_t i = 0; i < p->columns * p->rows; i++)
        if (!isfinite(values[i])) return snprintf(why, REASON_SIZE, "a value is not finite"), false;
    return true;
}

bool prepared_copy_marks(const Prepared *p, char **marks) {
    size_t size = (size_t)(p->marks_end - p->marks);
    *marks = size ? malloc(size + 1) : NULL;
    if (*marks) memcpy(*marks, p->bytes + p->marks, size), (*marks)[size] = 0;
    return *marks || !size;
}

int mark_road(const char *marks, int64_t at_mm, Name *name) {
    int roads = 0;
    for (const char *line = marks; line && *line; line = strchr(line, '\n') + 1) {
        char *kind;
        long long begins_mm = strtoll(line + strlen("mark "), &kind, 10);
        const char *begin = strchr(kind + 1, ' ') + 1;
        if (strncmp(kind, " road", strlen(" road")) != 0) continue;
        if (roads++ == 0 || begins_mm <= at_mm)
            snprintf(name->text, sizeof name->text, "%.*s", (int)strcspn(begin, "\n"), begin);
    }
    return roads;
}
