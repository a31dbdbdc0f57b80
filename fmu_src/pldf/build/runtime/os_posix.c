#if !defined _WIN32 && !defined __wasm__
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "os.h"

typedef struct stat Status;
const char os_separators[] = "/";
const bool os_refuses_open_files = false;

int os_open(const char *path, OpenMode mode) {
    static const int flags[] = {[OPEN_READ] = O_RDONLY, [OPEN_NEW] = O_WRONLY | O_CREAT | O_EXCL};
    return open(path, flags[mode] | O_CLOEXEC | O_NONBLOCK, 0666); /* a pipe must not block */
}

/* A lock holds nothing that could be read; its group need not be that of the folder. */
static void share_lock(int file, const char *path) {
    char folder[PATH_SIZE + 32];
    Status status;
    snprintf(folder, sizeof folder, "%s", path);
    char *end = strrchr(folder, '/');
    if (end) end[end == folder] = 0;
    if (!end || stat(folder, &status) != 0) return;
    if (fchmod(file, 0644 | (status.st_mode & 0022)) != 0) return; /* somebody else's: they do it */
}

/* To read is enough for a lock on most file systems, and what a strange umask leaves. And no O_CREAT
   on what is there: a shared folder with a sticky bit forbids it. */
int os_open_lock(const char *path) {
    int file = -1;
    for (int race = 0; race < 3; race++) { /* somebody else's may come between the calls */
        file = open(path, O_RDWR | O_CLOEXEC | O_NONBLOCK);
        if (file < 0 && errno == EACCES) file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
        if (file >= 0 || errno != ENOENT) return file;
        file = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
        if (file >= 0) share_lock(file, path);
        if (file >= 0 || errno != EACCES) return file;
    }
    return file;
}

void os_close(int file) { close(file); }

int64_t os_size(int file) {
    Status status;
    return fstat(file, &status) == 0 && S_ISREG(status.st_mode) ? status.st_size : -1;
}

int64_t os_read(int file, void *to, int64_t size) { return read(file, to, (size_t)size); }
int64_t os_write(int file, const void *from, int64_t size) { return write(file, from, (size_t)size); }

bool os_sync(int file) {
#ifdef __APPLE__ /* there fsync leaves it in the drive's cache, but some file systems know no more */
    if (fcntl(file, F_FULLFSYNC) == 0) return true;
#endif
    return fsync(file) == 0;
}

void os_sync_name(const char *path) {
    char folder[PATH_SIZE];
    snprintf(folder, sizeof folder, "%s", path);
    char *end = strrchr(folder, '/');
    if (end) end[end == folder] = 0;
    int file = end ? os_open(folder, OPEN_READ) : -1;
    if (file < 0) return;
    os_sync(file);
    close(file);
}

bool os_rename(const char *from, const char *to) {
    if (rename(from, to) != 0) return false;
    os_sync_name(to);
    return true;
}

void os_remove(const char *path) { unlink(path); }

bool os_make_folder(const char *path) {
    if (mkdir(path, 0777) != 0) return false;
    os_sync_name(path);
    return true;
}

DiskEntry os_entry(const char *path) {
    Status status;
    if (lstat(path, &status) != 0) return NO_ENTRY;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode) ? FOLDER : OTHER_ENTRY;
}

void os_each_name(const char *folder, void visit(void *context, const char *name), void *context) {
    DIR *names = opendir(folder);
    if (!names) return;
    for (struct dirent *entry = readdir(names); entry; entry = readdir(names))
        visit(context, entry->d_name);
    closedir(names);
}

void os_follow(char *path) {
    char to[PATH_SIZE];
    for (int links = 0; links < 40; links++) {
        ssize_t length = readlink(path, to, sizeof to - 1);
        char *name = strrchr(path, '/');
        if (length <= 0 || !name) return;
        to[length] = 0;
        size_t before = to[0] == '/' ? 0 : (size_t)(name + 1 - path);
        if (before + (size_t)length >= FOLDER_SIZE) return;
        memcpy(path + before, to, (size_t)length + 1);
    }
}

/* Its last holder may have removed the file: then the lock is one of nothing. */
bool os_lock(int file, const char *path) {
    Status ours, there;
    if (flock(file, LOCK_EX | LOCK_NB) != 0) return false;
    if (fstat(file, &ours) == 0 && stat(path, &there) == 0 && ours.st_ino == there.st_ino &&
        ours.st_dev == there.st_dev)
        return true;
    errno = EAGAIN;
    return false;
}

void os_wait_ms(int ms) {
    struct timespec time = {0, ms * 1000000L};
    nanosleep(&time, NULL);
}

bool os_reason(char *why) {
    snprintf(why, REASON_SIZE, "%s", strerror(errno));
    return false;
}

bool os_absolute(const char *path, char *absolute, char *why) {
    char here[PATH_SIZE] = "";
    if (path[0] != '/' && !getcwd(here, sizeof here)) return os_reason(why);
    long long length = snprintf(absolute, PATH_SIZE, "%s%s%s", here, *here ? "/" : "", path);
    snprintf(why, REASON_SIZE, "%lld bytes long, at most %d are possible", length, FOLDER_SIZE - 1);
    return length < FOLDER_SIZE;
}

bool os_own_library(char *path) {
    Dl_info found;
    if (!dladdr(os_separators, &found) || !found.dli_fname) return false;
    return snprintf(path, PATH_SIZE, "%s", found.dli_fname) < PATH_SIZE;
}

bool os_environment(const char *name, char *value) {
    const char *found = getenv(name);
    if (found) snprintf(value, PATH_SIZE, "%s", found);
    return found && *found;
}
#endif
