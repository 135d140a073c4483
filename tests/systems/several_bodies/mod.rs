//! Several bodies on a product of groups, as they are declared: links that feel each other's velocities, bodies that feel
//! each other's attitudes alone, and bodies that are translated too; systems of many, chains of many links, and bodies held
//! together by joints.

mod casimirs;
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

use crate::limit::assert_limit;
use declarations::motions::{matrix, number, read, vector};

/// A body that is translated, too.
type Body = (SO3, R3);

/// The turning part, and the other.
fn six(turning: &Vector3<f64>, velocity: &Vector3<f64>) -> Vector6<f64> {
    Vector6::from_fn(|k, _| if k < 3 { turning[k] } else { velocity[k - 3] })
}

/// The momentum of all, and their angular momentum about the origin.
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

/// Those of one body.
fn part<const D: usize>(of: &SVector<f64, D>, body: usize) -> Vector3<f64> {
    of.fixed_rows::<3>(3 * body).into_owned()
}

/// What a file has, as many as the system has bodies.
fn array<R, const N: usize>(values: Vec<R>) -> [R; N] {
    values.try_into().unwrap_or_else(|_| panic!("another number of bodies"))
}

/// What a file has of all bodies.
fn all<R>(values: &Value, read: impl Fn(&Value) -> R) -> Vec<R> {
    values.as_array().unwrap().iter().map(read).collect()
}

fn attitudes_of(values: &Value) -> Vec<SO3> {
    all(values, |value| SO3::try_from(matrix(value)).unwrap())
}

fn momentum<const D: usize>(values: &Value) -> SVector<f64, D> {
    stacked(&all(values, vector))
}

/// The largest difference of an entry.
fn apart(attitudes: &[SO3], expected: &[SO3]) -> f64 {
    let differences = attitudes.iter().zip(expected).map(|(a, b)| (a.as_matrix() - b.as_matrix()).amax());
    differences.fold(0.0, f64::max)
}

/// Each error is a quarter of the one before.
fn order(errors: &[f64]) {
    println!("{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.02, "{order}");
    }
}

/// Errors of the first link's attitude and of the last one's velocity in the reference's chain after two seconds, at steps
/// of 0.02, 0.01, 0.005 and 0.0025 s: the order, and those of `tests/data/chain_steps.py`, which reduces and eliminates
/// nothing.
fn assert_reference(errors: &[(f64, f64); 4]) {
    let expected = all(&read("chain steps")["errors"], |of| [&of["attitude"], &of["velocity"]].map(number));
    assert_eq!(expected.len(), errors.len());
    for (found, expected) in errors.iter().zip(expected) {
        let off = [found.0 / expected[0] - 1.0, found.1 / expected[1] - 1.0];
        // Seven digits are written.
        assert!(off.iter().all(|off| off.abs() < 1e-6), "{found:?} {off:?}");
    }
    order(&errors.map(|error| error.0));
    order(&errors.map(|error| error.1));
}

/// To the bit where they are numbers: as texts, zeros of different signs differ.
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

/// Every term that is derived from the declared expression, and the limit of small steps.
fn check_derived<L: System + Clone>(l: &L, seed: u64) {
    const { assert!(L::SELF_ADJOINT) };
    assert_momenta(l, seed);
    assert_stages(l, seed);
    assert_limit(l, "several bodies");
}

/// Where a solver of the continuous equations, which are those of the limit of `l_d`, comes from a start: attitude and
/// velocity after the time.
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

/// A stepper of a system, and where it starts.
fn started<L: Regular<Scalar = f64>>(
    system: L,
    h: f64,
    (attitude, velocity): (L::Group, liestep::mechanics::Vector<L>),
) -> (Stepper<L>, StateOf<L>) {
    let stepper = Stepper::new(system, h).unwrap();
    let state = stepper.start(attitude, velocity).unwrap();
    (stepper, state)
}

/// P1.
fn check_symplectic<L: System + Clone>(l: L, h: f64, attitude: L::Group, velocity: Vector<L>) {
    let (stepper, start) = started(l, h, (attitude, velocity));
    let [defect, of_other_sign] = symplectic::defects(&stepper.flow(), &attitude, &start.momentum());
    println!("symplectic to {defect:.1e}, with the other sign of the bracket {of_other_sign:.1e}");
    assert!(defect < 1e-11 && of_other_sign > 1e-6, "{defect:e}, {of_other_sign:e}");
}
