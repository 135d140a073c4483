//! T11 and T12: the claims of the thesis on its figures 3.7 to 3.10: the kind of precession of each case, the period of
//! nutation, and the time after which Runge–Kutta loses them.

use declarations::Motion;
use liestep::groups::LieGroup as _;
use nalgebra::Vector3;
use workbench::heavy_top::euler_angles::EulerAngles;
use workbench::heavy_top::precession::{Kind, Precession};
use workbench::heavy_top::rk4::Body;
use workbench::measure::{float, four_halvings, greater, order, steps_in};
use workbench::run::{Method, Sample};
use workbench::variational::Variational;

use crate::rivals::{on_matrix, on_quaternion, started};
use crate::row::{Effort, Failure, Row};
use crate::walk::orthogonality;

/// The ranges of two quantities, and the times of the minima of the first.
struct Ranges {
    tilt: (f64, f64),
    rate: (f64, f64),
    minima: Vec<f64>,
}

fn extended((least, most): (f64, f64), value: f64) -> (f64, f64) {
    (least.min(value), most.max(value))
}

/// The tilt and the rate of precession between two times, by a method's steps of `h`.
fn seen(body: &Body, method: &mut impl Method, h: f64, from: f64, to: f64) -> Result<Ranges, Failure> {
    method.advance(steps_in(from, h))?;
    let nothing = (f64::INFINITY, f64::NEG_INFINITY);
    let mut seen = Ranges { tilt: nothing, rate: nothing, minima: Vec::new() };
    let mut before: Option<f64> = None;
    for step in steps_in(from, h)..=steps_in(to, h) {
        let Sample { attitude, momentum } = method.sample();
        let angles = EulerAngles::of(&attitude, &body.inverse_moments.component_mul(&momentum));
        (seen.tilt, seen.rate) = (extended(seen.tilt, angles.angles.y), extended(seen.rate, angles.rates.x));
        // The zeros of θ' upwards, by linear interpolation between steps.
        let nutation = angles.rates.y;
        if let Some(before) = before.filter(|before| *before < 0.0 && nutation >= 0.0) {
            seen.minima.push(h * (float(step) - nutation / (nutation - before)));
        }
        before = Some(nutation);
        method.advance(1)?;
    }
    Ok(seen)
}

fn ours(motion: &Motion, h: f64, from: f64, to: f64) -> Result<Ranges, Failure> {
    let (stepper, state) = started(motion, h)?;
    seen(&Body::of(&motion.top), &mut Variational { stepper: &stepper, state }, h, from, to)
}

fn closed(motion: &Motion) -> Precession {
    let momentum = motion.top.ordinary_inertia().as_matrix() * motion.velocity;
    Precession::of(&motion.top, &momentum, &motion.attitude.matrix().row(2).transpose())
}

/// The larger distance between the ends of two ranges.
fn apart(a: (f64, f64), b: (f64, f64)) -> f64 {
    greater((a.0 - b.0).abs(), (a.1 - b.1).abs())
}

/// The kinds in the order of [`Motion::of_the_thesis`]; the thesis calls the third by reading A unidirectional.
const KINDS: [Kind; 6] =
    [Kind::Looping, Kind::Cuspidal, Kind::Looping, Kind::Looping, Kind::Cuspidal, Kind::Unidirectional];

pub(crate) fn t11(_: Effort) -> Result<Row, Failure> {
    let mut row = Row::new(
        "T11",
        "nutation and precession of the thesis' tops, both readings, 20 s",
        "ranges and period of the first integrals, order 2.00 ± 0.05; kinds as named, but for the third by reading A",
    );
    for (motion, kind) in Motion::of_the_thesis().iter().zip(KINDS) {
        let closed = closed(motion);
        let (mut errors, mut period) = (Vec::new(), Vec::new());
        for h in four_halvings(0.01) {
            let seen = ours(motion, h, 0.0, 20.0)?;
            errors.push((h, greater(apart(seen.tilt, closed.tilt), apart(seen.rate, closed.rate))));
            let (first, last) = (seen.minima[0], seen.minima[seen.minima.len() - 1]);
            let measured = (last - first) / (float(seen.minima.len() as u64) - 1.0);
            period.push((h, (measured / closed.period - 1.0).abs()));
            if h < 1e-3 {
                let found = Precession { tilt: seen.tilt, rate: seen.rate, period: measured };
                row = row.holds(
                    &format!(
                        "{}: {kind:?}, φ' {:.3} to {:.3}, θ {:.4} to {:.4}",
                        motion.name, found.rate.0, found.rate.1, found.tilt.0, found.tilt.1
                    ),
                    found.kind(1e-3) == kind && closed.kind(1e-9) == kind,
                );
            }
        }
        row = row.at_most(&format!("{}: ranges at h = 1/1600", motion.name), errors[4].1, 1e-3).near(
            &format!("{}: order of the period {:.6} s", motion.name, closed.period),
            order(&period, 1e-10),
            2.0,
            0.05,
        );
    }
    Ok(row)
}

/// The duration, s, and a step by which the classical method of order 4 has lost the motion by then.
const END: f64 = 200.0;
const COARSE: f64 = 0.05;

pub(crate) fn t12(_: Effort) -> Result<Row, Failure> {
    let motion = Motion::looping();
    let closed = closed(&motion);
    let mut row = Row::new(
        "T12",
        "the looping top for 200 s by steps of 0.02 and 0.05 s, beside RK4 in nine entries of R and in a quaternion",
        "ours stays rigid and loops between its two tilts; RK4 in nine entries passes 1e-2, and at 0.05 leaves that band",
    );
    for h in [0.02, COARSE] {
        let mut theirs = on_matrix(&motion, h);
        theirs.advance(steps_in(END, h))?;
        let (stepper, mut state) = started(&motion, h)?;
        stepper.run(&mut state, steps_in(END, h))?;
        let lost = orthogonality(&theirs.sample().attitude);
        row = row
            .at_most(&format!("h = {h}: our ‖RᵀR − I‖"), orthogonality(&state.attitude().matrix()), 1e-13)
            .holds(&format!("h = {h}: that of RK4 in nine entries {lost:.1e}"), lost > 1e-2);
    }
    let drawn = |Path { tilt, turns_back, .. }: &Path| {
        format!("tilt {:.2} to {:.2}, the azimuth turns back {turns_back} times", tilt.0, tilt.1)
    };
    row = row.shows(format!("the exact tilt is {:.2} to {:.2}", closed.tilt.0, closed.tilt.1));
    let (stepper, state) = started(&motion, COARSE)?;
    let path = late_path(&mut Variational { stepper: &stepper, state })?;
    row = row.holds(&format!("h = {COARSE}, the last 20 s, ours: {}", drawn(&path)), {
        apart(path.tilt, closed.tilt) < 0.02 && path.turns_back > 40
    });
    let path = late_path(&mut on_matrix(&motion, COARSE))?;
    row = row
        .holds(&format!("RK4 in nine entries: {}", drawn(&path)), {
            path.tilt.1 < closed.tilt.0 || path.tilt.0 > closed.tilt.1
        })
        .holds(
            &format!("and the length of the tip is {:.2} to {:.2}", path.length.0, path.length.1),
            path.length.1 < 0.9,
        );
    let path = late_path(&mut on_quaternion(&motion, COARSE))?;
    Ok(row.other(format!("RK4 in a quaternion, h = {COARSE}: {}", drawn(&path))))
}

/// The path of the tip `R e₃` in the last 20 s.
struct Path {
    /// The least and the greatest tilt, rad.
    tilt: (f64, f64),
    /// The least and the greatest length, which should be one.
    length: (f64, f64),
    /// The number of times that the azimuth begins to decrease: once a loop.
    turns_back: u32,
}

fn late_path(method: &mut impl Method) -> Result<Path, Failure> {
    method.advance(steps_in(END - 20.0, COARSE))?;
    let azimuth = |tip: &Vector3<f64>| tip.y.atan2(tip.x);
    let nothing = (f64::INFINITY, f64::NEG_INFINITY);
    let mut tip: Vector3<f64> = method.sample().attitude.column(2).into();
    let (mut path, mut forwards) = (Path { tilt: nothing, length: nothing, turns_back: 0 }, false);
    for _ in 0..steps_in(20.0, COARSE) {
        method.advance(1)?;
        let next: Vector3<f64> = method.sample().attitude.column(2).into();
        path.tilt = extended(path.tilt, next.xy().norm().atan2(next.z));
        path.length = extended(path.length, next.norm());
        // The sine of a difference isn't affected by jumps of the azimuth by a full turn.
        let goes_forwards = (azimuth(&next) - azimuth(&tip)).sin() > 0.0;
        path.turns_back += u32::from(forwards && !goes_forwards);
        (tip, forwards) = (next, goes_forwards);
    }
    Ok(path)
}
