/* As docs/native.md describes it. */
#include "prepared.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "model.h"
#include "text.h"

bool prepared_parse(Prepared *p, const char *kind, int64_t columns, char *why) {
    Cursor cursor = {p->bytes, p->bytes + p->size, 1, why};
    why[0] = 0;
    if (!take(&cursor, "PLDF-PREPARED 1") || !take_line_end(&cursor) || !take(&cursor, "kind ") ||
        !take(&cursor, kind) || !take_line_end(&cursor) || !take_key(&cursor, "key ", p->key) ||
        !take_entry(&cursor, "columns ", 2, &p->columns) ||
        !take_entry(&cursor, "rows ", 9, &p->rows) ||
        !take_entry(&cursor, "line ", 1, &p->has_line) || !take_end(&cursor, p->bytes))
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
