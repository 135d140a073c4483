//! One scene of two bodies in unusual spellings, all with one motion; and terms on bodies whose indices are computed
//! constants.

// Names of fields have capital letters, and the expressions superfluous parentheses.
#![allow(non_snake_case, unused_parens, unused_braces)]

use core::fmt::Debug;

use liestep::groups::R3;
use liestep::mechanics::{Along, Between, DiscreteLagrangian, Each, On, Pairs, Placement, Regular};
use liestep::methods::{Constraint, Place};
use liestep::numbers::{Bodies, Real};
use liestep::{NonstandardInertia, SO3, Stepper, constraint, force, lagrangian};
use nalgebra::{Matrix3, RealField, Vector3, Vector6};

type Inertia = NonstandardInertia;

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
        + 0.5 * h * k * (Q.trace() + (F_1.transpose() * Q * F_2).trace()),
)]
struct Plain {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    k: f64,
}

#[rustfmt::skip]
#[lagrangian(
    group(F = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F)),
    l_d = (((((F) - (I)) * (J_1) * ((F - I).transpose())).trace()) / ((2.0) * (h)))
        + { { (((F_2 - I) * J_2 * (F_2 - I).transpose()).trace()) / (2.0 * h) } }
        - - (0.5 * ((h) * (k)) * -(-(Q.trace()) - { (inverse(F) * (Q * (F_2))).trace() })),
)]
struct Parenthesised {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    k: f64,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = {
        let D = F_1 - I;
        let D = D * J_1 * D.transpose();
        let K = D.trace() / (2.0 * h);
        let D = F_2 - I;
        let K = K + (D * J_2 * D.transpose()).trace() / (2.0 * h);
        let J_1 = {
            let k = 0.5 * k;
            let after = F_1.transpose() * Q * F_2;
            k * (Q.trace() + after.trace())
        };
        K + h * J_1
    },
)]
struct Bound {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    k: f64,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = {
        let part = |A: Matrix3<f64>| 0.5 * h * k * A.trace();
        let K = |D: Matrix3<f64>, J: Matrix3<f64>| (D * J * D.transpose()).trace() / (2.0 * h);
        let U = |first: Matrix3<f64>, second: Matrix3<f64>| part(first) + part(second);
        K(F_1 - I, J_1.clone()) + K(F_2 - I, J_2) + U(Q, F_1.transpose() * Q * F_2)
    },
)]
struct Functions {
    J_1: Matrix3<f64>,
    J_2: Matrix3<f64>,
    k: f64,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = {
        let D = &(&F_1 - I);
        (D * &J_1 * D.transpose()).trace() / (2.0 * h)
            + ((&F_2 - I) * &J_2 * (&F_2 - I).transpose()).trace() / (2.0 * h)
            + 0.5 * h * k * (Q.trace() + (F_1.transpose() * &Q * &F_2).trace())
    },
)]
struct References {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    k: f64,
}

/// A Lagrangian of a struct with a const parameter that it doesn't use.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
        + 5e-1 * h * k * (Q.trace() + (F_1.transpose() * Q * F_2).trace()),
)]
struct Generic<Scalar: Real, const ID: usize>
where
    Vector3<Scalar>: Debug,
{
    J_1: NonstandardInertia<Scalar>,
    J_2: NonstandardInertia<Scalar>,
    k: Scalar,
}

/// A documented declaration.
#[derive(Clone, Copy)]
#[allow(dead_code)]
#[lagrangian(
    // The arguments are in an unusual order, the last one first.
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
        + 0.5 * h * k * (Q.trace() + (F_1.transpose() * Q * F_2).trace()),
    advected(
        Q = F_2.seen_from(F_1), /* how they stand */
    ),
    group(F_1 = liestep::SO3, F_2 = liestep::groups::SO3,)
)]
#[must_use]
pub struct Adorned {
    /// The stiffness.
    pub(crate) k: f64, // J
    #[cfg(not(any()))]
    #[doc(hidden)]
    pub J_2: NonstandardInertia,
    #[allow(unused)]
    J_1: NonstandardInertia,
}

// Names of groups and keywords may be names of increments.
#[lagrangian(
    group(r#fn = SO3, R1 = SO3),
    advected(r#type = R1.seen_from(r#fn)),
    l_d = ((r#fn - I) * J_1 * (r#fn - I).transpose()).trace() / (2.0 * h)
        + ((R1 - I) * J_2 * (R1 - I).transpose()).trace() / (2.0 * h)
        + 0.5 * h * r#in * (r#type.trace() + (r#fn.transpose() * r#type * R1).trace()),
)]
struct Named {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    r#in: f64,
}

// Each run of rustfmt would indent this further.
#[rustfmt::skip]
macro_rules! two {
    ($name:ident: $a:ident, $b:ident, $half:expr, $scalar:ty) => {
        #[lagrangian(
            group($a = SO3, $b = SO3),
            advected(Q = $b.seen_from($a)),
            l_d = (($a - I) * J_1 * ($a - I).transpose()).trace() / (2.0 * h)
                + (($b - I) * J_2 * ($b - I).transpose()).trace() / (2.0 * h)
                + h * $half * (Q.trace() + ($a.transpose() * Q * $b).trace()),
        )]
        struct $name {
            J_1: NonstandardInertia<$scalar>,
            J_2: NonstandardInertia<$scalar>,
            k: $scalar,
        }
    };
}

two!(FromAMacro: A, B, 0.25 * k + 0.25 * k, f64);

/// The momenta of both bodies after ten steps.
fn moved<S, T: RealField + Real>(scene: S) -> Vector6<T>
where
    S: DiscreteLagrangian<Scalar = T, Group = (SO3<T>, SO3<T>)> + Regular,
{
    let real = nalgebra::convert::<f64, T>;
    let stepper = Stepper::new(scene, real(0.1)).unwrap();
    let attitudes = (
        SO3::from_euler_angles(real(0.1), real(0.2), real(0.3)),
        SO3::from_euler_angles(real(1.0), real(0.5), real(0.0)),
    );
    let mut state = stepper.start(attitudes, Vector6::new(1.0, 0.5, -0.3, 0.2, -0.8, 0.6).map(real)).unwrap();
    stepper.run(&mut state, 10).unwrap();
    state.momentum()
}

/// A point of one body is at a point of the other, and an axis at right angles to one.
#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
    zero = (r + R_2 * below - R_1 * above, (R_1 * axis).dot(&(R_2 * normal))),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Universal {
    above: Vector3<f64>,
    below: Vector3<f64>,
    axis: Vector3<f64>,
    normal: Vector3<f64>,
}

#[derive(Debug, PartialEq, Copy)]
#[constraint(
    zero = {
        let gap = &r + &(R * (Q * below - above));
        (((gap.x), gap[1], gap.z, axis.dot(&(Q * normal))))
    },
    advected(R = A.seen_from(space), Q = B.seen_from(A), r = b.seen_from(a)),
    group(A = SO3, a = R3, B = SO3, b = R3)
)]
#[derive(Clone)]
struct Cardan {
    /// Point of the body above, m.
    pub above: Vector3<f64>,
    below: Vector3<f64>, // m
    #[allow(unused)]
    axis: Vector3<f64>,
    normal: Vector3<f64>,
}

/// Work of one of two bodies, with the name of a displacement on a single body.
#[force(group(F = SO3, d = R3), displacement(eta, r#mod), work = -(c) * (log(F).dot(&eta) + { d.dot(&r#mod) }))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Friction {
    c: f64,
}

#[lagrangian(group(G = SO3), l_d = ((G - I) * J * (G - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Turning {
    J: NonstandardInertia,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = 0.5 * h * k * (Q.trace() + (F_1.transpose() * Q * F_2).trace()),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Alike {
    k: f64,
}

struct Row;

impl Row {
    const ALIKE: Alike = Alike { k: 1.0 };
    const BODIES: usize = 2 + 1;
    const TIED: Placement<Along<{ Self::BODIES }>, Alike, 1> = Along::<{ Self::BODIES }>::of([Self::ALIKE]);
}

/// The drift of the total momentum of `N` bodies.
fn kept<const N: usize>(J: NonstandardInertia) -> f64 {
    let bodies = Each::<N>::of([Turning { J }; N]) + Pairs::<N>::of([Alike { k: -0.5 }]);
    let scene = bodies + (Between::<2, 0, N>::of([Row::ALIKE]) + On::<0, N>::of([Turning { J }]));
    let stepper = Stepper::new(scene, 0.01).unwrap();
    let attitudes = core::array::from_fn(|k| SO3::from_euler_angles(0.1, 0.2, if k == 0 { 0.3 } else { -0.2 }));
    let mut state = stepper.start(attitudes, Bodies([Vector3::x(); N])).unwrap();
    let whole = |momenta: Bodies<Vector3<f64>, N>| momenta.0.iter().sum::<Vector3<f64>>();
    let before = whole(state.spatial_momentum());
    stepper.run(&mut state, 20).unwrap();
    (whole(state.spatial_momentum()) - before).norm()
}

pub fn main() {
    let [J_1, J_2] = [[2.0, 2.0, 1.0], [1.0, 2.0, 1.5]].map(|J| Inertia::from_diagonal(J.into()).unwrap());
    let k = 3.0;
    let (A, B) = (*J_1.as_matrix(), *J_2.as_matrix());
    let plain = moved(Plain { J_1, J_2, k });
    let others = [
        moved(Parenthesised { J_1, J_2, k }),
        moved(Bound { J_1, J_2, k }),
        moved(Functions { J_1: A, J_2: B, k }),
        moved(References { J_1, J_2, k }),
        moved(Generic::<f64, 7> { J_1, J_2, k }),
        moved(Adorned { J_1, J_2, k }),
        moved(Named { J_1, J_2, r#in: k }),
        moved(FromAMacro { J_1, J_2, k }),
    ];
    // Ten steps agree, each solved to roundings: momenta of one step differ by some 1e-15 in double and by 1e-7 in
    // single precision.
    assert!(others.iter().all(|other| (other - plain).norm() < 1e-12 * plain.norm()), "{plain} {others:?}");
    let [single_1, single_2] = [[2.0, 2.0, 1.0], [1.0, 2.0, 1.5]]
        .map(|J: [f32; 3]| NonstandardInertia::<f32>::from_diagonal(J.into()).unwrap());
    let single = moved(Generic::<f32, 7> { J_1: single_1, J_2: single_2, k: 3.0 });
    assert!((single.cast::<f64>() - plain).norm() < 1e-5 * plain.norm());

    let [above, below, axis, normal] =
        [[0.1, 0.2, 0.3], [-0.5, 0.1, 0.0], [1.0, 0.0, 0.0], [0.0, 0.6, 0.8]].map(Vector3::from);
    let place =
        |angle: f64, position| Place { attitude: *SO3::from_euler_angles(angle, 0.4, 0.2).as_matrix(), position };
    let places = (place(0.3, Vector3::x()), place(-0.5, Vector3::y()));
    let gap = Universal { above, below, axis, normal }.gap(&places.0, &places.1);
    let other = Cardan { above, below, axis, normal }.gap(&places.0, &places.1);
    // The bound is the rounding of sums in another order, of numbers near one.
    assert!(gap.norm() > 0.1 && (gap - other).norm() < 1e-15, "{gap} {other}");

    // The bounds are roundings of twenty steps, for momenta of about ten.
    assert!(kept::<{ Row::BODIES }>(J_1) < 1e-13 && kept::<5>(J_2) < 1e-13);
    assert_eq!(Row::TIED, Along::<3>::of([Alike { k: 1.0 }]));
    let _ = Friction { c: 1.0 };
}
