/* What a WebAssembly module offers besides FMI 2.0: it imports nothing, so that files and messages are
   kept inside until they are asked for. Memory for arguments comes from malloc and goes to free. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "fmi2FunctionTypes.h"

#define PAGE_EXPORT __attribute__((visibility("default")))

/* Files by path, which begins at the root with a slash or without (os_memory.c): in place of one that
   is there; false: there is no memory. */
PAGE_EXPORT bool page_write(const char *path, const uint8_t *bytes, size_t size);
/* Its bytes, valid until it changes; NULL: there is none. */
PAGE_EXPORT const uint8_t *page_read(const char *path, size_t *size);
PAGE_EXPORT void page_remove(const char *path);
/* Without a slash, of the file with this number from 0; NULL behind the last one. */
PAGE_EXPORT const char *page_path(size_t index);

/* For fmi2Instantiate (page.c): with a logger that keeps the messages. */
PAGE_EXPORT const fmi2CallbackFunctions *page_callbacks(void);
/* Takes the oldest message; valid until the next call; NULL: there is none. */
PAGE_EXPORT const char *page_message(int32_t *status);
