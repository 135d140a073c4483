
PLAIN /* Number k of member i is at k * members + i. A state has @ROWS numbers: attitude, momentum, advected, history, guess. */
PLAIN enum { @ROWS = @ENTRIES + @N + @ADVECTED + 3 * @N };
COMPENSATED /* Number k of member i is at k * members + i. A state has @ROWS numbers: attitude, momentum, advected, history, guess, errors. */
COMPENSATED enum { @ROWS = @ENTRIES + @N + @ADVECTED + 3 * @N + @CHANGES };

FUNCTION void $load(LIESTEP_GLOBAL const double *rows, COUNT members, COUNT i, double *to, int count) {
    for (int k = 0; k < count; k++) to[k] = rows[k * members + i];
}

FUNCTION void $store(LIESTEP_GLOBAL double *rows, COUNT members, COUNT i, const double *from, int count) {
    for (int k = 0; k < count; k++) rows[k * members + i] = from[k];
}

FUNCTION void $load_state(LIESTEP_GLOBAL const double *rows, COUNT members, COUNT i, $state *state) {
    $load(rows, members, i, state->attitude, @ENTRIES);
    $load(rows + @ENTRIES * members, members, i, state->momentum, @N);
    $load(rows + (@ENTRIES + @N) * members, members, i, state->advected, @ADVECTED);
    $load(rows + (@ENTRIES + @N + @ADVECTED) * members, members, i, state->history, 2 * @N);
    $load(rows + (@ENTRIES + 3 * @N + @ADVECTED) * members, members, i, state->guess, @N);
COMPENSATED     $load(rows + (@ENTRIES + 4 * @N + @ADVECTED) * members, members, i, state->errors, @CHANGES);
}

FUNCTION void $store_state(LIESTEP_GLOBAL double *rows, COUNT members, COUNT i, const $state *state) {
    $store(rows, members, i, state->attitude, @ENTRIES);
    $store(rows + @ENTRIES * members, members, i, state->momentum, @N);
    $store(rows + (@ENTRIES + @N) * members, members, i, state->advected, @ADVECTED);
    $store(rows + (@ENTRIES + @N + @ADVECTED) * members, members, i, state->history, 2 * @N);
    $store(rows + (@ENTRIES + 3 * @N + @ADVECTED) * members, members, i, state->guess, @N);
COMPENSATED     $store(rows + (@ENTRIES + 4 * @N + @ADVECTED) * members, members, i, state->errors, @CHANGES);
}

FUNCTION void $begin_one(LIESTEP_GLOBAL double *states, LIESTEP_GLOBAL COUNT *steps, LIESTEP_GLOBAL int *status,
                         LIESTEP_GLOBAL const double *parameters, LIESTEP_GLOBAL const double *starts, double h, COUNT members,
                         COUNT i) {
    double numbers[@PARAMETERS], start[@ENTRIES + 2 * @N];
    $stepper stepper;
    $state state;
    for (int k = 0; k < @ADVECTED; k++) state.advected[k] = 0.0;
    $load(parameters, members, i, numbers, @PARAMETERS);
    $load(starts, members, i, start, @ENTRIES + 2 * @N);
    status[i] = $make(&stepper, numbers, h) ? 0 : 2;
    $start(&stepper, &state, start, start + @ENTRIES, start + @ENTRIES + @N);
    $store_state(states, members, i, &state);
    steps[i] = 0;
}

FUNCTION void $run_one(LIESTEP_GLOBAL double *states, LIESTEP_GLOBAL COUNT *steps, LIESTEP_GLOBAL int *status,
                       LIESTEP_GLOBAL const double *parameters, double h, COUNT members, unsigned int count, COUNT i) {
    double numbers[@PARAMETERS];
    $stepper stepper;
    $state state;
    if (status[i]) return;
    $load(parameters, members, i, numbers, @PARAMETERS);
    (void)$make(&stepper, numbers, h);
    $load_state(states, members, i, &state);
    state.steps = steps[i];
    for (unsigned int n = 0; n < count; n++) {
        if ($step(&stepper, &state)) continue;
        status[i] = 1;
        break;
    }
    $store_state(states, members, i, &state);
    steps[i] = state.steps;
}

/* The start of each member: @ENTRIES, @N and @N numbers for attitude, momentum and the velocity that it determines. The status is
   0, or 2 where parameters or h can't be used. */
LIESTEP_KERNEL $begin(LIESTEP_GLOBAL double *states, LIESTEP_GLOBAL COUNT *steps, LIESTEP_GLOBAL int *status,
                      LIESTEP_GLOBAL const double *parameters, LIESTEP_GLOBAL const double *starts, double h, COUNT members) {
    LIESTEP_EACH(i, members) $begin_one(states, steps, status, parameters, starts, h, members, i);
}

/* So many steps of each member. A member that can't go on stays at its last step, with the status 1. */
LIESTEP_KERNEL $run(LIESTEP_GLOBAL double *states, LIESTEP_GLOBAL COUNT *steps, LIESTEP_GLOBAL int *status,
                    LIESTEP_GLOBAL const double *parameters, double h, COUNT members, unsigned int count) {
    LIESTEP_EACH(i, members) $run_one(states, steps, status, parameters, h, members, count, i);
}
