//! Continuous Lagrangians with full paths and no prelude, with names that are keywords or come through a macro, and in
//! other scalars.

#![no_implicit_prelude]
#![deny(warnings, missing_docs)]

use ::liestep::mechanics::ContinuousLagrangian as _;

#[::liestep::lagrangian(
    group = ::liestep::SO3,
    velocity = r#fn,
    advected(w = up),
    l = {
        let kinetic = 0.5 * r#fn.dot(&(inertia * r#fn));
        kinetic - w.dot(&rho).sin()
    },
    discretise = trapezoid(Cayley),
)]
struct Top {
    inertia: ::liestep::mechanics::Inertia,
    rho: ::nalgebra::Vector3<f64>,
    up: ::nalgebra::Vector3<f64>,
}

#[::liestep::lagrangian(
    group = ::liestep::SO3,
    velocity = velocity,
    advected(f = up),
    l = 0.5 * k * velocity.norm_squared() + k * (1.0 + velocity.dot(&f).powi(2)).sqrt(),
)]
struct Generic<T: ::liestep::numbers::Real> {
    k: T,
    up: ::nalgebra::Vector3<T>,
}

macro_rules! potential {
    ($name:ident, $w:ident, $l:expr) => {
        #[::liestep::lagrangian(group = ::liestep::SO3, advected($w = up), l = $l, discretise = chord)]
        struct $name {
            k: f64,
            up: ::nalgebra::Vector3<f64>,
        }
    };
}

potential!(Pull, seen, -k * seen[2]);

pub fn main() {
    let z = ::nalgebra::Vector3::z();
    let moments = ::nalgebra::Vector3::new(3.0, 3.0, 4.0);
    let inertia = ::liestep::mechanics::Inertia::from_principal_moments(moments).unwrap();
    let top = Top { inertia, rho: z, up: z };
    ::std::assert_eq!(top.momentum(&z, &z), z * 4.0);
    let stepper = ::liestep::Stepper::new(top + Pull { k: 1.0, up: z }, 0.01).unwrap();
    let mut state = stepper.start(::liestep::SO3::identity(), z).unwrap();
    stepper.step(&mut state).unwrap();
    ::std::assert_eq!(state.steps(), 1);
    let generic = Generic { k: 2.0_f32, up: ::nalgebra::Vector3::x() };
    let momentum = generic.momentum(&::nalgebra::Vector3::y(), &::nalgebra::Vector3::x());
    ::std::assert_eq!(momentum, ::nalgebra::Vector3::y() * 2.0);
    // Continuous terms add with any others.
    let sum = generic + Generic { k: 1.0_f32, up: ::nalgebra::Vector3::z() };
    ::std::assert!(sum.velocity(&momentum, &(::nalgebra::Vector3::x(), ::nalgebra::Vector3::z())).is_ok());
}
