//! The double pendulum as it is declared.

use declarations::DoublePendulum;
use declarations::motions::{number, read, vector};
use liestep::groups::{CayleyRetraction, Retraction};
use liestep::laws::samples::Random;
use liestep::mechanics::{DiagonalNonstandardInertia, Effect, Term};
use liestep::methods::CompositionScheme;
use liestep::recording::{Recorder, Table};
use liestep::{NonstandardInertia, SO3, Stepper};
use nalgebra::{SVector, UnitQuaternion, Vector3, Vector6};

use super::{check_derived, check_symplectic, order, part, stacked};

type Group = (SO3, SO3);

fn element(random: &mut Random, size: f64) -> Group {
    let xi: SVector<f64, 6> = random.sample();
    <CayleyRetraction as Retraction<Group>>::retract(&(xi * size))
}

#[test]
fn what_is_derived_is_what_is_declared() {
    check_derived(&DoublePendulum::asymmetric(), 5);
    const { assert!(!DoublePendulum::<f64>::INERTIA_IS_CONSTANT) };
}

#[test]
fn a_step_is_symplectic() {
    let mut random = Random::new(8);
    for h in [0.02, 0.1] {
        check_symplectic(DoublePendulum::asymmetric(), h, element(&mut random, 1.0), random.sample());
    }
}

/// Two point masses on rods. The reference knows directions alone, and bodies that start without spin move as these,
/// whatever their moments about their axes.
#[test]
fn spherical_pendulum() {
    let data = &read("several bodies")["double_spherical_pendulum"];
    let (start, end) = (&data["states"][0], &data["states"][1]);
    let (e, direction) = (Vector3::z(), |value: &serde_json::Value, k: usize| vector(&value["q"][k]));
    let started = |pendulum: &DoublePendulum| {
        let [first, second] = [(0, pendulum.J_1), (1, pendulum.J_2)]
            .map(|(k, inertia)| inertia.pointing(&e, &direction(start, k), &vector(&start["omega"][k])).unwrap());
        ((first.0, second.0), stacked(&[first.1, second.1]))
    };
    let directions = |at: &Group| [at.0, at.1].map(|attitude| attitude.as_matrix() * e);
    let error = |end_at: &Group| {
        let [first, second] = directions(end_at);
        (first - direction(end, 0)).amax().max((second - direction(end, 1)).amax())
    };
    let run = |pendulum: DoublePendulum, (h, steps): (f64, u64)| {
        let ((attitude, velocity), stepper) = (started(&pendulum), Stepper::new(pendulum, h).unwrap());
        let mut state = stepper.start(attitude, velocity).unwrap();
        let energy = stepper.energy(&state);
        assert!((energy - number(&start["energy"])).abs() < 1e-13, "{energy}");
        for hundreds in 1..=steps / 100 {
            stepper.run(&mut state, 100).unwrap();
            let momentum = state.momentum();
            // What roundings of so many steps leave.
            let allowed = 1e-15 * f64::from(u32::try_from(hundreds).unwrap());
            let about_axes = momentum[2].abs().max(momentum[5].abs()) / momentum.norm();
            assert!(about_axes < allowed, "about the axes: {about_axes:e}");
        }
        state.attitude()
    };
    let errors =
        [(0.01, 200), (0.005, 400), (0.0025, 800)].map(|steps| error(&run(DoublePendulum::spherical(0.01), steps)));
    order(&errors);
    for (found, expected) in errors.iter().zip([1.78e-3, 4.45e-4, 1.11e-4]) {
        assert!((found / expected - 1.0).abs() < 0.01, "{errors:?}");
    }
    let expected = directions(&run(DoublePendulum::spherical(0.01), (0.01, 200)));
    for spinning in [1e-4, 0.3, 1.0] {
        let found = directions(&run(DoublePendulum::spherical(spinning), (0.01, 200)));
        let off = (found[0] - expected[0]).amax().max((found[1] - expected[1]).amax());
        println!("with {spinning} about the axes: {off:.1e}");
        assert!(off < 1e-13, "{spinning}: {off:e}");
    }
    let pendulum = DoublePendulum::spherical(0.25 * 1.7);
    assert!((NonstandardInertia::of_rod(1.7, &e).unwrap().as_matrix() - pendulum.J_1.as_matrix()).amax() < 1e-15);
    let (attitude, velocity) = started(&pendulum);
    let composed = Stepper::composed(pendulum, 0.02, CompositionScheme::KAHAN_LI_8).unwrap();
    let mut state = composed.start(attitude, velocity).unwrap();
    composed.run(&mut state, 100).unwrap();
    println!("of order 8: {:.1e}", error(&state.attitude()));
    assert!(error(&state.attitude()) < 1e-8);
}

/// Along the vertical the momentum of both.
fn vertical(motion: &liestep::motion::Motion<Group, <DoublePendulum as Term>::Advected>) -> f64 {
    let spatial = motion.spatial_momentum();
    part(&spatial, 0).z + part(&spatial, 1).z
}

/// Along the vertical the momentum of both is kept; a step back undoes a step, and sums are compensated and checkpoints
/// go on as on a group.
#[test]
fn vertical_momentum_and_energy() {
    let stepper = Stepper::new(DoublePendulum::asymmetric(), 0.01).unwrap();
    let attitude = element(&mut Random::new(7), 1.0);
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

/// A table has the columns of each body, with its place behind their names.
#[test]
fn a_record_has_the_columns_of_each_body() {
    let stepper = Stepper::new(DoublePendulum::asymmetric(), 0.01).unwrap();
    let velocity = Vector6::new(0.5, -1.0, 2.0, 1.0, 0.3, -0.5);
    let mut state = stepper.start(element(&mut Random::new(8), 1.0), velocity).unwrap();
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
