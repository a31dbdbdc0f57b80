#include "store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KEPT_MAX = 9999, LOCK_PATIENCE_MS = 10000 };

typedef struct { /* of a profile; of what a link leads to, if there is one in its place */
    char path[PATH_SIZE], folder[PATH_SIZE];
} Place;

static Place place_of(const char *folder, const Profile *wanted) {
    Place place;
    snprintf(place.path, PATH_SIZE, "%s/driver-%06lld_route-%s.pldf", folder,
             (long long)wanted->driver, wanted->route);
    os_follow(place.path);
    snprintf(place.folder, PATH_SIZE, "%s", place.path);
    disk_parent(place.folder);
    return place;
}

void profile_free(Profile *profile) {
    free(profile->bytes);
    profile->bytes = NULL;
}

/* Reads the file into `found`; REFUSED with the reason if it is not the profile that is wanted. */
static StoreResult read_profile(const char *path, const Profile *wanted, Profile *found, char *why) {
    memset(found, 0, sizeof *found);
    switch (disk_read(path, "PLDF-PROFILE ", &found->bytes, &found->size, why)) {
    case READ_ABSENT: return STORE_ABSENT;
    case READ_UNUSABLE: return STORE_REFUSED;
    case READ_FAILED: return STORE_UNREADABLE;
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

/* A file in the place of the folder means that nothing can ever be saved. */
static bool can_be_folder(const Importer *importer, const char *folder) {
    char part[PATH_SIZE];
    disk_nearest(folder, part);
    if (os_entry(part) != OTHER_ENTRY) return true;
    importer_tell(importer, WARNING, "%s: not a folder; choose another profile store", part);
    return false;
}

bool store_writable(const Importer *importer, const char *folder) {
    char part[PATH_SIZE], why[REASON_SIZE];
    if (disk_writable(folder, part, why)) return true;
    importer_tell(importer, WARNING, "what this drive teaches cannot be saved: %s: cannot be written "
                      "to (%s); make it writable, or choose another profile store", part, why);
    return false;
}

/* Under the lock: somebody may have dealt with it meanwhile. */
static StoreResult put_aside(const Place *place, Profile *found, char *kept, char *why, char *again) {
    Lock lock;
    kept[0] = 0;
    if (disk_lock(place->folder, LOCK_PATIENCE_MS, &lock, again) != LOCK_DONE) return STORE_REFUSED;
    Profile wanted = *found;
    StoreResult result = read_profile(place->path, &wanted, found, why);
    if (result == STORE_REFUSED && !(free_name(place->path, "refused", "", kept, again) &&
                                     disk_rename(place->path, kept, again)))
        kept[0] = 0;
    disk_unlock(&lock);
    return result;
}

static void tell_not_used(const Importer *importer, StoreResult result, const char *path, const char *why,
                          const char *kept, const char *again) {
    if (result == STORE_UNREADABLE)
        importer_tell(importer, WARNING, "%s: cannot be read now (%s); it is left as it is; the drive "
                      "goes on with the base profile, and what it teaches is kept in a file of its own",
                      path, why);
    else if (result == STORE_REFUSED)
        importer_tell(importer, WARNING, "%s: %s; %s%s%s; the drive goes on with the base profile", path,
                      why, *kept ? "kept as " : "left in its place (", *kept ? kept : again,
                      *kept ? "" : ")");
}

StoreResult store_load(const Importer *importer, const char *folder, Profile *profile) {
    char kept[PATH_SIZE] = "", why[REASON_SIZE] = "", again[REASON_SIZE] = "";
    Profile found;
    if (!can_be_folder(importer, folder)) return STORE_NO_FOLDER;
    Place place = place_of(folder, profile);
    StoreResult result = read_profile(place.path, profile, &found, why);
    if (result == STORE_REFUSED) {
        found = *profile;
        result = put_aside(&place, &found, kept, why, again);
    }
    if (result == STORE_LOADED) *profile = found;
    tell_not_used(importer, result, place.path, why, kept, again);
    return result;
}

static Level not_saved(const Importer *importer, const char *path, const char *why) {
    importer_tell(importer, ERROR_LEVEL, "profile not saved: %s: %s, what was there is unchanged; make "
                                         "room there, or choose another folder", path, why);
    return ERROR_LEVEL;
}

/* What was learned, beside a profile that it does not continue or that cannot be read now. */
static Level put_beside(const Importer *importer, const char *path, const Profile *new, const char *how) {
    char kept[PATH_SIZE], stem[PATH_SIZE], why[REASON_SIZE] = "";
    size_t length = strlen(path), end = strlen(".pldf"); /* which a link's file need not have */
    bool named = length > end && strcmp(path + length - end, ".pldf") == 0;
    snprintf(stem, sizeof stem, "%.*s", (int)(named ? length - end : length), path);
    if (!free_name(stem, "conflict", ".pldf", kept, why)) return not_saved(importer, path, why);
    if (!disk_replace(kept, new->bytes, new->size, NULL, why)) return not_saved(importer, kept, why);
    importer_tell(importer, WARNING, "%s: %s and left as it is; what was learned is kept in %s", path, how,
                  kept);
    return WARNING;
}

static Level put_in_place_of_bad(const Importer *importer, const char *path, const Profile *new,
                                 const char *reason) {
    char kept[PATH_SIZE], why[REASON_SIZE] = "";
    if (!free_name(path, "refused", "", kept, why)) return not_saved(importer, path, why);
    if (!disk_replace(path, new->bytes, new->size, kept, why)) {
        if (os_entry(kept) == NO_ENTRY) return not_saved(importer, path, why);
        importer_tell(importer, ERROR_LEVEL, "profile not saved: %s: %s; what was there is now %s", path,
                      why, kept);
        return ERROR_LEVEL;
    }
    importer_tell(importer, WARNING, "%s: %s; kept as %s, a new profile took its place", path, reason, kept);
    return WARNING;
}

/* Under the lock: puts the bytes where they belong. */
static Level put(const Importer *importer, const char *path, const Profile *ours, const Profile *new) {
    char why[REASON_SIZE] = "", how[REASON_SIZE + 32];
    Profile present;
    StoreResult found = read_profile(path, ours, &present, why);
    bool late = found == STORE_LOADED && !profile_same_history(&present, ours);
    profile_free(&present);
    snprintf(how, sizeof how, "cannot be read now (%s)", why);
    if (late) return put_beside(importer, path, new, "changed by another process meanwhile");
    if (found == STORE_UNREADABLE) return put_beside(importer, path, new, how);
    if (found == STORE_REFUSED) return put_in_place_of_bad(importer, path, new, why);
    return disk_replace(path, new->bytes, new->size, NULL, why) ? INFO : not_saved(importer, path, why);
}

Level store_save(const Importer *importer, const char *folder, const Profile *profile,
                 const Profile *new, const char *what, const char *why) {
    char reason[REASON_SIZE] = "";
    Lock lock;
    Level level = ERROR_LEVEL;
    Place place = place_of(folder, profile);
    if (why || !disk_make_folder(place.folder, reason) ||
        disk_lock(place.folder, LOCK_PATIENCE_MS, &lock, reason) != LOCK_DONE) {
        importer_tell(importer, ERROR_LEVEL, "profile not saved: %s: %s", place.path, why ? why : reason);
    } else {
        level = put(importer, place.path, profile, new);
        disk_unlock(&lock);
    }
    if (level == INFO) importer_tell(importer, INFO, "%s, saved in %s", what, place.path);
    return level;
}
