//! A declared pace: steps of a transformed time.

use checks::order::TOPS;
use declarations::{EqualNeedle, Needle};
use liestep::accuracy::Accuracy;
use liestep::groups::{Given, R3};
use liestep::mechanics::{DiscreteLagrangian as _, Effect};
use liestep::motion::Plan;
use liestep::prelude::*;
use liestep::recording::Event;
use nalgebra::{Matrix3, SVector, Vector6};

use crate::many_digits::heavy_top::Top;
use crate::many_digits::motion::Motion;
use crate::many_digits::poisson::{self, defect, derivative, phase};
use crate::many_digits::{DoubleDouble, Matrix, Vector, long};

/// The rewritten Lagrangian `l_d(F, w, h s̄) + h s̄ E_0`.
fn rewritten(body: &Needle, F: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> f64 {
    let next = F.transpose() * w;
    let step = h * 0.5 * (body.pace(w) + body.pace(&next));
    let change = F - Matrix3::identity();
    let kinetic = (change * body.J_d.as_matrix() * change.transpose()).trace() / (2.0 * step);
    kinetic + 0.5 * step * (1.0 / body.gap(w) + 1.0 / body.gap(&next)) + step * body.energy
}

/// The derived terms of a declaration with a pace are the derivatives of the rewritten Lagrangian.
#[test]
fn the_rewriting() {
    let body = Needle { energy: -1.3, ..Needle::new(0.8) };
    let (w, h) = (Vector3::new(0.3, -0.2, 0.9), 0.3);
    let F = *SO3::exp(Vector3::new(0.2, -0.3, 0.4)).as_matrix();
    let seen = (w, Given::scalar(body.energy));
    let slope = |f: &dyn Fn(f64) -> f64| derivative(|t: f64| SVector::<f64, 1>::new(f(t)), APART).x;
    assert!((body.l_d(&F, &seen, h) - rewritten(&body, &F, &w, h)).abs() < 1e-14);
    for k in 0..3 {
        let turn = |t: f64| *SO3::exp(Vector3::ith(k, t)).as_matrix();
        // The momenta at both ends of the step: `(R_F)* ∂/∂F + ∂/∂w ⋄ w`, and `(L_F)* ∂/∂F`.
        let before = slope(&|t| rewritten(&body, &(turn(t) * F), &(turn(t) * w), h));
        let after = slope(&|t| rewritten(&body, &(F * turn(t)), &w, h));
        assert!((before - body.legendre_minus(&F, &seen, h)[k]).abs() < 1e-12, "{k}");
        assert!((after - body.left_momentum(&F, &seen, h)[k]).abs() < 1e-12, "{k}");
    }
    let energy = -slope(&|t| rewritten(&body, &F, &w, h * (1.0 + 0.2 * t)) / (0.2 * h));
    assert!((energy - body.discrete_energy(&F, &seen, h)).abs() < 1e-11);
}

/// The distance of points in doubles, for functions that are smooth on the scale of one.
const APART: f64 = 0.02;

/// The extended map satisfies `DΦ B DΦᵀ = B` on momentum, `w`, time and `E_0`: for a step of the library, and with 32
/// digits for one that is written down from its equations, as in [`many_digits`](crate::many_digits).
#[test]
fn the_extended_map_is_poisson() {
    let (body, h) = (Needle::new(0.8), 0.2);
    let map = |z: &SVector<f64, 8>| {
        let [momentum, w] = [0, 3].map(|at| z.fixed_rows::<3>(at).into_owned());
        let stepper = Stepper::new(Needle { a: w, energy: z[7], ..body }, h).unwrap();
        let mut state = stepper.start_with_momentum(SO3::identity(), momentum).unwrap();
        stepper.step(&mut state).unwrap();
        let (next, Given(energy)) = state.advected();
        let time = z[6] + 0.5 * h * (body.pace(&w) + body.pace(&next));
        phase(&state.momentum(), &next, &[time, energy.x])
    };
    let z = SVector::<f64, 8>::from_column_slice(&[0.9, 0.15, 0.3, 0.1, 0.6, 0.8, 0.0, -0.9]);
    let (few, long) = (defect(map, &z, APART).amax(), z.map(long));
    let many = defect(|z| long_step(&body, z, h), &long, poisson::APART).map(DoubleDouble::rounded).amax();
    let apart = (long_step(&body, &long, h).map(DoubleDouble::rounded) - map(&z)).norm();
    println!("Poisson {few:.1e}, with 32 digits {many:.1e}; both steps {apart:.1e} apart");
    assert!(few < 1e-12 && many < 1e-26 && apart < 1e-14, "{few:e}, {many:e}, {apart:e}");
}

/// A step of momentum, `w`, time and `E_0`, from its equations, with the kick `p` at each end:
///
/// ```text
/// (F J_d − J_d Fᵀ)^∨ = H (μ + p)      μ⁺ = Fᵀ(μ + p) + p⁺      H = h s̄
/// p = ½ w × (H ∇V − h λ ∇s)           λ = E_0 − tr((F − I) J_d (F − I)ᵀ)/2H² − ½ (V + V⁺)
/// ```
fn long_step(needle: &Needle, z: &SVector<DoubleDouble, 8>, h: f64) -> SVector<DoubleDouble, 8> {
    let mut body = Motion::read(TOPS[3]);
    body.nonstandard = needle.J_d.as_matrix().diagonal().map(long);
    body.moments = body.nonstandard.map(|one| body.nonstandard.sum() - one);
    let (top, J_d) = (Top::at_start_of(&body), Matrix::from_diagonal(&body.nonstandard));
    let [momentum, w] = [0, 3].map(|at| z.fixed_rows::<3>(at).into_owned());
    let (one, half, h, delta, rho) = (long(1.0), long(0.5), long(h), long(needle.delta), needle.rho.map(long));
    let gap = |w: &Vector| ((w - rho).dot(&(w - rho)) + delta * delta).sqrt();
    let pace = |w: &Vector| long(2.0) * gap(w) * gap(w).sqrt();
    let pushed = |w: &Vector, step: DoubleDouble, excess: DoubleDouble| {
        let u = gap(w);
        rho.cross(w) * (half * step / (u * u * u) - long(1.5) * h * excess / u.sqrt())
    };
    let (mut step, mut excess, mut next, mut end) = (h * pace(&w), long(0.0), w, momentum);
    for _ in 0..60 {
        let middle = momentum + pushed(&w, step, excess);
        let back = top.turn(&(middle * step)).transpose();
        (next, end) = (back * w, back * middle + pushed(&(back * w), step, excess));
        step = half * h * (pace(&w) + pace(&next));
        let kinetic = (J_d - J_d * back).trace() / (step * step);
        excess = z[7] - kinetic + half * (one / gap(&w) + one / gap(&next));
    }
    phase(&end, &next, &[z[6] + step, z[7]])
}

/// Outputs are functions of the time `t`, and steps back undo steps.
#[test]
fn what_is_read_is_of_the_time() {
    let (body, h, velocity) = (Needle::new(0.05), 0.012, Vector3::new(0.9, 0.1, 0.15));
    let paced = Stepper::new(body, h).unwrap().paced().unwrap();
    let start = paced.start(SO3::identity(), velocity).unwrap();
    let momentum = Vector3::new(0.9, 0.14, 0.3);
    assert!((start.momentum() - momentum).norm() < 1e-15 && (paced.velocity(&start) - velocity).norm() < 1e-15);
    let energy = 0.5 * momentum.dot(&velocity) - 1.0 / body.gap(&body.a);
    assert!((paced.energy(&start) - energy).abs() < 1e-15 && (start.advected().1.0.x - energy).abs() < 1e-15);
    // Steps of `τ` by a scene with that energy are compared, and their times are summed.
    let own = Stepper::new(Needle { energy, ..body }, h).unwrap();
    let (mut state, mut other) = (start, own.start_with_momentum(SO3::identity(), momentum).unwrap());
    let mut time = 0.0;
    for _ in 0..300 {
        let before = body.pace(&state.advected().0);
        paced.step(&mut state).unwrap();
        own.step(&mut other).unwrap();
        time += 0.5 * h * (before + body.pace(&state.advected().0));
    }
    // Either solve stops where the next update would be below rounding if the curvature of its equation were one. In close
    // passes it is some thousand, so that a hundred roundings are left after 300 steps.
    let apart = (state.momentum() - other.momentum()).norm();
    assert!(apart < 1e-11 && (paced.time(&state) - time).abs() < 1e-13, "{apart:e}");
    let (mut seen, mut last, mut told) = (Vec::new(), start, Vec::new());
    let report = paced
        .observed(&mut last)
        .event(Event::crossing(), |now| now.momentum().x - 0.7, |now| seen.push((now.time(), **now)))
        .progress(|share| told.push(share))
        .until(time - 1e-9);
    assert!(report.unwrap().steps == 300 && !seen.is_empty());
    assert!(told.is_sorted() && told.len() > 50 && told.len() <= 101 && told.last() == Some(&1.0), "{told:?}");
    for (time, motion) in &seen {
        let again = paced.state_at(&start, *time).unwrap();
        assert!((motion.momentum().x - 0.7).abs() < 1e-12 && (again.momentum() - motion.momentum()).norm() < 1e-11);
    }
    assert_eq!(paced.resume(&paced.checkpoint(&state)).unwrap(), state);
    paced.inverse().unwrap().run(&mut state, 300).unwrap();
    assert!((state.momentum() - momentum).norm() < 1e-10 && paced.time(&state).abs() < 1e-10);
    let compensated = Stepper::new(body, h).unwrap().compensated().paced().unwrap();
    assert_eq!(compensated.adopt(&start).advected(), start.advected());
    // A pace must exist, and must be that of the whole scene.
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    assert!(Stepper::new(body + gravity, h).unwrap().paced().is_err());
    assert!(Stepper::new(RigidBody { J_d: body.J_d }, h).unwrap().paced().is_err());
}

/// The largest error of the energy in this number of steps, and their duration.
fn worst<S, P>(stepper: &Stepper<S, P>, steps: u32) -> (f64, f64)
where
    S: Effect<Scalar = f64, Group = SO3>,
    P: Plan<S>,
{
    let start = stepper.start_with_momentum(SO3::identity(), Vector3::new(0.9, 0.15, 0.3)).unwrap();
    let before = stepper.energy(&start);
    let states = stepper.steps(start).take(steps as usize).map(Result::unwrap);
    states
        .fold((0.0, 0.0), |(most, _), now| (f64::max(most, (stepper.energy(&now) - before).abs()), stepper.time(&now)))
}

/// The table of the guide's chapter: `cargo test -p liestep-accuracy-tests -- a_pace_is_worth --nocapture`.
#[test]
fn what_a_pace_is_worth() {
    let needle @ Needle { J_d, a, rho, delta, .. } = Needle::new(0.05);
    let paced = |n: u32, h: f64| worst(&Stepper::new(needle, h).unwrap().paced().unwrap(), n);
    // The step for which the steps end at 12 s.
    let tau = (0..6).fold(12.0, |tau, _| tau * 12.0 / paced(2000, tau / 2000.0).1);
    let rows = [500, 1000, 2000, 4000].map(|n| {
        let equal = Stepper::new(EqualNeedle { J_d, a, rho, delta }, 12.0 / f64::from(n)).unwrap().or_substeps(64);
        let errors = (worst(&equal, n).0, paced(n, tau / f64::from(n)).0);
        println!("{n} steps: equal {:.2e}, paced {:.2e}, {:.0} times less", errors.0, errors.1, errors.0 / errors.1);
        errors
    });
    assert!(rows[2].0 > 100.0 * rows[2].1);
    for pair in rows[1..].windows(2) {
        let order = (pair[0].1 / pair[1].1).log2();
        assert!((order - 2.0).abs() < 0.005, "{order}");
    }
}

/// Two points that attract each other.
#[lagrangian(
    group(d_1 = R3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    given(E_0 = energy),
    pace = {
        let u = (r.norm_squared() + delta * delta).sqrt();
        u * u.sqrt()
    },
    l_d = {
        let V = |r: Vector3<f64>| -1.0 / (r.norm_squared() + delta * delta).sqrt();
        (d_1.norm_squared() + d_2.norm_squared()) / (2.0 * h) - 0.5 * h * (V(r) + V(r + d_2 - d_1))
    },
)]
#[derive(Clone, Copy, Debug)]
struct Pair {
    /// The softening length, with which a step exists even if both points coincide.
    delta: f64,
    energy: f64,
}

/// Two asteroids that pass each other at a thousandth of their distance, a hundred times.
#[test]
fn close_passes_with_a_pace() {
    let far = |x: f64| R3::from(Vector3::x() * x);
    let v = 0.5 * (2.0 * 0.001 / 1.999_f64).sqrt();
    let stepper = Stepper::new(Pair { delta: 1e-5, energy: 0.0 }, 0.04).unwrap().paced().unwrap();
    let mut state = stepper.start((far(-0.9995), far(0.9995)), Vector6::new(0.0, -v, 0.0, 0.0, v, 0.0)).unwrap();
    let before = stepper.energy(&state);
    let (mut passes, mut most, mut nearest, mut was_near) = (0, [0.0_f64; 2], f64::INFINITY, false);
    while passes < 100 {
        stepper.step(&mut state).unwrap();
        let (one, other) = state.attitude();
        let r = (other.translation() - one.translation()).norm();
        nearest = nearest.min(r);
        passes += usize::from(was_near && r > 1.0);
        was_near = r < 1.0;
        if r > 1.0 {
            most[passes / 51] = most[passes / 51].max((stepper.energy(&state) - before).abs());
        }
    }
    println!("{} steps, nearest {nearest:.1e}, energy {before} off by {most:.1?}", state.steps());
    assert!(nearest < 1.2e-3 && most[1] < 1.01 * most[0] && most[0] < 1e-3);
}

/// The search would step in the time of the pace, with the energy zero: another motion.
#[test]
fn a_pace_has_no_choice_by_accuracy() {
    let accuracy = Accuracy { tolerance: 1e-6, horizon: 1.0 };
    let refused = Stepper::for_accuracy(Needle::new(0.8), accuracy, SO3::identity(), Vector3::new(0.1, 0.2, 0.3));
    let message = refused.map(|_| ()).unwrap_err().to_string();
    assert!(message.contains("paced()"), "{message}");
}
