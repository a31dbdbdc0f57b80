/* As pldf/profiles/profile_file.py; a reader accepts exactly what a writer writes. */
#include "profile.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"

enum { LINE_MAX_BYTES = 128 };

typedef struct {
    const uint8_t *at, *end;
    int line;
    char *why;
} Cursor;

static bool refuse(Cursor *cursor, const char *expected) {
    if (!cursor->why[0])
        snprintf(cursor->why, REASON_SIZE, "line %d: expected '%s'", cursor->line, expected);
    return false;
}

/* Takes `text` if the next bytes are it. */
static bool take(Cursor *cursor, const char *text) {
    size_t length = strlen(text);
    if ((size_t)(cursor->end - cursor->at) < length || memcmp(cursor->at, text, length) != 0)
        return refuse(cursor, text);
    cursor->at += length;
    return true;
}

static bool take_number(Cursor *cursor, int digits, int64_t *number) {
    const uint8_t *first = cursor->at;
    *number = 0;
    while (cursor->at < cursor->end && *cursor->at >= '0' && *cursor->at <= '9' &&
           cursor->at - first < digits)
        *number = 10 * *number + (*cursor->at++ - '0');
    bool padded = cursor->at - first > 1 && *first == '0';
    return (cursor->at > first && !padded) || refuse(cursor, "a number");
}

static bool take_line_end(Cursor *cursor) {
    cursor->line++;
    return cursor->at < cursor->end && *cursor->at == '\n' ? (cursor->at++, true)
                                                           : refuse(cursor, "the end of the line");
}

static bool take_entry(Cursor *cursor, const char *name, int digits, int64_t *number) {
    return take(cursor, name) && take_number(cursor, digits, number) && take_line_end(cursor);
}

static bool take_key(Cursor *cursor, const char *name, char *key) {
    if (!take(cursor, name)) return false;
    for (int i = 0; i < 16; i++, cursor->at++) {
        if (cursor->at >= cursor->end || !memchr("0123456789abcdef", *cursor->at, 16))
            return refuse(cursor, "16 hexadecimal digits");
        key[i] = (char)*cursor->at;
    }
    key[16] = 0;
    return take_line_end(cursor);
}

static bool take_iteration(Cursor *cursor, int64_t expected) {
    int64_t number, interventions;
    const uint8_t *first = cursor->at;
    if (!take(cursor, "iteration ") || !take_number(cursor, 9, &number) || !take(cursor, " ") ||
        !take_number(cursor, 9, &interventions) || number != expected)
        return refuse(cursor, "iteration NUMBER INTERVENTIONS NOTE, counted from 1");
    if (cursor->at < cursor->end && *cursor->at == ' ') {
        const uint8_t *note = ++cursor->at;
        while (cursor->at < cursor->end && *cursor->at >= ' ' && *cursor->at <= '~') cursor->at++;
        int64_t length = cursor->at - note;
        if (length < 1 || length > 80 || *note == ' ' || cursor->at[-1] == ' ')
            return refuse(cursor, "a note of 1 to 80 characters");
    }
    return cursor->at - first < LINE_MAX_BYTES && take_line_end(cursor);
}

/* Takes "end", as few spaces as possible and LF, so that the header fills a multiple of 64. */
static bool take_end(Cursor *cursor, const uint8_t *start) {
    if (!take(cursor, "end")) return false;
    while ((cursor->at + 1 - start) % ALIGNMENT != 0)
        if (!take(cursor, " ")) return false;
    return take_line_end(cursor);
}

/* CRC-32 of zlib, eight bytes at a time: tables[k] is what a byte with k more behind it adds. */
uint32_t checksum(const uint8_t *bytes, int64_t size) {
    uint32_t tables[8][256], value = 0xFFFFFFFFu;
    for (uint32_t i = 0; i < 256; i++) {
        tables[0][i] = i;
        for (int bit = 0; bit < 8; bit++)
            tables[0][i] = (tables[0][i] >> 1) ^ (tables[0][i] & 1 ? 0xEDB88320u : 0);
    }
    for (int k = 1; k < 8; k++)
        for (int i = 0; i < 256; i++)
            tables[k][i] = (tables[k - 1][i] >> 8) ^ tables[0][tables[k - 1][i] & 0xFF];
    int64_t at = 0;
    for (; at + 8 <= size; at += 8) {
        uint32_t next = 0;
        for (int k = 0; k < 8; k++)
            next ^= tables[7 - k][(bytes[at + k] ^ (k < 4 ? value >> 8 * k : 0)) & 0xFF];
        value = next;
    }
    for (; at < size; at++) value = (value >> 8) ^ tables[0][(value ^ bytes[at]) & 0xFF];
    return value ^ 0xFFFFFFFFu;
}

static void write_checksum(uint8_t *bytes, int64_t size) {
    char line[CHECKSUM_SIZE + 1];
    snprintf(line, sizeof line, "crc32 %08x\n", (unsigned)checksum(bytes, size));
    memcpy(bytes + size, line, CHECKSUM_SIZE);
}

static bool check_end(const uint8_t *bytes, int64_t size, int64_t expected, char *why) {
    char line[CHECKSUM_SIZE + 1];
    if (size != expected) {
        snprintf(why, REASON_SIZE, "%lld bytes long, but %lld bytes follow from the header",
                 (long long)size, (long long)expected);
        return false;
    }
    snprintf(line, sizeof line, "crc32 %08x\n", (unsigned)checksum(bytes, size - CHECKSUM_SIZE));
    if (memcmp(bytes + size - CHECKSUM_SIZE, line, CHECKSUM_SIZE) == 0) return true;
    snprintf(why, REASON_SIZE, "damaged: the checksum does not fit");
    return false;
}

static const double *block_at(const Profile *p, int64_t block) {
    return (const double *)(const void *)(p->bytes + p->head + block * p->stride);
}

static bool check_values(const Profile *p, int64_t block, char *why) {
    const ProfileColumn *column = &profile_columns[block ? 1 + (block - 1) % ITERATION_COLUMNS : 0];
    const double *values = block_at(p, block);
    for (int64_t i = 0; i < p->nodes; i++)
        if (!(values[i] >= column->low && values[i] <= column->high) ||
            (column->whole && floor(values[i]) != values[i])) {
            snprintf(why, REASON_SIZE, "byte %lld: %s is %g at %lld m",
                     (long long)(p->head + block * p->stride + 8 * i), column->name, values[i],
                     (long long)i);
            return false;
        }
    for (const uint8_t *at = (const uint8_t *)(values + p->nodes);
         at < (const uint8_t *)values + p->stride; at++)
        if (*at) return snprintf(why, REASON_SIZE, "fill bytes are not zero"), false;
    return true;
}

static int64_t stride_of(int64_t nodes) { return (8 * nodes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT; }

bool profile_parse(Profile *p, char *why) {
    Cursor cursor = {p->bytes, p->bytes + p->size, 1, why};
    why[0] = 0;
    int64_t version, step_m;
    if (!take(&cursor, "PLDF-PROFILE ")) return false;
    if (!take_number(&cursor, 9, &version) || !take_line_end(&cursor)) return false;
    if (version != 1) {
        snprintf(why, REASON_SIZE, "line 1: format %lld; this one reads format 1", (long long)version);
        return false;
    }
    if (!take_entry(&cursor, "driver ", 9, &p->driver) || !take_key(&cursor, "route ", p->route) ||
        !take_entry(&cursor, "nodes ", 9, &p->nodes))
        return false;
    if (p->nodes < 3 || p->nodes > NODES_MAX) return refuse(&cursor, "3 to 10000000 nodes");
    if (!take_entry(&cursor, "step_m ", 1, &step_m) || step_m != 1) return refuse(&cursor, "step_m 1");
    if (!take_entry(&cursor, "iterations ", 6, &p->count)) return false;
    p->lines = cursor.at - p->bytes;
    for (int64_t i = 1; i <= p->count; i++)
        if (!take_iteration(&cursor, i)) return false;
    p->lines_end = cursor.at - p->bytes;
    if (!take_end(&cursor, p->bytes)) return false;
    p->head = cursor.at - p->bytes;
    p->stride = stride_of(p->nodes);
    int64_t blocks = 1 + ITERATION_COLUMNS * p->count;
    if (!check_end(p->bytes, p->size, p->head + blocks * p->stride + CHECKSUM_SIZE, why)) return false;
    for (int64_t block = 0; block < blocks; block++)
        if (!check_values(p, block, why)) return false;
    return true;
}

const double *profile_block(const Profile *p, int64_t iteration, int64_t column) {
    return block_at(p, 1 + ITERATION_COLUMNS * (iteration - 1) + column);
}

bool profile_same_history(const Profile *a, const Profile *b) {
    int64_t count = a->bytes ? a->count : 0;
    if (count != (b->bytes ? b->count : 0)) return false;
    if (count == 0) return true;
    size_t lines = (size_t)(a->lines_end - a->lines);
    return b->lines_end - b->lines == (int64_t)lines &&
           memcmp(a->bytes + a->lines, b->bytes + b->lines, lines) == 0 &&
           memcmp(block_at(a, 1), block_at(b, 1), (size_t)(ITERATION_COLUMNS * count * a->stride)) == 0;
}

uint8_t *profile_extend(const Profile *p, const Lesson *lesson, int64_t *size) {
    int64_t count = p->bytes ? p->count : 0, stride = stride_of(p->nodes);
    int64_t old_lines = count ? p->lines_end - p->lines : 0, old = ITERATION_COLUMNS * count * stride;
    int64_t most = 512 + old_lines + (1 + ITERATION_COLUMNS) * stride + old + CHECKSUM_SIZE;
    uint8_t *bytes = calloc(1, (size_t)most);
    if (!bytes) return NULL;
    int64_t at = sprintf((char *)bytes,
                         "PLDF-PROFILE 1\ndriver %lld\nroute %s\nnodes %lld\nstep_m 1\niterations %lld\n",
                         (long long)p->driver, p->route, (long long)p->nodes, (long long)count + 1);
    if (old_lines) memcpy(bytes + at, p->bytes + p->lines, (size_t)old_lines);
    at += old_lines;
    at += sprintf((char *)bytes + at, "iteration %lld %lld %s\nend", (long long)count + 1,
                  (long long)lesson->interventions, lesson->note);
    while ((at + 1) % ALIGNMENT) bytes[at++] = ' ';
    bytes[at++] = '\n';
    memcpy(bytes + at, lesson->base, (size_t)(8 * p->nodes));
    at += stride;
    if (count) memcpy(bytes + at, block_at(p, 1), (size_t)old);
    at += old;
    for (int column = 0; column < ITERATION_COLUMNS; column++, at += stride)
        memcpy(bytes + at, lesson->columns + column * p->nodes, (size_t)(8 * p->nodes));
    write_checksum(bytes, at);
    *size = at + CHECKSUM_SIZE;
    return bytes;
}

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
