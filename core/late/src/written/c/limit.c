
/* The velocity that a momentum determines at an attitude, and the momentum of a velocity. */
EXPORTED void $velocity(const $stepper *stepper, const double *attitude, const double *momentum, double *velocity) {
    double advected[@ADVECTED];
    $inputs in = {0};
    $see(stepper, attitude, advected);
    in.parameters = stepper->parameters;
    in.advected = advected;
    in.momentum = momentum;
    $velocity_of(&in, velocity);
}

EXPORTED void $momentum(const $stepper *stepper, const double *attitude, const double *velocity, double *momentum) {
    double advected[@ADVECTED];
    $inputs in = {0};
    $see(stepper, attitude, advected);
    in.parameters = stepper->parameters;
    in.advected = advected;
    in.velocity = velocity;
    $momentum_of(&in, momentum);
}

EXPORTED double $energy(const $stepper *stepper, const $state *state) {
    double velocity[@N], found[1];
    $inputs in = {0};
    in.parameters = stepper->parameters;
    in.advected = state->advected;
    in.momentum = state->momentum;
    $velocity_of(&in, velocity);
    in.velocity = velocity;
    $energy_of(&in, found);
    return found[0];
}
