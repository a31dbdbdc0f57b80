/* As pldf/disk.py: nobody ever sees or leaves half of a file; the lock vanishes with its holder. */
#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include <io.h>
#include <sys/locking.h>
#include <windows.h>
#else
#define _GNU_SOURCE
#include <sys/file.h>
#include <time.h>
#include <unistd.h>
#endif
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "disk.h"

enum { LOCK_POLL_MS = 10, LOCK_POLLS = 1000, BUSY_POLL_MS = 20, BUSY_POLLS = 100, PART = 1 << 30 };
static const int64_t FILE_MAX = (int64_t)1 << 32;

static bool fail(char *why, const char *reason) {
    snprintf(why, REASON_SIZE, "%s", reason);
    return false;
}

static bool leaves_room(long long length, char *why) {
    snprintf(why, REASON_SIZE, "%lld bytes long, at most %d are possible", length, FOLDER_SIZE - 1);
    return length < FOLDER_SIZE;
}

#ifdef _WIN32 /* what POSIX calls otherwise, with paths in UTF-16 */

#define O_RDONLY _O_RDONLY
#define O_NEW (_O_WRONLY | _O_CREAT | _O_EXCL)
#define O_LOCK (_O_RDWR | _O_CREAT)
#define read(file, to, size) _read(file, to, (unsigned)(size))
#define write(file, from, size) _write(file, from, (unsigned)(size))
#define close _close
#define fsync _commit
#define fstat _fstat64
typedef struct _stat64 Status;
typedef wchar_t Wide[PATH_SIZE + 8];
static const char SEPARATORS[] = "/\\";
enum { LONG_PATH = 240 };      /* 248 for folders, 260 for files */
enum { BUSY_WHILE_OPEN = 1 }; /* a file is refused for the moment in which somebody else has it */

static const wchar_t *utf16(const char *text, Wide out) {
    if (!MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, text, -1, out, PATH_SIZE)) out[0] = 0;
    return out;
}

/* Windows takes long paths only with a prefix, and then only in their plain form. */
static const wchar_t *wide(const char *path, Wide out) {
    Wide given;
    if (wcslen(utf16(path, given)) < LONG_PATH || given[1] != L':') return utf16(path, out);
    DWORD length = GetFullPathNameW(given, PATH_SIZE, out + 4, NULL);
    if (length == 0 || length >= PATH_SIZE) return utf16(path, out);
    return memcpy(out, L"\\\\?\\", 4 * sizeof *out);
}

static bool narrow(DWORD length, const wchar_t *found, char *out) {
    return length > 0 && length < PATH_SIZE &&
           WideCharToMultiByte(CP_UTF8, 0, found, -1, out, PATH_SIZE, NULL, NULL) > 0;
}

static bool fail_now(char *why) {
    snprintf(why, REASON_SIZE, "Windows error %lu", GetLastError());
    return false;
}

static int open_path(const char *path, int flags) {
    Wide w;
    return _wopen(wide(path, w), flags | _O_BINARY | _O_NOINHERIT, _S_IREAD | _S_IWRITE);
}

static bool move(const char *from, const char *to) {
    Wide a, b;
    if (MoveFileExW(wide(from, a), wide(to, b), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH))
        return true;
    bool busy = GetLastError() == ERROR_SHARING_VIOLATION || GetLastError() == ERROR_ACCESS_DENIED;
    errno = busy ? EACCES : EIO;
    return false;
}

static void remove_file(const char *path) {
    Wide w;
    _wunlink(wide(path, w));
}

static bool make_one(const char *path) {
    Wide w;
    return CreateDirectoryW(wide(path, w), NULL);
}

DiskEntry disk_entry(const char *path) {
    Wide w;
    DWORD found = GetFileAttributesW(wide(path, w));
    if (found == INVALID_FILE_ATTRIBUTES) return NO_ENTRY;
    return found & FILE_ATTRIBUTE_DIRECTORY ? FOLDER : OTHER_ENTRY;
}

static bool take_lock(int file, const char *path) {
    (void)path;
    if (_locking(file, _LK_NBLCK, 1) == 0) return true;
    if (GetLastError() == ERROR_LOCK_VIOLATION) errno = EACCES; /* wine leaves it as it was */
    return false;
}

static void wait_ms(int ms) { Sleep((DWORD)ms); }

bool disk_absolute(const char *path, char *absolute, char *why) {
    Wide w, full;
    DWORD length = GetFullPathNameW(utf16(path, w), PATH_SIZE, full, NULL);
    if (!narrow(length, full, absolute)) return fail(why, "not a path, in UTF-8 and not too long");
    return leaves_room((long long)strlen(absolute), why);
}

bool disk_environment(const char *name, char *value) {
    Wide w, found;
    DWORD length = GetEnvironmentVariableW(utf16(name, w), found, PATH_SIZE);
    if (!narrow(length, found, value)) value[0] = 0;
    return length > 0;
}

#else

#define O_NEW (O_WRONLY | O_CREAT | O_EXCL)
#define O_LOCK (O_RDWR | O_CREAT)
typedef struct stat Status;
static const char SEPARATORS[] = "/";
enum { BUSY_WHILE_OPEN = 0 };

static bool fail_now(char *why) { return fail(why, strerror(errno)); }

static int open_path(const char *path, int flags) {
    return open(path, flags | O_CLOEXEC | O_NONBLOCK, 0666); /* a pipe must not block */
}

/* Makes the new name last through a power cut, where the system can do that for folders. */
static bool move(const char *from, const char *to) {
    char folder[PATH_SIZE];
    if (rename(from, to) != 0) return false;
    snprintf(folder, sizeof folder, "%s", to);
    char *end = strrchr(folder, '/');
    if (end) end[end == folder] = 0;
    int file = end ? open_path(folder, O_RDONLY) : -1;
    if (file < 0) return true;
    fsync(file);
    close(file);
    return true;
}

static void remove_file(const char *path) { unlink(path); }

static bool make_one(const char *path) { return mkdir(path, 0777) == 0; }

DiskEntry disk_entry(const char *path) {
    Status status;
    if (lstat(path, &status) != 0) return NO_ENTRY;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode) ? FOLDER : OTHER_ENTRY;
}

/* Valid only if it still is the file of that name: its last holder may have removed it. */
static bool take_lock(int file, const char *path) {
    Status ours, there;
    if (flock(file, LOCK_EX | LOCK_NB) != 0) return false;
    if (fstat(file, &ours) == 0 && stat(path, &there) == 0 && ours.st_ino == there.st_ino &&
        ours.st_dev == there.st_dev)
        return true;
    errno = EAGAIN;
    return false;
}

static void wait_ms(int ms) {
    struct timespec time = {0, ms * 1000000L};
    nanosleep(&time, NULL);
}

bool disk_absolute(const char *path, char *absolute, char *why) {
    char here[PATH_SIZE] = "";
    if (path[0] != '/' && !getcwd(here, sizeof here)) return fail_now(why);
    return leaves_room(snprintf(absolute, PATH_SIZE, "%s%s%s", here, *here ? "/" : "", path), why);
}

bool disk_environment(const char *name, char *value) {
    const char *found = getenv(name);
    if (found) snprintf(value, PATH_SIZE, "%s", found);
    return found && *found;
}

#endif

static bool is_busy(const char *path, int *polls) {
    if (!BUSY_WHILE_OPEN || errno != EACCES || ++*polls > BUSY_POLLS) return false;
    if (disk_entry(path) == FOLDER) return false;
    wait_ms(BUSY_POLL_MS);
    return true;
}

static bool read_all(int file, uint8_t **bytes, int64_t *size, char *why) {
    Status status;
    if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return fail(why, "not a regular file");
    *size = status.st_size;
    if (*size > FILE_MAX || !(*bytes = malloc((size_t)*size + 1)))
        return fail(why, "too long, or it does not fit into memory");
    for (int64_t at = 0; at < *size;) {
        int64_t got = read(file, *bytes + at, *size - at < PART ? *size - at : PART);
        if (got > 0) at += got;
        else if (got == 0 || errno != EINTR) return fail(why, "it ends while it is read");
    }
    return true;
}

ReadResult disk_read(const char *path, uint8_t **bytes, int64_t *size, char *why) {
    int file, polls = 0;
    *bytes = NULL;
    while ((file = open_path(path, O_RDONLY)) < 0) {
        if (errno == ENOENT) return READ_ABSENT;
        if (!is_busy(path, &polls)) return fail_now(why), READ_FAILED;
    }
    bool good = read_all(file, bytes, size, why);
    close(file);
    if (good) return READ_DONE;
    free(*bytes);
    *bytes = NULL;
    return READ_FAILED;
}

bool disk_rename(const char *from, const char *to, char *why) {
    for (int polls = 0; !move(from, to);)
        if (!is_busy(to, &polls)) return fail_now(why);
    return true;
}

static bool write_new(const char *path, const uint8_t *bytes, int64_t size, char *why) {
    int file = open_path(path, O_NEW);
    if (file < 0) return fail_now(why);
    bool good = true;
    for (int64_t at = 0; good && at < size;) {
        int64_t done = write(file, bytes + at, size - at < PART ? size - at : PART);
        if (done > 0) at += done;
        else if (errno != EINTR) good = fail_now(why);
    }
    if (good && fsync(file) != 0) good = fail_now(why);
    close(file);
    return good;
}

bool disk_replace(const char *path, const uint8_t *bytes, int64_t size, char *why) {
    char temporary[PATH_SIZE + 8];
    snprintf(temporary, sizeof temporary, "%s.tmp", path);
    remove_file(temporary); /* of a killed process; opening it instead would follow a link */
    if (write_new(temporary, bytes, size, why) && disk_rename(temporary, path, why)) return true;
    remove_file(temporary);
    return false;
}

bool disk_parent(char *path) {
    size_t length = strlen(path);
    while (length > 0 && !strchr(SEPARATORS, path[length - 1])) length--;
    if (length > 1) path[length - 1] = 0;
    return length > 1;
}

bool disk_make_folder(const char *path, char *why) {
    char part[PATH_SIZE];
    if (disk_entry(path) == FOLDER) return true;
    snprintf(part, sizeof part, "%s", path);
    for (char *at = part + 1; *at; at++) {
        if (!strchr(SEPARATORS, *at)) continue;
        char separator = *at;
        *at = 0;
        make_one(part); /* or it is there; the last one tells */
        *at = separator;
    }
    if (make_one(path)) return true;
    fail_now(why);
    return disk_entry(path) == FOLDER; /* made by another process meanwhile */
}

static bool try_lock(Lock *lock, char *why) {
    lock->file = open_path(lock->path, O_LOCK);
    if (lock->file < 0) return BUSY_WHILE_OPEN && errno == EACCES ? false : fail_now(why);
    if (take_lock(lock->file, lock->path)) return true;
    if (errno != EAGAIN && errno != EACCES && errno != EDEADLK) fail_now(why);
    close(lock->file);
    return false;
}

bool disk_lock(const char *folder, Lock *lock, char *why) {
    snprintf(lock->path, sizeof lock->path, "%s/pldf-store.lock", folder);
    why[0] = 0;
    for (int polls = 0; polls < LOCK_POLLS; polls++) {
        if (try_lock(lock, why)) return true;
        if (why[0]) return false;
        wait_ms(LOCK_POLL_MS);
    }
    return fail(why, "held by another process for 10 s");
}

void disk_unlock(Lock *lock) {
    if (!BUSY_WHILE_OPEN) remove_file(lock->path); /* who waits for it sees that it is gone */
    close(lock->file);
    if (BUSY_WHILE_OPEN) remove_file(lock->path); /* refused if another has it open, and uses it */
}
