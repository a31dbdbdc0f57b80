/* FMI 3.0 for co-simulation: each call is handed to the session, which is FMI's instance. */
#include <math.h>
#include <string.h>

#include "fmi3Functions.h"
#include "session.h"

#define FMI(NAME) fmi3##NAME
#define VALUES(TYPE) void *c, const uint32_t references[], size_t count, TYPE values[], size_t size
#define VALUE_COUNT size
#define fmi3GetFMUstate fmi3GetFMUState
#define fmi3SetFMUstate fmi3SetFMUState
#define fmi3FreeFMUstate fmi3FreeFMUState
#define fmi3SerializedFMUstateSize fmi3SerializedFMUStateSize
#define fmi3SerializeFMUstate fmi3SerializeFMUState
#define fmi3DeSerializeFMUstate fmi3DeserializeFMUState
#pragma GCC diagnostic ignored "-Wunused-parameter" /* the standard prescribes them */
#include "calls.h"

static void tell(const Importer *importer, Level level, const char *category, const char *text) {
    fmi3LogMessageCallback log_message = (fmi3LogMessageCallback)importer->logger;
    log_message(importer->environment, (fmi3Status)level, category, text);
}

/* What all three instantiations are given. */
#define NAMES \
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging
#define CALLBACK fmi3InstanceEnvironment environment, fmi3LogMessageCallback log_message

static Session *new_session(NAMES, CALLBACK, const char *problem) {
    Importer importer = {
        .tell = tell,
        .logger = (void (*)(void))log_message,
        .environment = environment,
        .doubled = "#", /* #1# is a variable */
    };
    if (!token || strcmp(token, model.token) != 0)
        problem = "the instantiation token is that of another FMU";
    return session_new(name, resources, logging, problem, &importer);
}

static const char ONE_KIND[] = "only co-simulation is possible";

fmi3Instance fmi3InstantiateModelExchange(NAMES, CALLBACK) {
    return new_session(name, token, resources, visible, logging, environment, log_message, ONE_KIND);
}

fmi3Instance fmi3InstantiateScheduledExecution(NAMES, CALLBACK, fmi3ClockUpdateCallback update,
                                               fmi3LockPreemptionCallback lock,
                                               fmi3UnlockPreemptionCallback unlock) {
    return new_session(name, token, resources, visible, logging, environment, log_message, ONE_KIND);
}

fmi3Instance fmi3InstantiateCoSimulation(NAMES, fmi3Boolean event_mode, fmi3Boolean early_return,
                                         const fmi3ValueReference intermediate[], size_t count,
                                         CALLBACK, fmi3IntermediateUpdateCallback update) {
    const char *problem = count ? "there are no intermediate variables" : NULL;
    if (event_mode) problem = "there is no event mode";
    return new_session(name, token, resources, visible, logging, environment, log_message, problem);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerance_given,
                                       fmi3Float64 tolerance, fmi3Float64 start,
                                       fmi3Boolean stop_given, fmi3Float64 stop) {
    return answer(session_allows(c, __func__, AT_START) &&
                  session_set_times(c, start, stop_given ? stop : INFINITY) &&
                  session_enter_initialization(c));
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 step, fmi3Boolean no_rollback,
                      fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early_return,
                      fmi3Float64 *last_time) {
    bool good = session_allows(c, __func__, AT_STEP) && session_step(c, time, step);
    if (event) *event = false;
    if (terminate) *terminate = false;
    if (early_return) *early_return = false;
    if (last_time && c) *last_time = session_time(c);
    return answer(good);
}

/* Values */

static bool is_time(fmi3ValueReference reference) {
    return model.variables[reference].kind == KIND_TIME;
}

GET(Float64, KIND_REAL | KIND_TIME, is_time(references[i]) ? session_time(s) : CELL(i).real)
GET(Int32, KIND_INTEGER, (fmi3Int32)CELL(i).integer)
GET(Int64, KIND_ENUMERATION, CELL(i).integer)
GET(Boolean, KIND_BOOLEAN, CELL(i).integer != 0)
GET(String, KIND_STRING, session_text(s, references[i]))
SET(Float64, KIND_REAL, values[i], CELL(i).real = values[i])
SET(Int32, KIND_INTEGER, values[i], CELL(i).integer = values[i])
SET(Int64, KIND_ENUMERATION, (double)values[i], CELL(i).integer = values[i])
SET(Boolean, KIND_BOOLEAN, values[i], CELL(i).integer = values[i])
SET(String, KIND_STRING, 0.0, good = session_set_text(s, references[i], values[i]))

/* What the capability flags say is not there, other types, model exchange, scheduled execution */

#define REFUSED_TYPE(TYPE)                 \
    REFUSED(Get##TYPE, VALUES(fmi3##TYPE)) \
    REFUSED(Set##TYPE, VALUES(const fmi3##TYPE))
#define REFERENCES fmi3Instance c, const fmi3ValueReference references[], size_t count

REFUSED_TYPE(Float32)
REFUSED_TYPE(Int8)
REFUSED_TYPE(UInt8)
REFUSED_TYPE(Int16)
REFUSED_TYPE(UInt16)
REFUSED_TYPE(UInt32)
REFUSED_TYPE(UInt64)
REFUSED(GetBinary, REFERENCES, size_t sizes[], fmi3Binary values[], size_t size)
REFUSED(SetBinary, REFERENCES, const size_t sizes[], const fmi3Binary values[], size_t size)
REFUSED(GetClock, REFERENCES, fmi3Clock values[])
REFUSED(SetClock, REFERENCES, const fmi3Clock values[])
REFUSED(GetIntervalDecimal, REFERENCES, fmi3Float64 s[], fmi3IntervalQualifier qualifiers[])
REFUSED(GetIntervalFraction, REFERENCES, fmi3UInt64 counters[], fmi3UInt64 resolutions[],
        fmi3IntervalQualifier qualifiers[])
REFUSED(GetShiftDecimal, REFERENCES, fmi3Float64 shifts[])
REFUSED(GetShiftFraction, REFERENCES, fmi3UInt64 counters[], fmi3UInt64 resolutions[])
REFUSED(SetIntervalDecimal, REFERENCES, const fmi3Float64 intervals[])
REFUSED(SetIntervalFraction, REFERENCES, const fmi3UInt64 counters[], const fmi3UInt64 units[])
REFUSED(SetShiftDecimal, REFERENCES, const fmi3Float64 shifts[])
REFUSED(SetShiftFraction, REFERENCES, const fmi3UInt64 counters[], const fmi3UInt64 units[])
REFUSED(GetOutputDerivatives, REFERENCES, const fmi3Int32 orders[], fmi3Float64 values[],
        size_t size)
REFUSED(GetDirectionalDerivative, REFERENCES, const fmi3ValueReference knowns[], size_t n,
        const fmi3Float64 seed[], size_t m, fmi3Float64 values[], size_t size)
REFUSED(GetAdjointDerivative, REFERENCES, const fmi3ValueReference knowns[], size_t n,
        const fmi3Float64 seed[], size_t m, fmi3Float64 values[], size_t size)
REFUSED(GetNumberOfVariableDependencies, fmi3Instance c, fmi3ValueReference v, size_t *count)
REFUSED(GetVariableDependencies, fmi3Instance c, fmi3ValueReference v, size_t elements[],
        fmi3ValueReference references[], size_t indices[], fmi3DependencyKind kinds[], size_t count)
REFUSED(EnterConfigurationMode, fmi3Instance c)
REFUSED(ExitConfigurationMode, fmi3Instance c)
REFUSED(EnterEventMode, fmi3Instance c)
REFUSED(EnterStepMode, fmi3Instance c)
REFUSED(EvaluateDiscreteStates, fmi3Instance c)
REFUSED(UpdateDiscreteStates, fmi3Instance c, fmi3Boolean *again, fmi3Boolean *terminate,
        fmi3Boolean *nominals, fmi3Boolean *values, fmi3Boolean *defined, fmi3Float64 *next)
REFUSED(EnterContinuousTimeMode, fmi3Instance c)
REFUSED(CompletedIntegratorStep, fmi3Instance c, fmi3Boolean no_rollback, fmi3Boolean *event,
        fmi3Boolean *terminate)
REFUSED(SetTime, fmi3Instance c, fmi3Float64 time)
REFUSED(SetContinuousStates, fmi3Instance c, const fmi3Float64 values[], size_t count)
REFUSED(GetContinuousStateDerivatives, fmi3Instance c, fmi3Float64 values[], size_t count)
REFUSED(GetEventIndicators, fmi3Instance c, fmi3Float64 values[], size_t count)
REFUSED(GetContinuousStates, fmi3Instance c, fmi3Float64 values[], size_t count)
REFUSED(GetNominalsOfContinuousStates, fmi3Instance c, fmi3Float64 values[], size_t count)
REFUSED(GetNumberOfEventIndicators, fmi3Instance c, size_t *count)
REFUSED(GetNumberOfContinuousStates, fmi3Instance c, size_t *count)
REFUSED(ActivateModelPartition, fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time)
