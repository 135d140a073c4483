"use strict";
// Plays `motion`: times in s, bodies with attitudes as unit quaternions w, x, y, z, body to space, and charts over time. Several
// bodies have positions, too; a single one turns about a point.
window.addEventListener("error", event => { document.documentElement.dataset.error = event.message; });

const decode = text => new Float32Array(Uint8Array.from(atob(text), letter => letter.charCodeAt(0)).buffer);
const times = decode(motion.times), frames = times.length;
// Lists of a motion that is computed here are empty at first.
const decoded = (text, size) => text ? decode(text) : new Float32Array(size);
for (const body of motion.bodies) { body.attitudes = decoded(body.attitudes, 4 * frames); body.positions = decode(body.positions); }
const [single] = motion.bodies, several = single && single.positions.length > 0;
const start = times[0], end = times[frames - 1];
for (const chart of motion.charts) for (const line of chart.lines) line.values = decoded(line.values, frames);

// Letters and lines are larger for a lecture hall: L, or `#large`.
let large = new URLSearchParams(location.hash.slice(1)).has("large") ? 1.7 : 1;
const letters = size => `${Math.round(size * large)}px system-ui, sans-serif`;
// With the page's white around it, where a line may pass.
const overLines = (pen, text, x, y) => {
  pen.strokeStyle = "#fff"; pen.lineWidth = 3 * large; pen.lineJoin = "round"; pen.strokeText(text, x, y); pen.fillText(text, x, y);
};
// Where seconds would have five digits, time is told in hours.
const [UNIT, UNIT_NAME] = end - start >= 1e4 ? [3600, "h"] : [1, "s"];

const COLOURS = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#2d2d2d", "#b8a800"], PATH = "#cc79a7", INK = "#2d2d2d", FAINT = "#d8dce2";
// The most ways that are drawn, and the most names.
const MOST_PATHS = 16, MOST_NAMES = 12;
// Of a drum or a box, so that a turn is seen.
const SHADES = [[86, 146, 190], [226, 232, 238]];

// Vectors.
const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const turned = ([w, ...q], v) => { const t = cross(q, v).map(x => 2 * x); return add(add(v, t, w), cross(q, t)); };

// The last frame at or before a time.
function frameAt(time) {
  let low = 0, high = frames - 1;
  while (low < high) { const middle = (low + high + 1) >> 1; if (times[middle] <= time) low = middle; else high = middle - 1; }
  return low;
}
const quaternion = (body, frame) => body.attitudes.subarray(4 * frame, 4 * frame + 4);
// The part of the way from a frame to the next that has passed at a time.
const partAt = (time, frame) => Math.min(1, Math.max(0, (time - times[frame]) / (times[frame + 1] - times[frame])));
// Between two frames the shorter turn from the one to the other.
function attitudeAt(body, time) {
  const frame = frameAt(time), a = quaternion(body, frame);
  if (frame + 1 >= frames) return a;
  const b = quaternion(body, frame + 1), part = partAt(time, frame);
  const cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3], sign = cosine < 0 ? -1 : 1;
  const angle = Math.acos(Math.min(1, Math.abs(cosine)));
  const [left, right] = angle < 1e-6 ? [1 - part, part] : [(1 - part) * angle, part * angle].map(x => Math.sin(x) / Math.sin(angle));
  const q = a.map((x, k) => left * x + sign * right * b[k]), size = Math.hypot(...q);
  return q.map(x => x / size);
}

const position = (body, frame) => [...body.positions.subarray(3 * frame, 3 * frame + 3)];
function positionAt(body, time) {
  const frame = frameAt(time), a = position(body, frame);
  return frame + 1 >= frames ? a : add(a, add(position(body, frame + 1), a, -1), partAt(time, frame));
}

// A canvas that fills its place, in pixels of the page.
function canvasIn(place, draw) {
  const canvas = place.appendChild(document.createElement("canvas")), pen = canvas.getContext("2d");
  const surface = { canvas, width: 0, height: 0, draw() {
    const scale = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect();
    surface.width = box.width; surface.height = box.height;
    canvas.width = Math.round(box.width * scale); canvas.height = Math.round(box.height * scale);
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    pen.clearRect(0, 0, box.width, box.height);
    pen.lineJoin = pen.lineCap = "round";
    draw(pen, surface.width, surface.height);
  } };
  return surface;
}
function dragged(canvas, move) {
  canvas.addEventListener("pointerdown", event => { canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointermove", event => { if (event.buttons & 1) move(event.movementX, event.movementY, event); });
}

// The path of the axis that is followed, of a single body.
const tips = single && !several ? Array.from({ length: frames }, (_, frame) => turned(quaternion(single, frame), motion.axis)) : [];
const usualCamera = { azimuth: 0.6, elevation: 0.45, zoom: 1 }, camera = { ...usualCamera };
let now = start;

// The faces of a box, or of a surface of revolution with the heights and radii of its profile.
function facesOf({ sides, round, profile, middle }) {
  if (round === null) {
    const [a, b, c] = sides;
    const face = (n, u, v, shade) => ({ shade, points: [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([s, t]) => add(add(add(middle, n), u, s), v, t)) });
    const both = (n, u, v, shade) => [face(n, u, v, shade), face(n.map(x => -x), v, u, shade + 1)];
    return [...both(a, b, c, 0), ...both(b, c, a, 0), ...both(c, a, b, 0)];
  }
  const n = sides[round], u = sides[(round + 1) % 3], v = sides[(round + 2) % 3], faces = [];
  const rim = (turn, [height, radius]) => add(add(add(middle, n, height), u, radius * Math.cos(turn)), v, radius * Math.sin(turn));
  for (let k = 0; k < 32; k++) {
    const [from, to] = [k, k + 1].map(x => x * Math.PI / 16), shade = Math.floor(k / 8);
    for (let ring = 0; ring + 1 < profile.length; ring++) {
      const [low, high] = [profile[ring], profile[ring + 1]];
      const points = low[1] === 0 ? [rim(0, low), rim(from, high), rim(to, high)] : [rim(from, low), rim(to, low), ...(high[1] === 0 ? [rim(0, high)] : [rim(to, high), rim(from, high)])];
      faces.push({ shade, plain: true, points });
    }
  }
  return faces;
}
for (const body of motion.bodies) body.faces = facesOf(body);

// Several bodies are drawn around the middle of their places, which fill the view.
const room = { middle: [0, 0, 0], size: 1 };
if (several) {
  motion.bodies.forEach((body, number) => {
    const own = [1, 3, 5].map(k => parseInt(COLOURS[number % COLOURS.length].slice(k, k + 2), 16));
    body.colours = [own.map(x => x + (255 - x) * 0.25), own.map(x => x + (255 - x) * 0.7)];
  });
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const body of motion.bodies) {
    const reach = Math.max(...body.sides.map(side => Math.hypot(...side)), 0);
    for (let k = 0; k < body.positions.length; k++) {
      low[k % 3] = Math.min(low[k % 3], body.positions[k] - reach); high[k % 3] = Math.max(high[k % 3], body.positions[k] + reach);
    }
  }
  const [x, y] = [0, 1].map(k => high[k] - low[k]);
  room.middle = add(low, high).map(k => k / 2); room.size = Math.hypot(...add(high, low, -1)) / 2 || 1;
  // A motion in a plane is seen from its side.
  usualCamera.azimuth = x > y ? -1.2 : 0.4; usualCamera.elevation = 0.3; Object.assign(camera, usualCamera);
}
const inRoom = p => add(p, room.middle, -1).map(x => x / room.size);

// Other groups than that of a body have charts alone.
document.getElementById("view").hidden = !single;
const view = canvasIn(document.getElementById("view"), (pen, width, height) => {
  if (!single) return;
  const [sa, ca, se, ce] = [Math.sin(camera.azimuth), Math.cos(camera.azimuth), Math.sin(camera.elevation), Math.cos(camera.elevation)];
  const right = [-sa, ca, 0], up = [-se * ca, -se * sa, ce], towards = [ce * ca, ce * sa, se];
  const size = (several ? 0.48 : 0.36) * Math.min(width, height) * camera.zoom, centre = [width / 2, height / 2];
  const place = p => [centre[0] + size * dot(right, p), centre[1] - size * dot(up, p)];
  const line = (points, colour, thickness) => {
    pen.beginPath();
    points.forEach((p, k) => { const [x, y] = place(p); if (k) pen.lineTo(x, y); else pen.moveTo(x, y); });
    pen.strokeStyle = colour; pen.lineWidth = thickness * large; pen.stroke();
  };
  const name = (text, p, colour) => {
    const [x, y] = place(p);
    pen.fillStyle = colour; pen.font = letters(12); overLines(pen, text, x + 4, y - 4);
  };
  // The faces of bodies that look here, the nearest last. Each body is convex, so that these are all that is seen of one.
  const draw = bodies => {
    const seen = bodies.flatMap(({ body, attitude, at }) => body.faces.map(({ points, shade, plain }) => {
      const corners = points.map(p => at(turned(attitude, p))), middle = at(turned(attitude, body.middle));
      let normal = cross(add(corners[1], corners[0], -1), add(corners[2], corners[0], -1));
      const length = Math.hypot(...normal), outwards = dot(normal, add(corners[0], middle, -1)) < 0 ? -1 : 1;
      normal = normal.map(x => outwards * x / length);
      const depth = corners.reduce((sum, p) => sum + dot(towards, p), 0) / corners.length;
      return { corners, shade, plain, normal, depth, colours: body.colours || SHADES, looks: length > 0 && dot(normal, towards) > 0 };
    })).filter(face => face.looks);
    if (bodies.length > 1) seen.sort((one, other) => one.depth - other.depth);
    for (const { corners, shade, plain, normal, colours } of seen) {
      const light = 0.62 + 0.38 * Math.max(0, dot(normal, [0.3, -0.2, 0.93])), colour = colours[shade % 2].map(x => Math.round(x * light));
      pen.beginPath();
      corners.forEach((p, k) => { const [x, y] = place(p); if (k) pen.lineTo(x, y); else pen.moveTo(x, y); });
      pen.closePath();
      pen.fillStyle = pen.strokeStyle = `rgb(${colour})`; pen.lineWidth = 0.7; pen.fill();
      if (!plain) pen.strokeStyle = "rgba(45, 45, 45, 0.5)";
      pen.stroke();
    }
  };
  if (several) {
    const frame = frameAt(now), origin = inRoom([0, 0, 0]);
    if (Math.hypot(...origin) < 1.5) ["e₁", "e₂", "e₃"].forEach((text, k) => {
      const e = add(origin, [0, 1, 2].map(j => j === k ? 0.35 : 0));
      line([origin, e], "#aab1ba", 1); name(text, e, "#7a828c");
    });
    const shown = motion.bodies.map((body, number) => {
      const attitude = attitudeAt(body, now), here = positionAt(body, now), colour = COLOURS[number % COLOURS.length];
      // The way of the centre of mass until now, for as many bodies as are told from each other.
      if (number < MOST_PATHS) {
        const stride = Math.max(1, Math.ceil(frame / 600)), points = [];
        for (let k = 0; k <= frame; k += stride) points.push(inRoom(position(body, k)));
        pen.globalAlpha = 0.6; line([...points, inRoom(here)], colour, 1); pen.globalAlpha = 1;
      }
      return { body, attitude, at: p => inRoom(add(here, p)) };
    });
    // Rods from centres of mass to joints, within or beside the bodies.
    for (const [number, point] of motion.rods) {
      const { attitude, at } = shown[number];
      line([at([0, 0, 0]), at(turned(attitude, point))], INK, 2);
    }
    draw(shown);
    for (const [number, point] of motion.rods) {
      const { attitude, at } = shown[number], [x, y] = place(at(turned(attitude, point)));
      pen.beginPath(); pen.arc(x, y, 2.5 * large, 0, 7); pen.fillStyle = INK; pen.fill();
    }
    if (shown.length <= MOST_NAMES) shown.forEach(({ body, at }, number) => name(body.name, at([0, 0, 0]), COLOURS[number % COLOURS.length]));
    return;
  }
  // Space: its axes, and the sphere on which the path is.
  pen.beginPath(); pen.arc(centre[0], centre[1], size, 0, 7); pen.strokeStyle = FAINT; pen.lineWidth = 1; pen.stroke();
  const circle = (u, v) => line(Array.from({ length: 65 }, (_, k) => add(u.map(x => x * Math.cos(k * Math.PI / 32)), v, Math.sin(k * Math.PI / 32))), FAINT, 1);
  circle([1, 0, 0], [0, 1, 0]); circle([1, 0, 0], [0, 0, 1]); circle([0, 1, 0], [0, 0, 1]);
  ["e₁", "e₂", "e₃"].forEach((text, k) => {
    const e = [0, 1, 2].map(j => j === k ? 1.15 : 0);
    line([[0, 0, 0], e], "#aab1ba", 1); name(text, e, "#7a828c");
  });
  // The path until now; what is older is fainter, and what is behind the sphere too.
  const last = frameAt(now), first = Math.max(0, last - 3000), attitude = attitudeAt(single, now), middle = turned(attitude, single.middle), tip = turned(attitude, motion.axis);
  const chunks = 60, chunk = Math.max(1, Math.ceil((last - first) / chunks));
  for (let k = first; k < last; k += chunk) {
    const to = Math.min(last, k + chunk), points = tips.slice(k, to + 1);
    pen.globalAlpha = (0.25 + 0.75 * (to - first) / (last - first)) * (dot(towards, tips[to]) < 0 ? 0.35 : 1);
    line(points, PATH, 1.6);
  }
  pen.globalAlpha = 1;
  line([tips[last], tip], PATH, 1.6);
  // From the pivot to the body and from the body to the tip, before or behind it.
  const stem = () => { line([[0, 0, 0], middle], INK, 2.5); };
  const pointer = () => {
    line([middle, tip], INK, 1.5);
    const [x, y] = place(tip);
    pen.beginPath(); pen.arc(x, y, 4, 0, 7); pen.fillStyle = PATH; pen.fill();
  };
  const axes = () => ["1", "2", "3"].forEach((text, k) => {
    const e = turned(attitude, [0, 1, 2].map(j => j === k ? 0.85 : 0));
    line([[0, 0, 0], e], COLOURS[k], 2); name(text, e, COLOURS[k]);
  });
  const behind = dot(towards, middle) < 0;
  if (!behind) stem();
  if (dot(towards, tip) < 0) pointer();
  draw([{ body: single, attitude, at: p => p }]);
  if (behind) stem();
  axes();
  if (dot(towards, tip) >= 0) pointer();
});
dragged(view.canvas, (x, y) => {
  camera.azimuth -= x * 0.008;
  camera.elevation = Math.max(-1.57, Math.min(1.57, camera.elevation + y * 0.008));
  view.draw();
});
view.canvas.addEventListener("wheel", event => {
  event.preventDefault();
  camera.zoom = Math.max(0.2, Math.min(20, camera.zoom * Math.exp(-event.deltaY * 0.001)));
  view.draw();
}, { passive: false });
view.canvas.addEventListener("dblclick", () => { Object.assign(camera, usualCamera); view.draw(); });

// Charts share one stretch of time.
const stretch = { from: start, to: end > start ? end : start + 1 };
const RIGHT = 14, left = () => 64 * large;
// More events in sight are ticks on the edge: lines would hide the curves.
const MOST_LINES = 40;

function ticks(from, to, about) {
  const raw = (to - from) / about, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map(x => x * power).find(x => x >= raw) || raw, list = [];
  for (let k = Math.ceil(from / step); k * step <= to + step * 1e-9; k++) list.push(k * step);
  return { list, digits: Math.max(0, Math.min(12, -Math.floor(Math.log10(step)))) };
}
const decimal = (x, digits) => Math.abs(x) >= 1e5 ? x.toExponential(1) : x.toFixed(digits).replace("-", "−");

const charts = motion.charts.map(chart => {
  const place = document.getElementById("charts").appendChild(document.createElement("div"));
  place.className = "chart";
  // What is zero has no logarithm, and isn't drawn.
  const height = value => chart.logarithmic ? Math.log10(value) : value;
  const surface = canvasIn(place, (pen, width, tall) => {
    const first = Math.max(0, frameAt(stretch.from)), last = Math.min(frames - 1, frameAt(stretch.to) + 1);
    let low = Infinity, high = -Infinity;
    for (const line of chart.lines) for (let k = first; k <= last; k++) {
      const y = height(line.values[k]);
      if (!Number.isFinite(y)) continue;
      low = Math.min(low, y); high = Math.max(high, y);
    }
    if (!(high >= low)) { low = chart.logarithmic ? -17 : 0; high = low + 1; }
    const margin = chart.logarithmic ? 0.15 : 0.06 * (high - low) || 0.5 * Math.abs(high) || 1; low -= margin; high += margin;
    const LEFT = left(), wide = width - LEFT - RIGHT;
    // The values now stand beside the title, or below it where there is no room.
    const frame = frameAt(now), title = chart.title + (chart.unit && `, ${chart.unit}`);
    const shownNow = chart.lines.map((line, number) => {
      const value = line.values[frame], size = Math.abs(value);
      const shown = chart.logarithmic || (size > 0 && size < 1e-2) || size >= 1e5 ? value.toExponential(1) : Number(value.toPrecision(3));
      return [(chart.lines.length > 1 ? line.name + " " : "") + String(shown).replace(/-/g, "−"), COLOURS[number % COLOURS.length]];
    });
    pen.font = letters(12);
    const needed = shownNow.reduce((sum, [text]) => sum + pen.measureText(text).width + 12, pen.measureText(title).width + 12);
    const row = 16 * large, below = needed > wide ? row : 0, TOP = 10 + row + below, BOTTOM = 24 * large, deep = tall - TOP - BOTTOM;
    const across = time => LEFT + wide * (time - stretch.from) / (stretch.to - stretch.from);
    const up = y => TOP + deep * (1 - (y - low) / (high - low));
    pen.font = letters(11); pen.textBaseline = "middle"; pen.lineWidth = 1;
    const levels = ticks(low, high, Math.max(2, deep / (28 * large)));
    pen.textAlign = "right";
    for (const y of levels.list) {
      if (chart.logarithmic && Math.abs(y - Math.round(y)) > 1e-6) continue;
      pen.strokeStyle = "#e2e2e2"; pen.beginPath(); pen.moveTo(LEFT, up(y)); pen.lineTo(LEFT + wide, up(y)); pen.stroke();
      pen.fillStyle = INK; pen.fillText(chart.logarithmic ? "1e" + String(Math.round(y)).replace("-", "−") : decimal(y, levels.digits), LEFT - 6, up(y));
    }
    pen.textAlign = "center";
    const marks = ticks(stretch.from / UNIT, stretch.to / UNIT, Math.max(2, wide / (80 * large)));
    for (const mark of marks.list) {
      const t = mark * UNIT;
      pen.strokeStyle = "#e2e2e2"; pen.beginPath(); pen.moveTo(across(t), TOP); pen.lineTo(across(t), TOP + deep); pen.stroke();
      pen.fillStyle = INK; pen.fillText(decimal(mark, marks.digits) + (mark === marks.list[marks.list.length - 1] ? " " + UNIT_NAME : ""), across(t), TOP + deep + 12 * large);
    }
    pen.save(); pen.beginPath(); pen.rect(LEFT, TOP, wide, deep); pen.clip();
    chart.lines.forEach((line, number) => {
      // In each pixel the first value, the least, the largest and the last; a gap parts one curve from the next.
      const curves = [[]];
      for (let k = first; k <= last; k++) {
        const y = height(line.values[k]), x = Math.round(across(times[k])), curve = curves[curves.length - 1];
        if (!Number.isFinite(line.values[k])) { if (curve.length) curves.push([]); continue; }
        if (!Number.isFinite(y)) continue;
        const column = curve[curve.length - 1];
        // How often it turns round, by more than a few hundredths of the chart.
        if (!column) Object.assign(curve, { turns: 0, peak: y, rises: true });
        if (curve.rises ? y >= curve.peak : y <= curve.peak) curve.peak = y;
        else if (Math.abs(y - curve.peak) > 0.03 * (high - low)) Object.assign(curve, { turns: curve.turns + 1, peak: y, rises: !curve.rises });
        if (column && column.x === x) { column.least = Math.min(column.least, y); column.most = Math.max(column.most, y); column.exit = y; }
        else curve.push({ x, enter: y, least: y, most: y, exit: y });
      }
      pen.strokeStyle = pen.fillStyle = COLOURS[number % COLOURS.length]; pen.lineWidth = 1.3 * large;
      for (const curve of curves) {
        // Where a curve goes to and fro within a few pixels, its strokes would make a pattern that isn't there: a band is drawn.
        pen.beginPath();
        if (curve.turns > 0.2 * curve.length) {
          const near = k => curve.slice(Math.max(0, k - 5), k + 6);
          const most = curve.map((_, k) => Math.max(...near(k).map(column => column.most)));
          const least = curve.map((_, k) => Math.min(...near(k).map(column => column.least)));
          curve.forEach(({ x }, k) => pen.lineTo(x, up(most[k])));
          for (let k = curve.length - 1; k >= 0; k--) pen.lineTo(curve[k].x, up(least[k]));
          pen.closePath(); pen.globalAlpha = 0.3; pen.fill(); pen.globalAlpha = 1;
        } else {
          for (const { x, enter, least, most, exit } of curve) for (const y of [enter, least, most, exit]) pen.lineTo(x, up(y));
        }
        pen.stroke();
      }
    });
    const inSight = motion.events.filter(([time]) => time >= stretch.from && time <= stretch.to), areFew = inSight.length <= MOST_LINES;
    for (const [time, name] of inSight) {
      pen.strokeStyle = "#999"; pen.lineWidth = 0.7 * large; pen.beginPath(); pen.moveTo(across(time), TOP); pen.lineTo(across(time), TOP + (areFew ? deep : 6 * large)); pen.stroke();
      if (inSight.length < 9) { pen.textAlign = "left"; pen.fillStyle = "#777"; overLines(pen, name, across(time) + 3, TOP + 8 * large); }
    }
    pen.strokeStyle = PATH; pen.lineWidth = 1.5; pen.beginPath(); pen.moveTo(across(now), TOP); pen.lineTo(across(now), TOP + deep); pen.stroke();
    pen.restore();
    pen.textAlign = "left"; pen.fillStyle = INK; pen.font = letters(12);
    pen.fillText(title, LEFT, 12 * large, width - LEFT);
    let x = LEFT + wide; pen.textAlign = "right";
    for (const [text, colour] of shownNow.reverse()) {
      pen.fillStyle = colour; pen.fillText(text, x, 12 * large + below); x -= pen.measureText(text).width + 12;
    }
  });
  const timeAt = event => {
    const box = surface.canvas.getBoundingClientRect();
    return stretch.from + (stretch.to - stretch.from) * (event.clientX - box.left - left()) / (box.width - left() - RIGHT);
  };
  surface.canvas.addEventListener("wheel", event => {
    event.preventDefault();
    const about = timeAt(event), factor = Math.exp(event.deltaY * 0.001);
    zoom(about - (about - stretch.from) * factor, about + (stretch.to - about) * factor);
  }, { passive: false });
  dragged(surface.canvas, (x, _, event) => {
    if (!event.shiftKey) return seek(timeAt(event));
    const shift = -x * (stretch.to - stretch.from) / Math.max(1, surface.width - left() - RIGHT);
    zoom(stretch.from + shift, stretch.to + shift);
  });
  surface.canvas.addEventListener("click", event => { if (!event.shiftKey) seek(timeAt(event)); });
  surface.canvas.addEventListener("dblclick", () => zoom(start, end));
  place.title = "Wheel: zoom. Shift and drag: move. Double click: all. Click or drag: go to that time.";
  return surface;
});
function zoom(from, to) {
  const span = Math.min(Math.max(to - from, (end - start) * 1e-5), end - start || 1);
  stretch.from = Math.max(start, Math.min(from, end - span)); stretch.to = stretch.from + span;
  charts.forEach(chart => chart.draw());
}

// Time.
const controls = document.getElementById("controls");
const element = (kind, properties) => controls.appendChild(Object.assign(document.createElement(kind), properties));
const play = element("button", { textContent: "Play" });
const slider = element("input", { type: "range", min: 0, max: 1, step: "any", value: 0, ariaLabel: "Time" });
const clock = element("output", {});
const speed = element("select", { ariaLabel: "Speed" });
// A run lasts at most a minute, and a short one as long as it is.
const usual = 2 ** Math.max(0, Math.ceil(Math.log2((end - start) / 60)));
for (const factor of [0.1, 0.25, 0.5, 1, 2, 4, 10].map(x => x * usual)) speed.add(new Option(`${factor} ×`, factor, factor === usual, factor === usual));
element("p", { textContent: "Space, ←, →: time · L: large letters · V: save a film" });
let playing = false, before = 0;
function seek(time) {
  now = Math.max(start, Math.min(end, time));
  slider.value = end > start ? (now - start) / (end - start) : 0;
  clock.textContent = `${(now / UNIT).toFixed(end - start > 1000 && UNIT === 1 ? 0 : 2)} ${UNIT_NAME}`;
  view.draw(); charts.forEach(chart => chart.draw());
  if (film) film.shoot();
}
function resize() {
  document.documentElement.style.setProperty("--large", large);
  seek(now);
}

// A film of what is on the screen, from the beginning to the end: V. The browser saves it.
let film = null;
function record() {
  if (film) return film.recorder.stop();
  const sheet = document.createElement("canvas"), pen = sheet.getContext("2d"), box = document.querySelector("main").getBoundingClientRect();
  const scale = window.devicePixelRatio || 1, kind = ["video/mp4", "video/webm"].find(kind => window.MediaRecorder && MediaRecorder.isTypeSupported(kind));
  if (!kind) { clock.textContent = "no film here"; return; }
  // Codecs ask for even numbers.
  sheet.width = 2 * Math.round(box.width * scale / 2); sheet.height = 2 * Math.round(box.height * scale / 2);
  const shoot = () => {
    pen.fillStyle = "#fff"; pen.fillRect(0, 0, sheet.width, sheet.height);
    for (const { canvas } of [view, ...charts]) { const at = canvas.getBoundingClientRect(); pen.drawImage(canvas, (at.left - box.left) * scale, (at.top - box.top) * scale); }
  };
  const pieces = [], recorder = new MediaRecorder(sheet.captureStream(30), { mimeType: kind, videoBitsPerSecond: 8e6 });
  recorder.addEventListener("dataavailable", event => pieces.push(event.data));
  recorder.addEventListener("stop", () => {
    if (playing) toggle();
    film = null;
    const blob = new Blob(pieces, { type: kind });
    document.documentElement.dataset.film = blob.size;
    Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: `${document.title}.${kind.slice(6)}` }).click();
  });
  film = { recorder, shoot };
  seek(start); recorder.start();
  if (!playing) toggle();
}
function tick(moment) {
  if (!playing) return;
  const passed = Math.min(0.25, (moment - before) / 1000); before = moment;
  seek(now + passed * Number(speed.value));
  if (now >= end) { if (film) film.recorder.stop(); else toggle(); return; }
  requestAnimationFrame(tick);
}
function toggle() {
  playing = !playing; play.textContent = playing ? "Pause" : "Play";
  if (!playing) return;
  if (now >= end) seek(start);
  before = performance.now(); requestAnimationFrame(tick);
}
play.addEventListener("click", toggle);
slider.addEventListener("input", () => seek(start + (end - start) * slider.value));
document.addEventListener("keydown", event => {
  const step = (end - start) / 200;
  const action = { " ": toggle, ArrowLeft: () => seek(now - step), ArrowRight: () => seek(now + step), Home: () => seek(start), End: () => seek(end), l: () => { large = large > 1 ? 1 : 1.7; resize(); }, v: record }[event.key];
  if (action && event.target.tagName !== "SELECT") { event.preventDefault(); action(); }
});
new ResizeObserver(() => seek(now)).observe(document.body);
resize();
// `#t=12.5` opens the page at that time.
seek(start + (Number(new URLSearchParams(location.hash.slice(1)).get("t")) || 0));
Object.assign(document.documentElement.dataset, { frames, charts: charts.length });
// A page that no time is asked of starts by itself, unless motion is unwelcome.
if (!location.hash.includes("t=") && !window.matchMedia("(prefers-reduced-motion: reduce)").matches) toggle();
