#include "fmi2Functions.h"

#include "host.h"
#include "library.h"

#define FUNCTIONS(X)                                                                               \
    X(GetTypesPlatform) X(GetVersion) X(SetDebugLogging) X(Instantiate) X(FreeInstance)            \
    X(SetupExperiment) X(EnterInitializationMode) X(ExitInitializationMode) X(Terminate) X(Reset)  \
    X(GetReal) X(GetInteger) X(GetBoolean) X(GetString)                                            \
    X(SetReal) X(SetInteger) X(SetBoolean) X(SetString)                                            \
    X(GetFMUstate) X(SetFMUstate) X(FreeFMUstate)                                                  \
    X(SerializedFMUstateSize) X(SerializeFMUstate) X(DeSerializeFMUstate)                          \
    X(GetDirectionalDerivative) X(SetRealInputDerivatives) X(GetRealOutputDerivatives)             \
    X(DoStep) X(CancelStep) X(GetStatus) X(GetRealStatus) X(GetIntegerStatus)                      \
    X(GetBooleanStatus) X(GetStringStatus)
#define DECLARE(name) fmi2##name##TYPE *name;
#define FIND(name) CHECK((found->name = (fmi2##name##TYPE *)library_find(fmu->library, "fmi2" #name)) != NULL);
#define CALL(name) ((const Functions *)fmu->functions)->name

typedef struct {
    FUNCTIONS(DECLARE)
} Functions;

static void *functions(const Fmu *fmu) {
    Functions *found = calloc(1, sizeof *found);
    CHECK(found);
    FUNCTIONS(FIND)
    return found;
}

static void logger(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                   fmi2String category, fmi2String text, ...) {
    (void)environment, (void)name, (void)category;
    told(status, text);
}

static const fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, NULL};

static const char *get_version(const Fmu *fmu) { return CALL(GetVersion)(); }

static void *instantiate(const Fmu *fmu, const char *name, const char *token) {
    return CALL(Instantiate)(name, fmi2CoSimulation, token, fmu->resources, &callbacks, fmi2False,
                             fmi2True);
}

static void free_instance(const Fmu *fmu, void *c) { CALL(FreeInstance)(c); }

static int enter(const Fmu *fmu, void *c, double start_s) {
    fmi2Status status = CALL(SetupExperiment)(c, fmi2False, 0.0, start_s, fmi2False, 0.0);
    return status == fmi2OK ? CALL(EnterInitializationMode)(c) : status;
}

static int leave(const Fmu *fmu, void *c) { return CALL(ExitInitializationMode)(c); }

static int step(const Fmu *fmu, void *c, double time_s, double step_s) {
    return CALL(DoStep)(c, time_s, step_s, fmi2True);
}

static int terminate(const Fmu *fmu, void *c) { return CALL(Terminate)(c); }
static int reset(const Fmu *fmu, void *c) { return CALL(Reset)(c); }

static int get(const Fmu *fmu, void *c, Kind kind, const uint32_t *references, size_t count,
               double *values) {
    int found[MANY]; /* fmi2Integer and fmi2Boolean */
    int status;
    if (kind == REAL) return CALL(GetReal)(c, references, count, values);
    if (kind == BOOLEAN) status = CALL(GetBoolean)(c, references, count, found);
    else status = CALL(GetInteger)(c, references, count, found);
    for (size_t i = 0; status == OK && i < count; i++) values[i] = found[i];
    return status;
}

static int set(const Fmu *fmu, void *c, Kind kind, const uint32_t *references, size_t count,
               const double *values) {
    int wanted[MANY];
    if (kind == REAL) return CALL(SetReal)(c, references, count, values);
    for (size_t i = 0; i < count; i++) wanted[i] = (int)values[i];
    if (kind == BOOLEAN) return CALL(SetBoolean)(c, references, count, wanted);
    return CALL(SetInteger)(c, references, count, wanted);
}

static int set_text(const Fmu *fmu, void *c, uint32_t reference, const char *text) {
    return CALL(SetString)(c, &reference, 1, &text);
}

static int get_state(const Fmu *fmu, void *c, void **state) { return CALL(GetFMUstate)(c, state); }
static int set_state(const Fmu *fmu, void *c, void *state) { return CALL(SetFMUstate)(c, state); }
static int free_state(const Fmu *fmu, void *c, void **state) { return CALL(FreeFMUstate)(c, state); }

static int state_size(const Fmu *fmu, void *c, void *state, size_t *size) {
    return CALL(SerializedFMUstateSize)(c, state, size);
}

static int serialize(const Fmu *fmu, void *c, void *state, uint8_t *bytes, size_t size) {
    return CALL(SerializeFMUstate)(c, state, (fmi2Byte *)bytes, size);
}

static int deserialize(const Fmu *fmu, void *c, const uint8_t *bytes, size_t size, void **state) {
    return CALL(DeSerializeFMUstate)(c, (const fmi2Byte *)bytes, size, state);
}

static int unsupported(const Fmu *fmu, void *c) {
    fmi2Status status;
    CHECK(CALL(GetStatus)(c, fmi2DoStepStatus, &status) == fmi2Error);
    return CALL(CancelStep)(c);
}

static bool other_kinds_refused(const Fmu *fmu) {
    return !CALL(Instantiate)("x", fmi2ModelExchange, fmu->token, fmu->resources, &callbacks, 0, 0);
}

const Api fmi2 = {"2.0", functions, get_version, instantiate, free_instance, enter, leave, step,
                  terminate, reset, get, set, set_text, get_state, set_state, free_state, state_size,
                  serialize, deserialize, unsupported, other_kinds_refused};
