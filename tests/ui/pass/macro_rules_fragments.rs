//! Declarations inside `macro_rules!`, with parts from the definition and from the call.

use liestep::mechanics::{DiscreteLagrangian as _, Term as _};
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::{Matrix3, Rotation3, Vector3};

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

/// Kinetic parts with a fragment of each kind, placed where its precedence or its name matters.
macro_rules! with_fragment {
    ($name:ident, $l:expr) => {
        #[lagrangian(group = SO3, l_d = $l)]
        struct $name {
            J_d: NonstandardInertia,
            m: f64,
        }
    };
}

macro_rules! of_expr {
    ($name:ident, $a:expr) => {
        with_fragment!($name, $a * ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h));
    };
}
of_expr!(OfSum, 1.0 + m);
of_expr!(OfDifference, 5.0 - m);
of_expr!(OfNegative, -m + 7.0);

macro_rules! of_receiver {
    ($name:ident, $a:expr) => {
        with_fragment!($name, $a.powi(2) * ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h));
    };
}
of_receiver!(OfReceiver, 1.0 + m);

macro_rules! of_divisor {
    ($name:ident, $a:expr) => {
        with_fragment!($name, ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) / $a);
    };
}
of_divisor!(OfDivisor, 0.5 * m);

macro_rules! of_ident {
    ($name:ident, $a:ident) => {
        with_fragment!($name, $a * $a * ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h));
    };
}
of_ident!(OfIdent, m);

macro_rules! of_literal {
    ($name:ident, $a:literal) => {
        with_fragment!($name, m * ((F - I) * J_d * (F - I).transpose()).trace() / (h - $a * h));
    };
}
of_literal!(OfLiteral, -1.5);

macro_rules! of_tokens {
    ($name:ident, $a:tt, $($l:tt)*) => {
        with_fragment!($name, $a * ($($l)*) / (2.0 * h));
    };
}
of_tokens!(OfTokens, (1.0 + m), ((F - I) * J_d * (F - I).transpose()).trace());

macro_rules! of_type_and_path {
    ($name:ident, $inertia:ty, $group:path) => {
        #[lagrangian(group = $group, l_d = m * ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
        struct $name {
            J_d: $inertia,
            m: f64,
        }
    };
}
of_type_and_path!(OfTypeAndPath, liestep::NonstandardInertia<f64>, liestep::SO3);

/// The `m` of the fragment is the field, and that of the definition the `let`: 5 K · 7.
macro_rules! hygienic_let {
    ($name:ident, $e:expr) => {
        with_fragment!($name, {
            let m = 7.0;
            $e * m
        });
    };
}
hygienic_let!(HygienicLet, m * ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h));

/// Names alone, without an invisible bracket around them: 5 K · 7.
macro_rules! hygienic_name {
    ($name:ident, $m:ident) => {
        with_fragment!($name, {
            let m = 7.0;
            $m * m * ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        });
    };
}
hygienic_name!(HygienicName, m);

/// A `let` in the fragment hides the field there, and nothing in the definition: (7 + 5) K.
macro_rules! let_of_the_call {
    ($name:ident, $e:expr) => {
        with_fragment!($name, ($e + m) * ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h));
    };
}
let_of_the_call!(LetOfTheCall, {
    let m = 7.0;
    m
});

// Each name is that of the nearest `let` around it: ((5 + 1) · 2 + (5 + 1)) K.
with_fragment!(Nested, {
    let m = m + 1.0;
    let twice = {
        let m = 2.0 * m;
        m
    };
    (twice + m) * ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
});

/// Whether `l_d` and the inertia derived from it are a multiple of those of the plain kinetic part.
macro_rules! is_times {
    ($name:ident, $m:expr, $factor:expr) => {{
        let j_d = Matrix3::from_diagonal(&Vector3::new(2.0, 3.0, 1.0));
        let body = $name { J_d: NonstandardInertia::new(j_d).unwrap(), m: $m };
        let f = *Rotation3::from_euler_angles(0.2, -0.1, 0.3).matrix();
        let d = f - Matrix3::identity();
        let kinetic = (d * j_d * d.transpose()).trace() / 0.2;
        let declared = body.l_d(&f, &(), 0.1);
        assert!((declared - $factor * kinetic).abs() < 1e-12, "l_d of {}: {declared}", stringify!($name));
        let inertia = $factor * (Matrix3::identity() * j_d.trace() - j_d);
        assert!(
            (liestep::mechanics::inertia(&body, &body.advected()) - inertia).norm() < 1e-10,
            "inertia of {}: {}",
            stringify!($name),
            liestep::mechanics::inertia(&body, &body.advected())
        );
    }};
}

fn values() {
    is_times!(OfSum, 2.0, 3.0);
    is_times!(OfDifference, 2.0, 3.0);
    is_times!(OfNegative, 2.0, 5.0);
    is_times!(OfReceiver, 2.0, 9.0);
    is_times!(OfDivisor, 4.0, 0.5);
    is_times!(OfIdent, 3.0, 9.0);
    is_times!(OfLiteral, 5.0, 4.0);
    is_times!(OfTokens, 2.0, 3.0);
    is_times!(OfTypeAndPath, 3.0, 3.0);
    is_times!(HygienicLet, 5.0, 35.0);
    is_times!(HygienicName, 5.0, 35.0);
    is_times!(LetOfTheCall, 5.0, 12.0);
    is_times!(Nested, 5.0, 18.0);
}

/// The momentum after a step, for each of the equivalent declarations.
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

pub fn main() {
    values();
    let momentum = step!(FromCall);
    assert!((step!(FromBoth) - momentum).norm() < 1e-12);
    assert_eq!(step!(Double), momentum);
    assert!((step!(Single).cast::<f64>() - momentum).norm() < 1e-4);
}
