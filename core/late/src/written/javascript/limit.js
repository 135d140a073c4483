
// The velocity that a momentum determines at an attitude, the momentum of a velocity, and the energy of a state, J.
function velocity(stepper, attitude, momentum) {
  const advected = array(ADVECTED), found = array(N);
  see(stepper, attitude, advected);
  given.parameters = stepper.parameters; given.advected = advected; given.momentum = momentum;
  velocity_of(given, found);
  return found;
}

function momentum(stepper, attitude, velocity) {
  const advected = array(ADVECTED), found = array(N);
  see(stepper, attitude, advected);
  given.parameters = stepper.parameters; given.advected = advected; given.velocity = velocity;
  momentum_of(given, found);
  return found;
}

function energy(stepper, state) {
  const velocity = array(N), found = array(1);
  given.parameters = stepper.parameters; given.advected = state.advected; given.momentum = state.momentum;
  velocity_of(given, velocity);
  given.velocity = velocity;
  energy_of(given, found);
  return found[0];
}
