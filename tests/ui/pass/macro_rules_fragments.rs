//! Declarations inside `macro_rules!`, with parts from either side.

use liestep::mechanics::Effect as _;
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::Vector3;

/// The name, the types and the whole Lagrangian come from the call.
macro_rules! from_call {
    ($name:ident, $inertia:ty, $vector:ty, $w:ident, $l:expr) => {
        #[lagrangian(group = SO3, advected($w = up), l_d = $l)]
        struct $name {
            inertia: $inertia,
            rho: $vector,
            up: $vector,
        }
    };
}

from_call!(
    FromCall,
    NonstandardInertia,
    Vector3<f64>,
    w,
    ((F - I) * inertia * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * w.dot(&(rho + F * rho))
);

/// Names of the definition and of the call meet in one expression; `let`s come from both sides.
macro_rules! from_both {
    ($name:ident { $field:ident: $ty:ty }, $group:path, $factor:literal, $potential:expr) => {
        #[lagrangian(
                                                    group = $group,
                                                    advected(w = up),
                                                    l_d = {
                                                        let d = F - I;
                                                        let kinetic = (d * inertia * d.transpose()).trace() / (2.0 * h);
                                                        kinetic - $factor * h * ($potential + w.dot(&$field))
                                                    },
                                                )]
        struct $name {
            inertia: NonstandardInertia,
            $field: $ty,
            up: Vector3<f64>,
        }
    };
}

from_both!(FromBoth { rho: Vector3<f64> }, liestep::SO3, 0.5, {
    let tip = F * rho;
    w.dot(&tip)
});

/// The scalar is a fragment, too.
macro_rules! of_scalar {
    ($name:ident, $scalar:ty) => {
        #[lagrangian(
            group = SO3,
            advected(w = up),
            l_d = ((F - I) * inertia * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * w.dot(&(rho + F * rho)),
        )]
        struct $name {
            inertia: NonstandardInertia<$scalar>,
            rho: Vector3<$scalar>,
            up: Vector3<$scalar>,
        }
    };
}

of_scalar!(Single, f32);
of_scalar!(Double, f64);

/// One value from each declaration that says the same.
macro_rules! step {
    ($name:ident) => {{
        let inertia = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap();
        let top = $name { inertia, rho: Vector3::z(), up: Vector3::z() };
        assert_eq!(top.advected(), Vector3::z());
        let stepper = Stepper::new(top, 0.0625).unwrap();
        let mut state = stepper.start(SO3::identity(), Vector3::new(0.125, 0.0, 5.0)).unwrap();
        stepper.step(&mut state).unwrap();
        state.momentum()
    }};
}

fn main() {
    let momentum = step!(FromCall);
    assert!((step!(FromBoth) - momentum).norm() < 1e-12);
    assert_eq!(step!(Double), momentum);
    assert!((step!(Single).cast::<f64>() - momentum).norm() < 1e-4);
}
