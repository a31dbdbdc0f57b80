/* usage: recorded_host DESCRIPTION CALLS [steal | replace]
   A short drive in a process that writes into the file CALLS what the FMU does to the disk, one line
   per call that succeeds: mkdir, rename, fsync, flock, unlink, and the file's path. With "steal",
   somebody else removes the lock's file before it is locked for the first time, and with "replace"
   a third one makes another in its place. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "host.h"

static FILE *calls;
static bool steal, replace;

static int note(int result, const char *call, const char *path) {
    if (calls && result == 0) fprintf(calls, "%s %s\n", call, path);
    return result;
}

static const char *path_of(int file) {
    static char path[LINE_SIZE], link[64];
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    ssize_t length = readlink(link, path, sizeof path - 1);
    path[length < 0 ? 0 : length] = 0;
    return path;
}

/* In place of the C library's, for the FMU too. */
int mkdir(const char *path, mode_t mode) {
    return note((int)syscall(SYS_mkdir, path, mode), "mkdir", path);
}
int rename(const char *from, const char *to) {
    return note((int)syscall(SYS_rename, from, to), "rename", to);
}
int unlink(const char *path) { return note((int)syscall(SYS_unlink, path), "unlink", path); }
int fsync(int file) { return note((int)syscall(SYS_fsync, file), "fsync", path_of(file)); }
int flock(int file, int how) {
    if (calls && steal) {
        steal = false;
        const char *path = path_of(file);
        unlink(path);
        if (replace) close(open(path, O_CREAT | O_RDWR, 0666));
    }
    return note((int)syscall(SYS_flock, file, how), "flock", path_of(file));
}

int main(int count, char **arguments) {
    double in[MANY] = {0.0};
    CHECK(count >= 3);
    Fmu *fmu = fmu_open(arguments[1]);
    CHECK((calls = fopen(arguments[2], "w")) != NULL);
    steal = count > 3;
    replace = steal && !strcmp(arguments[3], "replace");
    void *c = started(fmu, "recorded");
    for (int k = 0; k < 5; k++) {
        in[0] = 20.0 * k;
        in[1] = 20.0;
        CHECK(set_inputs(fmu, c, in) == OK);
        CHECK(fmu->api->step(fmu, c, k, 1.0) == OK);
    }
    CHECK(fmu->api->terminate(fmu, c) == OK);
    fmu->api->free(fmu, c);
    CHECK(fclose(calls) == 0);
    return 0;
}
