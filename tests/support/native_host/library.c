#include "library.h"

typedef struct {
    void (*work)(void *);
    void *given;
} Work;

#ifdef _WIN32
#include <windows.h>
void *library_open(const char *path) { return (void *)LoadLibraryA(path); }
void library_close(void *library) { FreeLibrary((HMODULE)library); }
bool library_is_open(const char *path) { return GetModuleHandleA(path) != NULL; }
void *library_find(void *library, const char *name) {
    return (void *)GetProcAddress((HMODULE)library, name);
}

static DWORD WINAPI run(void *given) {
    Work *w = given;
    w->work(w->given);
    return 0;
}

bool run_in_thread(void (*work)(void *), void *given, size_t stack) {
    Work w = {work, given};
    HANDLE thread = CreateThread(NULL, stack, run, &w, STACK_SIZE_PARAM_IS_A_RESERVATION, NULL);
    return thread && WaitForSingleObject(thread, INFINITE) == WAIT_OBJECT_0 && CloseHandle(thread);
}
#else
#include <dlfcn.h>
#include <pthread.h>
#include <sys/mman.h>
void *library_open(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
void library_close(void *library) { dlclose(library); }
bool library_is_open(const char *path) { return dlopen(path, RTLD_NOW | RTLD_NOLOAD) != NULL; }
void *library_find(void *library, const char *name) { return dlsym(library, name); }

static void *run(void *given) {
    Work *w = given;
    w->work(w->given);
    return NULL;
}

/* Below the stack nothing can be touched, so that a large frame does not leap over the guard. */
bool run_in_thread(void (*work)(void *), void *given, size_t stack) {
    enum { GUARD = 1 << 20 };
    Work w = {work, given};
    pthread_t thread;
    pthread_attr_t how;
    char *place = mmap(NULL, GUARD + stack, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    pthread_attr_init(&how);
    return place != MAP_FAILED && mprotect(place + GUARD, stack, PROT_READ | PROT_WRITE) == 0 &&
           pthread_attr_setstack(&how, place + GUARD, stack) == 0 &&
           pthread_create(&thread, &how, run, &w) == 0 && pthread_join(thread, NULL) == 0 &&
           munmap(place, GUARD + stack) == 0;
}
#endif
