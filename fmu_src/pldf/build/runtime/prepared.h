/* The bytes of prepared routes and scripts, checked before they are used. */
#pragma once

#include "disk.h"
#include "model.h"

typedef struct { /* docs/native.md */
    uint8_t *bytes; /* owned */
    int64_t size, head, columns, rows, has_line;
    int64_t marks, marks_end; /* where the lines of marks are; both 0: there are none */
    char key[17];
} Prepared;
typedef struct {
    char text[NAME_BYTES_MAX + 1];
} Name;

/* Fills the fields from bytes and size; false, and the reason, if the bytes are not sound. */
bool prepared_parse(Prepared *prepared, const char *kind, int64_t columns, char *why);
/* The lines of marks as a text to be freed, NULL if there are none; false: memory. */
bool prepared_copy_marks(const Prepared *prepared, char **marks);
/* Fills in the name of the road at a place; returns how many roads have one. */
int mark_road(const char *marks, int64_t at_mm, Name *name);
