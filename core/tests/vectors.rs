//! Several bodies in lanes move as each alone, and one as by the instructions of the target, to the bit, by the vector
//! instructions that the machine is found to have.
//!
//! Only builds without debug assertions ask for these: `cargo test --release -p liestep --lib --test vectors`.

#![cfg(not(debug_assertions))]
// The letters of the field.
#![allow(non_snake_case)]

use liestep::effects::{Gravity, PrincipalBody};
use liestep::mechanics::{SceneVisitor, Sum, Term};
use liestep::methods::{CompositionScheme, ExactBody, ProcessedScheme, SplittingScheme};
use liestep::motion::{Cost, Motion, Plan, StepReport, Summation};
use liestep::numbers::{Lanes, Real, Vectors};
use liestep::prelude::*;
use nalgebra::{Vector3, convert};
use simba::simd::{AutoF64x8, WideF64x4};

type Top<T> = Sum<PrincipalBody<T>, Gravity<T>>;

/// Asymmetric, its centre of mass on none of its axes.
fn top() -> Top<f64> {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.6, 2.6, 3.0)).unwrap();
    PrincipalBody { J_d } + Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.1, 0.2, 0.3), up: Vector3::z() }
}

/// Where the top of a lane starts: each leans and spins otherwise.
fn start(lane: usize) -> (SO3, Vector3<f64>) {
    let k = lane as f64;
    (SO3::from_euler_angles(0.3 * k, 1.0 - 0.2 * k, 0.1), Vector3::new(0.5, 0.4 * k - 1.0, 3.0 + k))
}

/// Steps the tops of all lanes together, and each of them alone.
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

/// A plan with the instructions of the target.
#[derive(Clone)]
struct AsCompiled<P>(P);

impl<P: Plan<Top<f64>>> Plan<Top<f64>> for AsCompiled<P> {
    type Kept = P::Kept;

    const VECTORS: Vectors = Vectors::AsCompiled;

    fn step_size(&self) -> f64 {
        self.0.step_size()
    }

    fn refolded(&self, scene: &Top<f64>, h: f64) -> Result<Self, SetupError> {
        self.0.refolded(scene, h).map(Self)
    }

    fn keep(&self, scene: &Top<f64>, motion: &Motion<SO3, <Top<f64> as Term>::Advected>) -> Self::Kept {
        self.0.keep(scene, motion)
    }

    fn step<M: Summation<SO3, <Top<f64> as Term>::Advected>>(
        &self,
        scene: &Top<f64>,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        self.0.step(scene, motion, kept)
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        self.0.describe(visitor);
    }

    fn cost(&self) -> Cost {
        self.0.cost()
    }
}

fn assert_as_compiled<P: Plan<Top<f64>> + Clone>(stepper: &Stepper<Top<f64>, P>) {
    assert_ne!(P::VECTORS, Vectors::AsCompiled);
    let other = Stepper::with_plan(top(), AsCompiled(stepper.plan().clone())).unwrap();
    let (attitude, velocity) = start(3);
    let (mut state, mut expected) =
        (stepper.start(attitude, velocity).unwrap(), other.start(attitude, velocity).unwrap());
    for _ in 0..500 {
        stepper.step(&mut state).unwrap();
        other.step(&mut expected).unwrap();
    }
    assert_eq!((state.attitude(), state.momentum()), (expected.attitude(), expected.momentum()));
}

#[test]
fn one_body_moves_as_by_the_instructions_of_the_target() {
    let body = ExactBody::new(&Inertia::from_principal_moments(Vector3::new(1.6, 2.6, 3.0)).unwrap());
    assert_as_compiled(&Stepper::split(top(), 0.01, body, SplittingScheme::FORCE_GRADIENT_5).unwrap());
    assert_as_compiled(&Stepper::processed(top(), 0.01, body, ProcessedScheme::SIX_A).unwrap());
    assert_as_compiled(&Stepper::collocated::<4>(top(), 0.1).unwrap());
}
