//! The animated picture of README: a heavy top with a periodic motion.
//!
//! ```text
//! cargo run --release -p liestep-examples --example moving-top -- examples/figures/moving-top.svg
//! ```
//!
//! A top nods while it precesses. Its initial rates are chosen so that after a whole number of nods it has gone round
//! once, and its pattern is mapped to itself: then the picture can be repeated without a jump.

use std::error::Error;
use std::f64::consts::TAU;
use std::fs;

use liestep::mechanics::Term;
use liestep::prelude::*;
use workbench::heavy_top::declaration::HeavyTop;
use workbench::heavy_top::euler_angles::EulerAngles;

/// The number of nods in one turn about the vertical.
const NODS: u32 = 12;
/// The turn after which the disc looks the same.
const PATTERN: f64 = TAU / 4.0;
/// The tilt at the top of a nod, rad.
const TILT: f64 = 0.5;
/// A guess of the initial rates of precession and spin, rad/s: pushed back, the axis makes loops.
const RATES: [f64; 2] = [-1.2, 6.0];
/// The step, s.
const STEP: f64 = 1e-3;
const FRAMES: u32 = 180;
/// The number of points of the tip's path per frame.
const POINTS: u32 = 4;
/// The size that is acceptable in a README.
const MOST_BYTES: usize = 100_000;

type StateOfTop = State<SO3, <HeavyTop as Term>::Advected>;

/// A nod: the motion between two least tilts.
struct Nod {
    /// The period, s.
    period: f64,
    /// The turns of the axis about the vertical, and of the top about its axis, rad.
    turns: [f64; 2],
}

/// A top with these rates of precession and spin at its start.
fn start(rates: [f64; 2]) -> Result<(Stepper<HeavyTop>, StateOfTop), Box<dyn Error>> {
    let stepper = Stepper::new(HeavyTop::thesis(), STEP)?;
    let angles = EulerAngles { angles: Vector3::new(0.0, TILT, 0.0), rates: Vector3::new(rates[0], 0.0, rates[1]) };
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::x() * TILT);
    let state = stepper.start(attitude, angles.velocity())?;
    Ok((stepper, state))
}

fn nod(rates: [f64; 2]) -> Result<Nod, Box<dyn Error>> {
    let (stepper, mut state) = start(rates)?;
    let angles = |state: &StateOfTop| EulerAngles::of(state.attitude().as_matrix(), &stepper.velocity(state));
    let (mut before, mut turns) = (angles(&state), [0.0; 2]);
    loop {
        stepper.step(&mut state)?;
        let now = angles(&state);
        let rises = |angles: &EulerAngles| angles.rates.y > 0.0 || state.steps() == 1;
        // The end of the nod, by linear interpolation of the nutation's rate between steps.
        let ends = !rises(&before) && rises(&now);
        let part = if ends { before.rates.y / (before.rates.y - now.rates.y) } else { 1.0 };
        for (turn, k) in turns.iter_mut().zip([0, 2]) {
            let change = now.angles[k] - before.angles[k];
            *turn += part * (change - TAU * (change / TAU).round());
        }
        if ends {
            return Ok(Nod { period: stepper.time(&state) - STEP * (1.0 - part), turns });
        }
        before = now;
    }
}

/// The rates near the guess for which the picture is periodic, by Newton's method with differences.
fn closed() -> Result<[f64; 2], Box<dyn Error>> {
    let patterns = (nod(RATES)?.turns[1] * f64::from(NODS) / PATTERN).round();
    let misses = |rates| -> Result<[f64; 2], Box<dyn Error>> {
        let [round, about] = nod(rates)?.turns;
        Ok([round - TAU / f64::from(NODS), about - patterns * PATTERN / f64::from(NODS)])
    };
    let (mut rates, delta) = (RATES, 1e-4);
    for _ in 0..20 {
        let here = misses(rates)?;
        let [a, b] = [[delta, 0.0], [0.0, delta]].map(|d| misses([rates[0] + d[0], rates[1] + d[1]]));
        let (a, b) = (a?, b?);
        let [a, b] = [a, b].map(|there| [(there[0] - here[0]) / delta, (there[1] - here[1]) / delta]);
        let determinant = a[0] * b[1] - a[1] * b[0];
        rates[0] -= (here[0] * b[1] - here[1] * b[0]) / determinant;
        rates[1] -= (a[0] * here[1] - a[1] * here[0]) / determinant;
    }
    Ok(rates)
}

/// The size of the picture, px, the pivot in it, and the radius of the sphere of the tip.
const PICTURE: [f64; 2] = [520.0, 335.0];
const PIVOT: [f64; 2] = [260.0, 247.0];
const SIZE: f64 = 230.0;
/// The elevation of the eye, rad.
const ELEVATION: f64 = 0.6;
/// The distance of the disc from the pivot, and its radius, in units of the sphere's.
const DISC: [f64; 2] = [0.6, 0.3];
/// The visible fraction of the tip's path.
const TAIL: f64 = 0.35;

/// The directions right, up and towards the eye.
struct View([Vector3<f64>; 3]);

impl View {
    /// Pixels, from the pivot downwards.
    fn place(&self, point: &Vector3<f64>) -> [f64; 2] {
        [SIZE * self.0[0].dot(point), -SIZE * self.0[1].dot(point)]
    }

    fn path(&self, points: impl Iterator<Item = Vector3<f64>>) -> String {
        let places = points.map(|point| self.place(&point)).map(|[x, y]| format!("{x:.1} {y:.1}"));
        format!("M{}", places.collect::<Vec<_>>().join(" "))
    }
}

/// The animated attributes, as lists of values.
#[derive(Default)]
struct Lists {
    /// The disc's position, the direction of its longer axis, its foreshortening, and its turn.
    middle: Vec<String>,
    lies: Vec<String>,
    flat: Vec<String>,
    turned: Vec<String>,
    /// The corners of the cone, the tip, and the stem.
    cone: Vec<String>,
    tip: Vec<String>,
    stem: Vec<String>,
    /// Whether the disc is visible from above, in front of the cone.
    above: Vec<String>,
    tail: Vec<String>,
}

/// The next angle, without a jump from the one before.
fn unwrapped(angle: f64, before: &mut Option<f64>) -> f64 {
    let next = before.map_or(angle, |before| angle - TAU * ((angle - before) / TAU).round());
    *before = Some(next);
    next
}

fn lists(view: &View, motion: &[[Vector3<f64>; 2]]) -> Lists {
    let (mut lists, mut lies, mut turned) = (Lists::default(), None, None);
    // The positions in the picture, because the dashes of a path are measured there.
    let places: Vec<_> = motion.iter().map(|[axis, _]| view.place(axis)).collect();
    let ways: Vec<f64> =
        places.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).collect();
    let length = ways.iter().sum::<f64>();
    for (number, [axis, mark]) in motion.iter().enumerate().step_by(POINTS as usize) {
        let across = view.0[2].cross(axis).normalize();
        let along = axis.cross(&across);
        let [x, y] = view.place(&(axis * DISC[0]));
        let (u, v) = (view.place(&across), view.place(&along));
        let flat = (v[1] * u[0] - v[0] * u[1]) / (SIZE * SIZE);
        lists.middle.push(format!("{x:.1} {y:.1}"));
        lists.lies.push(format!("{:.1}", unwrapped(u[1].atan2(u[0]), &mut lies).to_degrees()));
        lists.flat.push(format!("1 {flat:.3}"));
        let turn = unwrapped(mark.dot(&along).atan2(mark.dot(&across)), &mut turned);
        lists.turned.push(format!("{:.1}", turn.to_degrees()));
        // The tangents from the pivot to the ellipse, whose shorter axis points there.
        let (far, short) = (x.hypot(y), DISC[1] * SIZE * flat.abs());
        let (share, half) = ((short / far).powi(2), DISC[1] * (1.0 - (short / far).powi(2)).max(0.0).sqrt());
        let ([cx, cy], [dx, dy]) = ([x, y].map(|c| c * (1.0 - share.min(1.0))), u.map(|u| half * u));
        lists.cone.push(format!("0 0 {:.1} {:.1} {:.1} {:.1}", cx + dx, cy + dy, cx - dx, cy - dy));
        let tip = view.place(axis);
        lists.tip.push(format!("{:.1} {:.1}", tip[0], tip[1]));
        lists.stem.push(format!("M{x:.1} {y:.1} {:.1} {:.1}", tip[0], tip[1]));
        lists.above.push(if axis.dot(&view.0[2]) > 0.0 { "1" } else { "0" }.to_owned());
        let way: f64 = ways[..number].iter().sum();
        lists.tail.push(format!("{:.1}", 1000.0 * (TAIL - way / length)));
    }
    lists
}

/// The duration and the repetition of the animation.
struct Timing(String);

impl Timing {
    fn attribute(&self, name: &str, values: &[String]) -> String {
        format!("<animate attributeName=\"{name}\" values=\"{}\" {}/>", values.join(";"), self.0)
    }

    /// An animation that switches between values without interpolation.
    fn switch(&self, name: &str, values: &[String]) -> String {
        self.attribute(name, values).replacen("<animate", "<animate calcMode=\"discrete\"", 1)
    }

    fn transform(&self, kind: &str, values: &[String]) -> String {
        let values = values.join(";");
        format!("<animateTransform attributeName=\"transform\" type=\"{kind}\" values=\"{values}\" {}/>", self.0)
    }
}

/// The picture for these axes and marks at equal times, of a motion of this duration in seconds.
fn drawn(motion: &[[Vector3<f64>; 2]], duration: f64) -> String {
    let (sine, cosine) = ELEVATION.sin_cos();
    let view = View([Vector3::y(), Vector3::new(-sine, 0.0, cosine), Vector3::new(cosine, 0.0, sine)]);
    let timing = Timing(format!("dur=\"{duration:.2}s\" repeatCount=\"indefinite\""));
    let ([width, height], [left, top]) = (PICTURE, PIVOT.map(|length| -length));
    let path = view.path(motion.iter().map(|[axis, _]| *axis));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"{left} {top} {width} {height}\">\n<title>A heavy top whose tip makes loops</title>\n\
         <rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n\
         <g fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n{}{}</g>\n</svg>\n",
        space(&view, sine),
        moving(&lists(&view, motion), &path, &timing)
    )
}

/// The ground below the pivot, circles of equal tilt, and the vertical.
fn space(view: &View, sine: f64) -> String {
    let circle = |degrees: f64| {
        let (s, c) = degrees.to_radians().sin_cos();
        let point = |k| f64::from(k) * TAU / 72.0;
        let path = view.path((0..=72).map(point).map(|turn| Vector3::new(s * turn.sin(), s * turn.cos(), c)));
        format!("<path d=\"{path}\" stroke=\"#e2e6ea\"/>\n")
    };
    let [x, y] = view.place(&(Vector3::z() * 1.08));
    format!(
        "<ellipse cy=\"3\" rx=\"90\" ry=\"{:.1}\" fill=\"#eef0f3\"/>\n{}{}\
         <path d=\"M0 0 {x:.1} {y:.1}\" stroke=\"#c3c9d0\" stroke-dasharray=\"3 5\"/>\n",
        90.0 * sine,
        circle(30.0),
        circle(60.0)
    )
}

/// The path of the tip, and the top. The stem is behind the disc while that is visible from below, otherwise before it.
fn moving(lists: &Lists, path: &str, timing: &Timing) -> String {
    let radius = DISC[1] * SIZE;
    let sector = |k: u32| {
        let [(s, c), (t, d)] = [k, k + 1].map(|k| (f64::from(k) * TAU / 8.0).sin_cos());
        let [ax, ay, bx, by] = [c, s, d, t].map(|part| radius * part);
        format!("M0 0L{ax:.1} {ay:.1}A{radius:.1} {radius:.1} 0 0 1 {bx:.1} {by:.1}Z")
    };
    let sectors: Vec<_> = (0..8).step_by(2).map(sector).collect();
    let (tail, rest) = (1000.0 * TAIL, 1000.0 * (1.0 - TAIL));
    let stem = format!("<path stroke=\"#2d2d2d\" stroke-width=\"3\">{}</path>", timing.attribute("d", &lists.stem));
    let above = timing.switch("opacity", &lists.above);
    [
        format!("<path d=\"{path}\" stroke=\"#efdbe6\" stroke-width=\"1.5\"/>"),
        format!(
            "<path d=\"{path}\" pathLength=\"1000\" stroke=\"#cc79a7\" stroke-width=\"2\" \
             stroke-dasharray=\"{tail} {rest}\">{}</path>",
            timing.attribute("stroke-dashoffset", &lists.tail)
        ),
        stem.clone(),
        format!("<polygon fill=\"#3d6f95\">{}</polygon>", timing.attribute("points", &lists.cone)),
        format!("<g>{}", timing.transform("translate", &lists.middle)),
        format!("<g>{}", timing.transform("rotate", &lists.lies)),
        format!("<g>{}<circle r=\"{radius:.1}\" fill=\"#3d6f95\"/>", timing.transform("scale", &lists.flat)),
        format!("<g>{above}{}", timing.transform("rotate", &lists.turned)),
        format!("<circle r=\"{radius:.1}\" fill=\"#e2e8ee\" stroke=\"#3d6f95\" stroke-width=\"2\"/>"),
        format!("<path d=\"{}\" fill=\"#5692be\"/></g></g></g></g>", sectors.concat()),
        format!("<g>{above}{stem}</g>"),
        format!("<circle r=\"5\" fill=\"#cc79a7\">{}</circle>\n", timing.transform("translate", &lists.tip)),
    ]
    .join("\n")
}

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args_os().nth(1).ok_or("a file to write is required, as in moving-top.svg")?;
    let rates = closed()?;
    let duration = nod(rates)?.period * f64::from(NODS);
    // The steps are near those for which the rates were found, with a whole number between two points.
    let points = f64::from(FRAMES) * f64::from(POINTS);
    let between = (duration / STEP / points).round();
    let (_, start) = start(rates)?;
    let stepper = Stepper::new(HeavyTop::thesis(), duration / points / between)?;
    let mut state = stepper.adopt(&start);
    let mut motion = Vec::new();
    for _ in 0..=FRAMES * POINTS {
        let attitude = state.attitude().matrix();
        motion.push([attitude.column(2).into(), attitude.column(0).into()]);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // some dozens
        stepper.run(&mut state, between as u64)?;
    }
    let svg = drawn(&motion, duration);
    if svg.len() > MOST_BYTES {
        return Err(format!("the picture has {} bytes, more than {MOST_BYTES}", svg.len()).into());
    }
    fs::write(&file, &svg)?;
    println!("{}: {} nods in {duration:.2} s, {} kB", file.display(), NODS, svg.len().div_ceil(1000));
    Ok(())
}
