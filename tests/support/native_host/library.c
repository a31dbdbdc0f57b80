#include "library.h"

#include <stddef.h>

#ifdef _WIN32
#include <windows.h>
void *library_open(const char *path) { return (void *)LoadLibraryA(path); }
void library_close(void *library) { FreeLibrary((HMODULE)library); }
bool library_is_open(const char *path) { return GetModuleHandleA(path) != NULL; }
void *library_find(void *library, const char *name) {
    return (void *)GetProcAddress((HMODULE)library, name);
}
#else
#include <dlfcn.h>
void *library_open(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
void library_close(void *library) { dlclose(library); }
bool library_is_open(const char *path) { return dlopen(path, RTLD_NOW | RTLD_NOLOAD) != NULL; }
void *library_find(void *library, const char *name) { return dlsym(library, name); }
#endif
