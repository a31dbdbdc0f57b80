/* Variables by their value references. */
#include <math.h>
#include <string.h>

#include "session.h"

static const Variable *find(Session *s, uint32_t reference, int kinds) {
    uint32_t count = (uint32_t)model.variable_count;
    if (reference < count && model.variables[reference].kind & kinds) return &model.variables[reference];
    importer_tell(&s->importer, ERROR_LEVEL, "there is no variable of this type with value reference %u",
                  (unsigned)reference);
    return NULL;
}

static bool fits(Session *s, const void *references, size_t count, const void *values,
                 size_t value_count) {
    if (s && count != value_count)
        return importer_tell(&s->importer, ERROR_LEVEL, "%llu values for %llu variables",
                             (unsigned long long)value_count, (unsigned long long)count);
    return s && (count == 0 || (references && values) ||
                 importer_tell(&s->importer, ERROR_LEVEL, "NULL in place of references or values"));
}

bool session_can_get(Session *s, const uint32_t *references, size_t count, const void *values,
                     size_t value_count, int kinds) {
    if (!fits(s, references, count, values, value_count)) return false;
    for (size_t i = 0; i < count; i++) {
        const Variable *v = find(s, references[i], kinds);
        if (!v) return false;
        if (v->causality != OUTPUT) continue;
        if ((s->state.stale || !s->state.ready) && !session_bring_up_to_date(s)) return false;
        if (v->kind == KIND_REAL && !isfinite(s->state.record[v->cell].real))
            return importer_tell(&s->importer, ERROR_LEVEL, "%s is not a finite number", v->name);
    }
    return true;
}

bool session_can_set(Session *s, const uint32_t *references, size_t count, const void *values,
                     size_t value_count, int kinds) {
    bool fixed = false;
    if (!fits(s, references, count, values, value_count)) return false;
    for (size_t i = 0; i < count; i++) {
        const Variable *v = find(s, references[i], kinds);
        if (!v) return false;
        if (v->causality == OUTPUT)
            return importer_tell(&s->importer, ERROR_LEVEL, "%s is an output, it cannot be set", v->name);
        unsigned late = v->causality == INPUT || v->tunable ? AT_STEP : 0;
        if (!session_allows(s, v->name, AT_START | IN_INITIALIZATION | late)) return false;
        fixed = fixed || !late;
    }
    s->state.stale = 1;
    if (fixed) s->state.ready = s->prepared = false;
    return true;
}

bool session_allows_value(Session *s, uint32_t reference, double value) {
    return run_allows(&s->importer, &model.variables[reference], value);
}

bool session_set_text(Session *s, uint32_t reference, const char *text) {
    const Variable *v = &model.variables[reference];
    char *place = s->state.texts[v->cell];
    size_t length = text ? strlen(text) : 0;
    if (length >= PATH_SIZE) return importer_tell(&s->importer, ERROR_LEVEL, "%s is too long", v->name);
    memset(place, 0, PATH_SIZE); /* equal states have equal bytes */
    if (text) memcpy(place, text, length);
    return true;
}
