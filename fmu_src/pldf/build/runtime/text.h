/* The text in front of a file's blocks, taken line by line, and the checksum behind them. */
#pragma once

#include "disk.h"

typedef struct {
    const uint8_t *at, *end;
    int line;
    char *why; /* what was expected where something else stands: the first of them */
} Cursor;

bool refuse(Cursor *cursor, const char *expected); /* returns false */
bool take(Cursor *cursor, const char *text);
bool take_number(Cursor *cursor, int digits, int64_t *number);
bool take_line_end(Cursor *cursor);
bool take_entry(Cursor *cursor, const char *name, int digits, int64_t *number);
bool take_key(Cursor *cursor, const char *name, char *key);
bool take_name(Cursor *cursor, int bytes); /* at most so many, printable, no space around them */
bool take_end(Cursor *cursor, const uint8_t *start);

uint32_t checksum(const uint8_t *bytes, int64_t size);
void write_checksum(uint8_t *bytes, int64_t size); /* behind the bytes */
bool check_end(const uint8_t *bytes, int64_t size, int64_t expected, char *why);
