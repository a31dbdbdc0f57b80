/* What an instance knows of its importer: where messages go, and where the resources are. Everything
   else stands on this. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "model.h"
#include "os.h"

enum { MESSAGE_SIZE = 3 * PATH_SIZE };

typedef struct Importer Importer;
struct Importer { /* its logger, as it came, and the function that calls it by this version of FMI */
    void (*tell)(const Importer *importer, Level level, const char *category, const char *text);
    void (*logger)(void);
    void *environment;
    const char *doubled; /* characters that mean something else in its messages */
    const char *name;    /* of the instance */
    bool events;         /* tell INFO messages too */
    char resources[PATH_SIZE];
};

/* Returns whether it was no error. */
bool importer_tell(const Importer *importer, Level level, const char *format, ...);
bool importer_log(Importer *importer, bool on, size_t count, const char *const categories[]);
/* Of file:///p, file:////p, file:/p, file://C:/p, or plain; with a slash at the end; with %20. It
   stays empty if it is too long. */
void importer_set_resources(Importer *importer, const char *address);
/* Where a file of the resources is: in the importer's folder or, if it is not there, in that of the
   archive which this library was unpacked from; then the importer is told. False: there is no folder. */
bool importer_resource(const Importer *importer, const char *name, char *path, size_t size);
