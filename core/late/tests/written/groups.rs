//! Steps on groups of many rows, of linear and of products: the compiled step, the interpreted text and its C are one to the
//! bit.

// A declaration names its fields by the letters of its formula.
#![allow(non_snake_case)]

use declarations::Flyer;
use liestep::groups::{CayleyRetraction, LieGroup, Retraction, SE3, SE23, matrix_group};
use liestep::mechanics::Regular;
use liestep::motion::Propagator as _;
use liestep::numbers::Entries;
use liestep::with::Method;
use liestep::{SO3, Stepper, lagrangian};
use liestep_late::{Sums, Whole, c};
use nalgebra::{Matrix3, Matrix4, RealField, SMatrix, SVector, UnitQuaternion, Vector3};

use crate::door::{Door, STEP, is_there};
use crate::{ExtendedPose, entries, has_the_bits_of_a_step, parsed};

matrix_group! {
    /// Rotations of four dimensions.
    type SO4 = [
        [[0.0, -1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 1.0, 0.0]],
    ];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 4, 4>) -> T {
        (m.transpose() * m - SMatrix::identity()).norm()
    }

    fn inverse<T: RealField + Copy>(m: &SMatrix<T, 4, 4>) -> SMatrix<T, 4, 4> {
        m.transpose()
    }
}

matrix_group! {
    /// Rotations of five dimensions.
    type SO5 = [
        [[0.0, -1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.0, 1.0, 0.0]],
    ];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 5, 5>) -> T {
        (m.transpose() * m - SMatrix::identity()).norm()
    }

    fn inverse<T: RealField + Copy>(m: &SMatrix<T, 5, 5>) -> SMatrix<T, 5, 5> {
        m.transpose()
    }
}

matrix_group! {
    /// Linear maps of two places and momenta that are symplectic.
    type Sp4 = [
        [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, 0.0]],
        [[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0]],
        [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]],
    ];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 4, 4>) -> T {
        let mut form = SMatrix::zeros();
        for k in 0..2 {
            (form[(k, k + 2)], form[(k + 2, k)]) = (T::one(), -T::one());
        }
        (m.transpose() * form * m - form).norm()
    }
}

matrix_group! {
    /// Galilean maps: turns, boosts, displacements and delays.
    type Galilean = [
        [[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, -1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0]],
    ];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 5, 5>) -> T {
        let turn = m.fixed_view::<3, 3>(0, 0);
        let rows = m.rows(3, 2) - SMatrix::<T, 5, 5>::identity().rows(3, 2);
        let off = rows[(0, 4)];
        (turn.transpose() * turn - SMatrix::identity()).norm_squared() + rows.norm_squared() - off * off
    }
}

matrix_group! {
    /// Maps of space that keep volumes.
    type SL3 = [
        [[0.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
    ];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 3, 3>) -> T {
        (m.determinant() - T::one()).abs()
    }
}

#[lagrangian(
    group = SO4!,
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h),
)]
#[derive(Clone, Copy, Debug)]
struct Four {
    J: SMatrix<f64, 4, 4>,
}

#[lagrangian(
    group = SO5!,
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h),
)]
#[derive(Clone, Copy, Debug)]
struct Five {
    J: SMatrix<f64, 5, 5>,
}

#[lagrangian(
    group = Sp4!,
    l_d = (((F - I) * J * (F - I).transpose()).trace() + ((I - inverse(F)) * J * (I - inverse(F)).transpose()).trace())
        / (4.0 * h),
)]
#[derive(Clone, Copy, Debug)]
struct Optics {
    J: SMatrix<f64, 4, 4>,
}

#[lagrangian(
    group = Galilean!,
    l_d = (((F - I) * J * (F - I).transpose()).trace() + ((I - inverse(F)) * J * (I - inverse(F)).transpose()).trace())
        / (4.0 * h),
)]
#[derive(Clone, Copy, Debug)]
struct Event {
    J: SMatrix<f64, 5, 5>,
}

#[lagrangian(
    group = SL3!,
    l_d = (((F - I) * J * (F - I).transpose()).trace() + ((I - inverse(F)) * J * (I - inverse(F)).transpose()).trace())
        / (4.0 * h),
)]
#[derive(Clone, Copy, Debug)]
struct Volume {
    J: SMatrix<f64, 3, 3>,
}

/// Three bodies with potentials of their relative attitudes.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3, F_3 = SO3),
    advected(Q = F_2.seen_from(F_1), P = F_3.seen_from(F_1)),
    l_d = (((F_1 - I) * A * (F_1 - I).transpose()).trace() + ((F_2 - I) * B * (F_2 - I).transpose()).trace()
        + ((F_3 - I) * B * (F_3 - I).transpose()).trace()) / (2.0 * h)
        + 0.5 * h * k * ((D * Q).trace() + (D * F_1.transpose() * Q * F_2).trace() + P.trace()
            + (F_1.transpose() * P * F_3).trace()),
)]
#[derive(Clone, Copy, Debug)]
struct Three {
    A: Matrix3<f64>,
    B: Matrix3<f64>,
    D: Matrix3<f64>,
    k: f64,
}

fn metric<const N: usize>() -> SMatrix<f64, N, N> {
    let small = |number: usize| f64::from(u8::try_from(number).expect("a few rows"));
    SMatrix::from_fn(|i, j| if i == j { 1.0 + 0.1 * small(i) } else { 0.05 / small(i.abs_diff(j)) })
}

/// The compiled step beside that of its text: each is the same.
fn compared<E>(
    effect: &E,
    (attitude, velocity): (E::Group, &[f64]),
    steps: u32,
    mut compare: impl FnMut(u32, &[f64], &[f64]),
) where
    E: Regular<Scalar = f64> + Clone,
{
    let declaration = parsed(E::DECLARATION);
    let stepper = Stepper::new(effect.clone(), STEP).expect("a stepper");
    let mut at = velocity.iter();
    let components = Entries::from_entries(&mut || at.next().copied().expect("a component"));
    let mut state = stepper.start(attitude, components).expect("a start");
    let numbers = declaration.described(&liestep_late::numbers(effect)).expect("numbers");
    let whole: Whole = Whole::of(declaration, &numbers, STEP, Method::default()).expect("a stepper");
    let mut data = whole.start(&entries(&attitude.matrix()), velocity).expect("a start");
    for step in 0..steps {
        let report = stepper.step(&mut state);
        assert_eq!(report, whole.step(&mut data), "step {step} of {}", declaration.name);
        assert!(report.is_ok(), "step {step} of {}: {report:?}", declaration.name);
        let expected = [entries(&state.attitude().matrix()), entries(&state.momentum())].concat();
        compare(step, &expected, &data[..expected.len()]);
    }
}

/// Compares each step of the interpreted text, and each hundredth of its C.
fn assert_bits<E>(effect: &E, attitude: E::Group, velocity: &[f64])
where
    E: Regular<Scalar = f64> + Clone + 'static,
{
    const STEPS: u32 = 10_000;
    let declaration = parsed(E::DECLARATION);
    compared(effect, (attitude, velocity), STEPS, |step, expected, found| {
        assert_eq!(expected, found, "step {step} of {}", declaration.name);
    });
    if is_there("cc") {
        let text = c(declaration, Sums::Rounded).expect("a step in C");
        assert!(has_the_bits_of_a_step(effect, attitude, velocity, STEPS, (Door::C, &text)), "{}", declaration.name);
    }
}

const NINE: [f64; 9] = [0.25, -0.4, 0.6, 0.15, 0.1, -0.2, 0.05, 0.3, -0.1];

#[test]
fn rigid_motions() {
    let J = Matrix4::new(0.3, 0.02, 0.0, 0.05, 0.02, 0.2, 0.01, 0.0, 0.0, 0.01, 0.25, -0.1, 0.05, 0.0, -0.1, 1.5);
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -0.2, 0.1));
    let attitude = SE3::from_rotation_and_translation(turn, Vector3::new(0.1, 0.2, 0.5));
    assert_bits(&Flyer { J }, attitude, &[0.5, -0.8, 1.2, 0.3, 0.2, -0.4]);
}

#[test]
fn extended_poses() {
    let turn = SVector::from_fn(|i, _| [0.3, -0.5, 0.2][i % 3]);
    let attitude = <CayleyRetraction as Retraction<SE23>>::retract(&turn);
    assert_bits(&ExtendedPose { J: metric() }, attitude, &NINE);
}

/// Five rows, and an inverse by LU.
#[test]
fn galilean_maps() {
    assert_bits(&Event { J: metric() }, Galilean::identity(), &[&NINE[..], &[0.02]].concat());
}

#[test]
fn rotations_of_more_dimensions() {
    assert_bits(&Four { J: metric() }, SO4::identity(), &NINE[..6]);
    assert_bits(&Five { J: metric() }, SO5::identity(), &[&NINE[..], &[0.2]].concat());
}

#[test]
fn volume_preserving_maps() {
    assert_bits(&Volume { J: metric() }, SL3::identity(), &[-0.3, 0.2, 0.3, 0.1, -0.2, -0.1, 0.0, 0.0]);
}

#[test]
fn symplectic_maps() {
    assert_bits(&Optics { J: metric() }, Sp4::identity(), &[0.0, 0.2, -0.2, 0.0, -0.3, -0.2, 0.1, 0.3, 0.2, -0.1]);
}

#[test]
fn three_bodies() {
    let A = Matrix3::from_diagonal(&Vector3::new(1.0, 1.5, 2.0));
    let B = Matrix3::new(1.0, 0.0, 0.1, 0.0, 1.5, 0.0, 0.1, 0.0, 2.0);
    let D = Matrix3::new(1.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.2, 0.0, 2.0);
    let velocity = [0.1, 1.0, 0.2, 0.1, 0.0, 0.2, 0.1, 0.0, -1.0];
    assert_bits(&Three { A, B, D, k: 2.0 }, LieGroup::identity(), &velocity);
}

/// In steps of half a radian pivots are on the diagonal; in longer ones the library's LU has others, and other roundings.
#[test]
fn long_steps_agree_to_rounding() {
    let event = Event { J: metric() };
    let most = |turn: f64| {
        let (mut most, velocity) = (0.0_f64, [&[turn], &NINE[..]].concat());
        compared(&event, (Galilean::identity(), &velocity), 3, |_, expected, found| {
            most = expected.iter().zip(found).fold(most, |most, (a, b)| most.max((a - b).abs()));
        });
        most
    };
    assert_eq!(most(0.5 / STEP).to_bits(), 0);
    assert!(most(0.9 / STEP) < 1e-13, "{:e}", most(0.9 / STEP));
}
