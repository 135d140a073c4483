
/* The functions of FMI 2.0 for co-simulation. */
#include <stddef.h>

#if defined(_WIN32)
#define PUBLIC __declspec(dllexport)
#else
#define PUBLIC
#endif

typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef void *fmi2Component, *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef int fmi2Boolean, fmi2Integer;
typedef double fmi2Real;
typedef const char *fmi2String;

static fmi2Status status_of(Answer answer) { return answer == DONE ? fmi2OK : answer == REFUSED ? fmi2Discard : fmi2Error; }

PUBLIC const char *fmi2GetTypesPlatform(void) { return "default"; }
PUBLIC const char *fmi2GetVersion(void) { return "2.0"; }

PUBLIC fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String names[]) {
    (void)c, (void)on, (void)n, (void)names;
    return fmi2OK;
}

PUBLIC fmi2Component fmi2Instantiate(fmi2String name, int type, fmi2String token, fmi2String path, const void *functions, fmi2Boolean visible,
                              fmi2Boolean logs) {
    (void)name, (void)path, (void)functions, (void)visible, (void)logs;
    return type == 1 && token && !strcmp(token, "TOKEN") ? unit_made() : NULL;
}

PUBLIC void fmi2FreeInstance(fmi2Component c) { free(c); }

PUBLIC fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start, fmi2Boolean has_stop,
                               fmi2Real stop) {
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    ((Unit *)c)->values[0] = start;
    return fmi2OK;
}

PUBLIC fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    Unit *unit = c;
    if (unit->phase != MADE) return fmi2Error;
    unit->phase = BEGINS;
    return fmi2OK;
}

PUBLIC fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    Unit *unit = c;
    if (unit->phase != BEGINS || unit_begin(unit) != DONE) return fmi2Error;
    unit->phase = RUNS;
    return fmi2OK;
}

PUBLIC fmi2Status fmi2Terminate(fmi2Component c) {
    ((Unit *)c)->phase = ENDED;
    return fmi2OK;
}

PUBLIC fmi2Status fmi2Reset(fmi2Component c) {
    unit_reset(c);
    return fmi2OK;
}

PUBLIC fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real length, fmi2Boolean keeps) {
    (void)keeps;
    return status_of(unit_move(c, time, length));
}

PUBLIC fmi2Status fmi2CancelStep(fmi2Component c) {
    (void)c;
    return fmi2Error;
}

PUBLIC fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Real v[]) {
    for (size_t k = 0; k < n; k++) {
        if (unit_values_move(c, r[k], 1, v + k, 0) != DONE) return fmi2Error;
    }
    return fmi2OK;
}

PUBLIC fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Real v[]) {
    for (size_t k = 0; k < n; k++) {
        if (unit_values_move(c, r[k], 1, (double *)v + k, 1) != DONE) return fmi2Error;
    }
    return fmi2OK;
}

PUBLIC fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) {
    if (!*state) *state = malloc(sizeof(Unit));
    if (!*state) return fmi2Error;
    memcpy(*state, c, sizeof(Unit));
    return fmi2OK;
}

PUBLIC fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
    memcpy(c, state, sizeof(Unit));
    return fmi2OK;
}

PUBLIC fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) {
    (void)c;
    free(*state);
    *state = NULL;
    return fmi2OK;
}

PUBLIC fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) {
    (void)c, (void)state;
    *size = sizeof(Unit);
    return fmi2OK;
}

PUBLIC fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, char bytes[], size_t size) {
    (void)c;
    if (size < sizeof(Unit)) return fmi2Error;
    memcpy(bytes, state, sizeof(Unit));
    return fmi2OK;
}

PUBLIC fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const char bytes[], size_t size, fmi2FMUstate *state) {
    (void)c;
    if (size != sizeof(Unit) || !(*state = malloc(sizeof(Unit)))) return fmi2Error;
    memcpy(*state, bytes, sizeof(Unit));
    return fmi2OK;
}

/* Functions without a meaning here. Nothing has values of other types, and no step is left pending. */
#define OF_TYPE(Name, type)                                                                                             \
    PUBLIC fmi2Status fmi2Get##Name(fmi2Component c, const fmi2ValueReference r[], size_t n, type v[]) {                \
        (void)c, (void)r, (void)v;                                                                                      \
        return n ? fmi2Error : fmi2OK;                                                                                  \
    }                                                                                                                   \
    PUBLIC fmi2Status fmi2Set##Name(fmi2Component c, const fmi2ValueReference r[], size_t n, const type v[]) {          \
        (void)c, (void)r, (void)v;                                                                                      \
        return n ? fmi2Error : fmi2OK;                                                                                  \
    }
OF_TYPE(Integer, fmi2Integer)
OF_TYPE(Boolean, fmi2Boolean)
OF_TYPE(String, fmi2String)

#define REFUSES(Name) PUBLIC fmi2Status fmi2##Name(fmi2Component c) { (void)c; return fmi2Error; }
REFUSES(GetDirectionalDerivative)
REFUSES(SetRealInputDerivatives)
REFUSES(GetRealOutputDerivatives)

#define STATUS(Name, type) PUBLIC fmi2Status fmi2Get##Name(fmi2Component c, int kind, type *value) { (void)c, (void)kind, (void)value; return fmi2Discard; }
STATUS(Status, fmi2Status)
STATUS(RealStatus, fmi2Real)
STATUS(IntegerStatus, fmi2Integer)
STATUS(BooleanStatus, fmi2Boolean)
STATUS(StringStatus, fmi2String)
