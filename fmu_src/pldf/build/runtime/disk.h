/* The operating system: files, folders, the lock. Paths are UTF-8. What fails leaves its reason in
   `why` (REASON_SIZE bytes). */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* A store's folder leaves room for the names in it: "/driver-N_route-KEY.pldf.refused-N.tmp". */
enum { PATH_SIZE = 4096, FOLDER_SIZE = PATH_SIZE - 96, REASON_SIZE = 160 };
typedef enum { READ_DONE, READ_ABSENT, READ_FAILED } ReadResult;
typedef enum { NO_ENTRY, FOLDER, OTHER_ENTRY } DiskEntry;
typedef struct {
    int file;
    char path[PATH_SIZE + 32];
} Lock;

/* Whole regular file of at most 4 GiB, to be freed by the caller; NULL unless it is done. */
ReadResult disk_read(const char *path, uint8_t **bytes, int64_t *size, char *why);
bool disk_replace(const char *path, const uint8_t *bytes, int64_t size, char *why);
bool disk_rename(const char *from, const char *to, char *why);
DiskEntry disk_entry(const char *path);
bool disk_parent(char *path); /* cuts the last name off, unless nothing is left then */
bool disk_make_folder(const char *path, char *why); /* with those above it */
bool disk_lock(const char *folder, Lock *lock, char *why);
void disk_unlock(Lock *lock);
/* Of a store's folder; false if the path is too long or no text of this system. */
bool disk_absolute(const char *path, char *absolute, char *why);
bool disk_environment(const char *name, char *value); /* true, and cut or empty: cannot be used */
