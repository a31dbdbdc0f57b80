#include "importer.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool importer_tell(const Importer *importer, Level level, const char *format, ...) {
    static const char *const categories[] = {
        [INFO] = "logEvents", [WARNING] = "logStatusWarning", [ERROR_LEVEL] = "logStatusError"};
    char safe[2 * MESSAGE_SIZE], *text = safe + MESSAGE_SIZE, *to = safe; /* which never overtakes text */
    va_list values;
    if (importer->logger && (level != INFO || importer->events)) {
        va_start(values, format);
        vsnprintf(text, MESSAGE_SIZE, format, values);
        va_end(values);
        for (const char *at = text; *at; *to++ = *at++)
            if (strchr(importer->doubled, *at)) *to++ = *at;
        *to = 0;
        importer->tell(importer, level, categories[level], safe);
    }
    return level != ERROR_LEVEL;
}

bool importer_log(Importer *importer, bool on, size_t count, const char *const categories[]) {
    if (count && !categories) return false;
    importer->events = on && count == 0;
    for (size_t i = 0; on && i < count; i++)
        if (categories[i] && (!strcmp(categories[i], "logEvents") || !strcmp(categories[i], "logAll")))
            importer->events = true;
    return true;
}

/* Of a hexadecimal digit; below 0: it is none. */
static int digit(char c) {
    static const char digits[] = "0123456789abcdef";
    const char *at = c ? strchr(digits, c >= 'A' && c <= 'F' ? c | 0x20 : c) : NULL;
    return at ? (int)(at - digits) : -1;
}

/* Capitals or not; `with` has none. */
static bool starts(const char *text, const char *with) {
    while (*with && (*text | 0x20) == *with) text++, with++;
    return !*with;
}

static bool has_drive(const char *at) {
    return *at && (starts(at + 1, ":") || starts(at + 1, "%3a"));
}

void importer_set_resources(Importer *importer, const char *address) {
    bool coded = address && starts(address, "file:");
    const char *at = !address ? "" : coded ? address + 5 : address;
    char *path = importer->resources;
    if (coded && !strncmp(at, "//", 2)) {
        bool local = starts(at, "//localhost/"), whole = at[2] == '/' || has_drive(at + 2);
        at += local ? 11 : whole ? 2 : 0; /* //server/share stays as it is */
    }
    if (coded && at[0] == '/' && has_drive(at + 1)) at++;
    size_t length = 0;
    for (; *at && length + 1 < PATH_SIZE; at++) {
        bool escaped = coded && *at == '%' && digit(at[1]) >= 0 && digit(at[2]) >= 0;
        path[length++] = escaped ? (char)(16 * digit(at[1]) + digit(at[2])) : *at;
        if (escaped) at += 2;
    }
    while (length > 1 && (path[length - 1] == '/' || path[length - 1] == '\\')) length--;
    path[*at ? 0 : length] = 0;
}

/* Of binaries/PLATFORM/NAME beside it. */
static bool own_resources(char *folder) {
    static const char name[] = "resources";
    if (!os_own_library(folder)) return false;
    for (char *at = folder; *at; at++)
        if (strchr(os_separators, *at)) *at = '/';
    for (int level = 0; level < 3; level++) {
        char *end = strrchr(folder, '/');
        if (!end) return false;
        end[level == 2] = 0; /* the last one stays */
    }
    size_t length = strlen(folder);
    if (length + sizeof name > PATH_SIZE) return false;
    memcpy(folder + length, name, sizeof name);
    return os_entry(folder) == FOLDER;
}

bool importer_resource(const Importer *importer, const char *name, char *path, size_t size) {
    char own[PATH_SIZE];
    const char *given = importer->resources;
    snprintf(path, size, "%s/%s", given, name);
    if ((*given && os_entry(path) != NO_ENTRY) || !own_resources(own)) return *given;
    char found[PATH_SIZE + 64];
    snprintf(found, sizeof found, "%s/%s", own, name);
    if (*given && os_entry(found) == NO_ENTRY) return true; /* it is nowhere: the importer's is told */
    snprintf(path, size, "%s", found);
    importer_tell(importer, INFO, "%s: not in the folder of resources that the importer named (%s), so "
                                  "it is read from %s", name, *given ? given : "none", own);
    return true;
}
