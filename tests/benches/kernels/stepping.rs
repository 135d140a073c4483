//! A scene's steps as a kernel, compiled identically into every program that counts them.

use core::hint::black_box;

use liestep::groups::LieGroup;
use liestep::mechanics::Regular;
use liestep::motion::Plan;
use liestep::{SO3, StateOf, Stepper};
use nalgebra::{UnitQuaternion, Vector3, Vector6};

use crate::kernel::{Effort, Failure, Kernel};

const STEP: f64 = 0.01;

pub(crate) const EFFORT: Effort = Effort { batch: 20_000, rounds: 100, counted: 10_000 };

#[inline(never)]
fn run<L: Regular<Scalar = f64>, P: Plan<L>>(stepper: &Stepper<L, P>, state: &mut StateOf<L, P>, steps: u32) {
    for _ in 0..steps {
        stepper.step(state).expect("a solvable step");
    }
}

/// The steps of a stepper. Each batch starts anew: a torque would accelerate the body until no step is solvable.
pub(crate) fn stepping<L, P>(
    name: &str,
    ready: impl Fn() -> Result<(Stepper<L, P>, StateOf<L, P>), Failure> + 'static,
) -> Kernel
where
    L: Regular<Scalar = f64> + 'static,
    P: Plan<L, Kept: 'static> + 'static,
{
    Kernel::new(name, move || {
        let (stepper, start) = ready()?;
        Ok(move |steps| {
            let mut state = start;
            run(black_box(&stepper), black_box(&mut state), steps);
            Ok(0)
        })
    })
}

/// The steps of a scene from the initial state of its group.
pub(crate) fn scene<L: Regular<Scalar = f64, Group: Begin> + Clone + 'static>(name: &str, scene: L) -> Kernel {
    stepping(name, move || {
        let stepper = Stepper::new(scene.clone(), STEP)?;
        let (attitude, velocity) = L::Group::begin();
        let state = stepper.start(attitude, velocity)?;
        Ok((stepper, state))
    })
}

/// The initial state of a group's scenes.
pub(crate) trait Begin: LieGroup<Scalar = f64> {
    fn begin() -> (Self, Self::Vector);
}

/// The tilt and the spin of the thesis' looping top.
impl Begin for SO3 {
    fn begin() -> (Self, Vector3<f64>) {
        let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
        (attitude.into(), Vector3::new(0.5, 2.0, 12.0))
    }
}

/// Two links that swing.
impl Begin for (SO3, SO3) {
    fn begin() -> (Self, Vector6<f64>) {
        let attitude = |angle: f64| SO3::from(UnitQuaternion::from_scaled_axis(Vector3::new(angle, 0.0, 0.0)));
        ((attitude(0.8), attitude(-0.4)), Vector6::new(0.5, -1.0, 2.0, 1.0, 0.3, -0.5))
    }
}
