//! Products of groups, with a relative configuration and with translations, compared with differences of the stepper.

use liestep::groups::{CayleyRetraction, LieGroup, R1, R3, Retraction};
use liestep::laws::samples::Random;
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::{SO3, Stepper, lagrangian};
use nalgebra::{Matrix3, SVector, Vector3};

use super::dual::{Columns, SEEDS, STEP, STEPS};
use super::inputs::{assert_blocks, assert_columns};
use super::scenes::{J_D, Numbers};

type Pair = (SO3, SO3);

/// The double pendulum of the example, in matrices of a general kind, and with a spring between the links.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    gradients,
    advected(w_1 = up.seen_from(F_1), w_2 = up.seen_from(F_2), Q = F_2.seen_from(F_1)),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
        + ((F_1 - I) * rho).dot(&(Q * ((F_2 - I) * s_2))) / h
        - 0.5 * h * g * (w_1.dot(&(s_1 + F_1 * s_1)) + w_2.dot(&(s_2 + F_2 * s_2)))
        - h * k * (rho.dot(&(Q * s_2)) + w_1.dot(&(Q * s_2)) * w_2.dot(&s_1)),
)]
#[derive(Clone, Debug)]
struct Links {
    J_1: Matrix3<f64>,
    J_2: Matrix3<f64>,
    rho: Vector3<f64>,
    s_1: Vector3<f64>,
    s_2: Vector3<f64>,
    g: f64,
    k: f64,
    up: Vector3<f64>,
}

fn links(varied: Option<(usize, f64)>) -> Links {
    let mut n = Numbers::new(varied);
    Links {
        J_1: n.symmetric(&(J_D * 2.0)),
        J_2: n.symmetric(&J_D),
        rho: n.vector(0.2, -0.1, 0.5),
        s_1: n.vector(0.3, 0.2, 0.4),
        s_2: n.vector(-0.1, 0.3, 0.6),
        g: n.number(9.81),
        k: n.number(1.7),
        up: n.vector(0.0, 0.6, 0.8),
    }
}

/// A body with a wheel on a translated support: matrices of a rotation, a line and space together.
#[lagrangian(
    group(F = SO3, t = R1, d = R3),
    gradients,
    advected(
        w = up.seen_from(F),
        R = F.seen_from(space),
        s = t.seen_from(space),
        x = d.seen_from(space),
    ),
    l_d = {
        let U = |R: Matrix3<f64>, x: Vector3<f64>, s: f64| {
            0.5 * k * (x + R * rho).norm_squared() + g * s.cos() * x.z
        };
        ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
            + m * d.dot(&(R * ((F - I) * rho))) / h + J_w * (t + rho.dot(&vee(F))).powi(2) / (2.0 * h)
            - 0.5 * h * (U(R, x, s) + U(R * F, x + d, s + t) + g * w.dot(&(rho + F * rho)))
    },
)]
#[derive(Clone, Debug)]
struct SupportedBody {
    J: Matrix3<f64>,
    m: f64,
    J_w: f64,
    rho: Vector3<f64>,
    g: f64,
    k: f64,
    up: Vector3<f64>,
}

fn carried(varied: Option<(usize, f64)>) -> SupportedBody {
    let mut n = Numbers::new(varied);
    SupportedBody {
        J: n.symmetric(&(J_D * 2.0)),
        m: n.number(0.8),
        // A smaller moment has larger fifth derivatives: at 0.3 the differences have errors of 4e-10.
        J_w: n.number(0.9),
        rho: n.vector(0.2, -0.1, 0.5),
        g: n.number(2.81),
        k: n.number(1.7),
        up: n.vector(0.0, 0.6, 0.8),
    }
}

/// Derivatives by differences of the fourth order: their errors are some `10⁻¹²` times the fifth derivative, and some
/// `10⁻¹²` of rounding, which is a large part of a small column.
fn by_differences<L, const D: usize>(
    scene: impl Fn(Option<(usize, f64)>) -> L,
    parameters: usize,
    start: (L::Group, SVector<f64, D>),
) -> Columns<D>
where
    L: DiscreteLagrangian<
            Scalar = f64,
            Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>>,
            Retraction = CayleyRetraction,
        > + Regular,
    CayleyRetraction: Retraction<L::Group>,
{
    const SMALL: f64 = 1e-3;
    let end = |varied: Option<(usize, f64)>, turn: SVector<f64, D>, push: SVector<f64, D>| {
        let stepper = Stepper::new(scene(varied), STEP).expect("a stepper");
        let attitude = start.0.compose(&CayleyRetraction::retract(&turn));
        let mut state = stepper.start_with_momentum(attitude, start.1 + push).expect("a start");
        stepper.run(&mut state, STEPS).expect("steps");
        (state.attitude(), state.momentum())
    };
    let zero = SVector::zeros();
    let (middle, _) = end(None, zero, zero);
    let column = |outcome: &dyn Fn(f64) -> (L::Group, SVector<f64, D>)| {
        let [a, b, c, d] = [2.0, 1.0, -1.0, -2.0].map(|step| {
            let (attitude, momentum) = outcome(step * SMALL);
            // The function is odd in a turn, and agrees with it to first order.
            (L::Group::vee(&middle.inverse().compose(&attitude).matrix()), momentum)
        });
        let slope = |a, b, c, d| ((b - c) * 8.0 - (a - d)) / (12.0 * SMALL);
        (slope(a.0, b.0, c.0, d.0), slope(a.1, b.1, c.1, d.1))
    };
    let axis = |k: usize| SVector::<f64, D>::from_fn(|i, _| if i == k { 1.0 } else { 0.0 });
    let of_attitude = (0..D).map(|k| column(&|by| end(None, axis(k) * by, zero)));
    let of_momentum = (0..D).map(|k| column(&|by| end(None, zero, axis(k) * by)));
    let of_parameters = (0..parameters).map(|number| column(&|by| end(Some((number, by)), zero, zero)));
    of_attitude.chain(of_momentum).chain(of_parameters).collect()
}

#[test]
fn a_body_with_a_wheel_that_is_translated() {
    let stepper = Stepper::new(carried(None), STEP).expect("a stepper");
    let parameters = stepper.linearised().expect("derivatives").parameters().len();
    for seed in SEEDS {
        let mut random = Random::new(seed);
        let attitude: (SO3, R1, R3) = CayleyRetraction::retract(&random.sample());
        let start = (attitude, random.sample());
        let expected = by_differences(carried, parameters, start);
        assert_columns(&stepper, start, &[], &expected, (1e-10, 1e-7), seed);
        // Only the direction up varies: a derivation assumes that the others are a rotation and a position.
        assert_blocks(&stepper, start, seed, 3);
    }
}

#[test]
fn two_links() {
    let stepper = Stepper::new(links(None), STEP).expect("a stepper");
    let parameters = stepper.linearised().expect("derivatives").parameters().len();
    for seed in SEEDS {
        let mut random = Random::new(seed);
        let attitude: Pair = CayleyRetraction::retract(&random.sample());
        let start = (attitude, random.sample());
        let expected = by_differences(links, parameters, start);
        assert_columns(&stepper, start, &[], &expected, (1e-10, 1e-7), seed);
        assert_blocks(&stepper, start, seed, usize::MAX);
    }
}
