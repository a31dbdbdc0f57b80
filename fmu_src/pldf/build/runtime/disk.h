/* Files of which nobody ever sees or leaves half, folders, the lock. Paths are UTF-8. What fails
   leaves its reason in `why` (REASON_SIZE bytes). */
#pragma once

#include "os.h"

/* What is UNUSABLE can never be read as a file; what FAILED may be sound, and cannot be read now. */
typedef enum { READ_DONE, READ_ABSENT, READ_UNUSABLE, READ_FAILED } ReadResult;
typedef struct {
    int file;
    char path[PATH_SIZE + 32];
} Lock;

/* Whole regular file of at most 4 GiB, to be freed by the caller; NULL unless it is done. Of a file
   that does not begin with `begin` no more than that many bytes. */
ReadResult disk_read(const char *path, const char *begin, uint8_t **bytes, int64_t *size, char *why);
/* What was there gets the name `aside`, unless that is NULL, once the rest can hardly fail. */
bool disk_replace(const char *path, const uint8_t *bytes, int64_t size, const char *aside, char *why);
bool disk_rename(const char *from, const char *to, char *why);
bool disk_parent(char *path); /* cuts the last name off, unless nothing is left then */
bool disk_make_folder(const char *path, char *why); /* with those above it */
void disk_nearest(const char *folder, char *nearest); /* the folder, or the first above it that is there */
typedef enum { LOCK_DONE, LOCK_HELD, LOCK_FAILED } LockResult;
LockResult disk_lock(const char *folder, int patience_ms, Lock *lock, char *why);
void disk_unlock(Lock *lock);
/* Tries to write in the folder, or where it would be made (`part`), without leaving anything. */
bool disk_writable(const char *folder, char *part, char *why);
