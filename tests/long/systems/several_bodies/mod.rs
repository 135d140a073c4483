//! Several declared bodies on a product of groups: links with coupled velocities, bodies with coupled attitudes, and
//! bodies with translations; systems of many bodies, chains of many links, and bodies with joints.

mod casimirs;
mod damped;
mod declared;
mod edges;
mod forces;
mod joints;
mod lanes;
mod links;
mod many;
mod stiff;
mod translated;

use core::fmt::Debug;

use checks::structure::momenta::assert_momenta;
use checks::structure::stages::assert_stages;
use checks::structure::{System, Vector, symplectic};
use liestep::groups::{Advected as _, CayleyRetraction, LieGroup, R3, Retraction};
use liestep::mechanics::{ContinuousLagrangian, Regular};
use liestep::motion::RightHandSide;
use liestep::numbers::Bodies;
use liestep::{SO3, StateOf, Stepper};
use nalgebra::{SVector, Vector3, Vector6};
use serde_json::Value;
use workbench::runge_kutta;

use checks::limit::assert_limit;
use declarations::motions::{matrix, number, read, vector};

/// A body with rotation and translation.
type Body = (SO3, R3);

/// The six components from those of the rotation and of the translation.
fn six(turning: &Vector3<f64>, velocity: &Vector3<f64>) -> Vector6<f64> {
    Vector6::from_fn(|k, _| if k < 3 { turning[k] } else { velocity[k - 3] })
}

/// The momentum of all bodies, and their angular momentum about the origin.
fn whole<const N: usize>(bodies: &[Body; N], momenta: &Bodies<Vector6<f64>, N>) -> [Vector3<f64>; 2] {
    bodies.iter().zip(&momenta.0).fold([Vector3::zeros(); 2], |[p, l], (body, momentum)| {
        let [turning, linear] = [0, 1].map(|half| part(momentum, half));
        [p + linear, l + body.0.as_matrix() * turning + body.1.translation().cross(&linear)]
    })
}

/// The components of all bodies, one after the other.
fn stacked<const D: usize>(parts: &[Vector3<f64>]) -> SVector<f64, D> {
    SVector::from_fn(|k, _| parts[k / 3][k % 3])
}

/// The three components of one body.
fn part<const D: usize>(of: &SVector<f64, D>, body: usize) -> Vector3<f64> {
    of.fixed_rows::<3>(3 * body).into_owned()
}

/// The values of a file as an array, one per body of the system.
fn array<R, const N: usize>(values: Vec<R>) -> [R; N] {
    values.try_into().unwrap_or_else(|_| panic!("another number of bodies"))
}

/// The values of all bodies in a file.
fn all<R>(values: &Value, read: impl Fn(&Value) -> R) -> Vec<R> {
    values.as_array().unwrap().iter().map(read).collect()
}

fn attitudes_of(values: &Value) -> Vec<SO3> {
    all(values, |value| SO3::try_from(matrix(value)).unwrap())
}

fn momentum<const D: usize>(values: &Value) -> SVector<f64, D> {
    stacked(&all(values, vector))
}

/// The largest difference between two entries.
fn apart(attitudes: &[SO3], expected: &[SO3]) -> f64 {
    let differences = attitudes.iter().zip(expected).map(|(a, b)| (a.as_matrix() - b.as_matrix()).amax());
    differences.fold(0.0, f64::max)
}

/// Checks order two: each error is a quarter of the one before.
fn order(errors: &[f64]) {
    println!("{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.02, "{order}");
    }
}

/// Checks the errors of the first link's attitude and of the last one's velocity in the reference's chain after two
/// seconds, at steps of 0.02, 0.01, 0.005 and 0.0025 s: the order, and agreement with `tests/data/chain_steps.py`,
/// which reduces and eliminates nothing.
fn assert_reference(errors: &[(f64, f64); 4]) {
    let expected = all(&read("chain steps")["errors"], |of| [&of["attitude"], &of["velocity"]].map(number));
    assert_eq!(expected.len(), errors.len());
    for (found, expected) in errors.iter().zip(expected) {
        let off = [found.0 / expected[0] - 1.0, found.1 / expected[1] - 1.0];
        // The file has seven digits.
        assert!(off.iter().all(|off| off.abs() < 1e-6), "{found:?} {off:?}");
    }
    order(&errors.map(|error| error.0));
    order(&errors.map(|error| error.1));
}

/// Equality to the bit for numbers: as texts, zeros of different signs differ.
fn assert_same<S: PartialEq + Debug>(found: &S, expected: &S) {
    assert_eq!(found, expected);
    assert_eq!(format!("{found:?}"), format!("{expected:?}"));
}

fn element<G, const D: usize>(xi: &SVector<f64, D>) -> G
where
    G: LieGroup<Scalar = f64, Vector = SVector<f64, D>>,
    CayleyRetraction: Retraction<G>,
{
    <CayleyRetraction as Retraction<G>>::retract(xi)
}

/// Checks every term derived from the declared expression, and the limit of small steps.
fn check_derived<L: System + Clone>(l: &L, seed: u64) {
    const { assert!(L::FACTS.is_self_adjoint) };
    assert_momenta(l, seed);
    assert_stages(l, seed);
    assert_limit(l, "several bodies");
}

/// The attitude and velocity after the time by a solver of the continuous equations, which are those of the limit of
/// `l_d`.
fn solved<L, const D: usize>(
    l: &L,
    (attitude, velocity): (L::Group, SVector<f64, D>),
    (time, steps): (f64, u32),
) -> (L::Group, SVector<f64, D>)
where
    L: ContinuousLagrangian<Scalar = f64, Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>>> + Clone,
{
    let continuous = RightHandSide::new(l.clone()).unwrap();
    let momentum = l.momentum(&velocity, &l.advected().seen_from(&attitude));
    let mut state = continuous.state(&attitude, &momentum);
    runge_kutta::run(|y, rate| continuous.rate(y, rate).unwrap(), &mut state, time, steps);
    let (attitude, momentum) = continuous.parts(&state);
    let w = l.advected().seen_from(&attitude);
    (attitude, continuous.velocity(&momentum, &w).unwrap())
}

/// A stepper of a system, and its initial state.
fn started<L: Regular<Scalar = f64>>(
    system: L,
    h: f64,
    (attitude, velocity): (L::Group, liestep::mechanics::Vector<L>),
) -> (Stepper<L>, StateOf<L>) {
    let stepper = Stepper::new(system, h).unwrap();
    let state = stepper.start(attitude, velocity).unwrap();
    (stepper, state)
}

/// P1: checks that a step is symplectic.
fn check_symplectic<L: System + Clone>(l: L, h: f64, attitude: L::Group, velocity: Vector<L>) {
    let (stepper, start) = started(l, h, (attitude, velocity));
    let [defect, of_other_sign] = symplectic::defects(&stepper.flow(), &attitude, &start.momentum());
    println!("symplectic to {defect:.1e}, with the other sign of the bracket {of_other_sign:.1e}");
    assert!(defect < 1e-11 && of_other_sign > 1e-6, "{defect:e}, {of_other_sign:e}");
}
