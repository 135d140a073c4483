//! A product of groups, with a relative configuration, against differences of the stepper.

use liestep::groups::{CayleyRetraction, LieGroup as _, Retraction as _};
use liestep::laws::samples::Random;
use liestep::{SO3, Stepper, lagrangian};
use nalgebra::{Matrix3, Vector3, Vector6};

use super::dual::{Columns, STEP, STEPS, assert_columns};
use super::scenes::{J_D, Numbers, SEEDS};

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

/// By differences of the fourth order: off by some `10⁻¹²` times the fifth derivative, and by some `10⁻¹²` of rounding, of
/// which a small column has a large part.
fn by_differences(parameters: usize, start: (Pair, Vector6<f64>)) -> Columns<6> {
    const SMALL: f64 = 1e-3;
    let end = |varied: Option<(usize, f64)>, turn: Vector6<f64>, push: Vector6<f64>| {
        let stepper = Stepper::new(links(varied), STEP).expect("a stepper");
        let attitude = start.0.compose(&CayleyRetraction::retract(&turn));
        let mut state = stepper.start_with_momentum(attitude, start.1 + push).expect("a start");
        stepper.run(&mut state, STEPS).expect("steps");
        (state.attitude(), state.momentum())
    };
    let zero = Vector6::zeros();
    let (middle, _) = end(None, zero, zero);
    let column = |outcome: &dyn Fn(f64) -> (Pair, Vector6<f64>)| {
        let [a, b, c, d] = [2.0, 1.0, -1.0, -2.0].map(|step| {
            let (attitude, momentum) = outcome(step * SMALL);
            // Odd in a turn, and the same to the first order.
            (Pair::vee(&middle.inverse().compose(&attitude).matrix()), momentum)
        });
        let slope = |a, b, c, d| ((b - c) * 8.0 - (a - d)) / (12.0 * SMALL);
        (slope(a.0, b.0, c.0, d.0), slope(a.1, b.1, c.1, d.1))
    };
    let axis = |k: usize| Vector6::<f64>::ith(k, 1.0);
    let of_attitude = (0..6).map(|k| column(&|by| end(None, axis(k) * by, zero)));
    let of_momentum = (0..6).map(|k| column(&|by| end(None, zero, axis(k) * by)));
    let of_parameters = (0..parameters).map(|number| column(&|by| end(Some((number, by)), zero, zero)));
    of_attitude.chain(of_momentum).chain(of_parameters).collect()
}

#[test]
fn two_links() {
    let stepper = Stepper::new(links(None), STEP).expect("a stepper");
    let parameters = stepper.linearised().expect("derivatives").parameters().len();
    for seed in SEEDS {
        let mut random = Random::new(seed);
        let attitude: Pair = CayleyRetraction::retract(&random.sample());
        let start = (attitude, random.sample());
        let expected = by_differences(parameters, start);
        assert_columns(&stepper, start, &expected, (1e-10, 1e-7), seed);
    }
}
