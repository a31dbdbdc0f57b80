/* The calls that FMI 2.0 and FMI 3.0 have in common. Each of fmi2.c and fmi3.c includes this once and
   says before what differs: FMI(Name) is the name in its version, VALUES(TYPE) are the parameters of
   a get or set, VALUE_COUNT tells how many values there are. `c` is the session. */

static FMI(Status) answer(bool good) { return good ? FMI(OK) : FMI(Error); }

const char *FMI(GetVersion)(void) { return FMI(Version); }

FMI(Status) FMI(SetDebugLogging)(void *c, FMI(Boolean) on, size_t count, const FMI(String) names[]) {
    return answer(session_log(c, on, count, names));
}

void FMI(FreeInstance)(void *c) { session_free(c); }

FMI(Status) FMI(ExitInitializationMode)(void *c) {
    return answer(session_allows(c, __func__, IN_INITIALIZATION) && session_exit_initialization(c));
}

FMI(Status) FMI(Terminate)(void *c) {
    if (!session_allows(c, __func__, AT_STEP)) return FMI(Error);
    return session_terminate(c) == INFO ? FMI(OK) : FMI(Warning); /* the drive itself was good */
}

FMI(Status) FMI(Reset)(void *c) { return answer(session_reset(c)); }

FMI(Status) FMI(GetFMUstate)(void *c, void **state) { return answer(session_get_state(c, state)); }
FMI(Status) FMI(SetFMUstate)(void *c, void *state) { return answer(session_set_state(c, state)); }
FMI(Status) FMI(FreeFMUstate)(void *c, void **state) { return answer(session_free_state(c, state)); }

FMI(Status) FMI(SerializedFMUstateSize)(void *c, void *state, size_t *size) {
    return answer(session_serialized_size(c, state, size));
}

FMI(Status) FMI(SerializeFMUstate)(void *c, void *state, FMI(Byte) bytes[], size_t size) {
    return answer(session_serialize(c, state, bytes, size));
}

FMI(Status) FMI(DeSerializeFMUstate)(void *c, const FMI(Byte) bytes[], size_t size, void **state) {
    return answer(session_deserialize(c, bytes, size, state));
}

#define GET(TYPE, KINDS, READ)                                                         \
    FMI(Status) FMI(Get##TYPE)(VALUES(FMI(TYPE))) {                                    \
        Session *s = c;                                                                \
        bool good = session_can_get(s, references, count, values, VALUE_COUNT, KINDS); \
        for (size_t i = 0; good && i < count; i++) values[i] = READ;                   \
        return answer(good);                                                           \
    }

#define SET(TYPE, KINDS, NUMBER, WRITE)                                                \
    FMI(Status) FMI(Set##TYPE)(VALUES(const FMI(TYPE))) {                              \
        Session *s = c;                                                                \
        bool good = session_can_set(s, references, count, values, VALUE_COUNT, KINDS); \
        for (size_t i = 0; good && i < count; i++)                                     \
            if (model.variables[references[i]].tunable)                                \
                good = session_allows_value(s, references[i], NUMBER);                 \
        for (size_t i = 0; good && i < count; i++) WRITE;                              \
        return answer(good);                                                           \
    }

/* The i-th variable, in GET and SET. */
#define CELL(i) s->state.record[model.variables[references[i]].cell]

#define REFUSED(NAME, ...) \
    FMI(Status) FMI(NAME)(__VA_ARGS__) { return answer(session_unsupported(c, __func__)); }
