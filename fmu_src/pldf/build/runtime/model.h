/* One model as data: variables, defaults, arrays and the entry points compiled from its kernel.
   The table (table.h, table.c) is generated from the model's table of signals. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "table.h" /* MODEL_CELLS, MODEL_TEXTS, and codes and sizes that Python defines */

typedef union {
    int64_t integer;
    double real;
} Cell;

/* record, block of columns, number of nodes and of script lines, step in s. What numba makes of a function
   that returns nothing returns a pointer, which means nothing: WebAssembly asks for the exact type. */
typedef void *Entry(Cell *, double *, int64_t, int64_t, double);

enum { KIND_REAL = 1, KIND_INTEGER = 2, KIND_BOOLEAN = 4, KIND_STRING = 8, KIND_ENUMERATION = 16 };
enum { KIND_TIME = 32 }; /* what FMI 3.0 alone has; in no cell */
enum { PARAMETER, INPUT, OUTPUT, INDEPENDENT };

typedef struct { /* its index is the value reference */
    const char *name;
    int32_t kind, causality;
    bool tunable; /* a parameter that may be set between steps, too */
    int32_t cell; /* index in the record, of a String in the texts */
    double low, high;
} Variable;

enum { NOWHERE = -1, NODES = -2, LAST_NODE = -3 }; /* in place of a cell */

typedef struct { /* what a restored state may hold (pldf/kernel/ranges.py) */
    int32_t kind; /* integer or real; 0: anything */
    double low, high;
    int32_t at_most; /* cell of the number that bounds it as well */
    int32_t plus;    /* cell of the number that is added before that */
} Range;

typedef struct { /* value references of two Real parameters */
    int32_t allowed, used;
} Bound;

typedef struct { /* of the function's own recording */
    const char *name;
    int32_t column; /* of the block */
    const char *const *words; /* of codes, `count` of them; 0: numbers */
    int32_t count;
} RecordedColumn;

typedef struct { /* what only a model that learns has: cells, texts and columns */
    Entry *adopt, *learn, *forget, *mark, *take_back;
    const Bound *bounds; /* of every profile; none may be weaker than what is used */
    int32_t bound_count;
    const RecordedColumn *recorded;
    const int32_t *head; /* value references of what stands in the recording's head */
    int32_t recorded_count, head_count, recording_text;
    int32_t store_text, driver_id, apply_learned, learn_if[3], localization;
    int32_t first_node, nodes, intervening, interventions, profile_iteration, profile_status;
    int32_t set_series, holds, places, speed_min, accept, set_speed_gain, time_ns, s_m, input_state;
    int32_t teach_wanted, words, taken_back;
    int32_t base_column, learned_column, trace_column, next_column;
} Learning;

typedef struct { /* what only a model that speaks has: sentences per language, and cells */
    const char *const *reasons[2], *const *events[2];
    int32_t sentence, language;
    const char *names[SENTENCE_NUMBERS]; /* of the numbers, as they stand in a sentence */
    int32_t numbers[SENTENCE_NUMBERS];
} Cluster;

typedef enum { INFO = 0, WARNING = 1, ERROR_LEVEL = 3 } Level; /* numbers of FMI's status */

typedef struct {
    Level level;
    const char *text;
} Said;

typedef struct { /* a cell whose changes the user is told about */
    int32_t cell, flag, time; /* the flag's is -1 unless it is told once per drive */
    int32_t count;
    const Said *said; /* of each value, `count` of them */
} Watch;

typedef struct {
    const char *guid, *token; /* of FMI 2.0, of FMI 3.0 */
    const Variable *variables;
    int32_t variable_count;
    const Cell *defaults;
    const Range *ranges, *column_ranges; /* of the cells, of the columns that are kept */
    Entry *start, *refresh, *step; /* refresh is NULL if outputs follow no input without a step */
    /* columns of the block: per node (the first ones belong to the state), then per script line */
    int32_t node_columns, kept_columns, script_columns, route_column;
    int32_t route_if, script_if; /* cell that asks for it, -1: always; -2: never */
    int64_t route_if_value, script_if_value;
    int32_t route_id, script_id;     /* cells */
    int32_t route_text, script_text; /* index of the String parameters, -1: none */
    const Watch *watches; /* WATCHES of them */
    const Learning *learning; /* NULL: it does not learn */
    const Cluster *cluster;   /* NULL: it does not speak */
} Model;

extern const Model model;

typedef struct {
    const char *name, *unit;
    double low, high;
    bool whole;
} ProfileColumn;

/* Of an iteration; those from COLUMN_LEARNED on, KERNEL_COLUMNS of them, are the kernel's too. */
extern const ProfileColumn profile_columns[PROFILE_COLUMNS];
extern const char *const profile_kinds[PROFILE_KINDS];
extern const char *const mark_kinds[MARK_KINDS];
extern const char *const bound_words[];
extern const char *const phase_names[];
