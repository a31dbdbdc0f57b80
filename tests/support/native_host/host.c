/* The file that describes an FMU has one thing per line: "version 3", "library PATH", "token TOKEN",
   "resources ADDRESS", "parameter KIND REFERENCE", "input ...", "output ...",
   "set KIND REFERENCE VALUE" (a parameter, as text for kind 4). Kinds are numbers as in host.h. */
#include "host.h"

#include <string.h>

#include "library.h"

int errors;
bool tells_warnings;

void told(int status, const char *text) {
    if (status == ERROR) errors++;
    if (status == ERROR || (status && tells_warnings)) fprintf(stderr, "%s\n", text);
}

static void read_variable(Variable *list, size_t *count, const char *value) {
    int kind = 0;
    CHECK(*count < MANY && sscanf(value, "%d %u", &kind, &list[*count].reference) == 2);
    list[(*count)++].kind = (Kind)kind;
}

static void read_setting(Fmu *fmu, const char *value) {
    Setting *one = &fmu->settings[fmu->setting_count];
    size_t count = 0;
    int at = 0;
    CHECK(fmu->setting_count++ < MANY);
    read_variable(&one->variable, &count, value);
    sscanf(value, "%*d %*u %n", &at);
    if (one->variable.kind == TEXT) CHECK((one->text = strdup(value + at)) != NULL);
    else one->value = atof(value + at);
}

static void read_item(Fmu *fmu, const char *item, const char *value) {
    if (!strcmp(item, "version")) fmu->api = *value == '2' ? &fmi2 : &fmi3;
    else if (!strcmp(item, "library")) snprintf(fmu->path, sizeof fmu->path, "%s", value);
    else if (!strcmp(item, "token")) snprintf(fmu->token, sizeof fmu->token, "%s", value);
    else if (!strcmp(item, "resources")) snprintf(fmu->resources, sizeof fmu->resources, "%s", value);
    else if (!strcmp(item, "parameter")) read_variable(fmu->parameters, &fmu->parameter_count, value);
    else if (!strcmp(item, "input")) read_variable(fmu->inputs, &fmu->input_count, value);
    else if (!strcmp(item, "output")) read_variable(fmu->outputs, &fmu->output_count, value);
    else if (!strcmp(item, "set")) read_setting(fmu, value);
    else CHECK(!"a known item");
}

Fmu *fmu_open(const char *description) {
    char line[LINE_SIZE];
    Fmu *fmu = calloc(1, sizeof *fmu);
    FILE *file = fopen(description, "rb");
    CHECK(fmu && file);
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\r\n")] = 0;
        char *space = strchr(line, ' ');
        CHECK(space);
        *space = 0;
        read_item(fmu, line, space + 1);
    }
    fclose(file);
    CHECK(!library_is_open(fmu->path));
    CHECK((fmu->library = library_open(fmu->path)) != NULL);
    fmu->functions = fmu->api->functions(fmu);
    CHECK(!strcmp(fmu->api->get_version(fmu), fmu->api->version));
    return fmu;
}

void fmu_close(Fmu *fmu) {
    library_close(fmu->library);
    CHECK(!library_is_open(fmu->path));
    for (size_t i = 0; i < fmu->setting_count; i++) free(fmu->settings[i].text);
    free(fmu->functions);
    free(fmu);
}

void make_settings(const Fmu *fmu, void *c) {
    for (size_t i = 0; i < fmu->setting_count; i++) {
        const Setting *one = &fmu->settings[i];
        if (one->variable.kind == TEXT)
            CHECK(fmu->api->set_text(fmu, c, one->variable.reference, one->text) == OK);
        else CHECK(set_value(fmu, c, one->variable, one->value) == OK);
    }
}

void *make(const Fmu *fmu, const char *name) {
    void *c = fmu->api->instantiate(fmu, name, fmu->token);
    CHECK(c);
    make_settings(fmu, c);
    return c;
}

void start(const Fmu *fmu, void *c) {
    CHECK(fmu->api->enter(fmu, c, 0.0) == OK);
    CHECK(fmu->api->leave(fmu, c) == OK);
}

void *started(const Fmu *fmu, const char *name) {
    void *c = make(fmu, name);
    start(fmu, c);
    return c;
}

int set_value(const Fmu *fmu, void *c, Variable variable, double value) {
    return fmu->api->set(fmu, c, variable.kind, &variable.reference, 1, &value);
}

int set_inputs(const Fmu *fmu, void *c, const double *values) {
    for (Kind kind = REAL; kind < TEXT; kind++) {
        uint32_t references[MANY];
        double chosen[MANY];
        size_t count = 0;
        for (size_t i = 0; i < fmu->input_count; i++)
            if (fmu->inputs[i].kind == kind) {
                references[count] = fmu->inputs[i].reference;
                chosen[count++] = values[i];
            }
        int status = count ? fmu->api->set(fmu, c, kind, references, count, chosen) : OK;
        if (status != OK) return status;
    }
    return OK;
}

int get_outputs(const Fmu *fmu, void *c, double *values) {
    for (Kind kind = REAL; kind < TEXT; kind++) {
        uint32_t references[MANY];
        double found[MANY];
        size_t count = 0, next = 0;
        for (size_t i = 0; i < fmu->output_count; i++)
            if (fmu->outputs[i].kind == kind) references[count++] = fmu->outputs[i].reference;
        int status = count ? fmu->api->get(fmu, c, kind, references, count, found) : OK;
        if (status != OK) return status;
        for (size_t i = 0; i < fmu->output_count; i++)
            if (fmu->outputs[i].kind == kind) values[i] = found[next++];
    }
    return OK;
}
