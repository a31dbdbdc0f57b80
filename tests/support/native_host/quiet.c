/* usage: quiet_host DESCRIPTION STEPS [end]
   Steps with senseless inputs in a process that the kernel kills at its first system call but write
   and _exit, and that counts what it allocates. With "end", the drive also ends there, which needs
   files: the process must be killed. Status 77: this system cannot seal a process. */
#define _GNU_SOURCE
#include <linux/seccomp.h>
#include <stdio.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "host.h"

static long allocations;

/* In place of the C library's, for the FMU too. */
void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void __libc_free(void *);
void *malloc(size_t size) { return allocations++, __libc_malloc(size); }
void *calloc(size_t count, size_t size) { return allocations++, __libc_calloc(count, size); }
void *realloc(void *old, size_t size) { return allocations++, __libc_realloc(old, size); }
void free(void *old) { allocations += old != NULL, __libc_free(old); }

static void leave(int status) { syscall(SYS_exit, status); }

int main(int count, char **arguments) {
    double in[MANY], out[MANY], time = 0.0;
    CHECK(count >= 3);
    Fmu *fmu = fmu_open(arguments[1]);
    long before = allocations, steps = atol(arguments[2]);
    void *c = started(fmu, "quiet");
    CHECK(allocations > before); /* those of the FMU are counted */
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) return 77;
    before = allocations;
    for (long k = 0; k < steps; k++) {
        double step = senseless_step();
        senseless_inputs(fmu, in);
        int status = set_inputs(fmu, c, in);
        if (status == OK) status = fmu->api->step(fmu, c, time, step);
        if (status == OK) status = get_outputs(fmu, c, out);
        if (status != OK) leave(1);
        time += step;
    }
    if (count > 3) fmu->api->terminate(fmu, c);
    leave(allocations == before ? 0 : 2);
}
