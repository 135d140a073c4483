//! P1 to P3, and P5, for random Lagrangians on every group, with every kind of advected parameter.
//!
//! The form of a Lagrangian is fixed at compile time, its terms are not: each has a random coefficient, which is zero
//! for about a third of them.

mod continuous;
mod family;
#[path = "../late/same.rs"]
mod same;
#[path = "../late/slopes.rs"]
mod slopes;

use checks::structure::{Group as _, System, equations, momenta, poisson, stages, symmetry, two_flows};
use liestep::Stepper;
use liestep::laws::samples::Random;
use proptest::prelude::any;
use proptest::test_runner::{Config, TestRunner};

/// The bound is some dozens of roundings, amplified on groups that aren't compact.
const ROUNDING: f64 = 1e-12;

/// The steps are small, because the limit for a random Lagrangian isn't known.
const STEPS: [f64; 2] = [0.001, 0.02];

/// Checks all claims about one Lagrangian.
fn assert_structure<L: System + Clone>(lagrangian: &L, seed: u64) {
    momenta::assert_momenta(lagrangian, seed);
    stages::assert_stages(lagrangian, seed);
    stages::assert_step(lagrangian, &STEPS, seed);
    let (_, defect) = poisson::worst(lagrangian, &STEPS, seed);
    assert!(defect < 1e-11, "Poisson: {defect:e}");

    let mut random = Random::new(seed);
    let stepper = Stepper::new(lagrangian.clone(), 0.02).unwrap();
    let attitude = L::Group::along(&random.sample(), 1.0);
    let start = stepper.start(attitude, random.sample()).unwrap();
    let (momentum, parameters) = symmetry::drift(&stepper.flow(), (attitude, start.momentum()), 30);
    println!("drift {momentum:.1e} {parameters:.1e}");
    assert!(momentum < ROUNDING, "momentum along a symmetry: {momentum:e}");
    assert!(parameters < ROUNDING, "parameters: {parameters:e}");
}

/// Asserts a claim for eight random seeds; a failure names its seed. All tests share this one runner: separate runners
/// would be a twentieth of the compiled code.
fn for_seeds(claim: &dyn Fn(u64)) {
    let config = Config { cases: 8, failure_persistence: None, max_shrink_iters: 0, ..Config::default() };
    let run = TestRunner::new(config).run(&any::<u64>(), |seed| {
        claim(seed);
        Ok(())
    });
    run.unwrap_or_else(|failure| panic!("{failure}"));
}

macro_rules! on_every_group {
    ($($group:ident)+) => {$(
        mod $group {
            use super::*;

            #[test]
            fn collocation() {
                for seed in 0..3 {
                    continuous::assert_collocation(
                        |w: &(_, _, _)| family::$group::Continuous::<f64> {
                            covector: w.0,
                            vector: w.1,
                            form: w.2,
                            ..family::$group::Continuous::random(seed)
                        },
                        seed,
                    );
                }
            }

            /// Lagrangians read at run time make the same steps as compiled ones, to the bit.
            #[test]
            fn late() {
                for seed in 0..15 {
                    let random = &mut Random::new(seed);
                    same::assert_as_compiled(&family::$group::Vectors::random(random), seed);
                    same::assert_as_compiled(&family::$group::Tensors::random(random), seed);
                }
            }

            #[test]
            fn vectors() {
                for_seeds(&|seed| {
                    let lagrangian = family::$group::Vectors::random(&mut Random::new(seed));
                    assert_structure(&lagrangian, seed);
                    let parting = two_flows::parting(&lagrangian, 0.01, 30, seed);
                    assert!(parting < ROUNDING, "the flows (2.5) and (2.8) part by {parting:e}");
                });
            }

            #[test]
            fn continuous() {
                for_seeds(&|seed| {
                    equations::assert_equations(
                        &family::$group::Continuous::<f64>::random(seed),
                        &family::$group::Continuous::random(seed),
                        &family::$group::Continuous::random(seed),
                        seed,
                    );
                });
            }

            #[test]
            fn tensors() {
                for_seeds(&|seed| {
                    assert_structure(&family::$group::Tensors::random(&mut Random::new(seed)), seed);
                });
            }
        }
    )+};
}

on_every_group!(so2 se2 so3 se3 su2 sl2 heisenberg r1 r2 r3 affine);
