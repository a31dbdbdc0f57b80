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
void *library_open(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
void library_close(void *library) { dlclose(library); }
bool library_is_open(const char *path) { return dlopen(path, RTLD_NOW | RTLD_NOLOAD) != NULL; }
void *library_find(void *library, const char *name) { return dlsym(library, name); }

static void *run(void *given) {
    Work *w = given;
    w->work(w->given);
    return NULL;
}

bool run_in_thread(void (*work)(void *), void *given, size_t stack) {
    Work w = {work, given};
    pthread_t thread;
    pthread_attr_t how;
    pthread_attr_init(&how);
    return pthread_attr_setstacksize(&how, stack) == 0 &&
           pthread_create(&thread, &how, run, &w) == 0 && pthread_join(thread, NULL) == 0;
}
#endif
