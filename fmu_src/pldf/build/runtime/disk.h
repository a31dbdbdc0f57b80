/* Files of which nobody ever sees or leaves half, folders, the lock. Paths are UTF-8. What fails
   leaves its reason in `why` (REASON_SIZE bytes). */
#pragma once

#include "os.h"

typedef enum { READ_DONE, READ_ABSENT, READ_FAILED } ReadResult;
typedef struct {
    int file;
    char path[PATH_SIZE + 32];
} Lock;

/* Whole regular file of at most 4 GiB, to be freed by the caller; NULL unless it is done. */
ReadResult disk_read(const char *path, uint8_t **bytes, int64_t *size, char *why);
bool disk_replace(const char *path, const uint8_t *bytes, int64_t size, char *why);
bool disk_rename(const char *from, const char *to, char *why);
bool disk_parent(char *path); /* cuts the last name off, unless nothing is left then */
bool disk_make_folder(const char *path, char *why); /* with those above it */
bool disk_lock(const char *folder, Lock *lock, char *why);
void disk_unlock(Lock *lock);
