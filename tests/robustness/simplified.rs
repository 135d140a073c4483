//! A last iteration with the previous Jacobian ends at the same root as Newton's iteration, and is used only if it
//! suffices.

use checks::any_scalar::Top;
use checks::solvers::{JacobianCounter, jacobians};
use declarations::{FourthOrderTop, SixthOrderTop};
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::motion::DiscreteLiePoisson;
use liestep::prelude::*;
use nalgebra::{RealField, UnitQuaternion, Vector3, convert};
use num_dual::Dual64;
use workbench::measure::relative;

fn any<T: RealField>(v: Vector3<f64>) -> Vector3<T> {
    v.map(convert)
}

fn top<T: RealField + Copy>(moments: [f64; 3]) -> Top<T> {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(any(moments.into())).unwrap();
    Top { J_d, weight: convert(9.81), rho: any(Vector3::new(0.3, 0.2, 0.4)), up: any(Vector3::z()) }
}

/// The distances of the roots of a thousand steps from the limit of Newton's iteration from there, in roundings of `ξ`:
/// for `f64`, and for numbers with a derivative, which are solved by Newton's iteration alone. Also the number of steps
/// for which one Jacobian was enough.
fn missing(moments: [f64; 3], h: f64, speed: f64) -> ([f64; 2], u32) {
    let plain = DiscreteLiePoisson::new(JacobianCounter(top::<f64>(moments)), h).unwrap();
    let dual = DiscreteLiePoisson::new(top::<Dual64>(moments), h.into()).unwrap();
    let stepper = Stepper::new(top::<f64>(moments), h).unwrap();
    let tilt = UnitQuaternion::from_scaled_axis(Vector3::x() * 0.8);
    let mut state = stepper.start(tilt, Vector3::new(0.1, 0.3, 0.9) * speed).unwrap();
    let constants = stepper.scene().constants(h);
    let mut last = [Vector3::zeros(); 3];
    let (mut sums, mut single) = ([0.0; 2], 0);
    for step in 0..1003 {
        let (momentum, w) = (state.momentum(), state.advected());
        let guess = (last[0] - last[1]) * 3.0 + last[2];
        let (root, count) = jacobians(|| plain.step(&momentum, &w, &guess).unwrap().coordinates);
        let other = dual.step(&any(momentum), &any(w), &any(guess)).unwrap().coordinates.map(|x| x.re);
        if step >= 3 {
            let terms = Top::step_terms(&constants, &(momentum + Top::kick_before(&constants, &w)), &w);
            for (sum, root) in sums.iter_mut().zip([root, other]) {
                let (residual, jacobian) = Top::newton_system(&constants, &terms, &(root * 0.5));
                let update = jacobian.lu().solve(&residual).unwrap();
                *sum += 2.0 * update.norm() / root.norm() / f64::EPSILON / 1000.0;
            }
            single += u32::from(count == 1);
        }
        last = [root, last[0], last[1]];
        stepper.step(&mut state).unwrap();
    }
    (sums, single)
}

#[test]
fn solves_end_at_the_level_of_rounding() {
    let mut with_one = Vec::new();
    for moments in [[3.0, 3.0, 4.0], [2.0, 3.0, 4.5], [1.0, 1.02, 0.05]] {
        for turn in [0.01, 0.02, 0.05, 0.08, 0.12, 0.2, 0.3] {
            let ([plain, newton], single) = missing(moments, turn / 8.0, 8.0);
            println!(
                "{moments:?}, {turn} rad: {plain:.3} roundings, {newton:.3} of Newton's; {single} with one Jacobian"
            );
            assert!(plain < 1.1 * newton + 0.05, "{moments:?}, {turn} rad: {plain} and {newton}");
            with_one.push(single);
        }
    }
    // Slow turns with an extrapolated guess need no second Jacobian, fast ones do.
    assert!(with_one.chunks(7).all(|single| single[1] > 900 && single[6] == 0), "{with_one:?}");
}

/// One more of Newton's updates moves a root by less than two roundings of the residual, also if the Jacobian is much more
/// expensive than the residual.
#[test]
fn higher_orders_end_at_the_level_of_rounding() {
    fn last<L>(h: f64) -> f64
    where
        L: declarations::Top + DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Regular + Clone,
    {
        let J = Inertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).unwrap();
        let top = L::new(J, 9.81, Vector3::new(0.3, 0.2, 0.4), Vector3::z());
        let (flow, constants) = (DiscreteLiePoisson::new(top.clone(), h).unwrap(), top.constants(h));
        let stepper = Stepper::new(top, h).unwrap();
        let tilt = UnitQuaternion::from_scaled_axis(Vector3::x() * 0.8);
        let mut state = stepper.start(tilt, Vector3::new(0.8, 2.4, 7.2)).unwrap();
        let (mut guess, mut sum) = (stepper.velocity(&state) * h, 0.0);
        for _ in 0..200 {
            let (momentum, w) = (state.momentum(), state.advected());
            let root = flow.step(&momentum, &w, &guess).unwrap().coordinates;
            let terms = L::step_terms(&constants, &(momentum + L::kick_before(&constants, &w)), &w);
            let (residual, jacobian) = L::newton_system(&constants, &terms, &(root * 0.5));
            sum += 2.0 * jacobian.lu().solve(&residual).unwrap().norm() / root.norm() / f64::EPSILON;
            guess = root;
            stepper.step(&mut state).unwrap();
        }
        sum / 200.0
    }
    for h in [1e-4, 0.01, 0.05] {
        let missing = [last::<FourthOrderTop>(h), last::<SixthOrderTop>(h)];
        println!("h = {h}: {missing:?} roundings");
        assert!(missing.iter().all(|missing| *missing < 2.0), "h = {h}: {missing:?}");
    }
}

/// The determinant vanishes at a right angle. If it is less than a sixteenth of that at rest, each iteration has its
/// own Jacobian, however good the guess.
#[test]
fn near_the_fold_every_iteration_has_its_jacobian() {
    let body = Top { weight: 0.0, ..top::<f64>([3.0, 3.0, 4.0]) };
    let flow = DiscreteLiePoisson::new(JacobianCounter(body), 1.0).unwrap();
    for (angle, expected) in [(0.5_f64, 1), (1.0, 1), (1.49, 1), (1.52, 2), (1.55, 2)] {
        // The momentum is `p = J sin θ` for a step of one second.
        let momentum = Vector3::z() * (4.0 * angle.sin());
        let root = Vector3::z() * (2.0 * (0.5 * angle).tan());
        let guess = root * (1.0 + 1e-7);
        let (step, count) = jacobians(|| flow.step(&momentum, &Vector3::z(), &guess).unwrap());
        println!("{angle} rad: {count} Jacobians");
        assert!(relative(&step.coordinates, &root) < 1e-12, "{angle} rad");
        assert_eq!(count, expected, "{angle} rad");
    }
}
