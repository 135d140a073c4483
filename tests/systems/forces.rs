//! Forces and torques of joints, against the equations of motion of the bodies between which they act.

use liestep::effects::joints::{JointSpring, SliderDamping, SliderFriction};
use liestep::groups::R3;
use liestep::methods::{CompositionScheme, Joint, Multibody};
use liestep::{SO3, SetupError, force};
use nalgebra::{Matrix3, Vector3};

use crate::joints::{assert_second_order, at, falling, floating, six};

/// Friction in a slider acts at its point, so that the joint has the torque against its moment about the center of mass.
#[test]
fn friction_in_a_slider_acts_at_the_joint() {
    let (speed, axis, at_2) = (0.8, Vector3::x(), Vector3::new(0.1, 0.2, -0.3));
    let torque = |is_dry: bool| {
        let mut system = Multibody::new();
        let mass = system.body(floating(1.5, [0.2, 0.3, 0.4]));
        system.join(Joint::slider([at_2, at_2], axis, Matrix3::identity()), None, mass);
        if is_dry {
            system.between([None, Some(mass)], SliderFriction { force: 0.3, speed: 1e-5, axis, at_2 });
        } else {
            system.between([None, Some(mass)], SliderDamping { c: 0.4, axis, at_2 });
        }
        let stepper = system.stepper(1e-3).unwrap();
        let state = stepper.start(&[at(0.0, 0.0, 0.0)], &[six([0.0; 3], (axis * speed).into())]).unwrap();
        stepper.joint_forces(&state).unwrap()[0]
    };
    for (is_dry, friction) in [(false, -0.4 * speed), (true, -0.3)] {
        let [force, torque] = torque(is_dry);
        let expected = -at_2.cross(&(axis * friction));
        assert!(force.norm() < 1e-12, "{force}");
        assert!((torque - expected).norm() < 3e-4 * expected.norm(), "{torque} {expected}");
    }
}

/// The load of a joint on a body is the rate of its momentum but for its weight, and that of its angular momentum about the center of
/// mass, where no spring is: a universal joint has a torque about the axis across both of its own, which turns with the bodies.
#[test]
fn torques_are_of_second_order() {
    let (m, g, moments) = (1.2, 9.81, [0.3, 0.2, 0.1]);
    let arm = Vector3::new(0.1, -0.2, 0.5);
    let load = |h: f64| {
        let mut system = Multibody::new();
        let body = system.body(falling(m, moments));
        system.join(Joint::universal([Vector3::zeros(), arm], [Vector3::x(), Vector3::y()]), None, body);
        let stepper = system.stepper(h).unwrap();
        let turning = Vector3::new(2.0, 3.0, 0.0);
        let start = six(turning.into(), (-turning.cross(&arm)).into());
        let mut state = stepper.start(&[(SO3::identity(), R3::from(-arm))], &[start]).unwrap();
        // The step of which the middle is at 0.24 s.
        let steps = (0.24 / h - 0.5).round();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        stepper.run(&mut state, steps as u64).unwrap();
        let [force, torque] = stepper.joint_forces(&state).unwrap()[0];
        let spun = |state: &[f64]| {
            let velocity = stepper.velocity(state, body);
            let (turn, shift) = (velocity.fixed_rows::<3>(0).into_owned(), velocity.fixed_rows::<3>(3).into_owned());
            let attitude = *stepper.attitude(state, body).0.as_matrix();
            (attitude * Vector3::from(moments).component_mul(&turn), shift * m, attitude * arm)
        };
        let before = spun(&state);
        stepper.step(&mut state).unwrap();
        let after = spun(&state);
        let arm = (before.2 + after.2) * 0.5;
        let expected = [(after.1 - before.1) / h + Vector3::z() * m * g, (after.0 - before.0) / h - arm.cross(&force)];
        (force, torque, expected)
    };
    let off = |h: f64| {
        let (force, torque, [of_force, of_torque]) = load(h);
        assert!(torque.norm() > 0.1, "{torque}");
        [(force - of_force).norm(), (torque - of_torque).norm()]
    };
    let [coarse, fine] = [0.24 / 30.5, 0.24 / 60.5].map(off);
    println!("{coarse:?} {fine:?}");
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!(fine < 1e-9 || coarse / fine > 3.0, "{coarse:e} {fine:e}");
    }
    // Against a finer one, at this time.
    let finest = load(0.24 / 960.5);
    assert_second_order([30.5, 60.5].map(|steps| (load(0.24 / steps).1 - finest.1).norm()));
    assert_second_order([30.5, 60.5].map(|steps| (load(0.24 / steps).0 - finest.0).norm()));
}

/// A torque between two bodies by which a step of `−h` doesn't undo one of `h`: a root of an odd power of the step.
#[force(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    displacement(eta_1, eta_2),
    work = {
        let turn = Q * vee(F_2) - vee(F_1);
        let share = 0.5 * h * torque / (turn.norm_squared() + h * h).sqrt();
        -share * (turn.dot(&(Q * eta_2 - eta_1)) + turn.dot(&(Q * (F_2 * eta_2_next) - F_1 * eta_1_next)))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct OneWay {
    torque: f64,
}

#[test]
fn a_composition_needs_terms_that_are_undone() {
    let system = |is_one_way: bool| {
        let mut system = Multibody::new();
        let wheel = system.body(floating(1.0, [0.3, 0.3, 0.4]));
        system.join(Joint::pin([Vector3::zeros(); 2], [Vector3::z(); 2]), None, wheel);
        system.between([None, Some(wheel)], JointSpring { k: 0.3, rest: Matrix3::identity() });
        if is_one_way {
            system.between([None, Some(wheel)], OneWay { torque: 0.1 });
        }
        system.stepper(0.1).unwrap().composed(CompositionScheme::SUZUKI_4)
    };
    assert!(system(false).is_ok());
    assert_eq!(system(true).err(), Some(SetupError::NotSelfAdjoint));
}
