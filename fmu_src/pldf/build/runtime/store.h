/* As pldf/store.py: a folder with one profile file per driver and route. */
#pragma once

#include "profile.h"

enum { MESSAGE_SIZE = 3 * PATH_SIZE };
typedef enum { INFO = 0, WARNING = 1, ERROR_LEVEL = 3 } Level; /* numbers of FMI's status */
typedef enum { STORE_ABSENT, STORE_LOADED, STORE_REFUSED } StoreResult;

/* Fill `profile`, whose driver, route and nodes say what is wanted. A file that cannot be used is
   renamed; `message` then says why. */
StoreResult store_load(const char *folder, Profile *profile, char *message);
/* Save `profile`, as it was loaded for this drive, with one iteration more; `message` tells how. */
Level store_save(const char *folder, const Profile *profile, const Lesson *lesson, char *message);
void profile_free(Profile *profile);
