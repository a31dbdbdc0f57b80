/* The history of a profile: what all iterations hold, compared and continued. It is written in the
   newest format, whatever it was read from. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "profile.h"
#include "text.h"

enum { START_SIZE = 512, LINE_SIZE = 128 };

typedef struct { /* lines of iterations and the blocks that they name */
    const uint8_t *lines, *blocks;
    int64_t lines_size, count;
    uint8_t *owned_lines, *owned_blocks; /* or NULL: they are those of a profile */
} Piece;

int64_t profile_stride(int64_t nodes) { return (8 * nodes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT; }

static bool all_zero(const double *values, int64_t nodes) {
    const uint8_t *bytes = (const uint8_t *)values;
    for (int64_t i = 0; i < 8 * nodes; i++)
        if (bytes[i]) return false;
    return true;
}

bool profile_same_values(const double *a, const double *b, int64_t nodes) {
    if (!a || !b) return a == b || all_zero(a ? a : b, nodes);
    return a == b || memcmp(a, b, (size_t)(8 * nodes)) == 0;
}

/* Pieces */

static bool piece_make(Piece *piece, int64_t lines, int64_t blocks, int64_t stride) {
    memset(piece, 0, sizeof *piece);
    piece->lines = piece->owned_lines = malloc((size_t)(lines * LINE_SIZE + 1));
    piece->blocks = piece->owned_blocks = calloc((size_t)(blocks + 1), (size_t)stride);
    return piece->lines && piece->blocks;
}

static void piece_free(Piece *piece) {
    free(piece->owned_lines);
    free(piece->owned_blocks);
}

static void add_iteration(Piece *piece, const IterationLine *line) {
    char *at = (char *)piece->owned_lines + piece->lines_size;
    piece->lines_size += sprintf(at, "iteration %lld %s %lld%s%.*s\n", (long long)line->number, line->kind,
                                 (long long)line->interventions, line->note_length ? " " : "",
                                 (int)line->note_length, line->note);
}

/* Adds the block if it differs from the one before. */
static void add_block(Piece *piece, int column, const double *values, const double *before, int64_t nodes) {
    if (profile_same_values(values, before, nodes)) return;
    char *at = (char *)piece->owned_lines + piece->lines_size;
    piece->lines_size += sprintf(at, "block %s %s\n", profile_columns[column].name,
                                 profile_columns[column].unit);
    if (values) memcpy(piece->owned_blocks + piece->count * profile_stride(nodes), values, (size_t)(8 * nodes));
    piece->count++;
}

/* Of format 1, block by block */

typedef struct {
    const Profile *p;
    Piece *piece;
    const double *before[1 + FORMAT_1_COLUMNS];
} Upgrade;

static const double *block_of(const Profile *p, int64_t block) {
    return (const double *)(const void *)(p->bytes + p->head + block * p->stride);
}

static bool upgrade_block(void *context, const IterationLine *line, int column, int64_t block) {
    Upgrade *u = context;
    if (column < 0) return add_iteration(u->piece, line), true;
    const double *values = block_of(u->p, block);
    add_block(u->piece, column, values, u->before[column], u->p->nodes);
    u->before[column] = values;
    return true;
}

/* What is stored, in the newest format; false: memory. */
static bool piece_of(const Profile *p, Piece *piece) {
    memset(piece, 0, sizeof *piece);
    if (!p->bytes || !p->count) return true;
    if (p->version > 1) {
        piece->lines = p->bytes + p->lines;
        piece->lines_size = p->lines_end - p->lines;
        piece->blocks = p->bytes + p->head + p->stride;
        piece->count = p->blocks - 1;
        return true;
    }
    Upgrade upgrade = {p, piece, {0}};
    upgrade.before[COLUMN_LEARNED] = block_of(p, 0);
    if (!piece_make(piece, p->count + p->blocks, p->blocks, p->stride)) return false;
    return profile_walk(p, upgrade_block, &upgrade);
}

bool profile_same_history(const Profile *a, const Profile *b) {
    Piece x = {0}, y = {0};
    int64_t count = a->bytes ? a->count : 0;
    if (count != (b->bytes ? b->count : 0) || a->nodes != b->nodes) return false;
    if (count == 0) return true;
    bool known = piece_of(a, &x) && piece_of(b, &y);
    bool same = known && profile_same_values(block_of(a, 0), block_of(b, 0), a->nodes) &&
                x.lines_size == y.lines_size && memcmp(x.lines, y.lines, (size_t)x.lines_size) == 0 &&
                x.count == y.count && memcmp(x.blocks, y.blocks, (size_t)(x.count * a->stride)) == 0;
    piece_free(&x);
    piece_free(&y);
    return same;
}

/* One more iteration */

static bool piece_of_lesson(const Profile *p, const double *base, const Lesson *lesson, Piece *piece) {
    IterationLine line = {(p->bytes ? p->count : 0) + 1, lesson->interventions, lesson->kind, lesson->note,
                          (int64_t)strlen(lesson->note)};
    if (!piece_make(piece, 1 + PROFILE_COLUMNS, PROFILE_COLUMNS, profile_stride(p->nodes))) return false;
    add_iteration(piece, &line);
    for (int column = 0; column < PROFILE_COLUMNS; column++) {
        bool first = !p->bytes && (column == COLUMN_BASE || column == COLUMN_LEARNED);
        const double *before = first ? base : profile_newest(p, column);
        const double *values = lesson->carried ? before : NULL;
        if (column == COLUMN_BASE) values = lesson->base;
        else if (column < COLUMN_LEARNED + KERNEL_COLUMNS)
            values = lesson->columns + (column - COLUMN_LEARNED) * p->nodes;
        add_block(piece, column, values, before, p->nodes);
    }
    return true;
}

static int64_t put(uint8_t *bytes, int64_t at, const void *from, int64_t size) {
    if (size) memcpy(bytes + at, from, (size_t)size);
    return at + size;
}

static uint8_t *assemble(const Profile *p, const double *base, const Piece *old, const Piece *new,
                         int64_t *size) {
    int64_t stride = profile_stride(p->nodes), blocks = 1 + old->count + new->count;
    int64_t most = START_SIZE + old->lines_size + new->lines_size + blocks * stride + CHECKSUM_SIZE;
    uint8_t *bytes = calloc(1, (size_t)most);
    if (!bytes) return NULL;
    int64_t at = sprintf((char *)bytes,
                         "PLDF-PROFILE 2\ndriver %lld\nroute %s\nnodes %lld\nstep_m 1\niterations %lld\n"
                         "blocks %lld\nblock base_mps m/s\n",
                         (long long)p->driver, p->route, (long long)p->nodes,
                         (long long)(p->bytes ? p->count : 0) + 1, (long long)blocks);
    at = put(bytes, at, old->lines, old->lines_size);
    at = put(bytes, at, new->lines, new->lines_size);
    at = put(bytes, at, "end", 3);
    while ((at + 1) % ALIGNMENT) bytes[at++] = ' ';
    bytes[at++] = '\n';
    put(bytes, at, base, 8 * p->nodes);
    at = put(bytes, at + stride, old->blocks, old->count * stride);
    at = put(bytes, at, new->blocks, new->count * stride);
    write_checksum(bytes, at);
    *size = at + CHECKSUM_SIZE;
    return bytes;
}

bool profile_add(Profile *p, const uint8_t *stored, const Lesson *lesson, char *why) {
    Piece old = {0}, new = {0};
    Profile longer = {0};
    const double *base = p->bytes ? block_of(p, 0) : lesson->base;
    bool good = piece_of(p, &old) && piece_of_lesson(p, base, lesson, &new);
    longer.bytes = good ? assemble(p, base, &old, &new, &longer.size) : NULL;
    piece_free(&old);
    piece_free(&new);
    if (!longer.bytes) return snprintf(why, REASON_SIZE, "not enough memory"), false;
    if (!profile_parse(&longer, why)) return free(longer.bytes), false; /* what cannot be read back */
    if (p->bytes != stored) free(p->bytes);
    *p = longer;
    return true;
}
