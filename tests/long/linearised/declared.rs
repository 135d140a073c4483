//! Declarations with features that the library's effects don't have: a field under two names, points, closed `let`s.

use liestep::groups::SE2;
use liestep::mechanics::Effect as _;
use liestep::{SO3, Stepper, lagrangian};
use nalgebra::{Matrix3, Point2, RealField, Vector3};
use num_dual::Dual64;

use super::dual::{STEP, assert_linearised};
use super::scenes::{J_D, Numbers, unit};

#[lagrangian(
    group = SO3,
    gradients,
    advected(w = up, v = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * m * w.dot(&(rho + F * rho))
        - h * k * w.dot(&a) * v.dot(&(F * a)),
)]
#[derive(Clone, Debug)]
struct TwoNames<T: RealField + Copy> {
    J_d: Matrix3<T>,
    m: T,
    k: T,
    rho: Vector3<T>,
    a: Vector3<T>,
    up: Vector3<T>,
}

fn two_names<T: RealField + Copy>(varied: Option<(usize, T)>) -> TwoNames<T> {
    let mut n = Numbers::new(varied);
    TwoNames {
        J_d: n.symmetric(&J_D),
        m: n.number(1.2),
        k: n.number(2.3),
        rho: n.vector(0.3, 0.2, 0.4),
        a: n.vector(-0.5, 0.7, 0.1),
        up: n.vector(0.0, 0.6, 0.8),
    }
}

/// The derivatives of both uses are summed.
#[test]
fn a_field_under_two_names() {
    let stepper = Stepper::new(two_names::<f64>(None), STEP).expect("a stepper");
    let dual = |number| Stepper::new(two_names(unit(number)), STEP.into()).expect("a stepper");
    assert_linearised(&stepper, dual);
}

/// A body attracted by a point of the plane, by a potential that isn't expanded.
#[lagrangian(
    group = SE2,
    gradients,
    advected(c = centre),
    l_d = {
        let s = k + 1.0 / (1.0 + (c - F * p).norm_squared());
        let q = (k + s) * (1.0 + s);
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * (k + q) * (s + q)
    },
)]
#[derive(Clone, Debug)]
struct AttractedBody<T: RealField + Copy> {
    J: Matrix3<T>,
    k: T,
    p: Point2<T>,
    centre: Point2<T>,
}

fn attracted<T: RealField + Copy>(varied: Option<(usize, T)>) -> AttractedBody<T> {
    let mut n = Numbers::new(varied);
    AttractedBody {
        J: n.symmetric(&J_D),
        k: n.number(0.4),
        p: Point2::new(n.number(0.3), n.number(-0.2)),
        centre: Point2::new(n.number(0.6), n.number(0.5)),
    }
}

#[test]
fn a_point_and_closed_lets() {
    assert!(AttractedBody::<f64>::DERIVATION.contains("kept closed"), "{}", AttractedBody::<f64>::DERIVATION);
    let stepper = Stepper::new(attracted::<f64>(None), STEP).expect("a stepper");
    let dual = |number: Option<usize>| Stepper::new(attracted::<Dual64>(unit(number)), STEP.into()).expect("a stepper");
    assert_linearised(&stepper, dual);
}
