//! The declared double pendulum.

use declarations::DoublePendulum;
use liestep::laws::samples::Random;
use liestep::mechanics::{DiagonalNonstandardInertia, Effect, Term};
use liestep::recording::{Recorder, Table};
use liestep::{SO3, Stepper};
use nalgebra::{UnitQuaternion, Vector6};

use super::{check_derived, check_symplectic, element, part};

type Group = (SO3, SO3);

#[test]
fn what_is_derived_is_what_is_declared() {
    check_derived(&DoublePendulum::asymmetric(), 5);
    const { assert!(!DoublePendulum::<f64>::FACTS.has_constant_inertia) };
}

#[test]
fn a_step_is_symplectic() {
    let mut random = Random::new(8);
    for h in [0.02, 0.1] {
        check_symplectic(DoublePendulum::asymmetric(), h, element::<_, 6>(&random.sample()), random.sample());
    }
}

/// The momentum of both links about the vertical.
fn vertical(motion: &liestep::motion::Motion<Group, <DoublePendulum as Term>::Advected>) -> f64 {
    let spatial = motion.spatial_momentum();
    part(&spatial, 0).z + part(&spatial, 1).z
}

/// The momentum of both about the vertical is conserved; a step back undoes a step; and compensated sums and
/// checkpoints work as on a single group.
#[test]
fn vertical_momentum_and_energy() {
    let stepper = Stepper::new(DoublePendulum::asymmetric(), 0.01).unwrap();
    let attitude = element::<Group, 6>(&Random::new(7).sample());
    let mut state = stepper.start(attitude, Vector6::new(0.5, -1.0, 2.0, 1.0, 0.3, -0.5)).unwrap();
    let (before, energy) = (vertical(&state), stepper.energy(&state));
    let (mut most, mut iterations) = (0.0_f64, 0);
    for _ in 0..20_000 {
        iterations += stepper.step(&mut state).unwrap().iterations;
        most = most.max((stepper.energy(&state) - energy).abs());
    }
    println!("momentum {:.1e}, energy {most:.1e}, iterations {iterations}", vertical(&state) - before);
    assert!((vertical(&state) - before).abs() < 1e-12);
    assert!(most < 0.1 && iterations < 70_000);

    let compensated = stepper.clone().compensated();
    let (mut plain, mut carried) = (state, compensated.adopt(&state));
    stepper.run(&mut plain, 100).unwrap();
    compensated.run(&mut carried, 100).unwrap();
    assert!((carried.momentum() - plain.momentum()).norm() < 1e-11);
    let saved = serde_json::to_string(&stepper.checkpoint(&plain)).unwrap();
    let mut resumed = stepper.resume(&serde_json::from_str(&saved).unwrap()).unwrap();
    stepper.run(&mut resumed, 10).unwrap();
    stepper.run(&mut plain, 10).unwrap();
    assert_eq!(resumed, plain);

    let (there, back) = (state, stepper.inverse().unwrap());
    stepper.run(&mut state, 20).unwrap();
    let mut returned = back.adopt(&state);
    back.run(&mut returned, 20).unwrap();
    assert!((returned.momentum() - there.momentum()).norm() < 1e-11);
}

/// A table has the columns of each body, whose names end with the body's number.
#[test]
fn a_record_has_the_columns_of_each_body() {
    let stepper = Stepper::new(DoublePendulum::asymmetric(), 0.01).unwrap();
    let velocity = Vector6::new(0.5, -1.0, 2.0, 1.0, 0.3, -0.5);
    let mut state = stepper.start(element::<Group, 6>(&Random::new(8).sample()), velocity).unwrap();
    let mut recorder = Recorder::new(&stepper, Table::new());
    stepper.observed(&mut state).every(10, |now| recorder.record(now)).steps(50).unwrap();
    let table = recorder.finish().unwrap();
    let columns: Vec<_> = table.columns().iter().map(|column| format!("{} {}", column.name, column.unit)).collect();
    let of_bodies = |of: &str, names: &[&str], unit: &str| -> Vec<String> {
        [1, 2].iter().flat_map(|body| names.iter().map(move |name| format!("{of}_{name}_{body} {unit}"))).collect()
    };
    let axes = ["x", "y", "z"];
    let expected = [
        vec!["t s".to_owned()],
        of_bodies("q", &["w", "x", "y", "z"], "1"),
        of_bodies("velocity", &axes, "rad/s"),
        of_bodies("momentum", &axes, "kg m²/s"),
        vec!["energy J".to_owned(), "defect 1".to_owned()],
    ];
    assert_eq!(columns, expected.concat());
    let last = |name: &str| table.column(name).unwrap().last().unwrap();
    for (place, attitude) in [(1, state.attitude().0), (2, state.attitude().1)] {
        let [w, x, y, z] = ["w", "x", "y", "z"].map(|part| last(&format!("q_{part}_{place}")));
        let read = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(w, x, y, z)).to_rotation_matrix();
        assert!((read.matrix() - attitude.as_matrix()).norm() < 1e-14);
    }
    assert_eq!((last("velocity_z_1"), last("momentum_x_2")), (stepper.velocity(&state)[2], state.momentum()[3]));
}

/// Four bodies in a row, coupled by their attitudes.
#[liestep::lagrangian(
    group(F_1 = SO3, F_2 = SO3, F_3 = SO3, F_4 = SO3),
    advected(Q = F_2.seen_from(F_1), R = F_3.seen_from(F_2), S = F_4.seen_from(F_3)),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
        + ((F_3 - I) * J_3 * (F_3 - I).transpose()).trace() / (2.0 * h)
        + ((F_4 - I) * J_4 * (F_4 - I).transpose()).trace() / (2.0 * h)
        + 0.5 * h * kappa * (Q.trace() + (F_1.transpose() * Q * F_2).trace())
        + 0.5 * h * kappa * (R.trace() + (F_2.transpose() * R * F_3).trace())
        + 0.5 * h * kappa * (S.trace() + (F_3.transpose() * S * F_4).trace()),
)]
#[derive(Clone)]
pub(super) struct CoupledAttitudes {
    pub(super) J_1: DiagonalNonstandardInertia,
    pub(super) J_2: DiagonalNonstandardInertia,
    pub(super) J_3: DiagonalNonstandardInertia,
    pub(super) J_4: DiagonalNonstandardInertia,
    pub(super) kappa: f64,
}
