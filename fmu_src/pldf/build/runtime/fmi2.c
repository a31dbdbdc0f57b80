/* FMI 2.0 for co-simulation: each call is handed to the session, which is FMI's component. */
#include <math.h>
#include <string.h>

#include "fmi2Functions.h"
#include "session.h"

#define FMI(NAME) fmi2##NAME
#define VALUES(TYPE) void *c, const uint32_t references[], size_t count, TYPE values[]
#define VALUE_COUNT count
#pragma GCC diagnostic ignored "-Wunused-parameter" /* the standard prescribes them */
#include "calls.h"

static void tell(const Importer *importer, Level level, const char *category, const char *text) {
    fmi2CallbackLogger logger = (fmi2CallbackLogger)importer->logger;
    logger(importer->environment, importer->name, (fmi2Status)level, category, text);
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *callbacks, fmi2Boolean visible,
                              fmi2Boolean logging) {
    if (!callbacks) return NULL;
    Importer importer = {
        .tell = tell,
        .logger = (void (*)(void))callbacks->logger,
        .environment = callbacks->componentEnvironment,
        .doubled = "%#", /* may be printed with printf; #r1# is a variable */
    };
    const char *problem = NULL;
    if (type != fmi2CoSimulation) problem = "only co-simulation is possible";
    if (!guid || strcmp(guid, model.guid) != 0) problem = "the GUID is that of another FMU";
    return session_new(name, resources, logging, problem, &importer);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_given, fmi2Real tolerance,
                               fmi2Real start, fmi2Boolean stop_given, fmi2Real stop) {
    double end = INFINITY; /* of FMI 3.0 alone: importers of FMI 2.0 go on past their stop time */
    return answer(session_allows(c, __func__, AT_START) && session_set_times(c, start, end));
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    return answer(session_allows(c, __func__, AT_START) && session_enter_initialization(c));
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean no_rollback) {
    return answer(session_allows(c, __func__, AT_STEP) && session_step(c, time, step));
}

/* Values */

GET(Real, KIND_REAL, CELL(i).real)
GET(Integer, KIND_INTEGER | KIND_ENUMERATION, (fmi2Integer)CELL(i).integer)
GET(Boolean, KIND_BOOLEAN, (fmi2Boolean)CELL(i).integer)
GET(String, KIND_STRING, session_text(s, references[i]))
SET(Real, KIND_REAL, values[i], CELL(i).real = values[i])
SET(Integer, KIND_INTEGER | KIND_ENUMERATION, values[i], CELL(i).integer = values[i])
SET(Boolean, KIND_BOOLEAN, values[i] != fmi2False, CELL(i).integer = values[i] != fmi2False)
SET(String, KIND_STRING, 0.0, good = session_set_text(s, references[i], values[i]))

/* The status of the last step, none of which is ever pending */

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) {
    const Session *s = c;
    if (!s || !value || kind != fmi2LastSuccessfulTime)
        return answer(session_unsupported(c, __func__));
    *value = session_time(s);
    return fmi2OK;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value) {
    const Session *s = c;
    if (!s || !value || kind != fmi2Terminated) return answer(session_unsupported(c, __func__));
    *value = s->state.phase == TERMINATED;
    return fmi2OK;
}

/* What the capability flags say is not there, and model exchange */

REFUSED(GetStatus, fmi2Component c, const fmi2StatusKind kind, fmi2Status *value)
REFUSED(GetIntegerStatus, fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value)
REFUSED(GetStringStatus, fmi2Component c, const fmi2StatusKind kind, fmi2String *value)
REFUSED(CancelStep, fmi2Component c)
REFUSED(SetRealInputDerivatives, fmi2Component c, const fmi2ValueReference references[],
        size_t count, const fmi2Integer order[], const fmi2Real values[])
REFUSED(GetRealOutputDerivatives, fmi2Component c, const fmi2ValueReference references[],
        size_t count, const fmi2Integer order[], fmi2Real values[])
REFUSED(GetDirectionalDerivative, fmi2Component c, const fmi2ValueReference unknown[], size_t m,
        const fmi2ValueReference known[], size_t n, const fmi2Real dknown[], fmi2Real dunknown[])
REFUSED(EnterEventMode, fmi2Component c)
REFUSED(NewDiscreteStates, fmi2Component c, fmi2EventInfo *info)
REFUSED(EnterContinuousTimeMode, fmi2Component c)
REFUSED(CompletedIntegratorStep, fmi2Component c, fmi2Boolean no_rollback, fmi2Boolean *event,
        fmi2Boolean *terminate)
REFUSED(SetTime, fmi2Component c, fmi2Real time)
REFUSED(SetContinuousStates, fmi2Component c, const fmi2Real values[], size_t count)
REFUSED(GetDerivatives, fmi2Component c, fmi2Real values[], size_t count)
REFUSED(GetEventIndicators, fmi2Component c, fmi2Real values[], size_t count)
REFUSED(GetContinuousStates, fmi2Component c, fmi2Real values[], size_t count)
REFUSED(GetNominalsOfContinuousStates, fmi2Component c, fmi2Real values[], size_t count)
