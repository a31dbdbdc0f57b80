/* Shared libraries and threads of Linux and Windows; a header of its own, since windows.h takes many names. */
#ifndef LIBRARY_H
#define LIBRARY_H

#include <stdbool.h>
#include <stddef.h>

void *library_open(const char *path); /* NULL: not possible */
void library_close(void *library);
bool library_is_open(const char *path);
void *library_find(void *library, const char *name);
bool run_in_thread(void (*work)(void *), void *given, size_t stack); /* bytes; until its end */

#endif
