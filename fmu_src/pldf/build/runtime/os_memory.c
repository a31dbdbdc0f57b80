#ifdef __wasm__
/* Files in memory: who runs the module puts them there and takes them out (page.h). There is one
   process and one thread, so that a lock is always free, and folders are what names say. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "os.h"
#include "page.h"

typedef struct File File;
struct File {
    File *next;
    uint8_t *bytes;
    size_t size;
    bool folder; /* one that was made; those of files need none */
    char path[];
};
typedef struct {
    File *file; /* NULL: closed */
    size_t at;
} Opened;
enum { OPEN_FILES = 8 };

const char os_separators[] = "/";
const bool os_refuses_open_files = false;
static File *files; /* in the order in which they were made */
static Opened opened[OPEN_FILES];

static bool fail(int reason) {
    errno = reason;
    return false;
}

/* All paths begin at the root, with a slash or without. */
static const char *from_root(const char *path) { return path + strspn(path, "/"); }

static File **place_of(const char *path) {
    File **place = &files;
    path = from_root(path);
    while (*place && strcmp((*place)->path, path) != 0) place = &(*place)->next;
    return place;
}

static File *make(const char *path) {
    path = from_root(path);
    size_t length = strlen(path) + 1;
    File *file = calloc(1, sizeof *file + length);
    if (!file) return fail(ENOMEM), NULL;
    memcpy(file->path, path, length);
    return *place_of(path) = file;
}

static void drop(File **place) {
    File *file = *place;
    for (int i = 0; i < OPEN_FILES; i++)
        if (opened[i].file == file) opened[i].file = NULL;
    *place = file->next;
    free(file->bytes);
    free(file);
}

static int open_file(File *file) {
    for (int i = 0; file && i < OPEN_FILES; i++)
        if (!opened[i].file) return opened[i] = (Opened){file, 0}, i;
    if (file) errno = EMFILE;
    return -1;
}

int os_open(const char *path, OpenMode mode) {
    DiskEntry there = os_entry(path);
    int reason = mode == OPEN_NEW ? EEXIST : there == FOLDER ? EISDIR : ENOENT;
    if ((there == NO_ENTRY) != (mode == OPEN_NEW) || there == FOLDER) return errno = reason, -1;
    return open_file(mode == OPEN_NEW ? make(path) : *place_of(path));
}

int os_open_lock(const char *path) {
    DiskEntry there = os_entry(path);
    if (there == FOLDER) return errno = EISDIR, -1;
    return open_file(there == NO_ENTRY ? make(path) : *place_of(path));
}

void os_close(int file) { opened[file].file = NULL; }
int64_t os_size(int file) { return opened[file].file ? (int64_t)opened[file].file->size : -1; }

int64_t os_read(int file, void *to, int64_t size) {
    Opened *from = &opened[file];
    if (!from->file) return errno = EBADF, -1;
    size_t rest = from->file->size - from->at, part = (uint64_t)size < rest ? (size_t)size : rest;
    memcpy(to, from->file->bytes + from->at, part);
    from->at += part;
    return (int64_t)part;
}

int64_t os_write(int file, const void *from, int64_t size) {
    File *to = opened[file].file;
    if (!to) return errno = EBADF, -1;
    uint8_t *bytes = realloc(to->bytes, to->size + (size_t)size);
    if (!bytes) return errno = ENOSPC, -1;
    memcpy(bytes + to->size, from, (size_t)size);
    to->bytes = bytes;
    to->size += (size_t)size;
    return size;
}

bool os_sync(int file) { return opened[file].file != NULL; }
void os_sync_name(const char *path) { (void)path; }

bool os_rename(const char *from, const char *to) {
    File *file = *place_of(from);
    if (!file || file->folder) return fail(file ? EISDIR : ENOENT);
    if (os_entry(to) == FOLDER) return fail(EISDIR);
    os_remove(to);
    File *renamed = make(to);
    if (!renamed) return false;
    renamed->bytes = file->bytes;
    renamed->size = file->size;
    file->bytes = NULL;
    os_remove(from);
    return true;
}

void os_remove(const char *path) {
    File **place = place_of(path);
    if (*place && !(*place)->folder) drop(place);
}

bool os_make_folder(const char *path) {
    if (os_entry(path) != NO_ENTRY) return fail(EEXIST);
    File *folder = make(path);
    if (folder) folder->folder = true;
    return folder != NULL;
}

/* The rest of a file's path below a folder; NULL: it is not below it. */
static const char *below(const char *path, const char *folder) {
    folder = from_root(folder);
    size_t length = strlen(folder);
    while (length > 0 && folder[length - 1] == '/') length--;
    if (length == 0) return path;
    return !strncmp(path, folder, length) && path[length] == '/' ? path + length + 1 : NULL;
}

DiskEntry os_entry(const char *path) {
    File *file = *place_of(path);
    if (file) return file->folder ? FOLDER : OTHER_ENTRY;
    for (file = files; file; file = file->next)
        if (below(file->path, path)) return FOLDER;
    return *from_root(path) ? NO_ENTRY : FOLDER;
}

/* Files and the folders that were made: nobody asks for the others. */
void os_each_name(const char *folder, void visit(void *context, const char *name), void *context) {
    for (File *file = files; file; file = file->next) {
        const char *name = below(file->path, folder);
        if (name && !strchr(name, '/')) visit(context, name);
    }
}

void os_follow(char *path) { (void)path; }

bool os_lock(int file, const char *path) {
    (void)path;
    return os_sync(file);
}

void os_wait_ms(int ms) { (void)ms; }

bool os_reason(char *why) {
    snprintf(why, REASON_SIZE, "%s", strerror(errno));
    return false;
}

bool os_absolute(const char *path, char *absolute, char *why) {
    int length = snprintf(absolute, PATH_SIZE, "%s%s", *path == '/' ? "" : "/", path);
    snprintf(why, REASON_SIZE, "%d bytes long, at most %d are possible", length, FOLDER_SIZE - 1);
    return length < FOLDER_SIZE;
}

bool os_own_library(char *path) {
    (void)path;
    return false;
}

bool os_environment(const char *name, char *value) {
    (void)name;
    (void)value;
    return false;
}

/* What the page asks for */

bool page_write(const char *path, const uint8_t *bytes, size_t size) {
    os_remove(path);
    int file = os_open(path, OPEN_NEW);
    if (file < 0) return false;
    bool good = size == 0 || os_write(file, bytes, (int64_t)size) > 0;
    os_close(file);
    return good;
}

const uint8_t *page_read(const char *path, size_t *size) {
    static const uint8_t nothing[1];
    File *file = *place_of(path);
    if (!file || file->folder) return NULL;
    *size = file->size;
    return file->bytes ? file->bytes : nothing;
}

void page_remove(const char *path) { os_remove(path); }

const char *page_path(size_t index) {
    for (File *file = files; file; file = file->next)
        if (!file->folder && index-- == 0) return file->path;
    return NULL;
}
#endif
