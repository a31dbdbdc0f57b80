/* What the operating systems call by other names: os_posix.c, os_windows.c. Paths are UTF-8. What
   fails leaves errno. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* A store's folder leaves room for the names in it: "/driver-N_route-KEY.pldf.refused-N.tmp". */
enum { PATH_SIZE = 4096, FOLDER_SIZE = PATH_SIZE - 96, REASON_SIZE = 160 };
typedef enum { NO_ENTRY, FOLDER, OTHER_ENTRY } DiskEntry;
typedef enum { OPEN_READ, OPEN_NEW } OpenMode;

extern const char os_separators[];
extern const bool os_refuses_open_files; /* for the moment in which somebody else has them open */

int os_open(const char *path, OpenMode mode); /* below 0: not possible */
int os_open_lock(const char *path); /* made if it is not there, and open to whoever may write beside it */
void os_close(int file);
int64_t os_size(int file); /* below 0: not a regular file */
int64_t os_read(int file, void *to, int64_t size);
int64_t os_write(int file, const void *from, int64_t size);
bool os_sync(int file); /* to the medium */
/* Makes a new name in its folder last through a power cut, where the system can do that. */
void os_sync_name(const char *path);

bool os_rename(const char *from, const char *to);
void os_remove(const char *path);
bool os_make_folder(const char *path);
DiskEntry os_entry(const char *path);
/* Visits the names in a folder, in any order; none if it cannot be read. */
void os_each_name(const char *folder, void visit(void *context, const char *name), void *context);
void os_follow(char *path); /* PATH_SIZE bytes: to what a link leads to */
/* Whether we have the lock of the open file, and it still is the one at `path`. If somebody else has
   it, errno is EAGAIN, EACCES or EDEADLK. */
bool os_lock(int file, const char *path);
void os_wait_ms(int ms);

bool os_reason(char *why); /* of what failed last; false */
/* Of a store's folder; false if the path is too long or no text of this system. */
bool os_absolute(const char *path, char *absolute, char *why);
bool os_own_library(char *path); /* PATH_SIZE bytes: the file that this code was loaded from */
bool os_environment(const char *name, char *value); /* true, and cut or empty: cannot be used */
