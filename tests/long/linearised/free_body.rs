//! Exact flows compared with the variational equations of the free body, which are independent of the closed form.

use checks::free_body::variational;
use liestep::effects::{Gravity, RigidBody};
use liestep::mechanics::Sum;
use liestep::methods::{ExactBody, Splitting, SplittingScheme};
use liestep::{SO3, Stepper};
use nalgebra::{Matrix3, Rotation3, Vector3};

use super::scenes::{MOMENTS, exact_flow, heavy};

type FreeBody = Stepper<Sum<RigidBody, Gravity>, Splitting<Sum<RigidBody, Gravity>, ExactBody>>;

/// The limit above which the library doubles the closed form; below it uses polynomials or up to two doublings of a
/// curve.
const IS_DOUBLED: f64 = 0.8;

/// The larger of the constants `K_a` and `K_b` of a drift, which measures its length, for the momentum along the axes
/// of the moments.
fn size([of_a, of_b, of_c]: [f64; 3], along: &Vector3<f64>, time: f64) -> f64 {
    let (a, b) = (of_c / of_a - 1.0, of_c / of_b - 1.0);
    let u = along * (0.5 * time / of_c);
    let of_middle = -a * b * u.z * u.z;
    (of_middle + a * (a - b) * u.x * u.x).max(of_middle + b * (b - a) * u.y * u.y)
}

/// The bound relative to each column.
const BOUND: f64 = 1e-11;

/// A stepper whose whole step is one drift of this length.
fn free(moments: [f64; 3], axes: &Matrix3<f64>, time: f64) -> FreeBody {
    Stepper::split(heavy(moments, axes, 0.0, None), time, exact_flow(moments, axes, None), SplittingScheme::STRANG)
        .expect("a stepper")
}

/// Checks the columns of one drift, from a momentum along the axes of the moments.
fn assert_variational(moments: [f64; 3], axes: &Matrix3<f64>, along: &Vector3<f64>, time: f64) {
    let stepper = free(moments, axes, time);
    let linear = stepper.linearised().expect("derivatives");
    let momentum = axes * along;
    let inertia = axes * Matrix3::from_diagonal(&Vector3::from(moments)) * axes.transpose();
    let of_moment = |k: usize| axes.column(k) * axes.column(k).transpose();
    let of_turn = |k: usize| {
        let hat = Vector3::<f64>::ith(k, 1.0).cross_matrix();
        hat * inertia - inertia * hat
    };
    let varied: Vec<_> = (0..3).map(of_moment).chain((0..3).map(of_turn)).collect();
    let (F, expected) = variational(&inertia, &varied, &momentum, time);

    let mut tangent = linear.tangent(&[17, 18, 19, 20, 21, 22]);
    let mut state =
        stepper.start_with_momentum(SO3::from_matrix_unchecked(Matrix3::identity()), momentum).expect("a start");
    linear.step(&mut state, &mut tangent).expect("a step");
    let found: Vec<_> = tangent.columns().collect();
    let mut worst = 0.0_f64;
    for (k, (turn, change)) in found.iter().take(3).enumerate() {
        // A turn of the body at the start is the same turn in the body's axes later.
        let error = (turn - F.transpose().column(k)).amax().max(change.amax());
        worst = worst.max(error);
    }
    for (number, (found, (turn, change))) in found[3..].iter().zip(&expected).enumerate() {
        let turn = F.transpose() * turn;
        let own = turn.amax().max(change.amax());
        let error = (found.0 - turn).amax().max((found.1 - change).amax()) / own;
        assert!(error < BOUND, "column {number} at size {}: off by {error:e} of {own:e}", size(moments, along, time));
        worst = worst.max(error);
    }
    println!("size {:.3e}: {worst:.1e}", size(moments, along, time));
    assert!(worst < BOUND, "{worst:e}");
}

fn turned() -> Matrix3<f64> {
    Rotation3::new(Vector3::new(0.4, -0.3, 0.7)).into_inner()
}

/// Drifts by both polynomials, by one and by two doublings of the curve, and doubled ones.
#[test]
fn a_drift_of_a_generic_body() {
    let along = Vector3::new(0.9, -0.7, 1.2);
    let mut sizes = Vec::new();
    for time in [0.7, 3.0, 6.0, 12.0, 100.0] {
        assert_variational(MOMENTS, &turned(), &along, time);
        assert_variational(MOMENTS, &Matrix3::identity(), &along, time);
        sizes.push(size(MOMENTS, &along, time));
    }
    for (size, limits) in sizes.iter().zip([0.0, 0.0075, 0.05, 0.2, IS_DOUBLED, f64::MAX].windows(2)) {
        assert!(limits[0] < *size && *size < limits[1], "{sizes:?}");
    }
}

/// Near the middle axis the closed form has its smallest divisors and neighbouring momenta separate: beside the
/// separatrix on either side, and on it. With `A = −B` the separatrix is exact in the body's axes.
#[test]
fn a_drift_at_the_separatrix() {
    let moments = [3.75, 2.5, 3.0];
    for beside in [-1e-6, 0.0, 1e-6] {
        let along = Vector3::new(1.0 + beside, 1.0, 1.5);
        for time in [40.0, 60.0] {
            assert!(size(moments, &along, time) > IS_DOUBLED);
            assert_variational(moments, &turned(), &along, time);
            assert_variational(moments, &Matrix3::identity(), &along, time);
        }
    }
}
