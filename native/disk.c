/* As pldf/disk.py: nobody ever sees or leaves half of a file; the lock vanishes with its holder. */
#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#else
#define _GNU_SOURCE
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#endif
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "disk.h"

enum { LOCK_POLL_MS = 10, LOCK_POLLS = 1000 };

static bool fail(char *why, const char *reason) {
    snprintf(why, REASON_SIZE, "%s", reason);
    return false;
}

#ifdef _WIN32

typedef wchar_t Wide[PATH_SIZE];

static const wchar_t *wide(const char *path, Wide out) {
    if (!MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, out, PATH_SIZE)) out[0] = 0;
    return out;
}

static bool fail_now(char *why) {
    snprintf(why, REASON_SIZE, "Windows error %lu", GetLastError());
    return false;
}

static HANDLE open_file(const char *path, DWORD access, DWORD how) {
    Wide w;
    return CreateFileW(wide(path, w), access, FILE_SHARE_READ | FILE_SHARE_WRITE, NULL, how,
                       FILE_ATTRIBUTE_NORMAL, NULL);
}

/* A file is refused for the moment in which somebody else has it open. */
static bool is_busy(int tries) {
    DWORD error = GetLastError();
    if ((error != ERROR_SHARING_VIOLATION && error != ERROR_ACCESS_DENIED) || tries >= 100)
        return false;
    Sleep(20);
    return true;
}

ReadResult disk_read(const char *path, int64_t most, uint8_t **bytes, int64_t *size, char *why) {
    HANDLE file;
    LARGE_INTEGER length;
    for (int tries = 0; (file = open_file(path, GENERIC_READ, OPEN_EXISTING)) == INVALID_HANDLE_VALUE;
         tries++) {
        DWORD error = GetLastError();
        if (error == ERROR_FILE_NOT_FOUND || error == ERROR_PATH_NOT_FOUND) return READ_ABSENT;
        if (disk_is_folder(path) || !is_busy(tries)) return fail_now(why), READ_FAILED;
    }
    *bytes = NULL;
    bool good = GetFileSizeEx(file, &length) && length.QuadPart <= most &&
                (*bytes = malloc((size_t)length.QuadPart + 1)) != NULL;
    *size = good ? length.QuadPart : 0;
    for (int64_t at = 0; good && at < *size;) {
        DWORD got = 0, part = *size - at < (1 << 30) ? (DWORD)(*size - at) : 1 << 30;
        good = ReadFile(file, *bytes + at, part, &got, NULL) && got > 0;
        at += got;
    }
    CloseHandle(file);
    if (good) return READ_DONE;
    free(*bytes);
    return fail(why, "too long, or it does not fit into memory"), READ_FAILED;
}

bool disk_rename(const char *from, const char *to, char *why) {
    Wide a, b;
    wide(from, a), wide(to, b);
    for (int tries = 0; !MoveFileExW(a, b, MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH);
         tries++)
        if (!is_busy(tries)) return fail_now(why);
    return true;
}

static void remove_file(const char *path) {
    Wide w;
    DeleteFileW(wide(path, w));
}

static bool write_new(const char *path, const uint8_t *bytes, int64_t size, char *why) {
    HANDLE file = open_file(path, GENERIC_WRITE, CREATE_NEW);
    if (file == INVALID_HANDLE_VALUE) return fail_now(why);
    bool good = true;
    for (int64_t at = 0; good && at < size;) {
        DWORD done = 0, part = size - at < (1 << 30) ? (DWORD)(size - at) : 1 << 30;
        good = WriteFile(file, bytes + at, part, &done, NULL) && done > 0;
        at += done;
    }
    good = good && FlushFileBuffers(file);
    if (!good) fail_now(why);
    CloseHandle(file);
    return good;
}

bool disk_exists(const char *path) {
    Wide w;
    return GetFileAttributesW(wide(path, w)) != INVALID_FILE_ATTRIBUTES;
}

bool disk_is_folder(const char *path) {
    Wide w;
    DWORD found = GetFileAttributesW(wide(path, w));
    return found != INVALID_FILE_ATTRIBUTES && (found & FILE_ATTRIBUTE_DIRECTORY);
}

static bool make_one_folder(const char *path, char *why) {
    Wide w;
    return CreateDirectoryW(wide(path, w), NULL) || disk_is_folder(path) || fail_now(why);
}

static bool try_lock(Lock *lock, char *why) {
    HANDLE file = open_file(lock->path, GENERIC_READ | GENERIC_WRITE, OPEN_ALWAYS);
    if (file == INVALID_HANDLE_VALUE)
        return GetLastError() != ERROR_ACCESS_DENIED ? fail_now(why) : false; /* being removed */
    if (LockFile(file, 0, 0, 1, 0)) return lock->handle = (intptr_t)file, true;
    CloseHandle(file);
    return false;
}

void disk_unlock(Lock *lock) {
    CloseHandle((HANDLE)lock->handle);
    remove_file(lock->path); /* refused while others have it open: they reuse it */
}

static void wait_ms(int ms) { Sleep((DWORD)ms); }

bool disk_absolute(const char *path, char *absolute) {
    Wide w, full;
    DWORD length = GetFullPathNameW(wide(path, w), PATH_SIZE, full, NULL);
    return length > 0 && length < PATH_SIZE &&
           WideCharToMultiByte(CP_UTF8, 0, full, -1, absolute, PATH_SIZE, NULL, NULL) > 0;
}

bool disk_environment(const char *name, char *value) {
    Wide w, found;
    DWORD length = GetEnvironmentVariableW(wide(name, w), found, PATH_SIZE);
    return length > 0 && length < PATH_SIZE &&
           WideCharToMultiByte(CP_UTF8, 0, found, -1, value, PATH_SIZE, NULL, NULL) > 0;
}

#else

static bool fail_now(char *why) { return fail(why, strerror(errno)); }

ReadResult disk_read(const char *path, int64_t most, uint8_t **bytes, int64_t *size, char *why) {
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* a pipe must not block */
    if (file < 0) return errno == ENOENT ? READ_ABSENT : (fail_now(why), READ_FAILED);
    struct stat status;
    *bytes = NULL;
    bool good = fstat(file, &status) == 0 && S_ISREG(status.st_mode);
    if (!good) fail(why, "not a regular file");
    if (good && (status.st_size > most || !(*bytes = malloc((size_t)status.st_size + 1))))
        good = fail(why, "too long, or it does not fit into memory");
    *size = good ? status.st_size : 0;
    for (int64_t at = 0; good && at < *size;) {
        ssize_t got = read(file, *bytes + at, (size_t)(*size - at));
        if (got <= 0 && !(got < 0 && errno == EINTR)) good = fail(why, "it ends while it is read");
        at += got > 0 ? got : 0;
    }
    close(file);
    if (!good) free(*bytes);
    return good ? READ_DONE : READ_FAILED;
}

/* Makes a new name last through a power cut, where the system can do that for folders. */
static void sync_folder_of(const char *path) {
    char folder[PATH_SIZE];
    snprintf(folder, sizeof folder, "%s", path);
    char *end = strrchr(folder, '/');
    if (!end) return;
    *end = 0;
    int file = open(*folder ? folder : "/", O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    fsync(file);
    close(file);
}

bool disk_rename(const char *from, const char *to, char *why) {
    if (rename(from, to) != 0) return fail_now(why);
    sync_folder_of(to);
    return true;
}

static void remove_file(const char *path) { unlink(path); }

static bool write_new(const char *path, const uint8_t *bytes, int64_t size, char *why) {
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0) return fail_now(why);
    bool good = true;
    for (int64_t at = 0; good && at < size;) {
        ssize_t done = write(file, bytes + at, (size_t)(size - at));
        if (done < 0 && errno != EINTR) good = fail_now(why);
        at += done > 0 ? done : 0;
    }
    if (good && fsync(file) != 0) good = fail_now(why);
    close(file);
    return good;
}

bool disk_exists(const char *path) {
    struct stat status;
    return lstat(path, &status) == 0;
}

bool disk_is_folder(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

static bool make_one_folder(const char *path, char *why) {
    return mkdir(path, 0777) == 0 || disk_is_folder(path) || fail_now(why);
}

/* Valid only if it still is the file of that name: its last holder may have removed it. */
static bool try_lock(Lock *lock, char *why) {
    int file = open(lock->path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) return fail_now(why);
    struct stat ours, there;
    if (flock(file, LOCK_EX | LOCK_NB) != 0) {
        if (errno != EAGAIN && errno != EACCES && errno != EDEADLK) fail_now(why);
    } else if (fstat(file, &ours) == 0 && stat(lock->path, &there) == 0 &&
               ours.st_ino == there.st_ino && ours.st_dev == there.st_dev) {
        return lock->handle = file, true;
    }
    close(file);
    return false;
}

void disk_unlock(Lock *lock) {
    remove_file(lock->path); /* while it is locked: who waits for it sees that it is gone */
    close((int)lock->handle);
}

static void wait_ms(int ms) {
    struct timespec time = {0, ms * 1000000L};
    nanosleep(&time, NULL);
}

bool disk_absolute(const char *path, char *absolute) {
    char here[PATH_SIZE] = "";
    if (path[0] != '/' && !getcwd(here, sizeof here)) return false;
    int length = snprintf(absolute, PATH_SIZE, "%s%s%s", here, *here ? "/" : "", path);
    return length < PATH_SIZE;
}

bool disk_environment(const char *name, char *value) {
    const char *found = getenv(name);
    return found && *found && snprintf(value, PATH_SIZE, "%s", found) < PATH_SIZE;
}

#endif

bool disk_replace(const char *path, const uint8_t *bytes, int64_t size, char *why) {
    char temporary[PATH_SIZE + 8];
    snprintf(temporary, sizeof temporary, "%s.tmp", path);
    remove_file(temporary); /* of a killed process; opening it instead would follow a link */
    if (write_new(temporary, bytes, size, why) && disk_rename(temporary, path, why)) return true;
    remove_file(temporary);
    return false;
}

bool disk_make_folder(const char *path, char *why) {
    if (disk_is_folder(path)) return true;
    char part[PATH_SIZE];
    snprintf(part, sizeof part, "%s", path);
    for (char *at = part + 1; *at; at++) {
        if (*at != '/' && *at != '\\') continue;
        char separator = *at;
        *at = 0;
        if (!disk_exists(part)) make_one_folder(part, why); /* the last one tells */
        *at = separator;
    }
    return make_one_folder(part, why);
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
