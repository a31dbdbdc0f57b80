#ifdef _WIN32 /* with paths in UTF-16 */
#define WIN32_LEAN_AND_MEAN
#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <stdio.h>
#include <string.h>
#include <sys/locking.h>
#include <sys/stat.h>
#include <windows.h>

#include "os.h"

typedef wchar_t Wide[PATH_SIZE + 8];
enum { LONG_PATH = 240 }; /* 248 for folders, 260 for files */
const char os_separators[] = "/\\";
const bool os_refuses_open_files = true;

static const wchar_t *utf16(const char *text, Wide out) {
    if (!MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, text, -1, out, PATH_SIZE)) out[0] = 0;
    return out;
}

/* Windows takes long paths only with a prefix, and then only in their plain form. */
static const wchar_t *wide(const char *path, Wide out) {
    Wide given;
    if (wcslen(utf16(path, given)) < LONG_PATH || given[1] != L':') return utf16(path, out);
    DWORD length = GetFullPathNameW(given, PATH_SIZE, out + 4, NULL);
    if (length == 0 || length >= PATH_SIZE) return utf16(path, out);
    return memcpy(out, L"\\\\?\\", 4 * sizeof *out);
}

static bool narrow(DWORD length, const wchar_t *found, char *out) {
    return length > 0 && length < PATH_SIZE &&
           WideCharToMultiByte(CP_UTF8, 0, found, -1, out, PATH_SIZE, NULL, NULL) > 0;
}

int os_open(const char *path, OpenMode mode) {
    static const int flags[] = {[OPEN_READ] = _O_RDONLY, [OPEN_NEW] = _O_WRONLY | _O_CREAT | _O_EXCL};
    Wide w;
    return _wopen(wide(path, w), flags[mode] | _O_BINARY | _O_NOINHERIT, _S_IREAD | _S_IWRITE);
}

/* A new file has the rights of its folder here. */
int os_open_lock(const char *path) {
    Wide w;
    return _wopen(wide(path, w), _O_RDWR | _O_CREAT | _O_BINARY | _O_NOINHERIT, _S_IREAD | _S_IWRITE);
}

void os_close(int file) { _close(file); }

int64_t os_size(int file) {
    struct _stat64 status;
    return _fstat64(file, &status) == 0 && S_ISREG(status.st_mode) ? status.st_size : -1;
}

int64_t os_read(int file, void *to, int64_t size) { return _read(file, to, (unsigned)size); }
int64_t os_write(int file, const void *from, int64_t size) { return _write(file, from, (unsigned)size); }
bool os_sync(int file) { return _commit(file) == 0; }
void os_sync_name(const char *path) { (void)path; } /* NTFS keeps a journal of names */

bool os_rename(const char *from, const char *to) {
    Wide a, b;
    if (MoveFileExW(wide(from, a), wide(to, b), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH))
        return true;
    bool busy = GetLastError() == ERROR_SHARING_VIOLATION || GetLastError() == ERROR_ACCESS_DENIED;
    errno = busy ? EACCES : EIO;
    return false;
}

void os_remove(const char *path) {
    Wide w;
    _wunlink(wide(path, w));
}

bool os_make_folder(const char *path) {
    Wide w;
    return CreateDirectoryW(wide(path, w), NULL);
}

DiskEntry os_entry(const char *path) {
    Wide w;
    DWORD found = GetFileAttributesW(wide(path, w));
    if (found == INVALID_FILE_ATTRIBUTES) return NO_ENTRY;
    return found & FILE_ATTRIBUTE_DIRECTORY ? FOLDER : OTHER_ENTRY;
}

void os_each_name(const char *folder, void visit(void *context, const char *name), void *context) {
    char pattern[PATH_SIZE], name[4 * MAX_PATH];
    WIN32_FIND_DATAW entry;
    Wide w;
    if (snprintf(pattern, sizeof pattern, "%s/*", folder) >= PATH_SIZE) return;
    HANDLE names = FindFirstFileW(wide(pattern, w), &entry);
    if (names == INVALID_HANDLE_VALUE) return;
    do {
        if (WideCharToMultiByte(CP_UTF8, 0, entry.cFileName, -1, name, sizeof name, NULL, NULL) > 0)
            visit(context, name);
    } while (FindNextFileW(names, &entry));
    FindClose(names);
}

void os_follow(char *path) {
    Wide w, full;
    DWORD found = GetFileAttributesW(wide(path, w));
    if (found == INVALID_FILE_ATTRIBUTES || !(found & FILE_ATTRIBUTE_REPARSE_POINT)) return;
    HANDLE file = CreateFileW(w, 0, 7, NULL, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, NULL);
    if (file == INVALID_HANDLE_VALUE) return;
    DWORD length = GetFinalPathNameByHandleW(file, full, PATH_SIZE, 0);
    CloseHandle(file);
    char to[PATH_SIZE];
    /* It comes with the prefix of long paths, of which UNC\\ is another kind. */
    if (length > 4 && length < FOLDER_SIZE && wcsncmp(full, L"\\\\?\\UNC", 7) != 0 &&
        narrow(length - 4, full + 4, to) && strlen(to) < FOLDER_SIZE)
        memcpy(path, to, strlen(to) + 1);
}

/* No other can be at `path`: a file that somebody has open cannot be removed. */
bool os_lock(int file, const char *path) {
    (void)path;
    if (_locking(file, _LK_NBLCK, 1) == 0) return true;
    if (GetLastError() == ERROR_LOCK_VIOLATION) errno = EACCES; /* wine leaves it as it was */
    return false;
}

void os_wait_ms(int ms) { Sleep((DWORD)ms); }

bool os_reason(char *why) {
    snprintf(why, REASON_SIZE, "Windows error %lu", GetLastError());
    return false;
}

bool os_absolute(const char *path, char *absolute, char *why) {
    Wide w, full;
    DWORD length = GetFullPathNameW(utf16(path, w), PATH_SIZE, full, NULL);
    bool good = narrow(length, full, absolute);
    size_t bytes = good ? strlen(absolute) : 0;
    if (good) snprintf(why, REASON_SIZE, "%llu bytes long, at most %d are possible",
                       (unsigned long long)bytes, FOLDER_SIZE - 1);
    else snprintf(why, REASON_SIZE, "not a path, in UTF-8 and not too long");
    return good && bytes < FOLDER_SIZE;
}

bool os_own_library(char *path) {
    HMODULE module;
    Wide found;
    DWORD flags = GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
    return GetModuleHandleExW(flags, (const wchar_t *)os_separators, &module) &&
           narrow(GetModuleFileNameW(module, found, PATH_SIZE), found, path);
}

bool os_environment(const char *name, char *value) {
    Wide w, found;
    DWORD length = GetEnvironmentVariableW(utf16(name, w), found, PATH_SIZE);
    if (!narrow(length, found, value)) value[0] = 0;
    return length > 0;
}
#endif
