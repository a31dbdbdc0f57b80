/* Times of a native FMU in a host without Python (FMI 2.0, Linux). An FMU is named by a text file,
   one line each: library, GUID, resources, signals, table. Signals are words like iR12 or pI3=2: i
   input, o output, p parameter; its type (R, I or B); its value reference; a parameter's value.
   The table holds one row of inputs per step: all Reals, then Integers, then Booleans.

   native_step cost FMU EMPTY drives    per drive: CPU ns of a step of either
   native_step tail FMU EMPTY steps     quantiles of single steps of either, and of the clock alone
   native_step start FMU times          CPU and wall ns of each instantiation with initialization
   native_step finish FMU times         CPU and wall ns of each fmi2Terminate after a whole drive */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "fmi2Functions.h"

#define STEP_S 0.01
enum { MANY = 64, LINE = 8192, BINS = 100000 };

typedef struct {
    fmi2ValueReference references[MANY];
    size_t count;
} Batch;

typedef struct {
    void *library;
    char guid[LINE], resources[LINE];
    Batch reals_in, integers_in, booleans_in, reals_out, integers_out, booleans_out;
    char *parameters[MANY];
    size_t parameter_count;
    char *table;
    size_t row_size, rows;
    fmi2SetRealTYPE *set_real;
    fmi2SetIntegerTYPE *set_integer;
    fmi2SetBooleanTYPE *set_boolean;
    fmi2GetRealTYPE *get_real;
    fmi2GetIntegerTYPE *get_integer;
    fmi2GetBooleanTYPE *get_boolean;
    fmi2DoStepTYPE *do_step;
} Fmu;

#define F(fmu, name) ((fmi2##name##TYPE *)dlsym((fmu)->library, "fmi2" #name))

static void require(int truth, const char *what) {
    if (truth) return;
    fprintf(stderr, "native_step: %s\n", what);
    exit(1);
}

static void must(fmi2Status status) { require(status == fmi2OK, "the FMU refused a call"); }

static void logger(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                   fmi2String category, fmi2String text, ...) {
    static int told;
    (void)environment, (void)name, (void)category;
    if (status > fmi2Warning && told++ < 5) fprintf(stderr, "%s\n", text);
}

static const fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, NULL};

static int64_t now(clockid_t clock) {
    struct timespec time;
    clock_gettime(clock, &time);
    return (int64_t)time.tv_sec * 1000000000 + time.tv_nsec;
}

/* Loading */

static Batch *batch_of(Fmu *fmu, const char *word) {
    static const char kinds[] = "RIB";
    Batch *in[] = {&fmu->reals_in, &fmu->integers_in, &fmu->booleans_in};
    Batch *out[] = {&fmu->reals_out, &fmu->integers_out, &fmu->booleans_out};
    const char *kind = strchr(kinds, word[1]);
    require(kind != NULL && word[1] != 0, "unknown type of signal");
    return word[0] == 'i' ? in[kind - kinds] : out[kind - kinds];
}

static void read_signals(Fmu *fmu, char *line) {
    for (char *word = strtok(line, " "); word; word = strtok(NULL, " ")) {
        bool parameter = word[0] == 'p';
        Batch *batch = parameter ? NULL : batch_of(fmu, word);
        require((parameter ? fmu->parameter_count : batch->count) < MANY, "too many signals");
        if (parameter) fmu->parameters[fmu->parameter_count++] = strdup(word);
        else batch->references[batch->count++] = (unsigned)atoi(word + 2);
    }
    size_t size = 8 * fmu->reals_in.count + 4 * (fmu->integers_in.count + fmu->booleans_in.count);
    fmu->row_size = (size + 7) / 8 * 8;
}

static void read_table(Fmu *fmu, const char *path) {
    FILE *file = fopen(path, "rb");
    require(file != NULL, "no table");
    fseek(file, 0, SEEK_END);
    size_t size = (size_t)ftell(file);
    rewind(file);
    fmu->table = malloc(size);
    fmu->rows = size / fmu->row_size;
    require(fmu->table && fread(fmu->table, 1, size, file) == size, "the table cannot be read");
    fclose(file);
}

static void read_line(FILE *file, char *line) {
    require(fgets(line, LINE, file) != NULL, "the FMU's text file is too short");
    line[strcspn(line, "\n")] = 0;
}

static Fmu *load(const char *path) {
    char line[LINE];
    Fmu *fmu = calloc(1, sizeof *fmu);
    FILE *file = fopen(path, "r");
    require(fmu && file, path);
    read_line(file, line);
    fmu->library = dlopen(line, RTLD_NOW | RTLD_LOCAL);
    require(fmu->library != NULL, line);
    read_line(file, fmu->guid);
    read_line(file, fmu->resources);
    read_line(file, line);
    read_signals(fmu, line);
    read_line(file, line);
    read_table(fmu, line);
    fclose(file);
    fmu->set_real = F(fmu, SetReal), fmu->get_real = F(fmu, GetReal);
    fmu->set_integer = F(fmu, SetInteger), fmu->get_integer = F(fmu, GetInteger);
    fmu->set_boolean = F(fmu, SetBoolean), fmu->get_boolean = F(fmu, GetBoolean);
    fmu->do_step = F(fmu, DoStep);
    return fmu;
}

/* Driving */

static void set_parameter(const Fmu *fmu, fmi2Component c, const char *word) {
    fmi2ValueReference reference = (unsigned)atoi(word + 2);
    const char *text = strchr(word, '=');
    require(text != NULL, "a parameter without value");
    fmi2Real value = atof(text + 1);
    fmi2Integer whole = (fmi2Integer)value;
    if (word[1] == 'R') must(fmu->set_real(c, &reference, 1, &value));
    else if (word[1] == 'I') must(fmu->set_integer(c, &reference, 1, &whole));
    else must(fmu->set_boolean(c, &reference, 1, &whole));
}

static fmi2Component start(const Fmu *fmu) {
    fmi2Component c = F(fmu, Instantiate)("one", fmi2CoSimulation, fmu->guid, fmu->resources, &callbacks,
                                          fmi2False, fmi2False);
    require(c != NULL, "no instance");
    for (size_t i = 0; i < fmu->parameter_count; i++) set_parameter(fmu, c, fmu->parameters[i]);
    must(F(fmu, SetupExperiment)(c, fmi2False, 0, 0, fmi2False, 0));
    must(F(fmu, EnterInitializationMode)(c));
    must(F(fmu, ExitInitializationMode)(c));
    return c;
}

static void end(const Fmu *fmu, fmi2Component c) {
    must(F(fmu, Terminate)(c));
    F(fmu, FreeInstance)(c);
}

/* What a simulator does in every step: all inputs, the step, all outputs; types that the FMU does
   not have are left out. */
static inline int step(const Fmu *fmu, fmi2Component c, size_t k) {
    fmi2Real reals[MANY];
    fmi2Integer integers[MANY];
    fmi2Boolean booleans[MANY];
    const char *row = fmu->table + k * fmu->row_size;
    const char *whole = row + 8 * fmu->reals_in.count, *flags = whole + 4 * fmu->integers_in.count;
    int bad = 0;
#define EACH(call, batch, values) \
    if (fmu->batch.count) bad |= fmu->call(c, fmu->batch.references, fmu->batch.count, values)
    EACH(set_real, reals_in, (const fmi2Real *)(const void *)row);
    EACH(set_integer, integers_in, (const fmi2Integer *)(const void *)whole);
    EACH(set_boolean, booleans_in, (const fmi2Boolean *)(const void *)flags);
    bad |= fmu->do_step(c, STEP_S * (double)k, STEP_S, fmi2True);
    EACH(get_real, reals_out, reals);
    EACH(get_integer, integers_out, integers);
    EACH(get_boolean, booleans_out, booleans);
    return bad;
}

static double drive_cost_ns(const Fmu *fmu) {
    fmi2Component c = start(fmu);
    int bad = 0;
    int64_t before = now(CLOCK_PROCESS_CPUTIME_ID);
    for (size_t k = 0; k < fmu->rows; k++) bad |= step(fmu, c, k);
    int64_t passed = now(CLOCK_PROCESS_CPUTIME_ID) - before;
    must(bad ? fmi2Error : fmi2OK);
    end(fmu, c);
    return (double)passed / (double)fmu->rows;
}

/* Single steps */

typedef struct {
    uint32_t bins[BINS]; /* one per ns */
    int64_t count, longest;
} Histogram;

static inline void note(Histogram *h, int64_t ns) {
    h->bins[ns < BINS ? ns : BINS - 1]++;
    h->count++;
    if (ns > h->longest) h->longest = ns;
}

static int quantile_ns(const Histogram *h, double share) {
    int64_t seen = 0;
    for (int ns = 0; ns < BINS; ns++)
        if ((double)(seen += h->bins[ns]) >= share * (double)h->count) return ns;
    return BINS;
}

static void drive_noting(const Fmu *fmu, Histogram *h, int64_t most) {
    fmi2Component c = start(fmu);
    int bad = 0;
    int64_t before = now(CLOCK_MONOTONIC);
    for (size_t k = 0; k < fmu->rows && h->count < most; k++) {
        bad |= step(fmu, c, k);
        int64_t after = now(CLOCK_MONOTONIC);
        note(h, after - before);
        before = after;
    }
    must(bad ? fmi2Error : fmi2OK);
    end(fmu, c);
}

static void print(const char *name, const Histogram *h) {
    printf("%s %d %d %lld\n", name, quantile_ns(h, 0.5), quantile_ns(h, 0.999), (long long)h->longest);
}

/* The system gives the pages now and not in a step that is measured. */
static Histogram *new_histogram(void) {
    Histogram *h = malloc(sizeof *h);
    require(h != NULL, "no memory");
    for (size_t i = 0; i < sizeof *h; i++) ((volatile char *)h)[i] = 0;
    return h;
}

static void tail(const Fmu *fmu, const Fmu *empty, int64_t steps) {
    Histogram *ours = new_histogram(), *none = new_histogram(), *clock = new_histogram();
    while (ours->count < steps || none->count < steps) {
        drive_noting(fmu, ours, steps);
        drive_noting(empty, none, steps);
    }
    for (int64_t before = now(CLOCK_MONOTONIC), after; clock->count < steps; before = after)
        after = now(CLOCK_MONOTONIC), note(clock, after - before);
    print("fmu", ours), print("empty", none), print("clock", clock);
}

/* Begin and end */

typedef struct {
    int64_t cpu, wall;
} Moment;

static Moment moment(void) {
    return (Moment){now(CLOCK_PROCESS_CPUTIME_ID), now(CLOCK_MONOTONIC)};
}

static void print_since(Moment before) {
    Moment after = moment();
    printf("%lld %lld\n", (long long)(after.cpu - before.cpu), (long long)(after.wall - before.wall));
}

static void time_start(const Fmu *fmu) {
    Moment before = moment();
    fmi2Component c = start(fmu);
    print_since(before);
    end(fmu, c);
}

static void time_finish(const Fmu *fmu) {
    fmi2Component c = start(fmu);
    for (size_t k = 0; k < fmu->rows; k++) must(step(fmu, c, k) ? fmi2Error : fmi2OK);
    Moment before = moment();
    must(F(fmu, Terminate)(c));
    print_since(before);
    F(fmu, FreeInstance)(c);
}

int main(int count, char **arguments) {
    require(count >= 4, "usage: see the top of native_step.c");
    const char *what = arguments[1];
    int64_t number = atoll(arguments[count - 1]);
    Fmu *fmu = load(arguments[2]), *empty = count > 4 ? load(arguments[3]) : NULL;
    if (!strcmp(what, "tail") && empty) tail(fmu, empty, number);
    for (int64_t i = 0; i < number && strcmp(what, "tail") != 0; i++) {
        if (!strcmp(what, "cost") && empty)
            printf("%.2f %.2f\n", drive_cost_ns(fmu), drive_cost_ns(empty));
        else if (!strcmp(what, "start")) time_start(fmu);
        else if (!strcmp(what, "finish")) time_finish(fmu);
    }
    return 0;
}
