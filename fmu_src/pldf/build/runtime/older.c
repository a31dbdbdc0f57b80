/* As pldf/profiles/older_reading.py: was a profile learned on an older reading of this road? */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "store.h"

typedef struct { /* what is looked for, and the likeliest so far */
    const char *folder;
    const Profile *wanted;
    const double *base;
    char begin[32], path[PATH_SIZE];
    int64_t alike, nodes;
} Search;

static bool is_profile_of_driver(const Search *search, const char *name) {
    size_t length = strlen(name), end = strlen(".pldf");
    return strncmp(name, search->begin, strlen(search->begin)) == 0 && length > end &&
           strcmp(name + length - end, ".pldf") == 0 && !strstr(name, ".conflict-");
}

static int64_t nodes_alike(const double *older, const double *base, int64_t nodes) {
    int64_t count = 0;
    for (int64_t i = 0; i < nodes; i++) count += fabs(older[i] - base[i]) <= ALIKE_MPS;
    return count;
}

/* The same road has about the same length, and most of the base profile is as before. */
static void judge(Search *search, const Profile *found, const char *path) {
    int64_t nodes = search->wanted->nodes, others = found->nodes;
    if (found->driver != search->wanted->driver || !strcmp(found->route, search->wanted->route) ||
        !found->count || (double)llabs(nodes - others) > LENGTH_SHARE * (double)nodes)
        return;
    int64_t both = nodes < others ? nodes : others;
    int64_t alike = nodes_alike(profile_newest(found, COLUMN_BASE), search->base, both);
    bool better = alike > search->alike || (alike == search->alike && strcmp(path, search->path) < 0);
    if ((double)alike < ALIKE_SHARE * (double)both || !better) return;
    search->alike = alike;
    search->nodes = both;
    snprintf(search->path, PATH_SIZE, "%s", path);
}

/* What cannot be read now, or is not sound, is passed over: its own drive tells of it. */
static void look_at(void *context, const char *name) {
    Search *search = context;
    Profile found = {0};
    char path[PATH_SIZE], why[REASON_SIZE];
    if (!is_profile_of_driver(search, name)) return;
    if (snprintf(path, sizeof path, "%s/%s", search->folder, name) >= PATH_SIZE) return;
    if (disk_read(path, "PLDF-PROFILE ", &found.bytes, &found.size, why) == READ_DONE &&
        profile_parse(&found, why))
        judge(search, &found, path);
    profile_free(&found);
}

void store_tell_older(const Importer *importer, const char *folder, const Profile *wanted,
                      const double *base) {
    Search search = {.folder = folder, .wanted = wanted, .base = base};
    snprintf(search.begin, sizeof search.begin, "driver-%06lld_route-", (long long)wanted->driver);
    os_each_name(folder, look_at, &search);
    if (search.path[0])
        importer_tell(importer, WARNING, TEXT_OLDER_READING, search.path,
                      (int)(100 * search.alike / search.nodes), search.path);
}
