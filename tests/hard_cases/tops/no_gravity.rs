//! A top without weight is a free body, and a free body's spatial momentum `R p` is constant.

use declarations::Motion;
use declarations::{FreeBody, FullTop, HeavyTop};
use liestep::groups::LieGroup as _;
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::{SO3, Stepper};
use nalgebra::{Matrix3, Vector3};
use workbench::measure::relative;

/// Attitude and momentum after a thousand steps, about twenty turns, and how far `R p` has gone.
fn moved<L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular>(lagrangian: L) -> (Matrix3<f64>, Vector3<f64>) {
    let motion = Motion::looping();
    let stepper = Stepper::new(lagrangian, 0.01).unwrap();
    let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
    let momentum = state.spatial_momentum();
    for _ in 0..1000 {
        stepper.step(&mut state).unwrap();
        // Less than a rounding a step.
        assert!(relative(&state.spatial_momentum(), &momentum) < 5e-14);
    }
    (state.attitude().matrix(), state.momentum())
}

#[test]
fn t8_a_top_without_weight_is_a_free_body() {
    for top in [HeavyTop::thesis(), HeavyTop::asymmetric()] {
        let free = moved(FreeBody { J_d: top.J_d.into() });
        for weightless in [
            HeavyTop { g: 0.0, ..top.clone() },
            HeavyTop { m: 0.0, ..top.clone() },
            HeavyTop { rho: Vector3::zeros(), ..top.clone() },
        ] {
            let full = FullTop::in_axes(&weightless, &Matrix3::identity());
            for (attitude, momentum) in [moved(weightless), moved(full)] {
                let errors = [relative(&attitude, &free.0), relative(&momentum, &free.1)];
                println!("{errors:?}");
                // Two sums may round differently; a thousand steps and their twist make `1000^{3/2} ε` of it.
                assert!(errors.iter().all(|&error| error < 7e-12), "{errors:?}");
            }
        }
    }
}
