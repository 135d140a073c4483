
/* The functions of FMI 3.0 for co-simulation. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define PUBLIC __declspec(dllexport)
#else
#define PUBLIC
#endif

typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef void *fmi3Instance, *fmi3FMUState, *fmi3InstanceEnvironment, *fmi3Clock;
typedef uint32_t fmi3ValueReference;
typedef const char *fmi3String;
typedef const uint8_t *fmi3Binary;

static fmi3Status status_of(Answer answer) { return answer == DONE ? fmi3OK : answer == REFUSED ? fmi3Discard : fmi3Error; }

/* The number of values of a variable, which has the place of its first for a reference. */
static size_t length_of(fmi3ValueReference reference) {
    static const size_t places[] = {PLACES VALUES};
    for (size_t k = 0; places[k] < VALUES; k++) {
        if (places[k] == reference) return places[k + 1] - places[k];
    }
    return 0;
}

PUBLIC fmi3String fmi3GetVersion(void) { return "3.0"; }

PUBLIC fmi3Status fmi3SetDebugLogging(fmi3Instance i, bool on, size_t n, const fmi3String names[]) {
    (void)i, (void)on, (void)n, (void)names;
    return fmi3OK;
}

PUBLIC fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String path, bool visible, bool logs, bool events, bool early,
    const fmi3ValueReference required[], size_t n, fmi3InstanceEnvironment environment, void *log, void *update) {
    (void)name, (void)path, (void)visible, (void)logs, (void)early, (void)required, (void)n, (void)environment;
    (void)log, (void)update;
    if (events || !token || strcmp(token, "TOKEN")) return NULL;
    return unit_made();
}

PUBLIC fmi3Instance fmi3InstantiateModelExchange(void) { return NULL; }
PUBLIC fmi3Instance fmi3InstantiateScheduledExecution(void) { return NULL; }
PUBLIC void fmi3FreeInstance(fmi3Instance i) { free(i); }

PUBLIC fmi3Status fmi3EnterInitializationMode(fmi3Instance i, bool has_tolerance, double tolerance, double start, bool has_stop,
                                              double stop) {
    Unit *unit = i;
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    if (unit->phase != MADE) return fmi3Error;
    unit->values[0] = start;
    unit->phase = BEGINS;
    return fmi3OK;
}

PUBLIC fmi3Status fmi3ExitInitializationMode(fmi3Instance i) {
    Unit *unit = i;
    if (unit->phase != BEGINS || unit_begin(unit) != DONE) return fmi3Error;
    unit->phase = RUNS;
    return fmi3OK;
}

PUBLIC fmi3Status fmi3Terminate(fmi3Instance i) {
    ((Unit *)i)->phase = ENDED;
    return fmi3OK;
}

PUBLIC fmi3Status fmi3Reset(fmi3Instance i) {
    unit_reset(i);
    return fmi3OK;
}

PUBLIC fmi3Status fmi3DoStep(fmi3Instance i, double time, double length, bool keeps, bool *event, bool *ends, bool *early, double *last) {
    const Answer answer = unit_move(i, time, length);
    (void)keeps;
    *event = *ends = *early = false;
    *last = answer == DONE ? time + length : time;
    return status_of(answer);
}

static fmi3Status moved(Unit *unit, const fmi3ValueReference r[], size_t n, double v[], size_t m, int is_set) {
    size_t sum = 0;
    for (size_t k = 0; k < n; k++) {
        const size_t length = length_of(r[k]);
        if (!length || sum + length > m || unit_values_move(unit, r[k], length, v + sum, is_set) != DONE) return fmi3Error;
        sum += length;
    }
    return sum == m ? fmi3OK : fmi3Error;
}

PUBLIC fmi3Status fmi3GetFloat64(fmi3Instance i, const fmi3ValueReference r[], size_t n, double v[], size_t m) {
    return moved(i, r, n, v, m, 0);
}

PUBLIC fmi3Status fmi3SetFloat64(fmi3Instance i, const fmi3ValueReference r[], size_t n, const double v[], size_t m) {
    return moved(i, r, n, (double *)v, m, 1);
}

PUBLIC fmi3Status fmi3GetFMUState(fmi3Instance i, fmi3FMUState *state) {
    if (!*state) *state = malloc(sizeof(Unit));
    if (!*state) return fmi3Error;
    memcpy(*state, i, sizeof(Unit));
    return fmi3OK;
}

PUBLIC fmi3Status fmi3SetFMUState(fmi3Instance i, fmi3FMUState state) {
    memcpy(i, state, sizeof(Unit));
    return fmi3OK;
}

PUBLIC fmi3Status fmi3FreeFMUState(fmi3Instance i, fmi3FMUState *state) {
    (void)i;
    free(*state);
    *state = NULL;
    return fmi3OK;
}

PUBLIC fmi3Status fmi3SerializedFMUStateSize(fmi3Instance i, fmi3FMUState state, size_t *size) {
    (void)i, (void)state;
    *size = sizeof(Unit);
    return fmi3OK;
}

PUBLIC fmi3Status fmi3SerializeFMUState(fmi3Instance i, fmi3FMUState state, uint8_t bytes[], size_t size) {
    (void)i;
    if (size < sizeof(Unit)) return fmi3Error;
    memcpy(bytes, state, sizeof(Unit));
    return fmi3OK;
}

PUBLIC fmi3Status fmi3DeserializeFMUState(fmi3Instance i, const uint8_t bytes[], size_t size, fmi3FMUState *state) {
    (void)i;
    if (size != sizeof(Unit) || !(*state = malloc(sizeof(Unit)))) return fmi3Error;
    memcpy(*state, bytes, sizeof(Unit));
    return fmi3OK;
}

/* Functions without a meaning here. Nothing has values of other types. */
#define OF_TYPE(Name, type)                                                                                               \
    PUBLIC fmi3Status fmi3Get##Name(fmi3Instance i, const fmi3ValueReference r[], size_t n, type v[], size_t m) {         \
        (void)i, (void)r, (void)v;                                                                                        \
        return n || m ? fmi3Error : fmi3OK;                                                                               \
    }                                                                                                                     \
    PUBLIC fmi3Status fmi3Set##Name(fmi3Instance i, const fmi3ValueReference r[], size_t n, const type v[], size_t m) {   \
        (void)i, (void)r, (void)v;                                                                                        \
        return n || m ? fmi3Error : fmi3OK;                                                                               \
    }
OF_TYPE(Float32, float)
OF_TYPE(Int8, int8_t)
OF_TYPE(UInt8, uint8_t)
OF_TYPE(Int16, int16_t)
OF_TYPE(UInt16, uint16_t)
OF_TYPE(Int32, int32_t)
OF_TYPE(UInt32, uint32_t)
OF_TYPE(Int64, int64_t)
OF_TYPE(UInt64, uint64_t)
OF_TYPE(Boolean, bool)
OF_TYPE(String, fmi3String)
OF_TYPE(Clock, fmi3Clock)

#define REFUSES(Name) PUBLIC fmi3Status fmi3##Name(fmi3Instance i) { (void)i; return fmi3Error; }
REFUSES(GetBinary)
REFUSES(SetBinary)
REFUSES(GetNumberOfVariableDependencies)
REFUSES(GetVariableDependencies)
REFUSES(GetDirectionalDerivative)
REFUSES(GetAdjointDerivative)
REFUSES(EnterConfigurationMode)
REFUSES(ExitConfigurationMode)
REFUSES(EnterEventMode)
REFUSES(EnterContinuousTimeMode)
REFUSES(EnterStepMode)
REFUSES(GetIntervalDecimal)
REFUSES(GetIntervalFraction)
REFUSES(GetShiftDecimal)
REFUSES(GetShiftFraction)
REFUSES(SetIntervalDecimal)
REFUSES(SetIntervalFraction)
REFUSES(SetShiftDecimal)
REFUSES(SetShiftFraction)
REFUSES(EvaluateDiscreteStates)
REFUSES(UpdateDiscreteStates)
REFUSES(CompletedIntegratorStep)
REFUSES(SetTime)
REFUSES(SetContinuousStates)
REFUSES(GetContinuousStateDerivatives)
REFUSES(GetEventIndicators)
REFUSES(GetContinuousStates)
REFUSES(GetNominalsOfContinuousStates)
REFUSES(GetNumberOfEventIndicators)
REFUSES(GetNumberOfContinuousStates)
REFUSES(GetOutputDerivatives)
REFUSES(ActivateModelPartition)
