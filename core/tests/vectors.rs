//! Several bodies in lanes have the bits of each body alone, by the vector instructions that are detected on the
//! machine.
//!
//! Only builds without debug assertions ask for these: `cargo test --release -p liestep --lib --test vectors`.

#![cfg(not(debug_assertions))]

use liestep::effects::{Gravity, PrincipalBody};
use liestep::mechanics::Sum;
use liestep::methods::{CompositionScheme, ExactBody, ProcessedScheme};
use liestep::motion::Plan;
use liestep::numbers::{Lanes, Real};
use liestep::prelude::*;
use nalgebra::{Vector3, convert};
use simba::simd::{AutoF64x8, WideF64x4};

type Top<T> = Sum<PrincipalBody<T>, Gravity<T>>;

/// An asymmetric top with its centre of mass on none of its axes.
fn top() -> Top<f64> {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.6, 2.6, 3.0)).unwrap();
    PrincipalBody { J_d } + Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.1, 0.2, 0.3), up: Vector3::z() }
}

/// The start of the top of a lane: each leans and spins differently.
fn start(lane: usize) -> (SO3, Vector3<f64>) {
    let k = lane as f64;
    (SO3::from_euler_angles(0.3 * k, 1.0 - 0.2 * k, 0.1), Vector3::new(0.5, 0.4 * k - 1.0, 3.0 + k))
}

/// Compares steps of the tops of all lanes together with steps of each alone.
fn assert_independent<T, P, Q>(together: &Stepper<Top<T>, P>, alone: &Stepper<Top<f64>, Q>)
where
    T: Real<Element = f64>,
    P: Plan<Top<T>>,
    Q: Plan<Top<f64>>,
{
    let starts: Vec<_> = (0..T::LANES).map(start).collect();
    let attitude = SO3::gathered(&starts.iter().map(|(attitude, _)| *attitude).collect::<Vec<_>>()).unwrap();
    let velocity = Vector3::gathered(&starts.iter().map(|(_, velocity)| *velocity).collect::<Vec<_>>()).unwrap();
    let mut all = together.start(attitude, velocity).unwrap();
    together.run(&mut all, 500).unwrap();
    for _ in 0..10 {
        together.step(&mut all).unwrap();
    }
    for (lane, (attitude, velocity)) in starts.into_iter().enumerate() {
        let mut one = alone.start(attitude, velocity).unwrap();
        alone.run(&mut one, 510).unwrap();
        assert_eq!(all.momentum().lane(lane), one.momentum(), "lane {lane}");
        assert_eq!(all.attitude().lane(lane), one.attitude(), "lane {lane}");
    }
}

fn assert_all_methods<T: Real<Element = f64>>() {
    let (alone, together): (_, Top<T>) = (top(), Lanes::splat(&top()));
    let (h, step) = (0.01, convert::<f64, T>(0.01));
    let own = Stepper::new(together, step).unwrap();
    assert_independent(&own, &Stepper::new(alone, h).unwrap());
    let scheme = CompositionScheme::SUZUKI_4;
    assert_independent(
        &Stepper::composed(together, step, scheme).unwrap(),
        &Stepper::composed(alone, h, scheme).unwrap(),
    );
    let scheme = ProcessedScheme::SIX_A;
    let inertia = Inertia::from_principal_moments(Vector3::new(1.6, 2.6, 3.0)).unwrap();
    assert_independent(
        &Stepper::processed(together, step, ExactBody::<T>::new(&Lanes::splat(&inertia)), scheme).unwrap(),
        &Stepper::processed(alone, h, ExactBody::new(&inertia), scheme).unwrap(),
    );
}

#[test]
fn four_lanes_move_as_alone() {
    assert_all_methods::<WideF64x4>();
}

#[test]
fn eight_lanes_move_as_alone() {
    assert_all_methods::<AutoF64x8>();
}
