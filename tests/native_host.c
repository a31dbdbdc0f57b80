/* A simulator without Python: loads native FMUs and checks what the standard asks of them.
   usage: native_host LIBRARY GUID RESOURCES [LIBRARY GUID RESOURCES]
   The value references of Real inputs and outputs come in the environment as
   REALS_IN and REALS_OUT. Prints the outputs of every step of a scripted drive. */
#ifdef _WIN32
#include <windows.h>
#define dlopen(path, how) ((void *)LoadLibraryA(path))
#define dlsym(library, name) ((void *)GetProcAddress((HMODULE)(library), name))
#define dlclose(library) (FreeLibrary((HMODULE)(library)) ? 0 : 1)
#define dlerror() "LoadLibrary failed"
#else
#include <dlfcn.h>
#endif
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "fmi2Functions.h"

typedef struct {
    void *library;
    const char *path, *guid, *resources;
} Fmu;

#define F(fmu, name) ((fmi2##name##TYPE *)dlsym((fmu)->library, "fmi2" #name))
#define CHECK(truth)                                                       \
    do {                                                                   \
        if (!(truth)) {                                                    \
            printf("line %d: not true: %s\n", __LINE__, #truth);           \
            exit(1);                                                       \
        }                                                                  \
    } while (0)

enum { MANY = 64 };
static fmi2ValueReference inputs[MANY], outputs[MANY];
static size_t input_count, output_count;
static int errors;

static void logger(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                   fmi2String category, fmi2String text, ...) {
    (void)environment, (void)name, (void)category, (void)text;
    errors += status == fmi2Error;
}

static const fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, NULL};

static size_t references(const char *variable, fmi2ValueReference *found) {
    size_t count = 0;
    char *text = strdup(getenv(variable));
    for (char *one = strtok(text, ","); one; one = strtok(NULL, ",")) found[count++] = (unsigned)atoi(one);
    free(text);
    return count;
}

static Fmu load(char **arguments) {
    Fmu fmu = {dlopen(arguments[0], RTLD_NOW | RTLD_LOCAL), arguments[0], arguments[1], arguments[2]};
    if (!fmu.library) printf("%s\n", dlerror());
    CHECK(fmu.library);
    return fmu;
}

static fmi2Component make(const Fmu *fmu, const char *name) {
    fmi2Component c = F(fmu, Instantiate)(name, fmi2CoSimulation, fmu->guid, fmu->resources, &callbacks,
                                          fmi2False, fmi2False);
    CHECK(c);
    return c;
}

static void start(const Fmu *fmu, fmi2Component c) {
    const fmi2Boolean yes = fmi2True;
    const char *learn = getenv("LEARN"); /* value reference of learn_faithful */
    fmi2ValueReference reference = learn ? (unsigned)atoi(learn) : 0;
    if (learn) CHECK(F(fmu, SetBoolean)(c, &reference, 1, &yes) == fmi2OK);
    CHECK(F(fmu, SetupExperiment)(c, fmi2False, 0, 0, fmi2False, 0) == fmi2OK);
    CHECK(F(fmu, EnterInitializationMode)(c) == fmi2OK);
    CHECK(F(fmu, ExitInitializationMode)(c) == fmi2OK);
}

static void drive(const Fmu *fmu, fmi2Component c, int from, int to, bool print) {
    fmi2Real in[MANY], out[MANY];
    fmi2SetRealTYPE *set = F(fmu, SetReal);
    fmi2GetRealTYPE *get = F(fmu, GetReal);
    fmi2DoStepTYPE *step = F(fmu, DoStep);
    for (int k = from; k < to; k++) {
        for (size_t i = 0; i < input_count; i++) in[i] = (double)((7 * k + 13 * (int)i) % 97) / 97.0;
        in[0] = 0.2 * k;
        CHECK(set(c, inputs, input_count, in) == fmi2OK);
        CHECK(step(c, 0.01 * k, 0.01, fmi2True) == fmi2OK);
        CHECK(get(c, outputs, output_count, out) == fmi2OK);
        for (size_t i = 0; print && i < output_count; i++) printf("%a ", out[i]);
        if (print) printf("\n");
    }
}

static void wrong_order(const Fmu *fmu) {
    fmi2Component c = make(fmu, "wrong order");
    fmi2ValueReference unknown = 4000000000u;
    fmi2Real value = 0.0;
    errors = 0;
    CHECK(F(fmu, DoStep)(c, 0, 0.01, fmi2True) == fmi2Error);
    CHECK(F(fmu, ExitInitializationMode)(c) == fmi2Error);
    CHECK(F(fmu, Terminate)(c) == fmi2Error);
    CHECK(F(fmu, GetReal)(c, &unknown, 1, &value) == fmi2Error);
    CHECK(F(fmu, SetReal)(c, outputs, 1, &value) == fmi2Error);
    CHECK(F(fmu, CancelStep)(c) == fmi2Error);
    CHECK(errors == 6);
    start(fmu, c);
    CHECK(F(fmu, SetupExperiment)(c, fmi2False, 0, 0, fmi2False, 0) == fmi2Error);
    const double bad[] = {0.0, -1.0, NAN, INFINITY, 1e9};
    for (int i = 0; i < 5; i++) CHECK(F(fmu, DoStep)(c, 0, bad[i], fmi2True) == fmi2Error);
    CHECK(F(fmu, DoStep)(c, NAN, 0.01, fmi2True) == fmi2Error);
    drive(fmu, c, 0, 3, false);
    CHECK(F(fmu, DoStep)(c, 0.0, 0.01, fmi2True) == fmi2Error);
    CHECK(F(fmu, Terminate)(c) == fmi2OK);
    CHECK(F(fmu, DoStep)(c, 0.03, 0.01, fmi2True) == fmi2Error);
    CHECK(F(fmu, Reset)(c) == fmi2OK);
    start(fmu, c);
    drive(fmu, c, 0, 3, false);
    F(fmu, FreeInstance)(c);
    CHECK(!F(fmu, Instantiate)("x", fmi2CoSimulation, "{of another}", fmu->resources, &callbacks, 0, 0));
    CHECK(!F(fmu, Instantiate)("x", fmi2ModelExchange, fmu->guid, fmu->resources, &callbacks, 0, 0));
}

/* 200 steps at once = 100 steps, saved, restored in another instance, 100 steps. */
static void state_round_trip(const Fmu *fmu) {
    fmi2Component one = make(fmu, "one"), two = make(fmu, "two");
    fmi2FMUstate state = NULL, copy = NULL;
    size_t size = 0;
    fmi2Real expected[MANY], found[MANY];
    start(fmu, one);
    drive(fmu, one, 0, 100, false);
    CHECK(F(fmu, GetFMUstate)(one, &state) == fmi2OK);
    CHECK(F(fmu, SerializedFMUstateSize)(one, state, &size) == fmi2OK);
    fmi2Byte *bytes = malloc(size);
    CHECK(F(fmu, SerializeFMUstate)(one, state, bytes, size) == fmi2OK);
    drive(fmu, one, 100, 200, false);
    CHECK(F(fmu, GetReal)(one, outputs, output_count, expected) == fmi2OK);
    CHECK(F(fmu, DeSerializeFMUstate)(two, bytes, size, &copy) == fmi2OK);
    CHECK(F(fmu, SetFMUstate)(two, copy) == fmi2OK);
    drive(fmu, two, 100, 200, false);
    CHECK(F(fmu, GetReal)(two, outputs, output_count, found) == fmi2OK);
    CHECK(memcmp(expected, found, output_count * sizeof *found) == 0);
    CHECK(F(fmu, SetFMUstate)(one, state) == fmi2OK); /* back in time in the same instance */
    drive(fmu, one, 100, 200, false);
    CHECK(F(fmu, GetReal)(one, outputs, output_count, found) == fmi2OK);
    CHECK(memcmp(expected, found, output_count * sizeof *found) == 0);
    bytes[size / 2] ^= 1;
    CHECK(F(fmu, DeSerializeFMUstate)(two, bytes, size, &copy) == fmi2Error);
    for (size_t length = 0; length < 64; length++)
        CHECK(F(fmu, DeSerializeFMUstate)(two, bytes, length, &copy) == fmi2Error);
    CHECK(F(fmu, FreeFMUstate)(one, &state) == fmi2OK && !state);
    CHECK(F(fmu, FreeFMUstate)(two, &copy) == fmi2OK && !copy);
    free(bytes);
    F(fmu, FreeInstance)(one);
    F(fmu, FreeInstance)(two);
}

static void hostile_steps(const Fmu *fmu, int count) {
    static const double odd[] = {0, -0.0, 1, -1, 1e-300, 1e300, -1e300, 1e9, -1e9, NAN, INFINITY,
                                 -INFINITY, 4499.9, 4500, 20, 0.3};
    fmi2Component c = make(fmu, "hostile");
    fmi2Real in[MANY], out[MANY];
    double time = 0.0;
    start(fmu, c);
    srand(5);
    for (int k = 0; k < count; k++) {
        for (size_t i = 0; i < input_count; i++)
            in[i] = rand() % 3 ? 30.0 * rand() / RAND_MAX : odd[rand() % 16];
        double step = rand() % 50 ? 1e-3 * (1 + rand() % 100) : 1.7e-13;
        CHECK(F(fmu, SetReal)(c, inputs, input_count, in) == fmi2OK);
        CHECK(F(fmu, DoStep)(c, time, step, fmi2True) == fmi2OK);
        CHECK(F(fmu, GetReal)(c, outputs, output_count, out) == fmi2OK); /* finite, or an error */
        time += step;
    }
    CHECK(F(fmu, Terminate)(c) == fmi2OK);
    F(fmu, FreeInstance)(c);
}

static void bench(const Fmu *fmu, int count) {
    fmi2Component c = make(fmu, "bench");
    struct timespec a, b;
    start(fmu, c);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &a);
    drive(fmu, c, 0, count, false);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &b);
    printf("%.1f ns\n", ((double)(b.tv_sec - a.tv_sec) * 1e9 + (double)(b.tv_nsec - a.tv_nsec)) / count);
    F(fmu, FreeInstance)(c);
}

int main(int count, char **arguments) {
    input_count = references("REALS_IN", inputs);
    output_count = references("REALS_OUT", outputs);
    Fmu fmu = load(arguments + 1);
    if (getenv("BENCH")) return bench(&fmu, atoi(getenv("BENCH"))), 0;
    fmi2Component c = make(&fmu, "first"), other = make(&fmu, "second");
    start(&fmu, c);
    start(&fmu, other);
    drive(&fmu, other, 0, 500, false);
    drive(&fmu, c, 0, 2000, true); /* the other instance changes nothing */
    CHECK(F(&fmu, Terminate)(c) == fmi2OK);
    F(&fmu, FreeInstance)(c);
    F(&fmu, FreeInstance)(other); /* learned late: its result is kept beside the other's */
    if (getenv("LEARN")) return 0;
    wrong_order(&fmu);
    state_round_trip(&fmu);
    hostile_steps(&fmu, getenv("HOSTILE") ? atoi(getenv("HOSTILE")) : 20000);
    CHECK(dlclose(fmu.library) == 0);
    fmu = load(arguments + 1);
    if (count > 4) { /* two different FMUs in one process */
        Fmu second = load(arguments + 4);
        c = make(&fmu, "a"), other = make(&second, "b");
        start(&fmu, c);
        start(&second, other);
        CHECK(!strcmp(F(&second, GetVersion)(), "2.0"));
        drive(&fmu, c, 0, 50, false);
        CHECK(F(&second, DoStep)(other, 0, 0.01, fmi2True) == fmi2OK);
        F(&second, FreeInstance)(other);
        F(&fmu, FreeInstance)(c);
        dlclose(second.library);
    }
    CHECK(dlclose(fmu.library) == 0);
    return 0;
}
