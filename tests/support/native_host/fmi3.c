#include "fmi3Functions.h"

#include <math.h>

#include "host.h"
#include "library.h"

#define FUNCTIONS(X)                                                                               \
    X(GetVersion) X(SetDebugLogging) X(InstantiateModelExchange) X(InstantiateCoSimulation)        \
    X(InstantiateScheduledExecution) X(FreeInstance) X(EnterInitializationMode)                    \
    X(ExitInitializationMode) X(EnterEventMode) X(Terminate) X(Reset)                              \
    X(GetFloat32) X(GetFloat64) X(GetInt8) X(GetUInt8) X(GetInt16) X(GetUInt16) X(GetInt32)        \
    X(GetUInt32) X(GetInt64) X(GetUInt64) X(GetBoolean) X(GetString) X(GetBinary) X(GetClock)      \
    X(SetFloat32) X(SetFloat64) X(SetInt8) X(SetUInt8) X(SetInt16) X(SetUInt16) X(SetInt32)        \
    X(SetUInt32) X(SetInt64) X(SetUInt64) X(SetBoolean) X(SetString) X(SetBinary) X(SetClock)      \
    X(GetNumberOfVariableDependencies) X(GetVariableDependencies)                                  \
    X(GetFMUState) X(SetFMUState) X(FreeFMUState)                                                  \
    X(SerializedFMUStateSize) X(SerializeFMUState) X(DeserializeFMUState)                          \
    X(GetDirectionalDerivative) X(GetAdjointDerivative) X(EnterConfigurationMode)                  \
    X(ExitConfigurationMode) X(GetIntervalDecimal) X(GetIntervalFraction) X(GetShiftDecimal)       \
    X(GetShiftFraction) X(SetIntervalDecimal) X(SetIntervalFraction) X(SetShiftDecimal)            \
    X(SetShiftFraction) X(EvaluateDiscreteStates) X(UpdateDiscreteStates)                          \
    X(EnterContinuousTimeMode) X(CompletedIntegratorStep) X(SetTime) X(SetContinuousStates)        \
    X(GetContinuousStateDerivatives) X(GetEventIndicators) X(GetContinuousStates)                  \
    X(GetNominalsOfContinuousStates) X(GetNumberOfEventIndicators)                                 \
    X(GetNumberOfContinuousStates) X(EnterStepMode) X(GetOutputDerivatives) X(DoStep)              \
    X(ActivateModelPartition)
#define DECLARE(name) fmi3##name##TYPE *name;
#define FIND(name) CHECK((found->name = (fmi3##name##TYPE *)library_find(fmu->library, "fmi3" #name)) != NULL);
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

static void logger(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
                   fmi3String text) {
    (void)environment, (void)category;
    told(status, text);
}

static const char *get_version(const Fmu *fmu) { return CALL(GetVersion)(); }

static void *instantiate(const Fmu *fmu, const char *name, const char *token) {
    return CALL(InstantiateCoSimulation)(name, token, fmu->resources, fmi3False, fmi3True, fmi3False,
                                         fmi3False, NULL, 0, NULL, logger, NULL);
}

static void free_instance(const Fmu *fmu, void *c) { CALL(FreeInstance)(c); }

static int enter(const Fmu *fmu, void *c, double start_s) {
    return CALL(EnterInitializationMode)(c, fmi3False, 0.0, start_s, fmi3False, 0.0);
}

static int leave(const Fmu *fmu, void *c) { return CALL(ExitInitializationMode)(c); }

static int step(const Fmu *fmu, void *c, double time_s, double step_s) {
    fmi3Boolean event = true, end = true, early = true;
    double last = NAN;
    int status = CALL(DoStep)(c, time_s, step_s, fmi3True, &event, &end, &early, &last);
    if (status == OK) CHECK(!event && !end && !early && last == time_s + step_s);
    return status;
}

static int terminate(const Fmu *fmu, void *c) { return CALL(Terminate)(c); }
static int reset(const Fmu *fmu, void *c) { return CALL(Reset)(c); }

static int get(const Fmu *fmu, void *c, Kind kind, const uint32_t *references, size_t count,
               double *values) {
    int32_t small[MANY];
    int64_t large[MANY];
    fmi3Boolean truths[MANY];
    int status;
    if (kind == REAL) return CALL(GetFloat64)(c, references, count, values, count);
    if (kind == INTEGER) status = CALL(GetInt32)(c, references, count, small, count);
    else if (kind == ENUMERATION) status = CALL(GetInt64)(c, references, count, large, count);
    else status = CALL(GetBoolean)(c, references, count, truths, count);
    for (size_t i = 0; status == OK && i < count; i++)
        values[i] = kind == INTEGER ? small[i] : kind == ENUMERATION ? (double)large[i] : truths[i];
    return status;
}

static int set(const Fmu *fmu, void *c, Kind kind, const uint32_t *references, size_t count,
               const double *values) {
    int32_t small[MANY];
    int64_t large[MANY];
    fmi3Boolean truths[MANY];
    if (kind == REAL) return CALL(SetFloat64)(c, references, count, values, count);
    for (size_t i = 0; i < count; i++) {
        small[i] = (int32_t)values[i];
        large[i] = (int64_t)values[i];
        truths[i] = values[i] != 0.0;
    }
    if (kind == INTEGER) return CALL(SetInt32)(c, references, count, small, count);
    if (kind == ENUMERATION) return CALL(SetInt64)(c, references, count, large, count);
    return CALL(SetBoolean)(c, references, count, truths, count);
}

static int set_text(const Fmu *fmu, void *c, uint32_t reference, const char *text) {
    return CALL(SetString)(c, &reference, 1, &text, 1);
}

static int get_state(const Fmu *fmu, void *c, void **state) { return CALL(GetFMUState)(c, state); }
static int set_state(const Fmu *fmu, void *c, void *state) { return CALL(SetFMUState)(c, state); }
static int free_state(const Fmu *fmu, void *c, void **state) { return CALL(FreeFMUState)(c, state); }

static int state_size(const Fmu *fmu, void *c, void *state, size_t *size) {
    return CALL(SerializedFMUStateSize)(c, state, size);
}

static int serialize(const Fmu *fmu, void *c, void *state, uint8_t *bytes, size_t size) {
    return CALL(SerializeFMUState)(c, state, bytes, size);
}

static int deserialize(const Fmu *fmu, void *c, const uint8_t *bytes, size_t size, void **state) {
    return CALL(DeserializeFMUState)(c, bytes, size, state);
}

static int unsupported(const Fmu *fmu, void *c) {
    CHECK(CALL(EnterEventMode)(c) == fmi3Error);
    return CALL(EnterStepMode)(c);
}

static bool other_kinds_refused(const Fmu *fmu) {
    return !CALL(InstantiateModelExchange)("x", fmu->token, fmu->resources, false, false, NULL,
                                           logger) &&
           !CALL(InstantiateScheduledExecution)("x", fmu->token, fmu->resources, false, false, NULL,
                                                logger, NULL, NULL, NULL);
}

const Api fmi3 = {"3.0", functions, get_version, instantiate, free_instance, enter, leave, step,
                  terminate, reset, get, set, set_text, get_state, set_state, free_state, state_size,
                  serialize, deserialize, unsupported, other_kinds_refused};
