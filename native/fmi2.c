/* FMI 2.0 for co-simulation: arguments checked, then handed to the session. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2Functions.h"
#include "session.h"

typedef struct {
    Session *session;
    fmi2CallbackFunctions callbacks;
    bool events; /* tell INFO messages too */
    char name[];
} Instance;

enum { AT_START = 1 << INSTANTIATED, IN_INITIALIZATION = 1 << INITIALIZING, AT_STEP = 1 << STEPPING };

static void tell(void *host, Level level, const char *text) {
    static const char *const categories[] = {"logEvents", "logStatusWarning", "logStatusError"};
    static const fmi2Status statuses[] = {fmi2OK, fmi2Warning, fmi2Error};
    Instance *it = host;
    char escaped[2 * MESSAGE_SIZE], *to = escaped; /* importers may print it with printf */
    if (!it->callbacks.logger || (level == INFO && !it->events)) return;
    for (; *text; *to++ = *text++)
        if (*text == '%') *to++ = '%';
    *to = 0;
    it->callbacks.logger(it->callbacks.componentEnvironment, it->name, statuses[level],
                         categories[level], escaped);
}

static fmi2Status answer(bool good) { return good ? fmi2OK : fmi2Error; }

static bool refused(Instance *it, const char *call) {
    if (it) session_complain(it->session, ERROR_LEVEL, "%s is not supported", call);
    return false;
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char *fmi2GetVersion(void) { return fmi2Version; }

static bool is_event_category(const char *name) {
    return name && (!strcmp(name, "logEvents") || !strcmp(name, "logAll"));
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count,
                               const fmi2String names[]) {
    Instance *it = c;
    if (!it || (count && !names)) return fmi2Error;
    it->events = on && count == 0;
    for (size_t i = 0; i < count; i++) it->events = it->events || (on && is_event_category(names[i]));
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *callbacks, fmi2Boolean visible,
                              fmi2Boolean logging) {
    (void)visible;
    if (!name || !callbacks) return NULL;
    size_t length = strlen(name) + 1;
    Instance *it = calloc(1, sizeof *it + length);
    if (!it) return NULL;
    memcpy(it->name, name, length);
    it->callbacks = *callbacks;
    it->events = logging;
    const char *problem = NULL;
    if (type != fmi2CoSimulation) problem = "only co-simulation is possible";
    if (!guid || strcmp(guid, model.guid) != 0) problem = "the GUID is that of another FMU";
    if (!*name) problem = "the instance needs a name";
    if (problem) tell(it, ERROR_LEVEL, problem);
    else if ((it->session = session_new(resources, tell, it)) != NULL) return it;
    free(it);
    return NULL;
}

void fmi2FreeInstance(fmi2Component c) {
    if (!c) return;
    session_free(((Instance *)c)->session);
    free(c);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_given, fmi2Real tolerance,
                               fmi2Real start, fmi2Boolean stop_given, fmi2Real stop) {
    (void)tolerance_given, (void)tolerance, (void)stop_given, (void)stop;
    if (!c) return fmi2Error;
    Session *s = ((Instance *)c)->session;
    return answer(session_allows(s, __func__, AT_START) && session_set_start(s, start));
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    if (!c) return fmi2Error;
    Session *s = ((Instance *)c)->session;
    if (!session_allows(s, __func__, AT_START)) return fmi2Error;
    s->state.phase = INITIALIZING;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    if (!c) return fmi2Error;
    Session *s = ((Instance *)c)->session;
    return answer(session_allows(s, __func__, IN_INITIALIZATION) && session_exit_initialization(s));
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean no_rollback) {
    (void)no_rollback;
    if (!c) return fmi2Error;
    Session *s = ((Instance *)c)->session;
    return answer(session_allows(s, __func__, AT_STEP) && session_step(s, time, step));
}

fmi2Status fmi2Terminate(fmi2Component c) {
    if (!c) return fmi2Error;
    Session *s = ((Instance *)c)->session;
    if (!session_allows(s, __func__, AT_STEP)) return fmi2Error;
    session_terminate(s);
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c) {
    if (!c) return fmi2Error;
    session_reset(((Instance *)c)->session);
    return fmi2OK;
}

/* Values */

static bool can(fmi2Component c, const void *references, size_t count, const void *values) {
    return c && (count == 0 || (references && values));
}

#define GET(TYPE, KINDS, READ)                                                                     \
    fmi2Status fmi2Get##TYPE(fmi2Component c, const fmi2ValueReference references[], size_t count, \
                             fmi2##TYPE values[]) {                                                \
        if (!can(c, references, count, values)) return fmi2Error;                                  \
        Session *s = ((Instance *)c)->session;                                                     \
        if (!session_before_get(s, references, count, KINDS)) return fmi2Error;                    \
        for (size_t i = 0; i < count; i++) {                                                       \
            int32_t cell = model.variables[references[i]].cell;                                    \
            values[i] = READ;                                                                      \
        }                                                                                          \
        return fmi2OK;                                                                             \
    }

#define SET(TYPE, KINDS, WRITE)                                                                    \
    fmi2Status fmi2Set##TYPE(fmi2Component c, const fmi2ValueReference references[], size_t count, \
                             const fmi2##TYPE values[]) {                                          \
        if (!can(c, references, count, values)) return fmi2Error;                                  \
        Session *s = ((Instance *)c)->session;                                                     \
        if (!session_before_set(s, references, count, KINDS)) return fmi2Error;                    \
        for (size_t i = 0; i < count; i++) {                                                       \
            const Variable *v = &model.variables[references[i]];                                   \
            WRITE;                                                                                 \
        }                                                                                          \
        return fmi2OK;                                                                             \
    }

GET(Real, KIND_REAL, s->state.record[cell].real)
GET(Integer, KIND_INTEGER | KIND_ENUMERATION, (fmi2Integer)s->state.record[cell].integer)
GET(Boolean, KIND_BOOLEAN, (fmi2Boolean)s->state.record[cell].integer)
GET(String, KIND_STRING, s->state.texts[cell])
SET(Real, KIND_REAL, s->state.record[v->cell].real = values[i])
SET(Integer, KIND_INTEGER | KIND_ENUMERATION, s->state.record[v->cell].integer = values[i])
SET(Boolean, KIND_BOOLEAN, s->state.record[v->cell].integer = values[i] != fmi2False)
SET(String, KIND_STRING, if (!session_set_text(s, v, values[i])) return fmi2Error)

/* State: one piece of memory; serialized, with a checksum behind it */

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) {
    if (!c || !state) return fmi2Error;
    free(*state);
    *state = session_save(((Instance *)c)->session);
    return answer(*state != NULL);
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
    return answer(c && state && session_restore(((Instance *)c)->session, state));
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) {
    if (!c) return fmi2Error;
    if (state) free(*state), *state = NULL;
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) {
    if (!c || !state || !size) return fmi2Error;
    *size = (size_t)((State *)state)->size + sizeof(uint32_t);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
    if (!c || !state || !bytes) return fmi2Error;
    int64_t length = ((State *)state)->size;
    uint32_t sum = checksum(state, length);
    if (size < (size_t)length + sizeof sum) return fmi2Error;
    memcpy(bytes, state, (size_t)length);
    memcpy(bytes + length, &sum, sizeof sum);
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size,
                                   fmi2FMUstate *state) {
    if (!c || !bytes || !state) return fmi2Error;
    uint32_t sum = 0;
    size_t length = size < sizeof sum ? 0 : size - sizeof sum;
    memcpy(&sum, bytes + length, size < sizeof sum ? 0 : sizeof sum);
    if (sum != checksum((const uint8_t *)bytes, (int64_t)length)) length = 0;
    if (!session_is_state(((Instance *)c)->session, bytes, length)) return fmi2Error;
    State *copy = malloc(length);
    if (!copy) return fmi2Error;
    memcpy(copy, bytes, length);
    free(*state);
    *state = copy;
    return fmi2OK;
}

/* What the capability flags say is not there */

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[],
                                        size_t unknowns, const fmi2ValueReference known[],
                                        size_t knowns, const fmi2Real dknown[], fmi2Real dunknown[]) {
    (void)unknown, (void)unknowns, (void)known, (void)knowns, (void)dknown, (void)dunknown;
    return answer(refused(c, __func__));
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference references[],
                                       size_t count, const fmi2Integer order[],
                                       const fmi2Real values[]) {
    (void)references, (void)count, (void)order, (void)values;
    return answer(refused(c, __func__));
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference references[],
                                        size_t count, const fmi2Integer order[], fmi2Real values[]) {
    (void)references, (void)count, (void)order, (void)values;
    return answer(refused(c, __func__));
}

fmi2Status fmi2CancelStep(fmi2Component c) { return answer(refused(c, __func__)); }

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value) {
    (void)kind, (void)value;
    return answer(refused(c, __func__));
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) {
    if (!c || !value || kind != fmi2LastSuccessfulTime) return answer(refused(c, __func__));
    *value = ((Instance *)c)->session->state.time;
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value) {
    (void)kind, (void)value;
    return answer(refused(c, __func__));
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value) {
    if (!c || !value || kind != fmi2Terminated) return answer(refused(c, __func__));
    *value = ((Instance *)c)->session->state.phase == TERMINATED;
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value) {
    (void)kind, (void)value;
    return answer(refused(c, __func__));
}
