//! A declaration without a prelude, where all names need full paths.

#![no_implicit_prelude]

#[::liestep::lagrangian(
    group = ::liestep::SO3,
    advected(w = up, b = field),
    l_d = ((F - I) * inertia * (F - I).transpose()).trace() / (2.0 * h)
        - h * w.dot(&(F * rho)).sin() - h * vee(F).dot(&b).powi(2),
)]
struct Top {
    inertia: ::liestep::NonstandardInertia,
    rho: ::nalgebra::Vector3<f64>,
    up: ::nalgebra::Vector3<f64>,
    field: ::nalgebra::Vector3<f64>,
}

#[::liestep::lagrangian(group = ::liestep::SO3, l_d = 2.0 * k * (3.0 - F.trace()) / h - h * (k * F[(2, 2)]).exp())]
struct Generic<T: ::liestep::numbers::Real> {
    k: T,
}

pub fn main() {
    let inertia = ::liestep::NonstandardInertia::from_diagonal(::nalgebra::Vector3::new(2.0, 2.0, 1.0)).unwrap();
    let z = ::nalgebra::Vector3::z();
    let stepper = ::liestep::Stepper::new(Top { inertia, rho: z, up: z, field: z }, 0.01).unwrap();
    let mut state = stepper.start(::liestep::SO3::identity(), z).unwrap();
    stepper.step(&mut state).unwrap();
    ::std::assert_eq!(state.steps(), 1);
    let stepper = ::liestep::Stepper::new(Generic { k: 1.0_f64 }, 0.01).unwrap();
    let mut state = stepper.start(::liestep::SO3::identity(), z).unwrap();
    stepper.step(&mut state).unwrap();
    ::std::assert_eq!(state.steps(), 1);
}
