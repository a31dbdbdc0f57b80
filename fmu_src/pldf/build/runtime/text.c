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

/* Length of the printable character in UTF-8 that comes next, 0 if there is none. */
static int character(const Cursor *cursor) {
    const uint8_t *at = cursor->at;
    int64_t room = cursor->end - at;
    if (room < 1 || *at < 0x20 || *at == 0x7F) return 0;
    int length = *at < 0x80 ? 1 : *at < 0xC2 ? 0 : *at < 0xE0 ? 2 : *at < 0xF0 ? 3 : *at < 0xF5 ? 4 : 0;
    if (room < length) return 0;
    for (int i = 1; i < length; i++)
        if ((at[i] & 0xC0) != 0x80) return 0;
    bool too_long = (*at == 0xE0 && at[1] < 0xA0) || (*at == 0xF0 && at[1] < 0x90);
    bool no_letter = (*at == 0xED && at[1] > 0x9F) || (*at == 0xF4 && at[1] > 0x8F);
    return too_long || no_letter ? 0 : length;
}

bool take_name(Cursor *cursor, int bytes) {
    const uint8_t *first = cursor->at;
    for (int length = character(cursor); length; length = character(cursor)) cursor->at += length;
    int64_t length = cursor->at - first;
    return (length >= 1 && length <= bytes && *first != ' ' && cursor->at[-1] != ' ') ||
           refuse(cursor, "a name of 1 to 80 bytes");
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
