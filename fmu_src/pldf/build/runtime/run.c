#include "run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "prepared.h"

void run_release(Run *run) {
    free(run->block);
    free(run->marks);
    free(run->history);
    profile_free(&run->stored);
    memset(run, 0, sizeof *run);
}

void run_call(Entry *entry, State *state, Run *run, double step_s) {
    if (entry) entry(state->record, run->block, state->nodes, state->rows, step_s);
}

/* Parameters */

bool run_allows(const Importer *importer, const Variable *v, double value) {
    return (value >= v->low && value <= v->high) ||
           importer_tell(importer, ERROR_LEVEL, "parameter %s = %.17g: it must lie between %g and %g",
                         v->name, value, v->low, v->high);
}

static bool check_parameters(const Importer *importer, const Cell *record) {
    for (const Variable *v = model.variables; v < model.variables + model.variable_count; v++) {
        if (v->causality != PARAMETER || v->kind == KIND_STRING) continue;
        Cell cell = record[v->cell];
        if (!run_allows(importer, v, v->kind == KIND_REAL ? cell.real : (double)cell.integer)) return false;
    }
    return true;
}

/* Everything but parameters and inputs gets its start value. */
static void clear_memory(Cell *record) {
    Cell given[MODEL_CELLS];
    memcpy(given, record, sizeof given);
    memcpy(record, model.defaults, sizeof given);
    for (const Variable *v = model.variables; v < model.variables + model.variable_count; v++)
        if (v->kind != KIND_STRING && (v->causality == PARAMETER || v->causality == INPUT))
            record[v->cell] = given[v->cell];
}

/* Routes and scripts */

static bool wants(const State *state, int32_t cell, int64_t value) {
    return cell == -1 || (cell >= 0 && state->record[cell].integer == value);
}

static bool load(const Importer *importer, const State *state, const char *kind, int32_t text,
                 int32_t id, int64_t columns, Prepared *found) {
    char path[PATH_SIZE + 64], why[REASON_SIZE] = "there is no such file", help[REASON_SIZE];
    const char *given = text >= 0 ? state->texts[text] : "";
    char name[64];
    snprintf(name, sizeof name, "%s/%lld.prepared", kind, (long long)state->record[id].integer);
    snprintf(help, sizeof help, "a native FMU reads prepared files, see 'pldf %s --help'", kind);
    if (*given) snprintf(path, sizeof path, "%s", given);
    else if (!importer_resource(importer, name, path, sizeof path))
        return importer_tell(importer, ERROR_LEVEL,
                             "no %s: the importer named no folder of resources, or one with a path of "
                             "more than %d bytes, and there is none beside this library", kind,
                             PATH_SIZE - 1);
    return (disk_read(path, "PLDF-PREPARED ", &found->bytes, &found->size, why) == READ_DONE &&
            prepared_parse(found, kind, columns, why)) ||
           importer_tell(importer, ERROR_LEVEL, "%s: %s; %s", path, why,
                         *given ? help : "choose another number, or unpack the FMU again");
}

static bool load_both(const Importer *importer, const State *state, Prepared *route, Prepared *script) {
    const Learning *l = model.learning;
    if (wants(state, model.route_if, model.route_if_value)) {
        if (!load(importer, state, "route", model.route_text, model.route_id, ROUTE_COLUMNS, route))
            return false;
        if (l && state->record[l->localization].integer == LOCALIZATION_XY && !route->has_line)
            return importer_tell(importer, ERROR_LEVEL, "the route has no x_m and y_m, so localization "
                                                        "must be ARC_LENGTH");
    }
    return !wants(state, model.script_if, model.script_if_value) ||
           load(importer, state, "script", model.script_text, model.script_id, model.script_columns,
                script);
}

static void copy_columns(double *to, const Prepared *from) {
    if (from->bytes) memcpy(to, from->bytes + from->head, (size_t)(8 * from->columns * from->rows));
}

/* Gives the block its size and fills in what was prepared. */
static bool fill_block(const Importer *importer, State *state, Run *run, const Prepared *route,
                       const Prepared *script) {
    state->nodes = route->bytes ? route->rows : 2;
    state->rows = script->rows;
    int64_t values = model.node_columns * state->nodes + model.script_columns * state->rows;
    run->block = calloc((size_t)values, sizeof(double));
    if (!run->block || !prepared_copy_marks(route, &run->marks))
        return importer_tell(importer, ERROR_LEVEL, "not enough memory for this route");
    for (int64_t i = 0; i < values; i += 512) /* the system gives every page now, not in a step */
        *(volatile double *)(run->block + i) = 0.0;
    copy_columns(run->block + model.route_column * state->nodes, route);
    copy_columns(run->block + model.node_columns * state->nodes, script);
    memcpy(run->stored.route, route->key, sizeof run->stored.route);
    return true;
}

bool run_make(const Importer *importer, State *state, Run *run) {
    Prepared route = {0}, script = {0};
    if (!check_parameters(importer, state->record) || !learning_allows(importer, state)) return false;
    clear_memory(state->record);
    bool good = load_both(importer, state, &route, &script) &&
                fill_block(importer, state, run, &route, &script);
    free(route.bytes);
    free(script.bytes);
    if (!good) return run_release(run), false;
    run_call(model.start, state, run, 0.0);
    learning_follow(importer, state, run);
    return true;
}
