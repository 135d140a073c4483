//! The rotation of a symmetric body about its own axis, applied once a step.
//!
//! Under a potential that is symmetric about that axis too, `p_3` is constant and so is the angle. The sine and cosine
//! of a constant angle have constant rounding errors, and their error in `s² + c² = 1` would lengthen or shorten `w`,
//! `p` and the attitude in proportion to the number of steps. This drift is corrected from time to time.

use nalgebra::{Matrix3, Vector3};

use crate::groups::rotation_coefficients;
use crate::groups::{Advected, CayleyRetraction, LieGroup, Retraction as _, SO3};
use crate::mechanics::DiscreteLagrangian;
use crate::motion::Summation;
use crate::numbers::{Entries as _, Real, real, two_square, two_sum};

/// Attitudes in general position.
const SAMPLES: [[f64; 3]; 4] = [[0.7, -0.4, 1.1], [-0.3, 0.9, 0.5], [1.3, 0.8, -0.2], [-0.6, -1.2, 0.9]];

/// Whether a property of the scene holds for its advected parameters at sample attitudes, and for arbitrary values of
/// them.
pub(super) fn all_samples<T, L>(lagrangian: &L, is_so: impl Fn(&L::Advected) -> bool) -> bool
where
    T: Real,
    L: DiscreteLagrangian<Scalar = T, Group = SO3<T>>,
{
    SAMPLES.iter().all(|xi| {
        let attitude = CayleyRetraction::retract(&Vector3::from(*xi).map(real::<T>));
        // No two of the arbitrary values are parallel.
        let mut entries = xi.iter().cycle().scan(1.0, |factor, entry| {
            *factor += 0.37;
            Some(*factor * entry)
        });
        let given = L::Advected::from_entries(&mut || real(entries.next().unwrap_or(1.0)));
        is_so(&lagrangian.advected().seen_from(&attitude)) && is_so(&given)
    })
}

/// Turns the body by `−θ` about its third axis.
#[hot]
pub(super) fn turn<T: Real, A: Advected<SO3<T>>>(angle: T, motion: &mut impl Summation<SO3<T>, A>) {
    let (s, v) = sine_and_versine(angle);
    move_by(&diagonal_block(v, s), motion);
}

/// The numbers `sin θ` and `cos θ − 1`, without cancellation.
#[hot]
fn sine_and_versine<T: Real>(angle: T) -> (T, T) {
    let (sinc, versine) = rotation_coefficients(angle * angle);
    (angle * sinc, -(angle * angle * versine))
}

/// Corrects the lengths across the axis for the rounding error of `turns` turns by one angle.
#[cold]
#[inline(never)]
pub(super) fn make_good<T: Real, A: Advected<SO3<T>>>(angle: T, turns: u32, motion: &mut impl Summation<SO3<T>, A>) {
    let (s, v) = sine_and_versine(angle);
    let ((ss, ss_rest), (vv, vv_rest)) = (two_square(s), two_square(v));
    // s² + (1 + v)² − 1, in which the large terms cancel.
    let (twice, lost) = two_sum(ss, v + v);
    let (small, lost_again) = two_sum(twice, vv);
    let excess = small + ((lost + lost_again) + (ss_rest + vv_rest));
    move_by(&diagonal_block(-excess * real(0.5 * f64::from(turns)), T::zero()), motion);
}

#[hot]
fn move_by<T: Real, A: Advected<SO3<T>>>(increment: &Matrix3<T>, motion: &mut impl Summation<SO3<T>, A>) {
    motion.turn(increment);
    let change = SO3::adjoint_transpose_increment(increment, &motion.now().momentum);
    // The third component stays the same to the bit.
    motion.push(&Vector3::new(change.x, change.y, T::zero()));
}

fn diagonal_block<T: Real>(diagonal: T, s: T) -> Matrix3<T> {
    let zero = T::zero();
    Matrix3::new(diagonal, s, zero, -s, diagonal, zero, zero, zero, zero)
}
