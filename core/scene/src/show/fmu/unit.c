
/* A unit of a simulation: the step above, with the values that another program sets and reads. */
#include <stdlib.h>
#include <string.h>

enum {
    STAGES = STAGE_COUNT,
    FIRST_START = 1 + @PARAMETERS,
    FIRST_OUTPUT = FIRST_START + @ENTRIES + @N,
    ATTITUDE = FIRST_OUTPUT,
    MOMENTUM = ATTITUDE + @ENTRIES,
    VELOCITY = MOMENTUM + @N,
    ENERGY = VELOCITY + @N,
    VALUES = ENERGY + 1
};
typedef enum { MADE, BEGINS, RUNS, ENDED } Phase;
typedef enum { DONE, REFUSED, WRONG } Answer;

static const double unit_step = STEP_SIZE, unit_gamma[STAGES] = {GAMMAS}, unit_values[FIRST_OUTPUT] = {START_VALUES};

/* Values: the time, the parameters, attitude and velocity or momentum at the start; then attitude, momentum, velocity, energy. */
typedef struct {
    double values[VALUES];
    $stepper stages[STAGES];
    $state state;
    Phase phase;
    int is_changed;
} Unit;

static void unit_reset(Unit *unit) {
    memset(unit, 0, sizeof *unit);
    memcpy(unit->values, unit_values, sizeof unit_values);
}

static Unit *unit_made(void) {
    Unit *unit = malloc(sizeof *unit);
    if (unit) unit_reset(unit);
    return unit;
}

static void unit_show(Unit *unit) {
    double *values = unit->values;
    memcpy(values + ATTITUDE, unit->state.attitude, sizeof unit->state.attitude);
    memcpy(values + MOMENTUM, unit->state.momentum, sizeof unit->state.momentum);
    $velocity(unit->stages, unit->state.attitude, unit->state.momentum, values + VELOCITY);
    values[ENERGY] = $energy(unit->stages, &unit->state);
}

/* The start, from the values of now. */
static Answer unit_begin(Unit *unit) {
    const double *attitude = unit->values + FIRST_START, *given = attitude + @ENTRIES;
    double momentum[@N], velocity[@N];
    for (int k = 0; k < STAGES; k++) {
        if (!$make(unit->stages + k, unit->values + 1, unit_step * unit_gamma[k])) return WRONG;
    }
    memcpy(momentum, given, sizeof momentum);
    if (!IS_BY_MOMENTUM) $momentum(unit->stages, attitude, given, momentum);
    $velocity(unit->stages, attitude, momentum, velocity);
    $start(unit->stages, &unit->state, attitude, momentum, velocity);
    if (!($defect(&unit->state) <= 1e4 * @EPSILON)) return WRONG;
    unit->is_changed = 0;
    unit_show(unit);
    return DONE;
}

/* Other parameters between two steps. */
static Answer unit_give(Unit *unit) {
    if (!$give(unit->stages, &unit->state, unit->values + 1)) return REFUSED;
    for (int k = 1; k < STAGES; k++) {
        if (!$make(unit->stages + k, unit->values + 1, unit_step * unit_gamma[k])) return REFUSED;
    }
    unit->is_changed = 0;
    return DONE;
}

/* A whole number of steps, or none: where one is refused, or where a length is no whole number of steps, nothing moves. */
static Answer unit_move(Unit *unit, double time, double length) {
    const double ratio = length / unit_step, count = floor(ratio + 0.5);
    Unit next;
    if (unit->phase != RUNS) return WRONG;
    if (!(count >= 1.0 && count < 1e9) || fabs(ratio - count) > 1e-6 * count) return WRONG;
    memcpy(&next, unit, sizeof next);
    if (next.is_changed && unit_give(&next) != DONE) return REFUSED;
    for (double k = 0.0; k < count; k++) {
        if (!(UNIT_ADVANCES)) return REFUSED;
    }
    next.values[0] = time + length;
    unit_show(&next);
    memcpy(unit, &next, sizeof next);
    return DONE;
}

/* Sets or reads values; a value that follows from others isn't set, and one of the start not after it. */
static Answer unit_values_move(Unit *unit, size_t first, size_t count, double *values, int is_set) {
    if (first >= VALUES || count > VALUES - first) return WRONG;
    if (!is_set) {
        if (unit->phase < RUNS && unit_begin(unit) != DONE) return WRONG;
        memcpy(values, unit->values + first, count * sizeof *values);
        return DONE;
    }
    if (first < 1 || first + count > (size_t)(unit->phase < RUNS ? FIRST_OUTPUT : FIRST_START)) return WRONG;
    for (size_t k = 0; k < count; k++) {
        if (!isfinite(values[k])) return WRONG;
    }
    memcpy(unit->values + first, values, count * sizeof *values);
    unit->is_changed = 1;
    return DONE;
}
