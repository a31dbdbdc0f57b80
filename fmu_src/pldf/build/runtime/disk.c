/* As pldf/files/disk.py: nobody ever sees or leaves half of a file; the lock vanishes with its holder. */
#include "disk.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LOCK_POLL_MS = 10, BUSY_POLL_MS = 20, BUSY_POLLS = 100, PART = 1 << 30 };
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

static bool read_part(int file, uint8_t *bytes, int64_t size, char *why) {
    for (int64_t at = 0; at < size;) {
        int64_t got = os_read(file, bytes + at, part_of(size - at));
        if (got > 0) at += got;
        else if (got == 0) return fail(why, "it ends while it is read");
        else if (errno != EINTR) return os_reason(why);
    }
    return true;
}

/* A large file of something else must not take the memory before it is known to be that. */
static ReadResult read_all(int file, const char *begin, uint8_t **bytes, int64_t *size, char *why) {
    int64_t first = (int64_t)strlen(begin);
    if ((*size = os_size(file)) < 0) return fail(why, "not a regular file"), READ_UNUSABLE;
    if (*size > FILE_MAX) return fail(why, "longer than 4294967296 bytes"), READ_UNUSABLE;
    if (first > *size) first = *size;
    if (!(*bytes = malloc((size_t)first + 1))) return fail(why, "not enough memory"), READ_FAILED;
    if (!read_part(file, *bytes, first, why)) return READ_FAILED;
    if (memcmp(*bytes, begin, (size_t)first) != 0) return *size = first, READ_DONE;
    uint8_t *all = realloc(*bytes, (size_t)*size + 1);
    if (!all) return fail(why, "not enough memory"), READ_FAILED;
    *bytes = all;
    return read_part(file, all + first, *size - first, why) ? READ_DONE : READ_FAILED;
}

ReadResult disk_read(const char *path, const char *begin, uint8_t **bytes, int64_t *size, char *why) {
    int file, polls = 0;
    *bytes = NULL;
    while ((file = os_open(path, OPEN_READ)) < 0) {
        if (errno == ENOENT) return READ_ABSENT;
        if (!is_busy(path, &polls))
            return os_reason(why), os_entry(path) == FOLDER ? READ_UNUSABLE : READ_FAILED;
    }
    ReadResult result = read_all(file, begin, bytes, size, why);
    os_close(file);
    if (result == READ_DONE) return result;
    free(*bytes);
    *bytes = NULL;
    return result;
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

static bool swap(const char *temporary, const char *path, const char *aside, char *why) {
    char again[REASON_SIZE];
    if (aside && !disk_rename(path, aside, why)) return false;
    if (disk_rename(temporary, path, why)) return true;
    if (aside) disk_rename(aside, path, again);
    return false;
}

bool disk_replace(const char *path, const uint8_t *bytes, int64_t size, const char *aside, char *why) {
    char temporary[PATH_SIZE + 8];
    snprintf(temporary, sizeof temporary, "%s.tmp", path);
    os_remove(temporary); /* of a killed process; opening it instead would follow a link */
    if (write_new(temporary, bytes, size, why) && swap(temporary, path, aside, why)) return true;
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

static LockResult try_lock(Lock *lock, char *why) {
    lock->file = os_open_lock(lock->path);
    if (lock->file < 0 && os_refuses_open_files && errno == EACCES) return LOCK_HELD;
    if (lock->file < 0 && errno == EACCES && os_entry(lock->path) != NO_ENTRY)
        return fail(why, "another user left pldf-store.lock, which cannot be opened: delete it when no "
                         "simulation uses this folder"), LOCK_FAILED;
    if (lock->file < 0) return os_reason(why), LOCK_FAILED;
    if (os_lock(lock->file, lock->path)) return LOCK_DONE;
    bool held = errno == EAGAIN || errno == EACCES || errno == EDEADLK;
    if (!held) os_reason(why);
    os_close(lock->file);
    return held ? LOCK_HELD : LOCK_FAILED;
}

LockResult disk_lock(const char *folder, int patience_ms, Lock *lock, char *why) {
    LockResult result;
    snprintf(lock->path, sizeof lock->path, "%s/pldf-store.lock", folder);
    while ((result = try_lock(lock, why)) == LOCK_HELD && patience_ms > 0) {
        os_wait_ms(LOCK_POLL_MS);
        patience_ms -= LOCK_POLL_MS;
    }
    if (result == LOCK_HELD) fail(why, "pldf-store.lock is held by another process; nothing was changed");
    return result;
}

void disk_unlock(Lock *lock) {
    if (!os_refuses_open_files) os_remove(lock->path); /* who waits for it sees that it is gone */
    os_close(lock->file);
    if (os_refuses_open_files) os_remove(lock->path); /* refused if another has it open, and uses it */
}

void disk_nearest(const char *folder, char *nearest) {
    snprintf(nearest, PATH_SIZE, "%s", folder);
    while (os_entry(nearest) == NO_ENTRY)
        if (!disk_parent(nearest)) return;
}

bool disk_writable(const char *folder, char *part, char *why) {
    Lock lock;
    disk_nearest(folder, part);
    if (os_entry(part) == OTHER_ENTRY) return fail(why, "not a folder");
    /* The lock is made as any file is; and one that somebody left would be in the way. */
    LockResult result = disk_lock(part, 0, &lock, why);
    if (result == LOCK_DONE) disk_unlock(&lock);
    return result != LOCK_FAILED;
}
