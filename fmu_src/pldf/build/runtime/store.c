#include "store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KEPT_MAX = 9999 };

static void path_of(const char *folder, const Profile *wanted, char *path) {
    snprintf(path, PATH_SIZE, "%s/driver-%06lld_route-%s.pldf", folder, (long long)wanted->driver,
             wanted->route);
}

void profile_free(Profile *profile) {
    free(profile->bytes);
    profile->bytes = NULL;
}

/* Reads the file into `found`; REFUSED with the reason if it is not the profile that is wanted. */
static StoreResult read_profile(const char *path, const Profile *wanted, Profile *found, char *why) {
    memset(found, 0, sizeof *found);
    switch (disk_read(path, &found->bytes, &found->size, why)) {
    case READ_ABSENT: return STORE_ABSENT;
    case READ_FAILED: return STORE_REFUSED;
    case READ_DONE: break;
    }
    bool good = profile_parse(found, why);
    if (good && (found->driver != wanted->driver || found->nodes != wanted->nodes ||
                 strcmp(found->route, wanted->route) != 0)) {
        snprintf(why, REASON_SIZE, "it is the profile of another driver or route");
        good = false;
    }
    if (!good) profile_free(found);
    return good ? STORE_LOADED : STORE_REFUSED;
}

/* First name that is not taken. */
static bool free_name(const char *stem, const char *kind, const char *end, char *name, char *why) {
    for (int number = 1; number <= KEPT_MAX; number++) {
        snprintf(name, PATH_SIZE, "%s.%s-%d%s", stem, kind, number, end);
        if (os_entry(name) == NO_ENTRY) return true;
    }
    snprintf(why, REASON_SIZE, "%d files of it are kept already", KEPT_MAX);
    return false;
}

static bool keep_aside(const char *path, char *kept, char *why) {
    return free_name(path, "refused", "", kept, why) && disk_rename(path, kept, why);
}

/* A file in the place of the folder means that nothing can ever be saved. */
static bool can_be_folder(const Importer *importer, const char *folder) {
    char part[PATH_SIZE];
    snprintf(part, sizeof part, "%s", folder);
    while (os_entry(part) == NO_ENTRY)
        if (!disk_parent(part)) return true;
    if (os_entry(part) == FOLDER) return true;
    importer_tell(importer, WARNING, "%s: not a folder; choose another profile store", part);
    return false;
}

StoreResult store_load(const Importer *importer, const char *folder, Profile *profile) {
    char path[PATH_SIZE], kept[PATH_SIZE], why[REASON_SIZE] = "", again[REASON_SIZE] = "";
    bool aside = false;
    Profile found;
    Lock lock;
    if (!can_be_folder(importer, folder)) return STORE_REFUSED;
    path_of(folder, profile, path);
    StoreResult result = read_profile(path, profile, &found, why);
    if (result == STORE_REFUSED && disk_lock(folder, &lock, again)) {
        result = read_profile(path, profile, &found, why); /* somebody may have dealt with it */
        aside = result == STORE_REFUSED && keep_aside(path, kept, again);
        disk_unlock(&lock);
    }
    if (result == STORE_LOADED) *profile = found;
    if (result == STORE_REFUSED)
        importer_tell(importer, WARNING, "%s: %s; %s%s%s; the drive goes on with the base profile", path,
                      why, aside ? "kept as " : "left in its place (", aside ? kept : again,
                      aside ? "" : ")");
    return result;
}

static Level not_saved(const Importer *importer, const char *path, const char *why) {
    importer_tell(importer, ERROR_LEVEL, "profile not saved: %s: %s, what was there is unchanged; make "
                                         "room there, or choose another folder", path, why);
    return ERROR_LEVEL;
}

/* Under the lock: puts the bytes where they belong. */
static Level put(const Importer *importer, const char *path, const Profile *ours, const Profile *new) {
    char kept[PATH_SIZE], stem[PATH_SIZE], why[REASON_SIZE] = "", again[REASON_SIZE] = "";
    Profile present;
    StoreResult found = read_profile(path, ours, &present, why);
    bool late = found == STORE_LOADED && !profile_same_history(&present, ours);
    profile_free(&present);
    snprintf(stem, sizeof stem, "%.*s", (int)(strlen(path) - strlen(".pldf")), path);
    if (late && !free_name(stem, "conflict", ".pldf", kept, why)) return not_saved(importer, path, why);
    if (found == STORE_REFUSED && !keep_aside(path, kept, again)) {
        importer_tell(importer, ERROR_LEVEL, "profile not saved: %s: %s; it is left as it was, since it "
                      "cannot be renamed: %s; choose another folder", path, why, again);
        return ERROR_LEVEL;
    }
    const char *place = late ? kept : path;
    if (!disk_replace(place, new->bytes, new->size, why)) return not_saved(importer, place, why);
    if (late)
        importer_tell(importer, WARNING, "%s: changed by another process during this drive and left as "
                      "it is; what this drive learned is kept in %s", path, kept);
    else if (found == STORE_REFUSED)
        importer_tell(importer, WARNING, "%s: not a sound profile; kept as %s, a new one took its place",
                      path, kept);
    return late || found == STORE_REFUSED ? WARNING : INFO;
}

Level store_save(const Importer *importer, const char *folder, const Profile *profile,
                 const Lesson *lesson) {
    char path[PATH_SIZE], why[REASON_SIZE] = "not enough memory";
    Lock lock;
    Profile new = {0};
    Level level = ERROR_LEVEL;
    path_of(folder, profile, path);
    new.bytes = profile_extend(profile, lesson, &new.size);
    if (!new.bytes || !profile_parse(&new, why) || !disk_make_folder(folder, why) ||
        !disk_lock(folder, &lock, why)) { /* nothing is written that cannot be read back */
        importer_tell(importer, ERROR_LEVEL, "profile not saved: %s: %s", path, why);
    } else {
        level = put(importer, path, profile, &new);
        disk_unlock(&lock);
    }
    if (level == INFO)
        importer_tell(importer, INFO, "drive %lld learned from %lld pedal interventions, saved in %s",
                      (long long)new.count, (long long)lesson->interventions, path);
    profile_free(&new);
    return level;
}
