const EPSILON = 2 ** -52, array = length => new Float64Array(length);
const MATRICES = [OF_MATRICES], RESTORED_PLACES = [OF_PLACES], RESTORED_SIZES = [OF_SIZES];
const given = { h: 0 };

// The determinant, in units of the diagonals where there are several factors; negative where that of a block is.
function det(pairs, first) {
  if (IS_WHOLE) return pairs[first];
  let product = 1, isNegative = false;
  for (let k = 0; k < DETS; k++) {
    product *= pairs[first + 2 * k] / Math.abs(pairs[first + 2 * k + 1]);
    if (pairs[first + 2 * k] < 0) isNegative = true;
  }
  return isNegative ? -Math.abs(product) : product;
}

function see(stepper, attitude, advected) {
  given.parameters = stepper.parameters; given.attitude = attitude;
  seen(given, advected);
}

// The stepper of all parameters, those of a matrix row by row, with a step h, s; null where one of them can't be used.
function make(parameters, h) {
  const stepper = { h, safe: 0, largest: 0, parameters: Float64Array.from(parameters), constants: array(CONSTANTS) };
  const attitude = array(ENTRIES), advected = array(ADVECTED), found = array(1 + 2 * DETS);
  given.h = h; given.parameters = stepper.parameters;
  constants(given, stepper.constants);
  for (const [first, rows] of MATRICES) for (let i = 0; i < rows; i++) attitude[first + i * (rows + 1)] = 1;
  see(stepper, attitude, advected);
  given.constants = stepper.constants; given.advected = advected;
  rest(given, found);
  stepper.safe = det(found, 1) * 0.0625;
  const largest = found[0] / h * 0.00048828125 / EPSILON;
  stepper.largest = largest * largest;
  return Number.isFinite(stepper.safe) && stepper.safe > 0 && Number.isFinite(largest) ? stepper : null;
}

// The state at an attitude, the matrices of its factors row by row, with a momentum and the velocity that it determines, body
// frame.
function start(stepper, attitude, momentum, velocity) {
  const state = {
    attitude: Float64Array.from(attitude), momentum: Float64Array.from(momentum), advected: array(ADVECTED),
    history: array(2 * N), guess: array(N), steps: 0,
  };
  see(stepper, state.attitude, state.advected);
  for (let i = 0; i < N; i++) state.history[i] = state.guess[i] = velocity[i] * (stepper.h * 0.5);
  return state;
}

// The stepper with other parameters between two steps of a state; null where they can't be used, and nothing was done.
function give(stepper, state, parameters) {
  const next = make(parameters, stepper.h), before = array(ADVECTED), after = array(ADVECTED);
  if (!next) return null;
  see(stepper, state.attitude, before);
  see(next, state.attitude, after);
  for (let i = 0; i < CARRIED; i++) if (after[i] !== before[i]) state.advected[i] = after[i];
  return next;
}

// A copy of a state, from which the motion may go on.
const copy = ({ attitude, momentum, advected, history, guess, steps }) =>
  ({ attitude: attitude.slice(), momentum: momentum.slice(), advected: advected.slice(), history: history.slice(), guess: guess.slice(), steps });

// How far an attitude is from the group.
function defect(state) {
  const found = array(1);
  given.attitude = state.attitude;
  defect_of(given, found);
  return found[0];
}

// After very many steps: nearer to the group.
function restore(stepper, state) {
  const found = array(RESTORED);
  let isNearer = false, first = 0;
  given.attitude = state.attitude;
  restored(given, found);
  for (let k = 0; k < ATTITUDES; first += 1 + RESTORED_SIZES[k++]) {
    if (!(found[first] > (ROTATIONS > 1 ? 0 : 2048 * EPSILON))) continue;
    state.attitude.set(found.subarray(first + 1, first + 1 + RESTORED_SIZES[k]), RESTORED_PLACES[k]);
    isNearer = true;
  }
  if (isNearer) see(stepper, state.attitude, state.advected);
}

const FOUND = array(N + 2 + 2 * DETS + N * N), FACTORS_FOUND = FOUND.subarray(N + 2), SECOND = array(N + 2), DIAGONALS = array(2 * DETS);
const Y = array(N), TARGET = array(N + 1), END = array(ENTRIES + 4 * N + CARRIED + 1 + NEAR);

// Newton's iteration for y, half the coordinates of F; the last may use the Jacobian again.
function solve(stepper) {
  const expected = EPSILON * 0.5, enough = EPSILON * 0.03125;
  let safeHere = stepper.safe, d = 0, isSettled = false;
  if (VARIES) {
    safe(given, DIAGONALS);
    safeHere = det(DIAGONALS, 0) * 0.0625;
  }
  for (let iteration = 0; iteration < 20 && !isSettled; iteration++) {
    iterate(given, FOUND);
    for (let i = 0; i < N; i++) Y[i] = FOUND[i];
    const first = FOUND[N];
    d = det(FOUND, N + 2);
    isSettled = first <= FOUND[N + 1] * (EPSILON * 0.015625);
    if (!isSettled && first * first * first <= FOUND[N + 1] * (expected * expected) && d > safeHere) {
      given.factors = FACTORS_FOUND;
      again(given, SECOND);
      for (let i = 0; i < N; i++) Y[i] = SECOND[i];
      isSettled = SECOND[N] * Math.max(first, SECOND[N] / first) <= SECOND[N + 1] * (enough * enough);
    }
  }
  return isSettled && d > 0;
}

// Attitude, momentum and what is advected after one solve, with the guess of the next: 0 where nothing was done, and 2 where the
// coordinates are so large that an extrapolation of theirs isn't a guess.
function increment(stepper, state) {
  given.parameters = stepper.parameters; given.constants = stepper.constants;
  given.attitude = state.attitude; given.momentum = state.momentum; given.advected = state.advected; given.history = state.history;
  given.y = Y; given.target = TARGET;
  Y.set(state.guess);
  target(given, TARGET);
  if (!(solve(stepper) && TARGET[N] < stepper.largest)) return 0;
  finish(given, END);
  const from = ENTRIES + N + CARRIED, near = from + 3 * N + 1;
  let isFar = 0;
  if (!Number.isFinite(END[near - 1])) return 0;
  for (let k = 0; k < NEAR; k++) {
    if (!(END[near + k] * 9 < 1)) isFar = 1;
    if (!(END[near + k] * 4 < 1)) return 0;
  }
  for (let i = 0; i < ENTRIES; i++) state.attitude[i] = END[i];
  for (let i = 0; i < N; i++) state.momentum[i] = END[ENTRIES + i];
  for (let i = 0; i < CARRIED; i++) state.advected[i] = END[ENTRIES + N + i];
  for (let i = 0; i < 2 * N; i++) state.history[i] = END[from + i];
  for (let i = 0; i < N; i++) state.guess[i] = END[from + 2 * N + i];
  return 1 + isFar;
}

const isDue = state => state.steps % (ROTATIONS > 1 ? 64 : 1024) === 0;

// A step of a state; false where nothing was done.
function step(stepper, state) {
  const made = increment(stepper, state);
  if (!made) return false;
  if (made > 1) for (let i = 0; i < N; i++) state.guess[i] = state.history[i];
  if (isDue(state)) {
    for (let i = 0; i < N && state.steps === 0; i++) {
      state.guess[i] = state.history[i];
      state.history[N + i] = 0;
    }
    if (ATTITUDES > 0) restore(stepper, state);
  }
  state.steps++;
  return true;
}
