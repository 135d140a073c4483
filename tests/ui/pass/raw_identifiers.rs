//! Keywords as names of fields, of the advected parameter and of a `let`.

use liestep::mechanics::Term as _;
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    advected(r#dyn = r#move),
    l_d = {
        let r#where = F - I;
        let kinetic = (r#where * r#type * r#where.transpose()).trace() / (2.0 * h);
        kinetic - 0.5 * h * r#dyn.dot(&(r#in + F * r#in))
    },
)]
struct Top {
    r#type: NonstandardInertia,
    r#in: Vector3<f64>,
    r#move: Vector3<f64>,
}

pub fn main() {
    let inertia = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap();
    let top = Top { r#type: inertia, r#in: Vector3::z(), r#move: Vector3::z() };
    assert_eq!(top.advected(), Vector3::z());
    let stepper = Stepper::new(top, 0.01).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 0.0, 5.0)).unwrap();
    stepper.step(&mut state).unwrap();
    assert_eq!(state.steps(), 1);
}
