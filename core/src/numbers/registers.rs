//! Three numbers in one vector register, if the machine has registers of four `f64`, and small matrices by columns.

use core::ops::{Add, Div, Mul, Sub};

use nalgebra::{Matrix3, Vector3};

/// A vector of three numbers with operations entry by entry. Its digits don't depend on the type of register.
pub(crate) trait Register:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Another register of the same type. The fourth entry fills the register, and has no meaning.
    fn of(self, entries: [f64; 4]) -> Self;

    fn entries(self) -> [f64; 4];
}

/// A register of the target that the program was compiled for.
#[derive(Clone, Copy)]
pub(crate) struct Plain(Vector3<f64>);

impl Plain {
    pub(crate) const ZERO: Self = Self(Vector3::new(0.0, 0.0, 0.0));
}

operation!([] Plain, Add add |a, b| Self(a.0 + b.0));
operation!([] Plain, Sub sub |a, b| Self(a.0 - b.0));
operation!([] Plain, Mul mul |a, b| Self(a.0.component_mul(&b.0)));
operation!([] Plain, Div div |a, b| Self(a.0.component_div(&b.0)));

#[hot]
impl Register for Plain {
    fn of(self, [x, y, z, _]: [f64; 4]) -> Self {
        Self(Vector3::new(x, y, z))
    }

    fn entries(self) -> [f64; 4] {
        padded(&self.0)
    }
}

/// A computation on registers.
pub(crate) trait OnRegisters {
    type Output;

    /// Runs the computation with registers of the type of `zero`. An implementation is marked `#[hot]`, as are the functions
    /// that it calls; closures in it would be compiled without the vector instructions.
    fn run<R: Register>(self, zero: R) -> Self::Output;
}

/// Runs a computation on the registers that the machine has. With debug assertions, where nothing is inlined, these are
/// the plain ones.
#[hot]
pub(crate) fn on_registers<K: OnRegisters>(kernel: K) -> K::Output {
    #[cfg(all(feature = "dispatch", target_arch = "x86_64", not(debug_assertions)))]
    if let Some(four) = pulp::x86::V3::try_new() {
        return pulp::Simd::vectorize(four, avx2::FourKernel(four, kernel));
    }
    kernel.run(Plain::ZERO)
}

#[cfg(all(feature = "dispatch", target_arch = "x86_64", not(debug_assertions)))]
mod avx2 {
    use core::arch::x86_64::__m256d;

    use pulp::x86::V3;
    use pulp::{Simd, WithSimd, cast};

    use super::{Add, Div, Mul, OnRegisters, Register, Sub};

    /// A register, with the proof that the machine has it.
    #[derive(Clone, Copy)]
    struct Four(V3, __m256d);

    operation!([] Four, Add add |a, b| Self(a.0, a.0.avx._mm256_add_pd(a.1, b.1)));
    operation!([] Four, Sub sub |a, b| Self(a.0, a.0.avx._mm256_sub_pd(a.1, b.1)));
    operation!([] Four, Mul mul |a, b| Self(a.0, a.0.avx._mm256_mul_pd(a.1, b.1)));
    operation!([] Four, Div div |a, b| Self(a.0, a.0.avx._mm256_div_pd(a.1, b.1)));

    #[hot]
    impl Register for Four {
        fn of(self, entries: [f64; 4]) -> Self {
            Self(self.0, cast(entries))
        }

        fn entries(self) -> [f64; 4] {
            cast(self.1)
        }
    }

    pub(super) struct FourKernel<K>(pub(super) V3, pub(super) K);

    impl<K: OnRegisters> WithSimd for FourKernel<K> {
        type Output = K::Output;

        #[hot]
        fn with_simd<S: Simd>(self, _: S) -> K::Output {
            self.1.run(Four(self.0, cast([0.0_f64; 4])))
        }
    }
}

/// The entries of a register that holds a vector.
#[hot]
pub(crate) fn padded(v: &Vector3<f64>) -> [f64; 4] {
    [v.x, v.y, v.z, 0.0]
}

#[hot]
pub(crate) fn vector<R: Register>(v: R) -> Vector3<f64> {
    let [x, y, z, _] = v.entries();
    Vector3::new(x, y, z)
}

/// Entry `K` in all places.
#[hot]
fn spread<const K: usize, R: Register>(v: R) -> R {
    v.of([v.entries()[K]; 4])
}

#[hot]
pub(crate) fn cross<R: Register>(a: R, b: R) -> R {
    turned(a * turned(b) - turned(a) * b)
}

#[hot]
fn turned<R: Register>(v: R) -> R {
    let [x, y, z, w] = v.entries();
    v.of([y, z, x, w])
}

/// The dot product in all places.
#[hot]
pub(crate) fn dot<R: Register>(a: R, b: R) -> R {
    let products = a * b;
    spread::<0, R>(products) + spread::<1, R>(products) + spread::<2, R>(products)
}

#[hot]
pub(crate) fn square<R: Register>(v: R) -> f64 {
    dot(v, v).entries()[0]
}

/// A matrix by its columns.
#[derive(Clone, Copy)]
pub(crate) struct Columns<R>(pub(crate) [R; 3]);

operation!([R: Register] Columns<R>, Add add |a, b| Self([a.0[0] + b.0[0], a.0[1] + b.0[1], a.0[2] + b.0[2]]));
operation!([R: Register] Columns<R>, Sub sub |a, b| Self([a.0[0] - b.0[0], a.0[1] - b.0[1], a.0[2] - b.0[2]]));
operation!([R: Register] Columns<R>, Mul mul |a, b| Self([a.map(b.0[0]), a.map(b.0[1]), a.map(b.0[2])]));

#[hot]
impl<R: Register> Columns<R> {
    pub(crate) fn of(zero: R, m: &Matrix3<f64>) -> Self {
        Self([0, 1, 2].map(|k| zero.of([m[(0, k)], m[(1, k)], m[(2, k)], 0.0])))
    }

    /// The skew matrix `â`.
    pub(crate) fn hat(a: R) -> Self {
        let [x, y, z, _] = a.entries();
        Self([a.of([0.0, z, -y, 0.0]), a.of([-z, 0.0, x, 0.0]), a.of([y, -x, 0.0, 0.0])])
    }

    /// The matrix `s I`.
    pub(crate) fn multiple(zero: R, s: f64) -> Self {
        Self([zero.of([s, 0.0, 0.0, 0.0]), zero.of([0.0, s, 0.0, 0.0]), zero.of([0.0, 0.0, s, 0.0])])
    }

    /// The product `M v`.
    pub(crate) fn map(&self, v: R) -> R {
        self.0[0] * spread::<0, R>(v) + self.0[1] * spread::<1, R>(v) + self.0[2] * spread::<2, R>(v)
    }

    /// The product with a number in all places.
    pub(crate) fn scaled(&self, s: R) -> Self {
        Self([self.0[0] * s, self.0[1] * s, self.0[2] * s])
    }

    pub(crate) fn transposed(&self) -> Self {
        let [a, b, c] = self.entries();
        Self([0, 1, 2].map(|k| self.0[0].of([a[k], b[k], c[k], 0.0])))
    }

    /// The product `M â`: each row times `a`.
    pub(crate) fn cross_rows(&self, a: R) -> Self {
        let (x, y, z) = (spread::<0, R>(a), spread::<1, R>(a), spread::<2, R>(a));
        let m = &self.0;
        Self([m[1] * z - m[2] * y, m[2] * x - m[0] * z, m[0] * y - m[1] * x])
    }

    pub(crate) fn entries(&self) -> [[f64; 4]; 3] {
        self.0.map(R::entries)
    }
}
