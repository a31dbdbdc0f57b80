#include "text.h"

#include <stdio.h>
#include <string.h>

#include "model.h"

bool refuse(Cursor *cursor, const char *expected) {
    if (!cursor->why[0])
        snprintf(cursor->why, REASON_SIZE, "line %d: expected '%s'", cursor->line, expected);
    return false;
}

/* Takes `text` if the next bytes are it. */
bool take(Cursor *cursor, const char *text) {
    size_t length = strlen(text);
    if ((size_t)(cursor->end - cursor->at) < length || memcmp(cursor->at, text, length) != 0)
        return refuse(cursor, text);
    cursor->at += length;
    return true;
}

bool take_number(Cursor *cursor, int digits, int64_t *number) {
    const uint8_t *first = cursor->at;
    *number = 0;
    while (cursor->at < cursor->end && *cursor->at >= '0' && *cursor->at <= '9' &&
           cursor->at - first < digits)
        *number = 10 * *number + (*cursor->at++ - '0');
    bool padded = cursor->at - first > 1 && *first == '0';
    return (cursor->at > first && !padded) || refuse(cursor, "a number");
}

bool take_line_end(Cursor *cursor) {
    cursor->line++;
    return cursor->at < cursor->end && *cursor->at == '\n' ? (cursor->at++, true)
                                                           : refuse(cursor, "the end of the line");
}

bool take_entry(Cursor *cursor, const char *name, int digits, int64_t *number) {
    return take(cursor, name) && take_number(cursor, digits, number) && take_line_end(cursor);
}

bool take_key(Cursor *cursor, const char *name, char *key) {
    if (!take(cursor, name)) return false;
    for (int i = 0; i < 16; i++, cursor->at++) {
        if (cursor->at >= cursor->end || !memchr("0123456789abcdef", *cursor->at, 16))
            return refuse(cursor, "16 hexadecimal digits");
        key[i] = (char)*cursor->at;
    }
    key[16] = 0;
    return take_line_end(cursor);
}

/* Takes "end", as few spaces as possible and LF, so that the header fills a multiple of 64. */
bool take_end(Cursor *cursor, const uint8_t *start) {
    if (!take(cursor, "end")) return false;
    while ((cursor->at + 1 - start) % ALIGNMENT != 0)
        if (!take(cursor, " ")) return false;
    return take_line_end(cursor);
}

/* CRC-32 of zlib, eight bytes at a time: tables[k] is what a byte with k more behind it adds. */
uint32_t checksum(const uint8_t *bytes, int64_t size) {
    uint32_t tables[8][256], value = 0xFFFFFFFFu;
    for (uint32_t i = 0; i < 256; i++) {
        tables[0][i] = i;
        for (int bit = 0; bit < 8; bit++)
            tables[0][i] = (tables[0][i] >> 1) ^ (tables[0][i] & 1 ? 0xEDB88320u : 0);
    }
    for (int k = 1; k < 8; k++)
        for (int i = 0; i < 256; i++)
            tables[k][i] = (tables[k - 1][i] >> 8) ^ tables[0][tables[k - 1][i] & 0xFF];
    int64_t at = 0;
    for (; at + 8 <= size; at += 8) {
        uint32_t next = 0;
        for (int k = 0; k < 8; k++)
            next ^= tables[7 - k][(bytes[at + k] ^ (k < 4 ? value >> 8 * k : 0)) & 0xFF];
        value = next;
    }
    for (; at < size; at++) value = (value >> 8) ^ tables[0][(value ^ bytes[at]) & 0xFF];
    return value ^ 0xFFFFFFFFu;
}

void write_checksum(uint8_t *bytes, int64_t size) {
    char line[CHECKSUM_SIZE + 1];
    snprintf(line, sizeof line, "crc32 %08x\n", (unsigned)checksum(bytes, size));
    memcpy(bytes + size, line, CHECKSUM_SIZE);
}

bool check_end(const uint8_t *bytes, int64_t size, int64_t expected, char *why) {
    char line[CHECKSUM_SIZE + 1];
    if (size != expected) {
        snprintf(why, REASON_SIZE, "%lld bytes long, but %lld bytes follow from the header",
                 (long long)size, (long long)expected);
        return false;
    }
    snprintf(line, sizeof line, "crc32 %08x\n", (unsigned)checksum(bytes, size - CHECKSUM_SIZE));
    if (memcmp(bytes + size - CHECKSUM_SIZE, line, CHECKSUM_SIZE) == 0) return true;
    snprintf(why, REASON_SIZE, "damaged: the checksum does not fit");
    return false;
}
