typedef struct {
    double h, safe, largest;
    double parameters[PARAMETERS], constants[CONSTANTS];
} Stepper;

typedef struct {
    double attitude[ENTRIES], momentum[N], advected[ADVECTED];
    double history[2 * N], guess[N];
    unsigned long long steps;
} State;

static const double epsilon = 2.220446049250313e-16;

static void copy(double *to, const double *from, int count) {
    for (int i = 0; i < count; i++) to[i] = from[i];
}

/* The determinant, in units of the diagonals where there are several factors; negative where that of a block is. */
static double det(const double *pairs) {
    double product = 1.0;
    int is_negative = 0;
    if (IS_WHOLE) return pairs[0];
    for (int k = 0; k < DETS; k++) {
        product *= pairs[2 * k] / fabs(pairs[2 * k + 1]);
        is_negative |= pairs[2 * k] < 0.0;
    }
    return is_negative ? -fabs(product) : product;
}

int liestep_make(Stepper *stepper, const double *parameters, double h) {
    double attitude[ENTRIES] = {0.0}, advected[ADVECTED], found[1 + 2 * DETS];
    copy(stepper->parameters, parameters, PARAMETERS);
    stepper->h = h;
    constants(&(Inputs){.h = h, .parameters = parameters}, stepper->constants);
    IDENTITY
    seen(&(Inputs){.parameters = parameters, .attitude = attitude}, advected);
    rest(&(Inputs){.constants = stepper->constants, .advected = advected}, found);
    stepper->safe = det(found + 1) * 0.0625;
    const double largest = found[0] / h * 0.00048828125 / epsilon;
    stepper->largest = largest * largest;
    return isfinite(stepper->safe) && stepper->safe > 0.0 && isfinite(largest);
}

void liestep_start(const Stepper *stepper, State *state, const double *attitude, const double *momentum,
                   const double *velocity) {
    copy(state->attitude, attitude, ENTRIES);
    copy(state->momentum, momentum, N);
    seen(&(Inputs){.parameters = stepper->parameters, .attitude = attitude}, state->advected);
    for (int i = 0; i < N; i++) {
        state->history[i] = state->guess[i] = velocity[i] * (stepper->h * 0.5);
        state->history[N + i] = 0.0;
    }
    state->steps = 0;
}

double liestep_defect(const State *state) {
    double found[1];
    defect(&(Inputs){.attitude = state->attitude}, found);
    return found[0];
}

/* After very many steps: nearer to the group. */
static void restore(const Stepper *stepper, State *state) {
    static const int places[] = {RESTORED_PLACES 0}, entries[] = {RESTORED_ENTRIES 0};
    double found[RESTORED];
    const double *one = found;
    int any = 0;
    restored(&(Inputs){.attitude = state->attitude}, found);
    for (int k = 0; k < ATTITUDES; one += 1 + entries[k++]) {
        if (!(one[0] > (ATTITUDES > 1 ? 0.0 : 2048.0 * epsilon))) continue;
        copy(state->attitude + places[k], one + 1, entries[k]);
        any = 1;
    }
    if (any) seen(&(Inputs){.parameters = stepper->parameters, .attitude = state->attitude}, state->advected);
}

/* Newton's iteration for half the coordinates of F; the last may use the Jacobian again. */
static int solve(const Stepper *stepper, Inputs *in, double *half) {
    const double expected = epsilon * 0.5, enough = epsilon * 0.03125;
    double found[N + 2 + 2 * DETS + N * N], second[N + 2], diagonals[2 * DETS], safe_here = stepper->safe, d = 0.0;
    int settled = 0;
    if (VARIES) {
        safe(in, diagonals);
        safe_here = det(diagonals) * 0.0625;
    }
    for (int iteration = 0; iteration < 20 && !settled; iteration++) {
        iterate(in, found);
        copy(half, found, N);
        const double first = found[N];
        d = det(found + N + 2);
        settled = first <= found[N + 1] * (epsilon * 0.015625);
        if (!settled && first * first * first <= found[N + 1] * (expected * expected) && d > safe_here) {
            in->factors = found + N + 2;
            again(in, second);
            copy(half, second, N);
            settled = second[N] * fmax(first, second[N] / first) <= second[N + 1] * (enough * enough);
        }
    }
    return settled && d > 0.0;
}

/* Attitude, momentum and what is advected after one solve, with the guess of the next: 0 where nothing was done, and 2 where the
   coordinates are so large that an extrapolation of theirs isn't a guess. */
static int increment(const Stepper *stepper, State *state) {
    double half[N], a[N + 1], end[ENTRIES + 4 * N + CARRIED + 1 + NEAR];
    Inputs in = {.parameters = stepper->parameters, .constants = stepper->constants, .attitude = state->attitude,
                 .momentum = state->momentum, .advected = state->advected, .history = state->history, .half = half, .target = a};
    int is_far = 0;
    copy(half, state->guess, N);
    target(&in, a);
    if (!(solve(stepper, &in, half) && a[N] < stepper->largest)) return 0;
    finish(&in, end);
    const double *from = end + ENTRIES + N + CARRIED, *near = from + 3 * N + 1;
    if (!isfinite(near[-1])) return 0;
    for (int k = 0; k < NEAR; k++) {
        is_far |= !(near[k] * 9.0 < 1.0);
        if (!(near[k] * 4.0 < 1.0)) return 0;
    }
    copy(state->attitude, end, ENTRIES);
    copy(state->momentum, end + ENTRIES, N);
    copy(state->advected, end + ENTRIES + N, CARRIED);
    copy(state->history, from, 2 * N);
    copy(state->guess, from + 2 * N, N);
    return 1 + is_far;
}

static int is_due(const State *state) { return state->steps % (ATTITUDES > 1 ? 64 : 1024) == 0; }

int liestep_step(const Stepper *stepper, State *state) {
    const int made = increment(stepper, state);
    if (!made) return 0;
    if (made > 1) copy(state->guess, state->history, N);
    if (is_due(state)) {
        for (int i = 0; i < N && state->steps == 0; i++) {
            state->guess[i] = state->history[i];
            state->history[N + i] = 0.0;
        }
        if (ATTITUDES > 0) restore(stepper, state);
    }
    state->steps++;
    return 1;
}
