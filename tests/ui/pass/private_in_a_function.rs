//! A private struct in a module, and one inside a function, with private fields and without advected parameters.

use liestep::mechanics::Term as _;
use liestep::{SO3, Stepper, lagrangian};
use nalgebra::Vector3;

mod inner {
    use liestep::mechanics::DiagonalNonstandardInertia;
    use liestep::{SO3, lagrangian};

    #[lagrangian(group = SO3, l_d = ((F - I) * inertia * (F - I).transpose()).trace() / (2.0 * h))]
    struct Body {
        inertia: DiagonalNonstandardInertia,
    }

    pub fn steps() -> u64 {
        use liestep::Stepper;
        let inertia = DiagonalNonstandardInertia::from_diagonal(nalgebra::Vector3::new(2.0, 2.0, 1.0)).unwrap();
        let stepper = Stepper::new(Body { inertia }, 0.01).unwrap();
        let state = stepper.start(SO3::identity(), nalgebra::Vector3::new(0.1, 0.0, 5.0)).unwrap();
        stepper.steps(state).take(3).last().unwrap().unwrap().steps()
    }
}

pub fn main() {
    #[lagrangian(group = SO3, l_d = 2.0 * k * (3.0 - F.trace()) / h)]
    struct Ball {
        k: f64,
    }

    assert_eq!(inner::steps(), 3);
    Ball { k: 1.0 }.advected();
    let stepper = Stepper::new(Ball { k: 1.0 }, 0.01).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 0.0, 5.0)).unwrap();
    let before = state.momentum();
    stepper.step(&mut state).unwrap();
    assert!((state.momentum() - before).norm() < 1e-14);
}
