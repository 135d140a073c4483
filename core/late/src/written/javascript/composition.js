
// A step h of a symmetric composition, whose stages are made for gamma[k] h, and a start for the first. The guess of a stage is a
// straight line through the mean velocities of the two before it.
function compose(stages, gamma, state) {
  const count = gamma.length, next = copy(state), earlier = array(N);
  for (let k = 0; k < count; k++) {
    const before = gamma[(k + count - 1) % count], here = gamma[k], ahead = gamma[(k + 1) % count];
    const scale = ahead / here, straight = (here + ahead) / (before + here);
    const ratio = Math.abs(straight) <= 3 ? straight : 0;
    const last = scale * (1 + ratio), factor = -ratio * ahead / before;
    for (let i = 0; i < N; i++) earlier[i] = next.history[i];
    const made = increment(stages[k], next);
    if (!made) return false;
    for (let i = 0; i < N; i++) {
      const y = next.history[i];
      next.guess[i] = made > 1 ? y * scale : y * last + earlier[i] * factor;
      next.history[N + i] = 0;
    }
  }
  next.steps++;
  if (isDue(next) && ATTITUDES > 0) restore(stages[0], next);
  Object.assign(state, next);
  return true;
}
