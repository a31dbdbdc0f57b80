/* As pldf/profiles/store.py: a folder with one profile file per driver and route. */
#pragma once

#include "importer.h"
#include "profile.h"

/* What is UNREADABLE may be sound, and cannot be read now: nobody touches it. */
typedef enum { STORE_ABSENT, STORE_LOADED, STORE_REFUSED, STORE_UNREADABLE, STORE_NO_FOLDER } StoreResult;

/* Fill `profile`, whose driver, route and nodes say what is wanted. A file that was read and cannot be
   used is renamed, and the importer told. */
StoreResult store_load(const Importer *importer, const char *folder, Profile *profile);
/* Save `new`, which continues `profile` as it was loaded for this drive, and tell `what` it is; `why`
   it could not be made, or NULL. The level of what the importer was told. */
Level store_save(const Importer *importer, const char *folder, const Profile *profile,
                 const Profile *new, const char *what, const char *why);
/* Tries to write in the folder, or where it would be made, without leaving anything; else tells. */
bool store_writable(const Importer *importer, const char *folder);
/* Tells of a profile of this driver that was probably learned on an older reading of the road whose
   base profile is `base`, if there is one (older.c). */
void store_tell_older(const Importer *importer, const char *folder, const Profile *wanted,
                      const double *base);
void profile_free(Profile *profile);
