//! Random Lagrangians with every kind of advected parameter.

use liestep::groups::{ContravariantVector, CovariantTensor};
use liestep::laws::samples::Random;
use liestep::numbers::Entries;
use liestep::{Stepper, lagrangian};
use nalgebra::{Matrix2, Matrix3, RealField, SMatrix, Vector2, Vector3, Vector4};
use num_dual::Dual64;

use super::dual::{STEP, assert_linearised};

macro_rules! family {
    ($module:ident: $group:ident, $n:literal, $vector:ident, $matrix:ident) => {
        pub(crate) mod $module {
            use super::*;
            use liestep::groups::$group;

            #[lagrangian(
                        group = $group,
                        advected(w = covector, v = vector, B = form),
                        given(u = strength),
                        gradients,
                        l_d = {
                            let d = F - I;
                            let kinetic = (d * J * d.transpose()).trace() / (2.0 * h);
                            let gauge = 0.3 * (A * d).trace() + 0.3 * w.dot(&(d * r)) + 0.3 * a[2] * w.dot(&(d * v));
                            let forms = u * w.dot(&(A * w)) + a[0] * w.dot(&(F * r)).powi(2) + v.dot(&(B * v));
                            let products = a[3] * (A * F).trace() * w.dot(&r) + a[1] * (A * inverse(F)).trace();
                            let smooth = (w.dot(&(F * r)) + w.dot(&r)).sin() + (1.0 + (B * A).trace().powi(2)).sqrt();
                            kinetic + gauge - 0.5 * h * (forms + products + smooth / (2.0 + (0.3 * w.dot(&r)).exp()))
                        },
                    )]
            #[derive(Clone, Debug)]
            pub(crate) struct Terms<T: RealField + Copy> {
                J: $matrix<T>,
                A: $matrix<T>,
                r: $vector<T>,
                a: Vector4<T>,
                strength: T,
                covector: $vector<T>,
                vector: ContravariantVector<T, $n>,
                form: CovariantTensor<T, $n>,
            }

            impl<T: RealField + Copy> Terms<T> {
                /// The parameters of a random scene, one of which may have a derivative.
                fn random(seed: u64, varied: Option<(usize, T)>) -> Self {
                    let mut random = Random::new(seed);
                    let root: SMatrix<f64, $n, $n> = random.sample();
                    let metric = SMatrix::identity() + root * root.transpose();
                    let mut fixed = Vec::new();
                    Entries::each(&metric, &mut |entry: f64| fixed.push(entry));
                    let mut place = 0;
                    let mut next = || {
                        let number: T = nalgebra::convert(fixed.get(place).copied().unwrap_or_else(|| random.signed()));
                        place += 1;
                        varied.filter(|(number, _)| number + 1 == place).map_or(number, |(_, unit)| number + unit)
                    };
                    Self {
                        J: Entries::from_entries(&mut next),
                        A: Entries::from_entries(&mut next),
                        r: Entries::from_entries(&mut next),
                        a: Entries::from_entries(&mut next),
                        strength: next(),
                        covector: Entries::from_entries(&mut next),
                        vector: Entries::from_entries(&mut next),
                        form: Entries::from_entries(&mut next),
                    }
                }
            }

            #[test]
            fn tangent_and_adjoint() {
                for seed in 0..4 {
                    let stepper = Stepper::new(Terms::<f64>::random(seed, None), STEP).expect("a stepper");
                    let unit = Dual64::new(0.0, 1.0);
                    let dual = |number: Option<usize>| {
                        let terms = Terms::random(seed, number.map(|number| (number, unit)));
                        Stepper::new(terms, STEP.into()).expect("a stepper")
                    };
                    assert_linearised(&stepper, dual);
                }
            }
        }
    };
}

family!(so3: SO3, 3, Vector3, Matrix3);
family!(se2: SE2, 3, Vector3, Matrix3);
family!(sl2: SL2, 2, Vector2, Matrix2);
