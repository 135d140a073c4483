//! A user's group, with its generators written once.

mod groups {
    use nalgebra::{RealField, SMatrix};

    liestep::groups::matrix_group! {
        /// The affine maps `x ↦ a x + b` of the line, `a > 0`.
        #[allow(dead_code)]
        pub type Affine = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [0.0, 0.0]]];

        fn relation<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> T {
            m[(1, 0)].abs() + (m[(1, 1)] - T::one()).abs()
        }
    }

    liestep::lie_group_laws!(Affine);
}

use groups::Affine;
use liestep::groups::LieGroup as _;
use liestep::mechanics::Effect as _;
use liestep::numbers::Real;
use liestep::{Stepper, lagrangian};
use nalgebra::{Matrix2, Vector2};

/// The name is found where the type is imported.
#[derive(Clone)]
#[lagrangian(
    group = Affine!,
    advected(w = covector),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * k * w.dot(&(r + F * r)).powi(2),
)]
#[derive(Debug)]
pub struct Scaling<T: Real + nalgebra::RealField> {
    J: Matrix2<T>,
    k: T,
    r: Vector2<T>,
    covector: Vector2<T>,
}

mod by_its_path {
    #[super::lagrangian(crate = ::liestep, group = crate::own_group::groups::Affine!, l_d = m * (F - I).norm_squared() / h)]
    pub struct Plain {
        pub m: f64,
    }
}

/// The name of a group of liestep's is free if that isn't imported.
mod of_a_known_name {
    use nalgebra::{RealField, SMatrix};

    liestep::groups::matrix_group! {
        /// A user's group may have the name of a library's group: here squeezes of the plane, not translations of a
        /// line.
        pub type R1 = [[[1.0, 0.0], [0.0, -1.0]]];

        fn relation<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> T {
            m[(1, 0)].abs() + m[(0, 1)].abs() + (m[(0, 0)] * m[(1, 1)] - T::one()).abs()
        }
    }

    /// A type of nalgebra's name with its scalar.
    type Vector2 = nalgebra::Vector2<f64>;

    #[liestep::lagrangian(group = R1!, l_d = m * (F - I).norm_squared() / h - h * (v.x + v.y) * (F * v).y)]
    pub struct Squeezed {
        pub m: f64,
        pub v: Vector2,
    }
}

pub fn main() {
    let scaling = Scaling { J: Matrix2::identity(), k: 1.0, r: Vector2::new(1.0, 0.5), covector: Vector2::x() };
    assert!(format!("{scaling:?}").contains("covector") && Scaling::<f64>::DERIVATION.contains("in Affine"));
    let stepper = Stepper::new(scaling.clone(), 0.01).unwrap();
    let mut state = stepper.start(Affine::<f64>::identity(), Vector2::new(0.1, 0.2)).unwrap();
    stepper.step(&mut state).unwrap();
    assert!(Stepper::new(by_its_path::Plain { m: 1.0 }, 0.01).is_ok());
    let squeezed = Stepper::new(of_a_known_name::Squeezed { m: 1.0, v: Vector2::new(1.0, -1.0) }, 0.01).unwrap();
    let mut state = squeezed.start(of_a_known_name::R1::identity(), nalgebra::Vector1::new(0.1)).unwrap();
    squeezed.step(&mut state).unwrap();
    assert!(state.attitude().matrix()[(0, 0)] > 1.0 && state.attitude().matrix()[(0, 1)] == 0.0);
}
