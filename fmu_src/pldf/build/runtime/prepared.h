/* The bytes of prepared routes and scripts, checked before they are used. */
#pragma once

#include "disk.h"

typedef struct { /* docs/native.md */
    uint8_t *bytes; /* owned */
    int64_t size, head, columns, rows, has_line;
    char key[17];
} Prepared;

/* Fills the fields from bytes and size; false, and the reason, if the bytes are not sound. */
bool prepared_parse(Prepared *prepared, const char *kind, int64_t columns, char *why);
