//! All names of liestep imported at once: a scene's methods stay the only ones of their names.

#![allow(unused_imports)]

use liestep::accuracy::*;
use liestep::effects::*;
use liestep::gradients::*;
use liestep::groups::*;
use liestep::mechanics::*;
use liestep::methods::*;
use liestep::motion::*;
use liestep::nalgebra::Vector3;
use liestep::numbers::*;
use liestep::prelude::*;
use liestep::recording::*;
use liestep::with::*;
use liestep::*;

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone)]
struct Body {
    J_d: NonstandardInertia,
}

pub fn main() {
    let body = Body { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap() };
    assert_eq!(inertia(&body, &body.advected()).diagonal(), Vector3::new(3.0, 3.0, 4.0));
    assert_eq!(body.limit(None, &()).momentum, Vector3::zeros());
    let stepper = Stepper::new(body, 0.01).unwrap();
    let state = stepper.start(SO3::identity(), Vector3::new(0.1, 0.0, 5.0)).unwrap();
    assert_eq!(state.steps(), 0);
}
