/* Shared libraries of Linux and Windows; a header of its own, since windows.h takes many names. */
#ifndef LIBRARY_H
#define LIBRARY_H

#include <stdbool.h>

void *library_open(const char *path); /* NULL: not possible */
void library_close(void *library);
bool library_is_open(const char *path);
void *library_find(void *library, const char *name);

#endif
