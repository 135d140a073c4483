//! Online estimation of attitude, momentum and a gyroscope's bias from readings: by the last two seconds, and by a
//! Kalman filter.

use std::fmt::Write as _;

use liestep::effects::RigidBody;
use liestep::gradients::Input;
use liestep::laws::samples::Random;
use liestep::motion::Motion;
use liestep::{NonstandardInertia, SO3, StateOf, Stepper};
use liestep_control::{Estimate, Verdict};
use nalgebra::{DMatrix, Matrix3, SMatrix, SVector, UnitQuaternion, Vector3};
use workbench::args::Failure;
use workbench::plot::{BLUE, Line, Panel, VERMILION, Vertical};

use crate::{Drawing, Part, picture};

/// The time between two readings, s.
const STEP: f64 = 0.1;
const STEPS: usize = 200;
/// The number of steps in the horizon of an estimate.
const HORIZON: usize = 20;
/// Standard deviations: of the gyroscope, rad/s, of the vector's components, and of a constant torque over a step, N m.
const GYROSCOPE: f64 = 0.01;
const VECTOR: f64 = 0.02;
const TORQUE: f64 = 0.02;
/// Standard deviations of the initial state: rad, kg m²/s, rad/s.
const START: [f64; 3] = [0.5, 1.0, 0.1];
const MOMENTS: [f64; 3] = [2.0, 3.0, 4.0];

type State = StateOf<RigidBody>;
/// The states of a motion, the bias and the readings.
type Motions = (Vec<State>, Vector3<f64>, Vec<Reading>);
type Nine = SVector<f64, 9>;
type Square = SMatrix<f64, 9, 9>;

/// A gyroscope's reading, and that of a vector of space in the body frame.
#[derive(Clone, Copy)]
struct Reading([Vector3<f64>; 2]);

/// An estimate of the state and of the bias.
#[derive(Clone, Copy)]
struct Belief {
    state: State,
    bias: Vector3<f64>,
    /// The covariance of displacement, momentum and bias.
    covariance: Square,
}

fn stepper() -> Result<Stepper<RigidBody>, Failure> {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::from(MOMENTS))?;
    Ok(Stepper::new(RigidBody { J_d }, STEP)?)
}

fn inverse_inertia() -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::from(MOMENTS).map(f64::recip))
}

/// The readings without noise. The vector rotates as the Earth's field does along an orbit, but faster: with a constant
/// vector, a rotation about it would be unobservable for a free body.
fn read(motion: &Motion<SO3, ()>, bias: &Vector3<f64>, step: usize) -> Reading {
    let (sin, cos) = (0.1 * STEP * step as f64).sin_cos();
    let seen = motion.attitude().as_matrix().transpose() * Vector3::new(cos, 0.0, sin);
    Reading([inverse_inertia() * motion.momentum() + bias, seen])
}

/// A motion and its readings.
fn motion(seed: u64) -> Result<Motions, Failure> {
    let (stepper, mut random) = (stepper()?, Random::new(seed));
    let mut normal = |size: f64| Vector3::from_fn(|_, _| size * random.normal());
    let start = UnitQuaternion::from_scaled_axis(normal(START[0]));
    let mut states = vec![stepper.start_with_momentum(start, Vector3::new(0.8, 1.2, -1.0) + normal(START[1]))?];
    let bias = normal(START[2]);
    let mut readings = Vec::new();
    for k in 0..=STEPS {
        let Reading([rate, vector]) = read(&states[k], &bias, k);
        readings.push(Reading([rate + normal(GYROSCOPE), vector + normal(VECTOR)]));
        let mut next = states[k];
        stepper.step_forced(&mut next, &normal(TORQUE))?;
        states.push(next);
    }
    Ok((states, bias, readings))
}

impl Belief {
    fn first() -> Result<Self, Failure> {
        let state = stepper()?.start_with_momentum(SO3::identity(), Vector3::new(0.8, 1.2, -1.0))?;
        let variances = Nine::from_fn(|k, _| START[k / 3].powi(2));
        Ok(Self { state, bias: Vector3::zeros(), covariance: Square::from_diagonal(&variances) })
    }

    /// The estimate displaced by these numbers.
    fn moved(&self, by: &Nine) -> Result<Self, Failure> {
        let part = |first: usize| by.fixed_rows::<3>(first).into_owned();
        let turned: SO3 = UnitQuaternion::from_scaled_axis(part(0)).into();
        let attitude = self.state.attitude().compose(&turned);
        let state = stepper()?.start_with_momentum(attitude, self.state.momentum() + part(3))?;
        Ok(Self { state, bias: self.bias + part(6), ..*self })
    }

    /// The difference from another estimate: the turn in the body's axes, the momentum and the bias.
    fn off_from(&self, other: &Self) -> Nine {
        let [from, to] = [other, self].map(|belief| UnitQuaternion::from(belief.state.attitude()));
        let parts = [
            (from.inverse() * to).scaled_axis(),
            self.state.momentum() - other.state.momentum(),
            self.bias - other.bias,
        ];
        Nine::from_iterator(parts.iter().flatten().copied())
    }

    /// The estimate after a reading, linearised about this motion and bias.
    fn updated(&self, (step, reading): (usize, &Reading), about: &Self) -> Result<Self, Failure> {
        let off = self.off_from(about);
        let Reading([rate, vector]) = read(&about.state, &about.bias, step);
        let mut slope = SMatrix::<f64, 6, 9>::zeros();
        slope.fixed_view_mut::<3, 3>(0, 3).copy_from(&inverse_inertia());
        slope.fixed_view_mut::<3, 3>(0, 6).fill_with_identity();
        slope.fixed_view_mut::<3, 3>(3, 0).copy_from(&vector.cross_matrix());
        let mut left = SVector::<f64, 6>::zeros();
        left.fixed_rows_mut::<3>(0).copy_from(&(reading.0[0] - rate));
        left.fixed_rows_mut::<3>(3).copy_from(&(reading.0[1] - vector));
        let noise = SVector::<f64, 6>::from_fn(|k, _| if k < 3 { GYROSCOPE.powi(2) } else { VECTOR.powi(2) });
        let spread = slope * self.covariance * slope.transpose() + SMatrix::<f64, 6, 6>::from_diagonal(&noise);
        let gain = self.covariance * slope.transpose() * spread.try_inverse().ok_or("no gain")?;
        let covariance = (Square::identity() - gain * slope) * self.covariance;
        let covariance = (covariance + covariance.transpose()) * 0.5;
        Self { covariance, ..*about }.moved(&(off + gain * (left - slope * off)))
    }

    /// The estimate after a step, linearised about this motion and torque.
    fn stepped(&self, about: &Self, torque: &Vector3<f64>) -> Result<Self, Failure> {
        let (stepper, mut end) = (stepper()?, about.state);
        let transition = stepper.linearised()?.transition(&mut end, &Input::Force(*torque))?;
        let [[a, b], [c, d]] = transition.blocks();
        let mut by_state = Square::identity();
        for (place, block) in [((0, 0), a), ((0, 3), b), ((3, 0), c), ((3, 3), d)] {
            by_state.fixed_view_mut::<3, 3>(place.0, place.1).copy_from(&block);
        }
        let mut by_torque = SMatrix::<f64, 9, 3>::zeros();
        for (k, (turn, momentum)) in transition.by_input.iter().enumerate() {
            by_torque.fixed_view_mut::<3, 1>(0, k).copy_from(turn);
            by_torque.fixed_view_mut::<3, 1>(3, k).copy_from(momentum);
        }
        let covariance =
            by_state * self.covariance * by_state.transpose() + by_torque * by_torque.transpose() * TORQUE.powi(2);
        let off = self.off_from(about);
        let later = Self { state: end, bias: about.bias, covariance };
        later.moved(&(by_state * off - by_torque * torque))
    }

    /// The errors of the estimate: rad, and rad/s.
    fn errors(&self, state: &State, bias: &Vector3<f64>) -> [f64; 2] {
        let [found, right] = [self.state.attitude(), state.attitude()].map(UnitQuaternion::from);
        [found.angle_to(&right), (self.bias - bias).norm()]
    }
}

/// The multiplicative extended Kalman filter: each reading and each step is linearised about the current estimate.
fn filtered(readings: &[Reading]) -> Result<Vec<Belief>, Failure> {
    let (mut belief, mut all) = (Belief::first()?, Vec::new());
    for reading in readings.iter().enumerate() {
        let now = belief.updated(reading, &belief)?;
        all.push(now);
        belief = now.stepped(&now, &Vector3::zeros())?;
    }
    Ok(all)
}

/// The estimates of a moving horizon: the prior of its first state is linearised about the estimate at that time.
fn of_horizon(readings: &[Reading]) -> Result<Vec<Belief>, Failure> {
    let (stepper, mut known, mut first, mut all) = (stepper()?, Belief::first()?, 0, Vec::new());
    for last in 1..readings.len() {
        let information = known.covariance.try_inverse().ok_or("no information")?;
        let off = |step: usize, motion: &Motion<SO3, ()>, bias: &[f64]| {
            let Reading([rate, vector]) = read(motion, &Vector3::from_column_slice(bias), first + step);
            let Reading(was) = readings[first + step];
            let off = [(rate - was[0]) / GYROSCOPE, (vector - was[1]) / VECTOR];
            off.iter().flatten().copied().collect()
        };
        let fit = Estimate::new(&stepper, known.state, last - first, off)
            .unknowns(known.bias.as_slice().to_vec(), vec![0.1; 3])
            .inputs(Input::Force(Vector3::zeros()), vec![0, 1, 2], vec![TORQUE; 3])
            .known(DMatrix::from_column_slice(9, 9, information.as_slice()))
            .until(1e-2, 50)
            .solve()?;
        if fit.verdict != Verdict::Converged {
            return Err(format!("step {last}: {:?} {:e} {}", fit.verdict, fit.step, fit.squares).into());
        }
        let bias = Vector3::from_column_slice(&fit.constants);
        let then = |state: State| Belief { state, bias, ..known };
        if last == 1 {
            all.push(then(fit.states[0]));
        }
        all.push(then(fit.states[last - first]));
        if last - first == HORIZON {
            let about = then(fit.states[0]);
            let Input::Force(torque) = fit.inputs[0] else { return Err("no torque".into()) };
            known = known.updated((first, &readings[first]), &about)?.stepped(&about, &torque)?;
            first += 1;
        }
    }
    Ok(all)
}

/// The root mean squares of the errors over some seeds, after each number of steps: filter and horizon, each with
/// attitude, rad, and bias, rad/s.
fn compared(seeds: u64) -> Result<Vec<[[f64; 2]; 2]>, Failure> {
    let mut squares = vec![[[0.0; 2]; 2]; STEPS + 1];
    for seed in 1..=seeds {
        let (states, bias, readings) = motion(seed)?;
        for (way, beliefs) in [filtered(&readings)?, of_horizon(&readings)?].iter().enumerate() {
            for (k, belief) in beliefs.iter().enumerate() {
                let errors = belief.errors(&states[k], &bias);
                (0..2).for_each(|what| squares[k][way][what] += errors[what].powi(2) / seeds as f64);
            }
        }
    }
    Ok(squares.into_iter().map(|ways| ways.map(|whats| whats.map(f64::sqrt))).collect())
}

/// The table and the picture.
pub(crate) fn horizon() -> Drawing {
    let seeds = 20;
    let errors = compared(seeds)?;
    let mut report = format!("root of the mean square over {seeds} seeds\n");
    writeln!(report, "{:>8}{:>24}{:>24}", "", "attitude, degrees", "bias, 1e-3 rad/s")?;
    writeln!(report, "{:>8}{:>12}{:>12}{:>12}{:>12}", "time, s", "filter", "horizon", "filter", "horizon")?;
    for k in [5, 10, 20, 50, 100, 200] {
        let [filter, horizon] = errors[k];
        let [a, b] = [filter, horizon].map(|errors| errors[0].to_degrees());
        let [c, d] = [filter, horizon].map(|errors| 1e3 * errors[1]);
        writeln!(report, "{:>8.1}{a:>12.2}{b:>12.2}{c:>12.2}{d:>12.2}", k as f64 * STEP)?;
    }
    let lines = |what: usize, unit: f64| -> Vec<Line> {
        let of = |way: usize, colour| {
            let points = errors.iter().enumerate().map(|(k, errors)| (k as f64 * STEP, unit * errors[way][what]));
            Line { colour, width: 3, points: points.collect() }
        };
        vec![of(0, VERMILION), of(1, BLUE)]
    };
    let names = [("filter", VERMILION), ("horizon", BLUE)];
    let (degrees, bias) = (lines(0, 1.0_f64.to_degrees()), lines(1, 1.0));
    let parts = [
        Part::Lines(Panel::over_time("Error of the attitude", "degrees", Vertical::Logarithmic, degrees), &names),
        Part::Lines(Panel::over_time("Error of the bias", "rad/s", Vertical::Logarithmic, bias), &names),
    ];
    let below = "a gyroscope with a bias and one vector, ten times a second; root of the mean square over 20 seeds";
    let title = "Attitude and bias of a body by the last two seconds, and by a Kalman filter";
    Ok((report, picture(title, below, &parts)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The filter is linearised about a wrong state when the first readings arrive, so the horizon is more accurate
    /// from then on.
    #[test]
    fn the_horizon_is_nearer() {
        let errors = compared(6).expect("estimates");
        for [filter, horizon] in [errors[50], errors[STEPS]] {
            assert!(horizon[0] < 0.7 * filter[0] && horizon[1] < 0.7 * filter[1], "{filter:?}, {horizon:?}");
        }
    }
}
