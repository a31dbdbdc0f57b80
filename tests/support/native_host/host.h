/* A simulator without Python, for tests of native FMUs: one small interface to both versions of FMI,
   and jobs that use it. An FMU is described by a text file, see host.c. */
#ifndef HOST_H
#define HOST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define CHECK(truth)                                                                              \
    do {                                                                                          \
        if (!(truth)) {                                                                           \
            fprintf(stderr, "%s:%d: not true: %s\n", __FILE__, __LINE__, #truth);                 \
            exit(1);                                                                              \
        }                                                                                         \
    } while (0)

enum { OK = 0, WARNING = 1, ERROR = 3 }; /* as in both versions of FMI */
enum { MANY = 128, LINE_SIZE = 4096, UNKNOWN = 4000000000u, SEED = 5 };
typedef enum { REAL, INTEGER, ENUMERATION, BOOLEAN, TEXT } Kind;

typedef struct {
    Kind kind;
    uint32_t reference;
} Variable;

typedef struct {
    Variable variable;
    double value;
    char *text;
} Setting;

typedef struct Api Api;
typedef struct {
    const Api *api;
    void *library, *functions; /* of the version, found by name */
    char path[LINE_SIZE], token[64], resources[LINE_SIZE];
    Variable parameters[MANY], inputs[MANY], outputs[MANY];
    Setting settings[MANY]; /* before initialization */
    size_t parameter_count, input_count, output_count, setting_count;
} Fmu;

/* One version of FMI. Those that return int return the FMI status; numbers of all kinds are handed
   over as double, which holds them exactly. */
struct Api {
    const char *version;
    void *(*functions)(const Fmu *); /* looked up by name, to be freed; all of them must be there */
    const char *(*get_version)(const Fmu *);
    void *(*instantiate)(const Fmu *, const char *name, const char *token);
    void (*free)(const Fmu *, void *);
    int (*enter)(const Fmu *, void *, double start_s); /* initialization mode */
    int (*leave)(const Fmu *, void *);
    int (*step)(const Fmu *, void *, double time_s, double step_s);
    int (*terminate)(const Fmu *, void *);
    int (*reset)(const Fmu *, void *);
    int (*get)(const Fmu *, void *, Kind, const uint32_t *, size_t, double *);
    int (*set)(const Fmu *, void *, Kind, const uint32_t *, size_t, const double *);
    int (*set_text)(const Fmu *, void *, uint32_t, const char *);
    int (*get_state)(const Fmu *, void *, void **);
    int (*set_state)(const Fmu *, void *, void *);
    int (*free_state)(const Fmu *, void *, void **);
    int (*state_size)(const Fmu *, void *, void *, size_t *);
    int (*serialize)(const Fmu *, void *, void *, uint8_t *, size_t);
    int (*deserialize)(const Fmu *, void *, const uint8_t *, size_t, void **);
    int (*unsupported)(const Fmu *, void *); /* calls what the FMU says it cannot do: the status */
    bool (*other_kinds_refused)(const Fmu *); /* model exchange and the like */
};

extern const Api fmi2, fmi3;
extern int errors; /* told to a logger since it was last set to 0 */
extern bool tells_warnings; /* on stderr, as errors always are */
void told(int status, const char *text);

Fmu *fmu_open(const char *description);
void fmu_close(Fmu *fmu); /* the library is out of memory then */

void *make(const Fmu *fmu, const char *name);  /* a new instance; its settings are made */
void make_settings(const Fmu *fmu, void *c);
void start(const Fmu *fmu, void *c);           /* initialization */
void *started(const Fmu *fmu, const char *name);
int set_value(const Fmu *fmu, void *c, Variable variable, double value);
int set_inputs(const Fmu *fmu, void *c, const double *values);
int get_outputs(const Fmu *fmu, void *c, double *values);

/* Jobs */
void replay(const Fmu *fmu, const char *script, char **results, int count);
void check(const char *description, const char *other, bool same_model);
void hostile(const Fmu *fmu, long steps, uint32_t seed);
void attempt(const Fmu *fmu);
void forge(const Fmu *fmu);
void reads(const Fmu *fmu, const char *script);
void little_stack(const Fmu *fmu, const char *script, long kilobytes);
uint32_t dice(uint32_t sides);
void senseless_inputs(const Fmu *fmu, double *values);
double senseless_step(void);

#endif
