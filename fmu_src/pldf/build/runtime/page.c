#ifdef __wasm__
/* Messages for who runs the module: kept until they are asked for. */
#include "page.h"

#include <stdlib.h>
#include <string.h>

typedef struct Message Message;
struct Message {
    Message *next;
    int32_t status;
    char text[];
};

static Message *oldest, *taken;

/* importer.c doubled what means something else in a text of FMI 2.0. */
static void copy_single(char *to, const char *from) {
    for (; *from; from++) {
        if ((*from == '%' || *from == '#') && from[1] == *from) from++;
        *to++ = *from;
    }
    *to = 0;
}

/* Without memory for it a message is lost; the status of the call is not. */
static void keep(void *environment, fmi2String instance, fmi2Status status, fmi2String category,
                 fmi2String text, ...) {
    (void)environment, (void)instance, (void)category;
    Message *message = calloc(1, sizeof *message + strlen(text) + 1), **end = &oldest;
    if (!message) return;
    message->status = (int32_t)status;
    copy_single(message->text, text);
    while (*end) end = &(*end)->next;
    *end = message;
}

const fmi2CallbackFunctions *page_callbacks(void) {
    static const fmi2CallbackFunctions callbacks = {keep, calloc, free, NULL, NULL};
    return &callbacks;
}

const char *page_message(int32_t *status) {
    free(taken);
    taken = oldest;
    if (!taken) return NULL;
    oldest = taken->next;
    *status = taken->status;
    return taken->text;
}
#endif
