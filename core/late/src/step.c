typedef struct {
    double h, safe, largest;
    double constants[CONSTANTS], spatial[ADVECTED];
} Stepper;

typedef struct {
    double attitude[9], momentum[3], advected[ADVECTED];
    double half[3], guess[3], difference[3];
    unsigned long long steps;
} State;

static double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The transpose of a matrix times a vector; added to the vector, if it is that of a change. */
static void turned(const double *matrix, const double *from, double *to, int is_change) {
    double image[3];
    for (int i = 0; i < 3; i++) image[i] = matrix[i] * from[0] + matrix[3 + i] * from[1] + matrix[6 + i] * from[2];
    for (int i = 0; i < 3; i++) to[i] = is_change ? from[i] + image[i] : image[i];
}

/* What is advected, as it is seen after a turn. */
static void seen(const double *matrix, const double *from, double *to, int is_change) {
    (void)matrix;
    (void)from;
    (void)to;
    (void)is_change;
    (void)turned;
TURNED_VALUES}

/* The adjugate and the determinant of a matrix of three rows. */
static double adjugate(const double *m, double *a) {
    a[0] = m[4] * m[8] - m[5] * m[7];
    a[3] = m[5] * m[6] - m[3] * m[8];
    a[6] = m[3] * m[7] - m[4] * m[6];
    a[1] = m[2] * m[7] - m[1] * m[8];
    a[4] = m[0] * m[8] - m[2] * m[6];
    a[7] = m[1] * m[6] - m[0] * m[7];
    a[2] = m[1] * m[5] - m[2] * m[4];
    a[5] = m[2] * m[3] - m[0] * m[5];
    a[8] = m[0] * m[4] - m[1] * m[3];
    return m[0] * a[0] + m[3] * a[1] + m[6] * a[2];
}

static void solved(const double *a, double det, const double *right, double *solution) {
    const double inverse = 1.0 / det;
    for (int i = 0; i < 3; i++) solution[i] = dot(a + 3 * i, right) * inverse;
}

/* The increment F - I of half its Cayley coordinates. */
static void increment_of(const double *y, double *d) {
    const double s = 2.0 / (1.0 + dot(y, y));
    const double bx = s * y[0], by = s * y[1], bz = s * y[2];
    const double xx = bx * y[0], yy = by * y[1], zz = bz * y[2];
    const double xy = bx * y[1], xz = bx * y[2], yz = by * y[2];
    d[0] = -(yy + zz), d[1] = xy - bz, d[2] = xz + by;
    d[3] = xy + bz, d[4] = -(xx + zz), d[5] = yz - bx;
    d[6] = xz - by, d[7] = yz + bx, d[8] = -(xx + yy);
}

int liestep_make(Stepper *stepper, const double *parameters, double h) {
    const double zero[3] = {0.0, 0.0, 0.0};
    double system[12], a[9];
    double *spatial = stepper->spatial;
    spatial[0] = 0.0;
SPATIAL_VALUES    stepper->h = h;
    constants(h, parameters, stepper->constants);
    newton_system(stepper->constants, zero, zero, spatial, system);
    stepper->safe = adjugate(system + 3, a) * 0.0625;
    const double trace = system[3] + system[7] + system[11];
    const double largest = trace / h * 0.00048828125 / 2.220446049250313e-16;
    stepper->largest = largest * largest;
    return isfinite(stepper->safe) && stepper->safe > 0.0 && isfinite(largest);
}

void liestep_start(const Stepper *stepper, State *state, const double *attitude, const double *momentum,
                   const double *velocity) {
    for (int i = 0; i < 9; i++) state->attitude[i] = attitude[i];
    seen(attitude, stepper->spatial, state->advected, 0);
    for (int i = 0; i < 3; i++) {
        state->momentum[i] = momentum[i];
        state->half[i] = state->guess[i] = velocity[i] * (stepper->h * 0.5);
        state->difference[i] = 0.0;
    }
    state->steps = 0;
}

double liestep_defect(const State *state) {
    const double *r = state->attitude;
    double on = 0.0, off = 0.0;
    for (int i = 0; i < 3; i++) {
        for (int j = i; j < 3; j++) {
            const double entry = r[i] * r[j] + r[3 + i] * r[3 + j] + r[6 + i] * r[6 + j] - (i == j);
            if (i == j) on += entry * entry;
            else off += entry * entry;
        }
    }
    return sqrt(on + off * 2.0);
}

/* After very many steps: nearer to the rotations by a Newton step of the polar decomposition. */
static void restore(const Stepper *stepper, State *state) {
    double *r = state->attitude, gram[9], nearer[9];
    if (!(liestep_defect(state) > 2048.0 * 2.220446049250313e-16)) return;
    for (int i = 0; i < 9; i++)
        gram[i] = 3.0 * (i % 4 == 0) - (r[i / 3] * r[i % 3] + r[3 + i / 3] * r[3 + i % 3] + r[6 + i / 3] * r[6 + i % 3]);
    for (int i = 0; i < 9; i++) {
        const double *row = r + i / 3 * 3;
        nearer[i] = 0.5 * (row[0] * gram[i % 3] + row[1] * gram[3 + i % 3] + row[2] * gram[6 + i % 3]);
    }
    for (int i = 0; i < 9; i++) r[i] = nearer[i];
    seen(r, stepper->spatial, state->advected, 0);
}

/* Newton's iteration for half the coordinates of F; the last may use the Jacobian again. */
static int solve(const Stepper *stepper, const double *target, const double *advected, double *half) {
    const double epsilon = 2.220446049250313e-16;
    const double expected = epsilon * 0.5, enough = epsilon * 0.03125;
    double system[12], a[9], update[3], det = 0.0;
    int settled = 0;
    for (int iteration = 0; iteration < 20 && !settled; iteration++) {
        newton_system(stepper->constants, half, target, advected, system);
        det = adjugate(system + 3, a);
        solved(a, det, system, update);
        for (int i = 0; i < 3; i++) half[i] = half[i] - update[i];
        const double first = dot(update, update), size = dot(half, half);
        settled = first <= size * (epsilon * 0.015625);
        if (!settled && first * first * first <= size * (expected * expected) && det > stepper->safe) {
            double residual[3], second[3];
            newton_residual(stepper->constants, half, target, advected, residual);
            solved(a, det, residual, second);
            for (int i = 0; i < 3; i++) half[i] = half[i] - second[i];
            const double length = dot(second, second);
            settled = length * fmax(first, length / first) <= dot(half, half) * (enough * enough);
        }
    }
    return settled && det > 0.0 && dot(target, target) < stepper->largest && dot(half, half) < 1.0;
}

int liestep_step(const Stepper *stepper, State *state) {
    double target[3], kick[3] = {0.0, 0.0, 0.0}, half[3], d[9], next[ADVECTED], change[3], momentum[3], total = 0.0;
    if (HAS_KICK_BEFORE) kick_before(stepper->constants, state->advected, kick);
    for (int i = 0; i < 3; i++) {
        target[i] = HAS_KICK_BEFORE ? state->momentum[i] + kick[i] : state->momentum[i];
        half[i] = state->guess[i];
    }
    if (!solve(stepper, target, state->advected, half)) return 0;
    increment_of(half, d);
    next[0] = 0.0;
    seen(d, state->advected, next, 1);
    turned(d, target, change, 0);
    if (HAS_KICK_AFTER) kick_after(stepper->constants, d, next, kick);
    for (int i = 0; i < 3; i++) {
        if (HAS_KICK_BEFORE) change[i] = change[i] + (target[i] - state->momentum[i]);
        if (HAS_KICK_AFTER) change[i] = change[i] + kick[i];
        momentum[i] = state->momentum[i] + change[i];
        total += momentum[i];
    }
    if (!isfinite(total)) return 0;
    double attitude[9];
    for (int i = 0; i < 9; i++) {
        const double *row = state->attitude + i / 3 * 3;
        attitude[i] = state->attitude[i] + (row[0] * d[i % 3] + row[1] * d[3 + i % 3] + row[2] * d[6 + i % 3]);
    }
    for (int i = 0; i < 9; i++) state->attitude[i] = attitude[i];
    for (int i = 0; i < ADVECTED; i++) state->advected[i] = next[i];
    const int is_far = !(dot(half, half) < 4.0 / 9.0);
    for (int i = 0; i < 3; i++) {
        const double difference = half[i] - state->half[i];
        state->guess[i] = is_far ? half[i] : half[i] + (difference + (difference - state->difference[i]));
        state->difference[i] = difference;
        state->half[i] = half[i];
        state->momentum[i] = momentum[i];
    }
    if (state->steps % 1024 == 0) {
        for (int i = 0; i < 3 && state->steps == 0; i++) {
            state->guess[i] = state->half[i];
            state->difference[i] = 0.0;
        }
        restore(stepper, state);
    }
    state->steps++;
    return 1;
}
