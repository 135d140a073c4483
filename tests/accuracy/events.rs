//! Events against closed forms, and the order of the motion between two steps.

use checks::order::{End, assert_order, counts};
use checks::random::Random;
use declarations::{FreeBody, HeavyTop, Motion};
use liestep::mechanics::Effect;
use liestep::methods::{CompositionScheme, ExactBody, SplittingScheme, SymmetricBody};
use liestep::motion::{Integrator as _, Plan};
use liestep::prelude::*;
use liestep::recording::{Event, sections};
use nalgebra::Vector3;

use crate::many_digits::{DoubleDouble, Vector, long};

/// The steady rotation of a free symmetric body's axis about its momentum in space:
/// `n·R(t) e₃ − c = a + ρ cos(λ t − φ)` with `λ = |Π|/J₁`.
struct Precession {
    /// The constant part `a`, from the axis' component along the momentum.
    mean: f64,
    amplitude: f64,
    phase: f64,
    rate: f64,
}

impl Precession {
    fn of(attitude: SO3, momentum: Vector3<f64>, moment: f64, normal: Vector3<f64>, level: f64) -> Self {
        let spatial = attitude.as_matrix() * momentum;
        let (along, rate) = (spatial.normalize(), spatial.norm() / moment);
        let axis: Vector3<f64> = attitude.as_matrix().column(2).into();
        let across = axis - along * along.dot(&axis);
        let (cosine, sine) = (normal.dot(&across), normal.dot(&along.cross(&across)));
        let mean = normal.dot(&along) * along.dot(&axis) - level;
        Self { mean, amplitude: cosine.hypot(sine), phase: sine.atan2(cosine), rate }
    }

    /// The zeros and their directions up to a time.
    fn zeros(&self, end: f64) -> Vec<(f64, bool)> {
        let angle = (-self.mean / self.amplitude).acos();
        if angle.is_nan() {
            return Vec::new();
        }
        let turns = 0..10 + workbench::measure::steps_in(end * self.rate, 6.0);
        let zeros = turns.flat_map(|turn| {
            let turn = 2.0 * std::f64::consts::PI * (workbench::measure::float(turn) - 2.0) + self.phase;
            [((turn - angle) / self.rate, true), ((turn + angle) / self.rate, false)]
        });
        zeros.filter(|(time, _)| (0.0..end).contains(time)).collect()
    }
}

/// The value `n·R(t) e₃` to 30 digits: in the body frame, the axis rotates about the momentum.
fn exact_value(
    attitude: SO3,
    momentum: Vector3<f64>,
    moment: f64,
    time: DoubleDouble,
    normal: Vector3<f64>,
) -> DoubleDouble {
    let momentum: Vector = momentum.map(long);
    let size = momentum.dot(&momentum).sqrt();
    let along = momentum.map(|part| part / size);
    let axis: Vector = Vector3::z().map(long);
    let across = axis - along * along.z;
    let (sine, cosine) = sine_and_cosine(size / long(moment) * time);
    let turned = along * along.z + across * cosine + along.cross(&axis) * sine;
    (attitude.as_matrix().map(long) * turned).dot(&normal.map(long))
}

/// Sine and cosine by their series at a thousandth of the angle, doubled ten times.
fn sine_and_cosine(angle: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let small = angle / long(1024.0);
    let (mut term, mut sine, mut less) = (long(1.0), long(0.0), long(0.0));
    for k in 1..24 {
        term = term * small / long(f64::from(k));
        match k % 4 {
            1 => sine += term,
            2 => less += term,
            3 => sine -= term,
            _ => less -= term,
        }
    }
    // The function 1 − cos in place of cos avoids cancellation.
    for _ in 0..10 {
        (sine, less) = (long(2.0) * sine * (long(1.0) - less), long(2.0) * sine * sine);
    }
    (sine, long(1.0) - less)
}

/// Ten thousand crossings of random cones by the axes of random bodies, up to a dozen in one step: all are found, in
/// order.
///
/// The exact motion from the beginning of a step is known to 30 digits. A crossing is within two ulp of its exact time
/// if the function changes by more than its rounding error in that time. Otherwise, in the first seconds, in which time
/// has more digits than the function, it is within the time in which the function changes by its rounding error. If
/// that is more than two ulp, the evaluated function is zero at the crossing up to two roundings, so no method that
/// evaluates only the function could be more accurate. Since the start of the run the rounding errors of steps have
/// moved the crossing by at most their number.
#[test]
fn crossings_are_where_closed_forms_have_them() {
    /// The error of an evaluation of `n·R b − c`, in units of rounding. It is measured and not derived: the largest
    /// error is printed, and must be less.
    const ROUNDINGS: f64 = 4.0;
    let mut random = Random::new(181);
    let (mut found, mut in_one_step, mut sharp, mut within, mut at_zero) = (0, 0, 0, 0, 0);
    let (mut of_sharp, mut of_function, mut of_run) = (0.0_f64, 0.0_f64, 0.0_f64);
    while found < 10_000 {
        let (size, shape) = (1.5 + random.signed(), 1.2 + 0.7 * random.signed());
        let moments = [1.0, 1.0, shape].map(|moment| moment * size);
        let momentum = random.direction() * size * (2.0 + random.signed());
        let (normal, attitude, level) = (random.direction(), random.rotation(), 0.9 * random.signed());
        let h = 1.5 + random.signed();
        let flow = SymmetricBody::new(&Inertia::from_principal_moments(moments.into()).unwrap()).unwrap();
        let stepper = Stepper::split(FreeBody::with_moments(moments), h, flow, SplittingScheme::STRANG).unwrap();
        let mut state = stepper.start_with_momentum(attitude, momentum).unwrap();
        let states: Vec<_> = stepper.steps(state).take(50).map(Result::unwrap).collect();
        let states = [&[state], states.as_slice()].concat();
        let expected = Precession::of(attitude, momentum, size, normal, level);
        let bound = 1.001 * expected.amplitude * expected.rate * expected.rate;
        let function = sections::cone(Vector3::z(), normal, level);
        let mut crossings = Vec::new();
        stepper
            .observed(&mut state)
            .event(Event::crossing().curvature(bound), &function, |now| {
                let step = usize::try_from(now.steps()).unwrap();
                crossings.push((now.time(), now.rising().unwrap(), step, function(now)));
            })
            .until(20.0)
            .unwrap();
        assert_eq!(state, states[usize::try_from(state.steps()).unwrap()], "events have moved the steps");
        let zeros = expected.zeros(stepper.time(&state));
        assert_eq!(crossings.len(), zeros.len(), "{crossings:?} for {zeros:?}");
        in_one_step += crossings.windows(2).filter(|pair| pair[0].2 == pair[1].2).count();
        let slope = (expected.amplitude.powi(2) - expected.mean.powi(2)).max(0.0).sqrt() * expected.rate;
        for (&(time, rises, step, value), &(closed, rising)) in crossings.iter().zip(&zeros) {
            assert!(
                rises == rising && (time - closed).abs() < 1e-13 * (1.0 + time + 1.0 / slope),
                "{time} for {closed}"
            );
            let exact = |state: &liestep::State<SO3, (), ()>, time: f64| {
                let since = long(time) - long(stepper.time(state));
                (exact_value(state.attitude(), state.momentum(), size, since, normal) - long(level)).rounded()
            };
            let ulp = f64::EPSILON * 2.0_f64.powf(time.log2().floor());
            let error = exact(&states[step], time).abs() / slope;
            if 2.0 * ulp * slope > ROUNDINGS * f64::EPSILON {
                sharp += 1;
                of_sharp = of_sharp.max(error / ulp);
            } else {
                within += usize::from(error <= 2.0 * ulp);
                at_zero += usize::from(error > 2.0 * ulp && value.abs() <= 2.0 * f64::EPSILON);
                of_function = of_function.max(error * slope / f64::EPSILON);
            }
            let error = exact(&states[0], time).abs() - 2.0 * ulp * slope;
            of_run = of_run.max(error / f64::EPSILON / workbench::measure::float(1 + step as u64));
        }
        found += crossings.len();
    }
    println!(
        "{found} crossings, {in_one_step} with another in the same step; where two ulp of time change the function by"
    );
    println!(
        "more than {ROUNDINGS} roundings, {sharp} of them, within {of_sharp:.2} ulp; of the others {within} within 2, and"
    );
    println!(
        "{at_zero} at a zero of the evaluated function, no farther than it changes by {of_function:.2} roundings;"
    );
    println!("from the start {of_run:.0} roundings for each step");
    assert!(of_sharp <= 2.0 && of_function < ROUNDINGS && of_run < 40.0 && in_one_step > 1000);
    assert!(sharp * 100 > found * 80 && within * 100 > (found - sharp) * 90, "{sharp} {within}");
    assert_eq!(sharp + within + at_zero, found);
}

/// A heavy symmetric top nutates with a period that is a complete elliptic integral.
#[test]
fn a_top_turns_where_its_quadrature_has_it() {
    let top = HeavyTop::thesis();
    let moments = top.ordinary_inertia().as_matrix().diagonal();
    let weight = 2.0 * top.m * top.g * top.rho.norm() / moments.x;
    for (precession, spin) in [(1.9, 12.0), (0.0, 9.0), (-0.7, 15.0)] {
        // At the start the axis neither rises nor falls, so its cosine is a root of `u̇² = f(u)`.
        let (nutation, u) = (0.8_f64, 0.8_f64.cos());
        let velocity = Vector3::new(0.0, precession * nutation.sin(), spin + precession * u);
        let (a, b) =
            (moments.z / moments.x * velocity.z, velocity.y * nutation.sin() + moments.z / moments.x * velocity.z * u);
        let energy = velocity.y.powi(2) + weight * u;
        let (sum, product) = ((energy + a * a) / weight - u, -(energy - b * b) / weight / u);
        let root = (sum * sum / 4.0 - product).sqrt();
        let mut roots = [u, sum / 2.0 - root, sum / 2.0 + root];
        roots.sort_by(f64::total_cmp);
        let [low, high, outside] = roots;
        let (mut x, mut y) = (1.0, ((outside - high) / (outside - low)).sqrt());
        for _ in 0..6 {
            (x, y) = (0.5 * (x + y), f64::sqrt(x * y));
        }
        let half = std::f64::consts::PI / (x * (weight * (outside - low)).sqrt());

        let stepper = Stepper::collocated::<4>(top.clone(), 0.05).unwrap();
        let mut state = stepper.start(SO3::from_euler_angles(0.0, nutation, 0.0), velocity).unwrap();
        let mut turns = Vec::new();
        let vertical = Vector3::z();
        stepper
            .observed(&mut state)
            .event(Event::crossing(), sections::passage(vertical, vertical), |now| {
                turns.push((now.time(), now.attitude().as_matrix().m33));
            })
            .until(20.0 * half)
            .unwrap();
        assert!(turns.len() >= 19, "{turns:?}");
        for (turn, (time, cosine)) in (1..).zip(&turns) {
            let expected = f64::from(turn) * half;
            assert!((time - expected).abs() < 1e-12 * expected, "{time} for {expected}");
            let nearest = if (cosine - low).abs() < (cosine - high).abs() { low } else { high };
            assert!((cosine - nearest).abs() < 1e-12, "{cosine} for {nearest}");
        }
    }
}

/// The motion between two steps has the order of the method.
#[test]
fn between_steps_the_order_is_that_of_the_method() {
    fn between<S, P>(motion: &Motion, stepper: Stepper<S, P>, steps: u32) -> End
    where
        S: Effect<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + 'static,
        P: Plan<S, Kept: 'static> + 'static,
    {
        let stepper = stepper.into_any().on_group::<SO3, Vector3<f64>>().unwrap();
        let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
        stepper.run(&mut state, u64::from(steps) - 1).unwrap();
        let end = stepper.part(&state, PART).unwrap();
        (end.attitude(), stepper.velocity(&end))
    }
    /// The part of the last step.
    const PART: f64 = 0.63;
    let length = |h: f64, steps: u32| h * f64::from(steps) / (f64::from(steps) - 1.0 + PART);
    for top in ["looping A", "third A"] {
        assert_order(("part of a step", 2), (top, 1.0), &counts(100, 1.5, 6), |motion, h, steps| {
            between(motion, Stepper::new(motion.top.clone(), length(h, steps)).unwrap(), steps)
        });
        assert_order(("part of a composition", 6), (top, 1.0), &counts(60, 1.2, 6), |motion, h, steps| {
            let scheme = CompositionScheme::KAHAN_LI_6;
            between(motion, Stepper::composed(motion.top.clone(), length(h, steps), scheme).unwrap(), steps)
        });
        assert_order(("part of a splitting", 4), (top, 1.0), &counts(60, 1.4, 6), |motion, h, steps| {
            let (flow, scheme) = (ExactBody::new(&motion.top.ordinary_inertia()), SplittingScheme::FORCE_GRADIENT_4);
            between(motion, Stepper::split(motion.top.clone(), length(h, steps), flow, scheme).unwrap(), steps)
        });
        assert_order(("part of a collocation", 4), (top, 1.0), &counts(60, 1.4, 6), |motion, h, steps| {
            between(motion, Stepper::collocated::<1>(motion.top.clone(), length(h, steps)).unwrap(), steps)
        });
    }
}
