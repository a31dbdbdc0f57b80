/* The bytes of profile files and of prepared routes and scripts, checked before they are used. */
#pragma once

#include "disk.h"

typedef struct { /* docs/profile-format.md */
    uint8_t *bytes; /* NULL: nothing stored yet; owned */
    int64_t size, driver, nodes, count, lines, lines_end, head, stride;
    char route[17];
} Profile;

typedef struct { /* docs/native.md */
    uint8_t *bytes; /* owned */
    int64_t size, head, columns, rows, has_line;
    char key[17];
} Prepared;

typedef struct { /* what a drive leaves behind */
    const double *base, *columns; /* n values; the columns of an iteration, one by one */
    const char *note;
    int64_t interventions;
} Lesson;

/* Fill the fields from bytes and size; false, and the reason, if the bytes are not sound. */
bool profile_parse(Profile *profile, char *why);
bool prepared_parse(Prepared *prepared, const char *kind, int64_t columns, char *why);

const double *profile_block(const Profile *profile, int64_t iteration, int64_t column); /* from 1 */
bool profile_same_history(const Profile *a, const Profile *b);
/* Bytes of the profile (driver, route and nodes are set) with one more iteration; NULL: memory. */
uint8_t *profile_extend(const Profile *profile, const Lesson *lesson, int64_t *size);
uint32_t checksum(const uint8_t *bytes, int64_t size);
