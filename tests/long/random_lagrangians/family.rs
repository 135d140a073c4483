//! A family of Lagrangians on each group with vectors, and one with tensors.

// Public items are for this test program alone.
#![allow(unreachable_pub)]

use checks::affine::Affine;
use liestep::groups::{ContravariantTensor, ContravariantVector, CovariantTensor, MixedTensor};
use liestep::groups::{Heisenberg, R1, R2, R3, SE2, SE3, SL2, SO2, SU2};
use liestep::laws::samples::Random;
use liestep::{SO3, lagrangian};
use nalgebra::{Matrix2, Matrix3, Matrix4, RealField, SMatrix, Vector2, Vector3, Vector4};

/// Four coefficients, of which about a third are zero, so that the selection of terms is random too.
fn coefficients(random: &mut Random) -> Vector4<f64> {
    Vector4::from_fn(|_, _| if random.signed() < -0.3 { 0.0 } else { random.signed() })
}

/// A symmetric matrix with eigenvalues from one to a few.
fn metric<const N: usize>(random: &mut Random) -> SMatrix<f64, N, N> {
    let root: SMatrix<f64, N, N> = random.sample();
    SMatrix::identity() + root * root.transpose()
}

macro_rules! family {
    ($group:ident, $n:literal, $vector:ident, $matrix:ident, [$($own:tt)*]) => {
        // A kinetic energy that depends on advected parameters, and one that isn't quadratic.
        #[lagrangian(
            group = $group,
            $($own)*
            velocity = xi,
            advected(w = covector, v = vector, B = form),
            l = {
                let x = hat(xi);
                let quadratic = (x * J * x.transpose()).trace();
                let kinetic = 0.5 * quadratic + 0.5 * a[0] * a[0] * w.dot(&(x * r)).powi(2);
                let bent = a[1] * a[1] * (1.0 + (x * J * x.transpose()).trace() * (1.0 + w.dot(&r).powi(2))).sqrt();
                let linear = a[2] * w.dot(&(x * v)) + a[3] * (A * x * B).trace();
                let potential = b[0] * w.dot(&r).sin() + b[1] * v.dot(&(B * v)) + b[2] * w.dot(&v) * (A * B).trace();
                kinetic + bent + linear - potential - b[3] * (0.3 * w.dot(&r)).exp()
            },
        )]
        #[derive(Clone, Debug)]
        pub struct Continuous<T: RealField + Copy> {
            pub J: $matrix<T>,
            pub A: $matrix<T>,
            pub r: $vector<T>,
            pub a: Vector4<T>,
            pub b: Vector4<T>,
            pub covector: $vector<T>,
            pub vector: ContravariantVector<T, $n>,
            pub form: CovariantTensor<T, $n>,
        }

        impl<T: RealField + Copy> Continuous<T> {
            /// The parameters of a random Lagrangian from a seed, in any scalar.
            pub fn random(seed: u64) -> Self {
                let mut random = Random::new(seed);
                let (metric, matrix, form): (SMatrix<f64, $n, $n>, SMatrix<f64, $n, $n>, SMatrix<f64, $n, $n>) =
                    (metric(&mut random), random.sample(), random.sample());
                let mut vector = || -> SMatrix<T, $n, 1> { random.sample::<SMatrix<f64, $n, 1>>().map(nalgebra::convert) };
                let (r, covector, advected) = (vector(), vector(), vector());
                Self {
                    J: metric.map(nalgebra::convert),
                    A: matrix.map(nalgebra::convert),
                    r,
                    a: coefficients(&mut random).map(nalgebra::convert),
                    b: coefficients(&mut random).map(nalgebra::convert),
                    covector,
                    vector: ContravariantVector(advected),
                    form: CovariantTensor(form.map(nalgebra::convert)),
                }
            }
        }

        #[lagrangian(
            group = $group,
            $($own)*
            advected(w = covector, v = vector),
            l_d = {
                let d = F - I;
                let kinetic = (d * J * d.transpose()).trace() / (2.0 * h);
                let gauge = 0.3 * a[0] * (A * d).trace() + 0.3 * a[1] * w.dot(&(d * r)) + 0.3 * a[2] * w.dot(&(d * v));
                let backwards = 0.3 * c[2] * (A * (inverse(F) - I)).trace() + h * c[3] * w.dot(&(inverse(F) * r));
                let forms = b[0] * w.dot(&(A * w)) + b[1] * w.dot(&(F * r)).powi(2) + b[2] * v.dot(&(A * v));
                let products = a[3] * (A * F).trace() * w.dot(&r) + b[3] * w.dot(&(F * v));
                let smooth = c[0] * (w.dot(&(F * r)) + w.dot(&r)).sin() + c[1] * (1.0 + v.dot(&r).powi(2)).sqrt();
                kinetic + gauge + backwards - 0.5 * h * (forms + products + smooth)
            },
        )]
        #[derive(Clone, Debug)]
        pub struct Vectors {
            pub J: $matrix<f64>,
            pub A: $matrix<f64>,
            pub r: $vector<f64>,
            pub a: Vector4<f64>,
            pub b: Vector4<f64>,
            pub c: Vector4<f64>,
            pub covector: $vector<f64>,
            pub vector: ContravariantVector<f64, $n>,
        }

        impl Vectors {
            pub fn random(random: &mut Random) -> Self {
                Self {
                    J: metric(random),
                    A: random.sample(),
                    r: random.sample(),
                    a: coefficients(random),
                    b: coefficients(random),
                    c: coefficients(random),
                    covector: random.sample(),
                    vector: random.sample(),
                }
            }
        }

        #[lagrangian(
            group = $group,
            $($own)*
            advected(S = tensor, B = form, M = map),
            l_d = {
                let d = F - I;
                let kinetic = (d * J * d.transpose()).trace() / (2.0 * h);
                let gauge = 0.3 * a[0] * (A * d).trace() + 0.3 * a[1] * (M * d).trace();
                let words = b[0] * (A * F * S).trace() + b[1] * (S * B * F).trace() + b[2] * (M * F * A).trace();
                let products = a[2] * (M * F).trace() * (S * B).trace() + a[3] * r.dot(&(B * (F * r)));
                let smooth = c[0] * (S * F).trace().cos() + c[1] * (0.3 * r.dot(&(B * r))).exp();
                kinetic + gauge - 0.5 * h * (words + products + smooth)
            },
        )]
        #[derive(Clone, Debug)]
        pub struct Tensors {
            pub J: $matrix<f64>,
            pub A: $matrix<f64>,
            pub r: $vector<f64>,
            pub a: Vector4<f64>,
            pub b: Vector4<f64>,
            pub c: Vector4<f64>,
            pub tensor: ContravariantTensor<f64, $n>,
            pub form: CovariantTensor<f64, $n>,
            pub map: MixedTensor<f64, $n>,
        }

        impl Tensors {
            pub fn random(random: &mut Random) -> Self {
                Self {
                    J: metric(random),
                    A: random.sample(),
                    r: random.sample(),
                    a: coefficients(random),
                    b: coefficients(random),
                    c: coefficients(random),
                    tensor: random.sample(),
                    form: random.sample(),
                    map: random.sample(),
                }
            }
        }
    };
}

macro_rules! on {
    ($module:ident: $group:ident, $n:literal, $vector:ident, $matrix:ident $(, $($own:tt)*)?) => {
        pub mod $module {
            use super::*;

            family!($group, $n, $vector, $matrix, [$($($own)*)?]);
        }
    };
}

on!(so2: SO2, 2, Vector2, Matrix2);
on!(se2: SE2, 3, Vector3, Matrix3);
on!(so3: SO3, 3, Vector3, Matrix3);
on!(se3: SE3, 4, Vector4, Matrix4);
on!(su2: SU2, 4, Vector4, Matrix4);
on!(sl2: SL2, 2, Vector2, Matrix2);
on!(heisenberg: Heisenberg, 3, Vector3, Matrix3);
on!(r1: R1, 2, Vector2, Matrix2);
on!(r2: R2, 3, Vector3, Matrix3);
on!(r3: R3, 4, Vector4, Matrix4);
on!(affine: Affine, 2, Vector2, Matrix2, generators = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [0.0, 0.0]]],);
