FUNCTION void $copy(double *to, const double *from, int count) {
    for (int i = 0; i < count; i++) to[i] = from[i];
}

/* The determinant, in units of the diagonals where there are several factors; negative where that of a block is. */
FUNCTION double $det(const double *pairs) {
    double product = 1.0;
    int is_negative = 0;
    if (@IS_WHOLE) return pairs[0];
    for (int k = 0; k < @DETS; k++) {
        product *= pairs[2 * k] / fabs(pairs[2 * k + 1]);
        is_negative |= pairs[2 * k] < 0.0;
    }
    return is_negative ? -fabs(product) : product;
}

FUNCTION void $see(const $stepper *stepper, const double *attitude, double *advected) {
    $inputs in = {0};
    in.parameters = stepper->parameters;
    in.attitude = attitude;
    $seen(&in, advected);
}

EXPORTED int $make($stepper *stepper, const double *parameters, double h) {
    double attitude[@ENTRIES] = {0.0}, advected[@ADVECTED], found[1 + 2 * @DETS], largest;
    $inputs in = {0};
    $copy(stepper->parameters, parameters, @PARAMETERS);
    stepper->h = in.h = h;
    in.parameters = parameters;
    $constants(&in, stepper->constants);
    IDENTITY
    $see(stepper, attitude, advected);
    in.constants = stepper->constants;
    in.advected = advected;
    $rest(&in, found);
    stepper->safe = $det(found + 1) * 0.0625;
    largest = found[0] / h * 0.00048828125 / @EPSILON;
    stepper->largest = largest * largest;
    return isfinite(stepper->safe) && stepper->safe > 0.0 && isfinite(largest);
}

EXPORTED void $start(const $stepper *stepper, $state *state, const double *attitude, const double *momentum,
                     const double *velocity) {
    $copy(state->attitude, attitude, @ENTRIES);
    $copy(state->momentum, momentum, @N);
    $see(stepper, attitude, state->advected);
    for (int i = 0; i < @N; i++) {
        state->history[i] = state->guess[i] = velocity[i] * (stepper->h * 0.5);
        state->history[@N + i] = 0.0;
    }
COMPENSATED     for (int i = 0; i < @CHANGES; i++) state->errors[i] = 0.0;
    state->steps = 0;
}

EXPORTED int $give($stepper *stepper, $state *state, const double *parameters) {
    $stepper next;
    double before[@ADVECTED], after[@ADVECTED];
    if (!$make(&next, parameters, stepper->h)) return 0;
    $see(stepper, state->attitude, before);
    $see(&next, state->attitude, after);
    for (int i = 0; i < @CARRIED; i++) {
        if (after[i] == before[i]) continue;
        state->advected[i] = after[i];
COMPENSATED         state->errors[@ENTRIES + @N + i] = 0.0;
    }
    *stepper = next;
    return 1;
}

EXPORTED double $defect(const $state *state) {
    double found[1];
    $inputs in = {0};
    in.attitude = state->attitude;
    $defect_of(&in, found);
    return found[0];
}

TABLE int $places[] = {RESTORED_PLACES 0};
TABLE int $sizes[] = {RESTORED_ENTRIES 0};

/* After very many steps: nearer to the group. */
FUNCTION void $restore(const $stepper *stepper, $state *state) {
    double found[@RESTORED];
    const double *one = found;
    int any = 0;
COMPENSATED     int has_moved = 0;
    $inputs in = {0};
    in.attitude = state->attitude;
    $restored(&in, found);
    for (int k = 0; k < @ATTITUDES; one += 1 + $sizes[k++]) {
PLAIN         if (!(one[0] > (@ROTATIONS > 1 ? 0.0 : 2048.0 * @EPSILON))) continue;
COMPENSATED         if (!(one[0] > 2048.0 * @EPSILON)) continue;
COMPENSATED         for (int i = 0; i < $sizes[k]; i++) {
COMPENSATED             const double before = state->attitude[$places[k] + i], after = one[1 + i];
COMPENSATED             has_moved |= after != before || !signbit(after) != !signbit(before);
COMPENSATED         }
        $copy(state->attitude + $places[k], one + 1, $sizes[k]);
        any = 1;
    }
    if (any) $see(stepper, state->attitude, state->advected);
COMPENSATED     /* A restored attitude has no rounding error, and neither has what is seen from it. */
COMPENSATED     for (int i = 0; i < @CHANGES && has_moved; i++) {
COMPENSATED         if (i < @ENTRIES || i >= @ENTRIES + @N) state->errors[i] = 0.0;
COMPENSATED     }
}
COMPENSATED 
COMPENSATED /* Sums and their rounding errors, which the next changes get back. */
COMPENSATED FUNCTION void $sum(double *sums, double *errors, const double *changes, int count) {
COMPENSATED     for (int i = 0; i < count; i++) {
COMPENSATED         const double a = sums[i], b = changes[i] + errors[i], sum = a + b, of_b = sum - a;
COMPENSATED         sums[i] = sum;
COMPENSATED         errors[i] = (a - (sum - of_b)) + (b - of_b);
COMPENSATED     }
COMPENSATED }

/* Newton's iteration for y, half the coordinates of F; the last may use the Jacobian again. */
FUNCTION int $solve(const $stepper *stepper, $inputs *in, double *y) {
    const double expected = @EPSILON * 0.5, enough = @EPSILON * 0.03125;
    double found[@N + 2 + 2 * @DETS + @N * @N], second[@N + 2], diagonals[2 * @DETS], safe_here = stepper->safe, d = 0.0;
    int settled = 0;
    if (@VARIES) {
        $safe(in, diagonals);
        safe_here = $det(diagonals) * 0.0625;
    }
    for (int iteration = 0; iteration < @ITERATIONS && !settled; iteration++) {
        $iterate(in, found);
        $copy(y, found, @N);
        const double first = found[@N];
        d = $det(found + @N + 2);
        settled = first <= found[@N + 1] * (@EPSILON * 0.015625);
        if (!settled && first * first * first <= found[@N + 1] * (expected * expected) && d > safe_here) {
            in->factors = found + @N + 2;
            $again(in, second);
            $copy(y, second, @N);
            settled = second[@N] * fmax(first, second[@N] / first) <= second[@N + 1] * (enough * enough);
        }
    }
    return settled && d > 0.0;
}

/* Attitude, momentum and what is advected after one solve, with the guess of the next: 0 where nothing was done, and 2 where the
   coordinates are so large that an extrapolation of theirs isn't a guess. */
FUNCTION int $increment(const $stepper *stepper, $state *state) {
    double y[@N], a[@N + 1], end[@ENTRIES + 4 * @N + @CARRIED + 1 + @NEAR];
    $inputs in = {0};
COMPENSATED     double changes[@CHANGES];
    int is_far = 0;
    in.parameters = stepper->parameters;
    in.constants = stepper->constants;
    in.attitude = state->attitude;
    in.momentum = state->momentum;
    in.advected = state->advected;
    in.history = state->history;
    in.y = y;
    in.target = a;
    $copy(y, state->guess, @N);
    $target(&in, a);
    if (!($solve(stepper, &in, y) && a[@N] < stepper->largest)) return 0;
    $finish(&in, end);
    const double *from = end + @ENTRIES + @N + @CARRIED, *near_here = from + 3 * @N + 1;
    if (!isfinite(near_here[-1])) return 0;
    for (int k = 0; k < @NEAR; k++) {
        is_far |= !(near_here[k] * 9.0 < 1.0);
        if (!(near_here[k] * 4.0 < 1.0)) return 0;
    }
PLAIN     $copy(state->attitude, end, @ENTRIES);
PLAIN     $copy(state->momentum, end + @ENTRIES, @N);
PLAIN     $copy(state->advected, end + @ENTRIES + @N, @CARRIED);
COMPENSATED     in.factors = state->errors + @ENTRIES + @N;
COMPENSATED     $changes(&in, changes);
COMPENSATED     $sum(state->attitude, state->errors, changes, @ENTRIES);
COMPENSATED     $sum(state->momentum, state->errors + @ENTRIES, changes + @ENTRIES, @N);
COMPENSATED     $sum(state->advected, state->errors + @ENTRIES + @N, changes + @ENTRIES + @N, @CARRIED);
    $copy(state->history, from, 2 * @N);
    $copy(state->guess, from + 2 * @N, @N);
    return 1 + is_far;
}

FUNCTION int $is_due(const $state *state) { return state->steps % (@ROTATIONS > 1 ? 64 : 1024) == 0; }

EXPORTED int $step(const $stepper *stepper, $state *state) {
    const int made = $increment(stepper, state);
    if (!made) return 0;
    if (made > 1) $copy(state->guess, state->history, @N);
    if ($is_due(state)) {
        for (int i = 0; i < @N && state->steps == 0; i++) {
            state->guess[i] = state->history[i];
            state->history[@N + i] = 0.0;
        }
        if (@ATTITUDES > 0) $restore(stepper, state);
    }
    state->steps++;
    return 1;
}
