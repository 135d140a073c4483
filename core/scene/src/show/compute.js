// The stages of a step and the state at the start, for a value of each slider; null where there is no step with them.
function begun(values) {
  const { step, linked } = model, numbers = Float64Array.from(model.numbers), velocity = [...model.velocity], turn = [0, 0, 0];
  const isChanged = model.sliders.map(({ value }, k) => values[k] !== value);
  model.sliders.forEach(({ of, places }, k) => {
    if (isChanged[k]) for (const place of places) ({ numbers, velocity, turn })[of][place] = values[k];
  });
  // Inertias of effects follow that of the body, J = tr(J_d) I - J_d.
  const stride = linked.isDiagonal ? 3 : 9, at = (i, j) => linked.isDiagonal ? (i === j ? numbers[linked.body + i] : 0) : numbers[linked.body + 3 * i + j];
  const isOther = model.sliders.some(({ of, places }, k) => isChanged[k] && of === "numbers" && places[0] >= linked.body && places[0] < linked.body + stride);
  if (isOther) for (const place of linked.places) for (let i = 0; i < 3; i++) for (let j = 0; j < 3; j++) {
    const trace = i === j ? at(0, 0) + at(1, 1) + at(2, 2) : 0;
    numbers[place + 3 * i + j] = linked.isNonstandard ? trace - at(i, j) : at(i, j);
  }
  const stages = model.gamma.map(gamma => step.make(numbers, model.h * gamma));
  if (stages.includes(null)) return null;
  const attitude = turn.some(angle => angle !== 0) ? turnedBy(turn.map(angle => angle * Math.PI / 180), model.attitude) : model.attitude;
  const isOfMomentum = model.isByMomentum && !model.sliders.some(({ of }, k) => isChanged[k] && of === "velocity");
  const momentum = isOfMomentum ? model.momentum : step.momentum(stages[0], attitude, velocity);
  return { stages, state: step.start(stages[0], attitude, momentum, step.velocity(stages[0], attitude, momentum)) };
}

// The rotation by a vector, rad, of space, and then a rotation, row by row: R v = v + sin(a) n x v + (1 - cos(a)) n x (n x v).
function turnedBy(vector, rotation) {
  const angle = Math.hypot(...vector), [x, y, z] = vector.map(part => part / angle), s = Math.sin(angle), c = 1 - Math.cos(angle);
  const by = [[1 - c * (y * y + z * z), c * x * y - s * z, c * x * z + s * y], [c * x * y + s * z, 1 - c * (x * x + z * z), c * y * z - s * x], [c * x * z - s * y, c * y * z + s * x, 1 - c * (x * x + y * y)]];
  return by.flatMap(row => [0, 1, 2].map(j => row[0] * rotation[j] + row[1] * rotation[3 + j] + row[2] * rotation[6 + j]));
}

// One step; false where it is refused, and nothing was done.
const advanced = ({ stages, state }) => stages.length > 1 ? model.step.compose(stages, model.gamma, state) : model.step.step(stages[0], state);
/* End of the model. */
