//! A motion doesn't depend on the body axes in which it is described. In axes turned or mirrored by an orthogonal `Q`
//! everything is seen in a mirror, `J_d' = Q J_d Qᵀ`, `ρ' = Qρ`, `R' = QRQᵀ`, `up' = Q up`, and the angular velocity,
//! an axial vector, is `Ω' = det(Q) QΩ`.

use checks::random::Random;
use declarations::{FullTop, HeavyTop, Motion};
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::prelude::*;
use nalgebra::{Matrix3, Vector3};
use workbench::measure::relative;

/// One second; the looping top's spin turns it twelve times around.
fn moved<L>(lagrangian: L, attitude: SO3, velocity: Vector3<f64>) -> (Matrix3<f64>, Vector3<f64>)
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular,
{
    let stepper = Stepper::new(lagrangian, 0.01).unwrap();
    let mut state = stepper.start(attitude, velocity).unwrap();
    for _ in 0..100 {
        stepper.step(&mut state).unwrap();
    }
    (state.attitude().matrix(), state.momentum())
}

fn seen_in(q: &Matrix3<f64>, attitude: &SO3, velocity: &Vector3<f64>) -> (SO3, Vector3<f64>) {
    (SO3::try_from(q * attitude.as_matrix() * q.transpose()).unwrap(), q * velocity * q.determinant())
}

/// A hundred steps and their twist make `100^{3/2} ε` of the roundings.
const TOLERANCE: f64 = 1e-13;

fn assert_same_motion(moved: (Matrix3<f64>, Vector3<f64>), original: (Matrix3<f64>, Vector3<f64>), q: &Matrix3<f64>) {
    let (attitude, momentum) = (q * original.0 * q.transpose(), q * original.1 * q.determinant());
    assert!(relative(&moved.0, &attitude) < TOLERANCE, "attitude in axes {q}");
    assert!(relative(&moved.1, &momentum) < TOLERANCE, "momentum in axes {q}");
}

/// The forty-eight matrices that permute the axes and flip their signs.
fn signed_permutations() -> Vec<Matrix3<f64>> {
    let mut matrices = Vec::new();
    for order in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
        for signs in 0..8 {
            let sign = |i: usize| if signs >> i & 1 == 0 { 1.0 } else { -1.0 };
            matrices.push(Matrix3::from_fn(|i, j| if order[i] == j { sign(i) } else { 0.0 }));
        }
    }
    matrices
}

#[test]
fn b5_all_permutations_and_flips_of_the_axes() {
    let motion = Motion::looping();
    let top = HeavyTop::asymmetric();
    let original = moved(top.clone(), motion.attitude, motion.velocity);
    let permutations = signed_permutations();
    assert_eq!(permutations.len(), 48);
    for q in &permutations {
        let (attitude, velocity) = seen_in(q, &motion.attitude, &motion.velocity);
        let diagonal = (q * top.J_d.to_matrix() * q.transpose()).diagonal();
        let permuted = HeavyTop {
            J_d: DiagonalNonstandardInertia::from_diagonal(diagonal).unwrap(),
            rho: q * top.rho,
            up: q * top.up,
            ..top.clone()
        };
        assert_same_motion(moved(permuted, attitude, velocity), original, q);
    }
}

#[test]
fn b5_turned_and_mirrored_axes() {
    let motion = Motion::looping();
    let top = HeavyTop::asymmetric();
    let original = moved(top.clone(), motion.attitude, motion.velocity);
    let mut random = Random::new(31);
    for sign in [1.0, -1.0] {
        for rotation in random.hard_rotations() {
            let q = rotation.matrix() * sign;
            let (attitude, velocity) = seen_in(&q, &motion.attitude, &motion.velocity);
            let turned = FullTop { up: q * top.up, ..FullTop::in_axes(&top, &q) };
            assert_same_motion(moved(turned, attitude, velocity), original, &q);
        }
    }
}
