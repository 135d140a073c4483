//! The memory of a processed splitting: the kernel's motion, which differs from the processed one.

use crate::groups::{Advected, LieGroup as _, SO3};
use crate::motion::{Kept, Motion};
use crate::numbers::{Real, flag, real, replaced, zero};
use nalgebra::SimdBool as _;

/// The kernel's motion of a run of [`ProcessedSplitting`](super::ProcessedSplitting), and its step. `None` at the
/// start, after a push and after another method's steps.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
#[doc(hidden)]
pub struct Inside<T: Real, A>(pub(super) Option<InsideMotion<T, A>>);

/// The kernel's motion without the number of steps, which is that of the processed motion.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub(super) struct InsideMotion<T: Real, A> {
    attitude: SO3<T>,
    momentum: nalgebra::Vector3<T>,
    advected: A,
    /// The step that the processor belongs to.
    pub(super) h: T,
}

impl<T: Real, A: Advected<SO3<T>>> InsideMotion<T, A> {
    pub(super) fn of(motion: &Motion<SO3<T>, A>, h: T) -> Self {
        Self { attitude: motion.attitude, momentum: motion.momentum, advected: motion.advected, h }
    }

    pub(super) fn after(self, steps: u64) -> Motion<SO3<T>, A> {
        let Self { attitude, momentum, advected, .. } = self;
        Motion { attitude, momentum, advected, steps }
    }
}

impl<T: Real, A: Advected<SO3<T>>> Kept<T> for Inside<T, A> {
    fn with_numbers(&self, number: &mut dyn FnMut(T) -> T) -> Option<Self> {
        let is_inside = flag(self.0.is_some(), number)?;
        let nothing = || InsideMotion {
            attitude: SO3::from_matrix_unchecked(zero()),
            momentum: zero::<T, nalgebra::Vector3<T>>(),
            advected: zero::<T, A>(),
            h: T::zero(),
        };
        let InsideMotion { attitude, momentum, advected, h } = self.0.unwrap_or_else(nothing);
        let attitude = SO3::from_matrix_unchecked(replaced(attitude.as_matrix(), number));
        let (momentum, advected, h) = (replaced(&momentum, number), replaced(&advected, number), number(h));
        if !is_inside {
            return Some(Self(None));
        }
        let is_rotation = attitude.defect().simd_le(T::simd_default_epsilon() * real(1e4)).all();
        is_rotation.then_some(Self(Some(InsideMotion { attitude, momentum, advected, h })))
    }

    /// A lane from a step of another length needs the inverse processor, which would round the lanes that don't need
    /// it.
    fn is_in_step(&self, h: T) -> bool {
        self.0.is_none_or(|inside| {
            let is_there = inside.h.simd_eq(h);
            is_there.all() || !is_there.any()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Inside;
    use crate::motion::Kept as _;
    use alloc::vec::Vec;
    use nalgebra::Vector3;

    /// A memory from its numbers: the flag, an attitude, a momentum, a vector and the step.
    fn read(flag: f64, corner: f64) -> Option<Inside<f64, Vector3<f64>>> {
        let attitude = [corner, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0];
        let mut numbers = [flag].into_iter().chain(attitude).chain([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.1]);
        Inside(None).with_numbers(&mut |_| numbers.next().unwrap())
    }

    #[test]
    fn a_memory_is_its_numbers() {
        for flag in [0.0, 1.0] {
            let (mut numbers, inside) = (Vec::new(), read(flag, 1.0).unwrap());
            inside.each(&mut |number| numbers.push(number));
            let mut again = numbers.iter().copied();
            assert_eq!(Inside(None).with_numbers(&mut |_| again.next().unwrap()), Some(inside));
            assert_eq!((numbers.len(), again.next()), (17, None));
        }
    }

    #[test]
    fn what_is_none_is_refused() {
        assert_eq!(read(2.0, 1.0), None);
        assert_eq!(read(f64::NAN, 1.0), None);
        assert_eq!(read(1.0, 1.001), None);
    }
}
