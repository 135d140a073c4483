//! The free body with preprocessed moments of inertia.

use checks::random::Random;
use checks::structure::poisson::{TOLERANCE, defect_of};
use declarations::{FreeBody, Motion};
use liestep::methods::PreprocessedOrder;
use liestep::prelude::*;
use nalgebra::Vector3;
use workbench::measure::relative;

use crate::convergence::{assert_order, counts};

const ORDERS: [(u32, PreprocessedOrder); 4] = [
    (4, PreprocessedOrder::Four),
    (6, PreprocessedOrder::Six),
    (8, PreprocessedOrder::Eight),
    (10, PreprocessedOrder::Ten),
];

fn asymmetric() -> DiagonalNonstandardInertia {
    DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).unwrap()
}

#[test]
fn preprocessed_bodies_have_their_order() {
    // From the coarsest step on that the series describe to one on which rounding begins to show.
    for ((order, preprocessing), (coarsest, ratio)) in
        ORDERS.into_iter().zip([(200, 2.0), (120, 1.6), (50, 1.3), (54, 1.1)])
    {
        for motion in ["free", "free flip"] {
            assert_order(("preprocessed", order), (motion, 10.0), &counts(coarsest, ratio, 5), |motion, h, steps| {
                let body = Stepper::preprocessed(PrincipalBody { J_d: motion.top.J_d }, h, preprocessing).unwrap();
                let mut state = body.start(motion.attitude, motion.velocity).unwrap();
                for _ in 0..steps {
                    body.step(&mut state).unwrap();
                }
                (state.attitude(), body.velocity(&state))
            });
        }
    }
}

#[test]
fn p1_the_momentum_map_is_poisson() {
    let mut random = Random::new(41);
    for (order, preprocessing) in ORDERS {
        let body = Stepper::preprocessed(PrincipalBody { J_d: asymmetric() }, 0.3, preprocessing).unwrap();
        let step = |momentum: &Vector3<f64>, (): &()| {
            let mut state = body.start_with_momentum(SO3::identity(), *momentum).unwrap();
            body.step(&mut state).unwrap();
            (state.momentum(), ())
        };
        let (defect, _) = defect_of::<FreeBody, 3, 3>(step, &(random.vector() * 5.0), &());
        assert!(defect < TOLERANCE, "order {order}: {defect:e}");
    }
}

#[test]
fn preprocessed_bodies_keep_energy_and_momentum() {
    for (order, preprocessing) in ORDERS {
        let body = Stepper::preprocessed(PrincipalBody { J_d: asymmetric() }, 0.2, preprocessing).unwrap();
        let mut state = body.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02)).unwrap();
        let (energy, spatial) = (body.energy(&state), state.spatial_momentum());
        for _ in 0..1_000_000 {
            body.step(&mut state).unwrap();
        }
        let drift = ((body.energy(&state) - energy) / energy).abs();
        let moved = relative(&state.spatial_momentum(), &spatial);
        println!("order {order}: energy {drift:.1e}, momentum {moved:.1e}");
        assert!(drift < 1e-12 && moved < 1e-12 && state.orthogonality_defect() < 1e-12);
    }
}

#[test]
fn s5_negative_preprocessed_step_is_the_inverse_map() {
    let mut random = Random::new(42);
    for (_, preprocessing) in ORDERS {
        let [there, back] =
            [0.2, -0.2].map(|h| Stepper::preprocessed(PrincipalBody { J_d: asymmetric() }, h, preprocessing).unwrap());
        for _ in 0..10 {
            let mut state = there.start(random.rotation(), random.vector()).unwrap();
            let before = state;
            there.step(&mut state).unwrap();
            back.step(&mut state).unwrap();
            assert!(relative(&state.attitude().matrix(), &before.attitude().matrix()) < 1e-14);
            assert!(relative(&state.momentum(), &before.momentum()) < 1e-14);
        }
    }
}

#[test]
fn a_preprocessed_step_of_zero_is_the_identity() {
    let body = Stepper::preprocessed(PrincipalBody { J_d: asymmetric() }, 0.0, PreprocessedOrder::Ten).unwrap();
    let mut state = body.start(SO3::identity(), Vector3::x()).unwrap();
    let before = state;
    body.step(&mut state).unwrap();
    assert_eq!((before.attitude(), before.momentum(), 1), (state.attitude(), state.momentum(), state.steps()));
}

#[test]
fn a_preprocessed_step_that_is_too_long_is_an_error() {
    let motion = Motion::read("free");
    for (_, preprocessing) in ORDERS {
        let body = Stepper::preprocessed(PrincipalBody { J_d: motion.top.J_d }, 5.0, preprocessing).unwrap();
        let mut state = body.start(motion.attitude, motion.velocity).unwrap();
        let before = state;
        let error = body.step(&mut state).unwrap_err();
        assert_eq!(state, before);
        let StepError::BeyondSolvable { largest, .. } = error else { panic!("{error}") };
        assert!(largest > 0.1, "{largest}");
        let body = Stepper::preprocessed(PrincipalBody { J_d: motion.top.J_d }, largest, preprocessing).unwrap();
        let mut state = body.start(motion.attitude, motion.velocity).unwrap();
        body.step(&mut state).unwrap();
    }
}
