
/* The guess of a stage is a straight line through the mean velocities of the two before it. */
EXPORTED int $compose(const $stepper *stages, const double *gamma, int count, $state *state) {
    $state next = *state;
    for (int k = 0; k < count; k++) {
        const double before = gamma[(k + count - 1) % count], here = gamma[k], ahead = gamma[(k + 1) % count];
        const double scale = ahead / here, straight = (here + ahead) / (before + here);
        const double ratio = fabs(straight) <= 3.0 ? straight : 0.0;
        const double last = scale * (1.0 + ratio), factor = -ratio * ahead / before;
        double earlier[@N];
        $copy(earlier, next.history, @N);
        const int made = $increment(stages + k, &next);
        if (!made) return 0;
        for (int i = 0; i < @N; i++) {
            const double y = next.history[i];
            next.guess[i] = made > 1 ? y * scale : y * last + earlier[i] * factor;
            next.history[@N + i] = 0.0;
        }
    }
    next.steps++;
    if ($is_due(&next) && @ATTITUDES > 0) $restore(stages, &next);
    *state = next;
    return 1;
}
