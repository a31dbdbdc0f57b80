/* The function's own recording, as pldf/own_recording.py: the same bytes. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "run.h"

enum { LOCK_PATIENCE_MS = 10000, NUMBER_SIZE = 32 };

typedef struct {
    char *bytes; /* NULL: there was not enough memory */
    size_t size, room;
} Text;

static void add(Text *text, const char *more) {
    size_t length = strlen(more);
    if (text->bytes && text->size + length > text->room) {
        text->room = 2 * text->room + length;
        char *bytes = realloc(text->bytes, text->room);
        if (!bytes) free(text->bytes);
        text->bytes = bytes;
    }
    if (!text->bytes) return;
    memcpy(text->bytes + text->size, more, length);
    text->size += length;
}

/* With a point whatever the locale. */
static void add_number(Text *text, double value) {
    char number[NUMBER_SIZE];
    snprintf(number, sizeof number, "%.17g", value);
    for (char *at = number; *at; at++)
        if (!strchr("0123456789+-e", *at)) *at = '.';
    add(text, number);
}

static const double *trace(const State *state, const Run *run, int32_t column) {
    return run->block + (model.learning->trace_column + column) * state->nodes;
}

static void add_head(Text *text, const State *state, const Run *run) {
    const Learning *l = model.learning;
    add(text, "# " TEXT_RECORDING_HEAD "\n# route ");
    add(text, run->stored.route);
    for (int32_t i = 0; i < l->head_count; i++) {
        const Variable *v = &model.variables[l->head[i]];
        Cell cell = state->record[v->cell];
        add(text, "\n# ");
        add(text, v->name);
        add(text, " ");
        add_number(text, v->kind == KIND_REAL ? cell.real : (double)cell.integer);
    }
    for (int32_t i = 0; i < l->recorded_count; i++) {
        add(text, i ? "," : "\n");
        add(text, l->recorded[i].name);
    }
    add(text, "\n");
}

typedef struct { /* where and when a row is, which speed it has; else it has what the node has */
    int64_t node;
    double time_s, s_m, speed_mps;
} Place;

static double value_at(const State *state, const Run *run, const RecordedColumn *column, Place place) {
    if (strcmp(column->name, "time_s") == 0) return place.time_s;
    if (strcmp(column->name, "s_m") == 0) return place.s_m;
    if (strcmp(column->name, "speed_mps") == 0) return place.speed_mps;
    return run->block[column->column * state->nodes + place.node];
}

static void add_row(Text *text, const State *state, const Run *run, Place place) {
    const Learning *l = model.learning;
    for (int32_t i = 0; i < l->recorded_count; i++) {
        const RecordedColumn *column = &l->recorded[i];
        double value = value_at(state, run, column, place);
        if (i) add(text, ",");
        if (column->count == 0) add_number(text, value);
        else add(text, column->words[(int)value]);
    }
    add(text, "\n");
}

/* Rows between a node and the next if the car stood or crept there, at its mean speed. */
static void add_between(Text *text, const State *state, const Run *run, int64_t node) {
    const double *time_s = trace(state, run, TRACE_TIME_S) + node;
    double passed_s = time_s[1] - time_s[0];
    int64_t rows = passed_s / RECORDING_ROW_S < RECORDING_ROWS_MAX ? (int64_t)(passed_s / RECORDING_ROW_S)
                                                                  : RECORDING_ROWS_MAX;
    for (int64_t k = 1; k <= rows; k++) {
        double share = (double)k / ((double)rows + 1.0);
        Place place = {node, time_s[0] + passed_s * share, (double)node + share, 1.0 / passed_s};
        add_row(text, state, run, place);
    }
}

static Text content(const State *state, const Run *run) {
    Text text = {.bytes = malloc(1 << 16), .room = 1 << 16};
    int64_t first = state->record[model.learning->first_node].integer;
    int64_t behind = first + state->record[model.learning->nodes].integer;
    const double *time_s = trace(state, run, TRACE_TIME_S), *gap = trace(state, run, TRACE_GAP);
    const double *speed_mps = trace(state, run, TRACE_SPEED_MPS);
    add_head(&text, state, run);
    for (int64_t node = first; node < behind; node++) {
        add_row(&text, state, run, (Place){node, time_s[node], (double)node, speed_mps[node]});
        if (node + 1 < behind && gap[node + 1] == 0.0) add_between(&text, state, run, node);
    }
    return text;
}

/* A name as studies have it: person, system (A base, B learned), number of the drive. */
static bool free_path(const State *state, const char *folder, char *path, char *why) {
    const Learning *l = model.learning;
    char system = state->record[l->apply_learned].integer ? 'B' : 'A';
    for (int number = 1; number < 1000000; number++) {
        if (snprintf(path, PATH_SIZE, "%s/P%03lld_%c%d.csv", folder,
                     (long long)state->record[l->driver_id].integer, system, number) >= PATH_SIZE)
            return snprintf(why, REASON_SIZE, "its path is too long"), false;
        if (os_entry(path) == NO_ENTRY) return true;
    }
    snprintf(why, REASON_SIZE, "no name is free");
    return false;
}

static bool save(const State *state, const Run *run, char *path, char *why) {
    Lock lock;
    Text text = content(state, run);
    bool good = text.bytes != NULL;
    if (!good) snprintf(why, REASON_SIZE, "not enough memory");
    good = good && disk_make_folder(run->recordings, why) &&
           disk_lock(run->recordings, LOCK_PATIENCE_MS, &lock, why) == LOCK_DONE;
    if (good) {
        good = free_path(state, run->recordings, path, why) &&
               disk_replace(path, (const uint8_t *)text.bytes, (int64_t)text.size, NULL, why);
        disk_unlock(&lock);
    }
    free(text.bytes);
    return good;
}

void recording_open(const Importer *importer, const State *state, Run *run) {
    char found[PATH_SIZE] = "", part[PATH_SIZE], why[REASON_SIZE];
    const char *given = state->texts[model.learning->recording_text];
    if (!*given && !os_environment(RECORDING_VARIABLE, found)) return;
    if (!*given) given = found;
    if (!os_absolute(given, run->recordings, why)) {
        run->recordings[0] = 0;
        importer_tell(importer, WARNING, TEXT_RECORDING_NOT_WRITABLE, given, why);
    } else if (!disk_writable(run->recordings, part, why))
        importer_tell(importer, WARNING, TEXT_RECORDING_NOT_WRITABLE, run->recordings, why);
}

Level recording_save(const Importer *importer, const State *state, const Run *run) {
    char path[PATH_SIZE], why[REASON_SIZE] = "";
    if (!model.learning || !run->block || !*run->recordings) return INFO;
    int64_t nodes = state->record[model.learning->nodes].integer;
    if (nodes < 2) return INFO;
    snprintf(path, sizeof path, "%s", run->recordings);
    if (save(state, run, path, why)) {
        importer_tell(importer, INFO, TEXT_RECORDING_WRITTEN, (int)nodes - 1, path);
        return INFO;
    }
    importer_tell(importer, ERROR_LEVEL, TEXT_RECORDING_NOT_WRITTEN, path, why);
    return ERROR_LEVEL;
}
