/* FMI 3.0 for co-simulation: each call is handed to the session, which is FMI's instance. */
#include <math.h>
#include <string.h>

#include "fmi3Functions.h"
#include "session.h"

#pragma GCC diagnostic ignored "-Wunused-parameter" /* the standard prescribes them */

static fmi3Status answer(bool good) { return good ? fmi3OK : fmi3Error; }

static void tell(const Session *s, Level level, const char *category, const char *text) {
    fmi3LogMessageCallback log_message = (fmi3LogMessageCallback)s->importer.logger;
    log_message(s->importer.environment, (fmi3Status)level, category, text);
}

static Session *new_session(fmi3String name, fmi3String token, fmi3String resources, bool logging,
                            void *environment, fmi3LogMessageCallback log_message,
                            const char *problem) {
    Importer importer = {tell, (void (*)(void))log_message, environment, "#"}; /* #1# is a variable */
    if (!token || strcmp(token, model.token) != 0)
        problem = "the instantiation token is that of another FMU";
    return session_new(name, resources, logging, problem, &importer);
}

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t count,
                               const fmi3String categories[]) {
    return answer(session_log(c, on, count, categories));
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                          fmi3Boolean visible, fmi3Boolean logging,
                                          fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback log_message) {
    return new_session(name, token, resources, logging, environment, log_message,
                       "only co-simulation is possible");
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
                                         fmi3Boolean visible, fmi3Boolean logging,
                                         fmi3Boolean event_mode, fmi3Boolean early_return,
                                         const fmi3ValueReference intermediate[], size_t count,
                                         fmi3InstanceEnvironment environment,
                                         fmi3LogMessageCallback log_message,
                                         fmi3IntermediateUpdateCallback update) {
    return new_session(name, token, resources, logging, environment, log_message,
                       event_mode ? "there is no event mode"
                       : count    ? "there are no intermediate variables"
                                  : NULL);
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token,
                                               fmi3String resources, fmi3Boolean visible,
                                               fmi3Boolean logging,
                                               fmi3InstanceEnvironment environment,
                                               fmi3LogMessageCallback log_message,
                                               fmi3ClockUpdateCallback update,
                                               fmi3LockPreemptionCallback lock,
                                               fmi3UnlockPreemptionCallback unlock) {
    return new_session(name, token, resources, logging, environment, log_message,
                       "only co-simulation is possible");
}

void fmi3FreeInstance(fmi3Instance c) { session_free(c); }

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerance_given,
                                       fmi3Float64 tolerance, fmi3Float64 start,
                                       fmi3Boolean stop_given, fmi3Float64 stop) {
    return answer(session_allows(c, __func__, AT_START) &&
                  session_set_times(c, start, stop_given ? stop : INFINITY) &&
                  session_enter_initialization(c));
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c) {
    return answer(session_allows(c, __func__, IN_INITIALIZATION) && session_exit_initialization(c));
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 step, fmi3Boolean no_rollback,
                      fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early_return,
                      fmi3Float64 *last_time) {
    bool good = session_allows(c, __func__, AT_STEP) && session_step(c, time, step);
    if (event) *event = false;
    if (terminate) *terminate = false;
    if (early_return) *early_return = false;
    if (last_time && c) *last_time = ((Session *)c)->state.time;
    return answer(good);
}

fmi3Status fmi3Terminate(fmi3Instance c) {
    return answer(session_allows(c, __func__, AT_STEP) && session_terminate(c));
}

fmi3Status fmi3Reset(fmi3Instance c) { return answer(session_reset(c)); }

/* Values */

#define VALUES(TYPE) \
    fmi3Instance c, const fmi3ValueReference references[], size_t count, TYPE values[], size_t size

#define GET(TYPE, KINDS, READ)                                                  \
    fmi3Status fmi3Get##TYPE(VALUES(fmi3##TYPE)) {                              \
        Session *s = c;                                                         \
        bool good = session_can_get(s, references, count, values, size, KINDS); \
        for (size_t i = 0; good && i < count; i++) values[i] = READ;            \
        return answer(good);                                                    \
    }

#define SET(TYPE, KINDS, WRITE)                                                 \
    fmi3Status fmi3Set##TYPE(VALUES(const fmi3##TYPE)) {                        \
        Session *s = c;                                                         \
        bool good = session_can_set(s, references, count, values, size, KINDS); \
        for (size_t i = 0; good && i < count; i++) WRITE;                       \
        return answer(good);                                                    \
    }

static bool is_time(fmi3ValueReference reference) {
    return reference == (fmi3ValueReference)model.variable_count;
}

GET(Float64, KIND_REAL | KIND_TIME, is_time(references[i]) ? session_time(s) : CELL(i).real)
GET(Int32, KIND_INTEGER, (fmi3Int32)CELL(i).integer)
GET(Int64, KIND_ENUMERATION, CELL(i).integer)
GET(Boolean, KIND_BOOLEAN, CELL(i).integer != 0)
GET(String, KIND_STRING, TEXT(i))
SET(Float64, KIND_REAL, CELL(i).real = values[i])
SET(Int32, KIND_INTEGER, CELL(i).integer = values[i])
SET(Int64, KIND_ENUMERATION, CELL(i).integer = values[i])
SET(Boolean, KIND_BOOLEAN, CELL(i).integer = values[i])
SET(String, KIND_STRING, good = session_set_text(s, references[i], values[i]))

/* States */

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state) {
    return answer(session_get_state(c, state));
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) {
    return answer(session_set_state(c, state));
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state) {
    return answer(session_free_state(c, state));
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size) {
    return answer(session_serialized_size(c, state, size));
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
    return answer(session_serialize(c, state, bytes, size));
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size,
                                   fmi3FMUState *state) {
    return answer(session_deserialize(c, bytes, size, state));
}

/* What the capability flags say is not there, other types, model exchange, scheduled execution */

#define REFUSED(NAME, ...) \
    fmi3Status NAME(__VA_ARGS__) { return answer(session_unsupported(c, __func__)); }
#define REFUSED_TYPE(TYPE)                              \
    REFUSED(fmi3Get##TYPE, VALUES(fmi3##TYPE))          \
    REFUSED(fmi3Set##TYPE, VALUES(const fmi3##TYPE))
#define REFERENCES fmi3Instance c, const fmi3ValueReference references[], size_t count

REFUSED_TYPE(Float32)
REFUSED_TYPE(Int8)
REFUSED_TYPE(UInt8)
REFUSED_TYPE(Int16)
REFUSED_TYPE(UInt16)
REFUSED_TYPE(UInt32)
REFUSED_TYPE(UInt64)
REFUSED(fmi3GetBinary, REFERENCES, size_t sizes[], fmi3Binary values[], size_t size)
REFUSED(fmi3SetBinary, REFERENCES, const size_t sizes[], const fmi3Binary values[], size_t size)
REFUSED(fmi3GetClock, REFERENCES, fmi3Clock values[])
REFUSED(fmi3SetClock, REFERENCES, const fmi3Clock values[])
REFUSED(fmi3GetIntervalDecimal, REFERENCES, fmi3Float64 s[], fmi3IntervalQualifier qualifiers[])
REFUSED(fmi3GetIntervalFraction, REFERENCES, fmi3UInt64 counters[], fmi3UInt64 resolutions[],
        fmi3IntervalQualifier qualifiers[])
REFUSED(fmi3GetShiftDecimal, REFERENCES, fmi3Float64 shifts[])
REFUSED(fmi3GetShiftFraction, REFERENCES, fmi3UInt64 counters[], fmi3UInt64 resolutions[])
REFUSED(fmi3SetIntervalDecimal, REFERENCES, const fmi3Float64 intervals[])
REFUSED(fmi3SetIntervalFraction, REFERENCES, const fmi3UInt64 counters[], const fmi3UInt64 units[])
REFUSED(fmi3SetShiftDecimal, REFERENCES, const fmi3Float64 shifts[])
REFUSED(fmi3SetShiftFraction, REFERENCES, const fmi3UInt64 counters[], const fmi3UInt64 units[])
REFUSED(fmi3GetOutputDerivatives, REFERENCES, const fmi3Int32 orders[], fmi3Float64 values[],
        size_t size)
REFUSED(fmi3GetDirectionalDerivative, REFERENCES, const fmi3ValueReference knowns[], size_t n,
        const fmi3Float64 seed[], size_t m, fmi3Float64 values[], size_t size)
REFUSED(fmi3GetAdjointDerivative, REFERENCES, const fmi3ValueReference knowns[], size_t n,
        const fmi3Float64 seed[], size_t m, fmi3Float64 values[], size_t size)
REFUSED(fmi3GetNumberOfVariableDependencies, fmi3Instance c, fmi3ValueReference v, size_t *count)
REFUSED(fmi3GetVariableDependencies, fmi3Instance c, fmi3ValueReference v, size_t elements[],
        fmi3ValueReference references[], size_t indices[], fmi3DependencyKind kinds[], size_t count)
REFUSED(fmi3EnterConfigurationMode, fmi3Instance c)
REFUSED(fmi3ExitConfigurationMode, fmi3Instance c)
REFUSED(fmi3EnterEventMode, fmi3Instance c)
REFUSED(fmi3EnterStepMode, fmi3Instance c)
REFUSED(fmi3EvaluateDiscreteStates, fmi3Instance c)
REFUSED(fmi3UpdateDiscreteStates, fmi3Instance c, fmi3Boolean *again, fmi3Boolean *terminate,
        fmi3Boolean *nominals, fmi3Boolean *values, fmi3Boolean *defined, fmi3Float64 *next)
REFUSED(fmi3EnterContinuousTimeMode, fmi3Instance c)
REFUSED(fmi3CompletedIntegratorStep, fmi3Instance c, fmi3Boolean no_rollback, fmi3Boolean *event,
        fmi3Boolean *terminate)
REFUSED(fmi3SetTime, fmi3Instance c, fmi3Float64 time)
REFUSED(fmi3SetContinuousStates, fmi3Instance c, const fmi3Float64 values[], size_t count)
REFUSED(fmi3GetContinuousStateDerivatives, fmi3Instance c, fmi3Float64 values[], size_t count)
REFUSED(fmi3GetEventIndicators, fmi3Instance c, fmi3Float64 values[], size_t count)
REFUSED(fmi3GetContinuousStates, fmi3Instance c, fmi3Float64 values[], size_t count)
REFUSED(fmi3GetNominalsOfContinuousStates, fmi3Instance c, fmi3Float64 values[], size_t count)
REFUSED(fmi3GetNumberOfEventIndicators, fmi3Instance c, size_t *count)
REFUSED(fmi3GetNumberOfContinuousStates, fmi3Instance c, size_t *count)
REFUSED(fmi3ActivateModelPartition, fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time)
