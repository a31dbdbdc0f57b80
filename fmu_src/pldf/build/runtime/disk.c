/* As pldf/files/disk.py: nobody ever sees or leaves half of a file; the lock vanishes with its holder. */
#include "disk.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LOCK_POLL_MS = 10, LOCK_POLLS = 1000, BUSY_POLL_MS = 20, BUSY_POLLS = 100, PART = 1 << 30 };
static const int64_t FILE_MAX = (int64_t)1 << 32;

static bool fail(char *why, const char *reason) {
    snprintf(why, REASON_SIZE, "%s", reason);
    return false;
}

static bool is_busy(const char *path, int *polls) {
    if (!os_refuses_open_files || errno != EACCES || ++*polls > BUSY_POLLS) return false;
    if (os_entry(path) == FOLDER) return false;
    os_wait_ms(BUSY_POLL_MS);
    return true;
}

static int64_t part_of(int64_t rest) { return rest < PART ? rest : PART; }

static bool read_all(int file, uint8_t **bytes, int64_t *size, char *why) {
    if ((*size = os_size(file)) < 0) return fail(why, "not a regular file");
    if (*size > FILE_MAX || !(*bytes = malloc((size_t)*size + 1)))
        return fail(why, "too long, or it does not fit into memory");
    for (int64_t at = 0; at < *size;) {
        int64_t got = os_read(file, *bytes + at, part_of(*size - at));
        if (got > 0) at += got;
        else if (got == 0 || errno != EINTR) return fail(why, "it ends while it is read");
    }
    return true;
}

ReadResult disk_read(const char *path, uint8_t **bytes, int64_t *size, char *why) {
    int file, polls = 0;
    *bytes = NULL;
    while ((file = os_open(path, OPEN_READ)) < 0) {
        if (errno == ENOENT) return READ_ABSENT;
        if (!is_busy(path, &polls)) return os_reason(why), READ_FAILED;
    }
    bool good = read_all(file, bytes, size, why);
    os_close(file);
    if (good) return READ_DONE;
    free(*bytes);
    *bytes = NULL;
    return READ_FAILED;
}

bool disk_rename(const char *from, const char *to, char *why) {
    for (int polls = 0; !os_rename(from, to);)
        if (!is_busy(to, &polls)) return os_reason(why);
    return true;
}

static bool write_new(const char *path, const uint8_t *bytes, int64_t size, char *why) {
    int file = os_open(path, OPEN_NEW);
    if (file < 0) return os_reason(why);
    bool good = true;
    for (int64_t at = 0; good && at < size;) {
        int64_t done = os_write(file, bytes + at, part_of(size - at));
        if (done > 0) at += done;
        else if (errno != EINTR) good = os_reason(why);
    }
    if (good && !os_sync(file)) good = os_reason(why);
    os_close(file);
    return good;
}

bool disk_replace(const char *path, const uint8_t *bytes, int64_t size, char *why) {
    char temporary[PATH_SIZE + 8];
    snprintf(temporary, sizeof temporary, "%s.tmp", path);
    os_remove(temporary); /* of a killed process; opening it instead would follow a link */
    if (write_new(temporary, bytes, size, why) && disk_rename(temporary, path, why)) return true;
    os_remove(temporary);
    return false;
}

bool disk_parent(char *path) {
    size_t length = strlen(path);
    while (length > 0 && !strchr(os_separators, path[length - 1])) length--;
    if (length > 1) path[length - 1] = 0;
    return length > 1;
}

bool disk_make_folder(const char *path, char *why) {
    char part[PATH_SIZE];
    if (os_entry(path) == FOLDER) return true;
    snprintf(part, sizeof part, "%s", path);
    for (char *at = part + 1; *at; at++) {
        if (!strchr(os_separators, *at)) continue;
        char separator = *at;
        *at = 0;
        os_make_folder(part); /* or it is there; the last one tells */
        *at = separator;
    }
    if (os_make_folder(path)) return true;
    os_reason(why);
    return os_entry(path) == FOLDER; /* made by another process meanwhile */
}

static bool try_lock(Lock *lock, char *why) {
    lock->file = os_open(lock->path, OPEN_LOCK);
    if (lock->file < 0) return os_refuses_open_files && errno == EACCES ? false : os_reason(why);
    if (os_lock(lock->file, lock->path)) return true;
    if (errno != EAGAIN && errno != EACCES && errno != EDEADLK) os_reason(why);
    os_close(lock->file);
    return false;
}

bool disk_lock(const char *folder, Lock *lock, char *why) {
    snprintf(lock->path, sizeof lock->path, "%s/pldf-store.lock", folder);
    why[0] = 0;
    for (int polls = 0; polls < LOCK_POLLS; polls++) {
        if (try_lock(lock, why)) return true;
        if (why[0]) return false;
        os_wait_ms(LOCK_POLL_MS);
    }
    return fail(why, "held by another process for 10 s");
}

void disk_unlock(Lock *lock) {
    if (!os_refuses_open_files) os_remove(lock->path); /* who waits for it sees that it is gone */
    os_close(lock->file);
    if (os_refuses_open_files) os_remove(lock->path); /* refused if another has it open, and uses it */
}
