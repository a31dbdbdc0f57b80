/* Preloaded into a process, lets the disk fail as FAULTS says: "CALL AT ERRNO PATH;..." Each is a call
   (a name below, or "any"), the how manieth of it on a file whose path has PATH in it, from 1, and what
   it fails with; 0: it reads or writes one byte only; -1: the process is killed before it. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

enum { FAULTS_MAX = 8 };
typedef struct {
    char call[16], path[256];
    int at, error, count;
} Fault;
static Fault faults[FAULTS_MAX];
static int fault_count = -1;

static void parse(const char *text) {
    for (fault_count = 0; text && fault_count < FAULTS_MAX; text = strchr(text, ';'), text += text != NULL) {
        Fault *f = &faults[fault_count];
        if (sscanf(text, "%15s %d %d %255[^;]", f->call, &f->at, &f->error, f->path) == 4) fault_count++;
    }
}

static int fails(const char *call, const char *path) {
    if (fault_count < 0) parse(getenv("FAULTS"));
    int failed = 0;
    for (Fault *f = faults; f < faults + fault_count; f++) {
        if ((strcmp(f->call, call) && strcmp(f->call, "any")) || !strstr(path, f->path)) continue;
        if (++f->count != f->at) continue;
        if (f->error < 0) kill(getpid(), SIGKILL);
        errno = f->error;
        failed = 1;
    }
    return failed;
}

static const char *path_of(int file) {
    static char path[8192];
    char link[64];
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    ssize_t length = readlink(link, path, sizeof path - 1);
    path[length < 0 ? 0 : length] = 0;
    return path;
}

#define REAL(call) ((__typeof__(&call))dlsym(RTLD_NEXT, #call))

int open(const char *path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    int mode = flags & O_CREAT ? va_arg(more, int) : 0;
    va_end(more);
    return fails("open", path) ? -1 : REAL(open)(path, flags, mode);
}
ssize_t read(int file, void *to, size_t size) {
    if (!fails("read", path_of(file))) return REAL(read)(file, to, size);
    return errno ? -1 : REAL(read)(file, to, size > 0);
}
ssize_t write(int file, const void *from, size_t size) {
    if (!fails("write", path_of(file))) return REAL(write)(file, from, size);
    return errno ? -1 : REAL(write)(file, from, size > 0);
}
int fsync(int file) { return fails("fsync", path_of(file)) ? -1 : REAL(fsync)(file); }
int rename(const char *from, const char *to) { return fails("rename", from) ? -1 : REAL(rename)(from, to); }
int unlink(const char *path) { return fails("unlink", path) ? -1 : REAL(unlink)(path); }
int flock(int file, int how) { return fails("flock", path_of(file)) ? -1 : REAL(flock)(file, how); }
int mkdir(const char *path, mode_t mode) { return fails("mkdir", path) ? -1 : REAL(mkdir)(path, mode); }
