
// Sliders, whose values the motion is computed with, here.
{
  const panel = document.createElement("details");
  document.querySelector("main").prepend(panel);
  const part = (kind, properties, place = panel) => place.appendChild(Object.assign(document.createElement(kind), properties));
  panel.id = "values"; panel.open = window.innerWidth > 800 && window.innerHeight > 500;
  part("summary", { textContent: "Parameters and start" });
  const values = model.sliders.map(({ value }) => value);
  const short = x => String(Number(x.toPrecision(4))).replace("-", "−");
  const rows = model.sliders.map(({ name, unit, value, low, high }, k) => {
    const label = part("label", {}), shown = () => `${name} = ${short(values[k])}${unit && " " + unit}`;
    const text = part("span", { textContent: shown() }, label);
    const input = part("input", { type: "range", min: low, max: high, step: "any", value, ariaLabel: name }, label);
    const set = to => { values[k] = to; text.textContent = shown(); };
    input.addEventListener("input", () => { set(Number(input.value)); restart(); });
    return () => { input.value = value; set(value); };
  });
  part("button", { textContent: "Reset" }).addEventListener("click", () => { rows.forEach(reset => reset()); restart(); });
  const words = model.isExact ? "Computed in this page, to the bit as by the program." : "Computed in this page, not to the bit: sines and cosines are those of the browser.";
  const note = part("p", { textContent: words });

  const [tilt, energies, momenta, rates] = motion.charts.map(chart => chart.lines.map(line => line.values));
  const stepOf = Array.from(times, time => Math.round(time / model.h));
  // The frame of a state, of the motion that began with `first`.
  function write(frame, { stages: [stepper], state }, first) {
    const r = state.attitude, m = state.momentum, along = row => r[3 * row] * m[0] + r[3 * row + 1] * m[1] + r[3 * row + 2] * m[2];
    const inSpace = [0, 1, 2].map(along), energy = model.step.energy(stepper, state), rate = model.step.velocity(stepper, r, m);
    if (frame === 0) Object.assign(first, { inSpace, energy });
    single.attitudes.set(quaternionOf(r), 4 * frame);
    const tip = tips[frame] = [0, 1, 2].map(row => r[3 * row] * model.axis[0] + r[3 * row + 1] * model.axis[1] + r[3 * row + 2] * model.axis[2]);
    tilt[0][frame] = Math.acos(Math.max(-1, Math.min(1, tip[2] / Math.hypot(...tip)))) * 180 / Math.PI;
    energies[0][frame] = Math.abs(energy - first.energy);
    const away = add(inSpace, first.inSpace, -1);
    momenta[0][frame] = Math.abs(away[2]); momenta[1][frame] = Math.hypot(...away);
    for (let k = 0; k < 3; k++) rates[k][frame] = rate[k];
  }
  function quaternionOf(r) {
    const square = [1 + r[0] + r[4] + r[8], 1 + r[0] - r[4] - r[8], 1 - r[0] + r[4] - r[8], 1 - r[0] - r[4] + r[8]];
    const k = square.indexOf(Math.max(...square)), size = Math.sqrt(square[k]) / 2, [x, y, z] = [r[7] - r[5], r[2] - r[6], r[3] - r[1]];
    const [xy, xz, yz] = [r[1] + r[3], r[2] + r[6], r[5] + r[7]];
    return [[0, x, y, z], [x, 0, xy, xz], [y, xy, 0, yz], [z, xz, yz, 0]][k].map((part, at) => at === k ? size : part / (4 * size));
  }

  let job = 0;
  function restart() {
    const own = ++job, course = begun(values), first = {};
    // Events are those of the file.
    if (own > 1) motion.events.length = 0;
    const refuse = (frame, text) => {
      note.textContent = text;
      for (let k = frame; k < frames; k++) {
        if (frame > 0) { single.attitudes.copyWithin(4 * k, 4 * frame - 4, 4 * frame); tips[k] = tips[frame - 1]; }
        for (const lines of [tilt, energies, momenta, rates]) for (const line of lines) line[k] = NaN;
      }
      end_of(own);
    };
    const end_of = () => { document.documentElement.dataset.computed = own; seek(now); };
    if (!course) return refuse(0, "There is no step with these parameters.");
    note.textContent = words;
    let frame = 0, made = 0;
    // A stretch of some milliseconds, so that the page stays alive.
    const stretchOn = () => {
      if (own !== job) return;
      const until = performance.now() + 12;
      while (frame < frames) {
        for (; made < stepOf[frame]; made++) if (!advanced(course)) {
          return refuse(frame, `The step at ${short(made * model.h)} s is refused: it is too long for this motion.`);
        }
        write(frame++, course, first);
        if (performance.now() > until) break;
      }
      if (frame >= frames) return end_of();
      seek(now); requestAnimationFrame(stretchOn);
    };
    stretchOn();
  }
  // The program's own motion isn't written where this is it.
  if (model.isExact) restart();
}
