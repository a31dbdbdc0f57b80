/* hmi.text: the sentence that the kernel chose, with its numbers (as pldf/hmi_texts.py). */
#include <stdio.h>
#include <string.h>

#include "session.h"

static const char *sentence_of(const Cluster *c, const Cell *record) {
    int64_t number = record[c->sentence].integer;
    int german = record[c->language].integer == LANGUAGE_DE;
    if (number >= 0 && number < REASON_COUNT) return c->reasons[german][number];
    number -= EVENT_SENTENCES;
    return number >= 0 && number < EVENT_COUNT ? c->events[german][number] : "";
}

/* Appends what a name in braces stands for; returns what follows it, NULL if it is no number. */
static const char *put_number(const Cluster *c, const Cell *record, const char *at, char *text) {
    for (int k = 0; k < SENTENCE_NUMBERS; k++) {
        size_t length = strlen(c->names[k]);
        if (strncmp(at, c->names[k], length) != 0) continue;
        size_t size = strlen(text);
        snprintf(text + size, SENTENCE_SIZE - size, "%lld", (long long)record[c->numbers[k]].integer);
        return at + length;
    }
    return NULL;
}

const char *session_text(Session *s, uint32_t reference) {
    const Variable *v = &model.variables[reference];
    if (v->causality != OUTPUT) return s->state.texts[v->cell];
    const Cluster *c = model.cluster;
    const char *at = sentence_of(c, s->state.record);
    s->text[0] = 0;
    while (*at) {
        if (*at == '[' && !s->state.record[c->numbers[SENTENCE_DRIVE]].integer) at = strchr(at, ']');
        if (*at == '[' || *at == ']') { /* what stands between them needs a drive */
            at++;
            continue;
        }
        const char *behind = put_number(c, s->state.record, at, s->text);
        size_t size = strlen(s->text);
        if (!behind && size + 1 < SENTENCE_SIZE) {
            s->text[size] = *at;
            s->text[size + 1] = 0;
        }
        at = behind ? behind : at + 1;
    }
    return s->text;
}
