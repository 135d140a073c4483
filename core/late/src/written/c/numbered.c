
const $stepper $stages[@STAGES] = {
    STEPPERS
};
static const double $gamma[@STAGES] = {GAMMAS};

void $begin($state *state) {
    static const double attitude[] = {ATTITUDE}, momentum[] = {MOMENTUM}, velocity[] = {VELOCITY};
    $start($stages, state, attitude, momentum, velocity);
}

int $next($state *state) {
    (void)$gamma;
    return NEXT;
}
