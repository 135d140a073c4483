//! The step with a Newton iteration of adjustable tolerance, and the effect of the tolerance.
//!
//! The library's own iteration ends at rounding and has no such option; here the equations derived by the macro are
//! solved by a loop of a few lines.

use liestep::groups::{Advected, LieGroup as _, Retraction as _};
use liestep::mechanics::{DiscreteLagrangian, Effect, inertia};
use liestep::numbers::Coordinates as _;
use liestep::{SO3, StateOf, StepError, Stepper};
use nalgebra::Vector3;

use crate::tenths::{Tenths, float, greater};

/// The tolerances of the table, as powers of ten.
pub const EXPONENTS: [i32; 8] = [-12, -10, -8, -6, -4, -2, -1, 0];

/// The initial guess of the iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Guess {
    /// The increment of the last step.
    Last,
    /// The linear extrapolation of the last two increments.
    Extrapolated,
}

/// The form of the momentum update.
#[derive(Clone, Copy, PartialEq)]
pub enum Form {
    /// The transport form `μ⁺ = Ad*_F (μ + diamond)`, from the old momentum; (2.9).
    Transport,
    /// The form `μ⁺ = 𝔽l_d⁺(F, w)`, from `F` alone, as printed in (3.18).
    Printed,
}

/// The drifts of a run.
#[derive(Default)]
pub struct Drifts {
    /// The relative drift of the energy's mean, between the first and the last tenth of the run.
    pub energy: f64,
    /// The relative drifts of `p·w` and of `p_3`.
    pub vertical: f64,
    pub axial: f64,
    /// Newton iterations a step.
    pub iterations: f64,
}

/// The limit on iterations; every solvable step converges earlier.
const MOST: u64 = 20;

/// A run of `steps` steps `h` from a momentum and a vertical. An iteration ends after an update below the tolerance,
/// relative to the unknown.
pub fn run<L>(
    lagrangian: &L,
    h: f64,
    (mut momentum, mut w): (Vector3<f64>, Vector3<f64>),
    (guess, tolerance): (Guess, f64),
    form: Form,
    steps: u64,
) -> Drifts
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>>,
{
    let constants = lagrangian.constants(h);
    let (energy_before, vertical, axial) = (energy(lagrangian, &momentum, &w), momentum.dot(&w), momentum.z);
    let mut left = Drifts::default();
    let mut energies = Tenths::new(steps);
    let (mut before, mut last) = (Vector3::zeros(), Vector3::zeros());
    let mut spent = 0;
    for step in 1..=steps {
        let a = momentum + L::kick_before(&constants, &w);
        let terms = L::step_terms(&constants, &a, &w);
        let mut half = if guess == Guess::Extrapolated && step > 2 { last * 2.0 - before } else { last };
        for iteration in 1..=MOST {
            let (residual, jacobian) = L::newton_system(&constants, &terms, &half);
            let update = Vector3::solve(&jacobian, &residual).0;
            half -= update;
            if update.norm() <= tolerance * half.norm() || iteration == MOST {
                spent += iteration;
                break;
            }
        }
        (before, last) = (last, half);
        let increment = L::Retraction::increment_of_half(&half);
        let next = Advected::<SO3>::advect(&w, &increment);
        momentum = match form {
            Form::Transport => {
                let kicks = (a - momentum) + L::kick_after(&constants, &increment, &next);
                momentum + (SO3::adjoint_transpose_increment(&increment, &a) + kicks)
            }
            Form::Printed => lagrangian.legendre_plus(&SO3::from_increment(&increment).matrix(), &w, h),
        };
        w = next;
        energies.after(step, || energy(lagrangian, &momentum, &w) - energy_before);
        left.vertical = greater(left.vertical, (momentum.dot(&w) / vertical - 1.0).abs());
        left.axial = greater(left.axial, (momentum.z / axial - 1.0).abs());
    }
    left.energy = energies.drift() / energy_before.abs();
    left.iterations = float(spent) / float(steps);
    left
}

/// A run of as many of the library's own steps.
pub fn by_the_library<L>(stepper: &Stepper<L>, mut state: StateOf<L>, steps: u64) -> Result<Drifts, StepError>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>>,
{
    let momenta = |state: &StateOf<L>| (state.momentum().dot(&state.advected()), state.momentum().z);
    let (start, (vertical, axial)) = (stepper.energy(&state), momenta(&state));
    let (mut left, mut energies, mut iterations) = (Drifts::default(), Tenths::new(steps), 0);
    for step in 1..=steps {
        iterations += u64::from(stepper.step(&mut state)?.iterations);
        energies.after(step, || stepper.energy(&state) - start);
        let now = momenta(&state);
        left.vertical = greater(left.vertical, (now.0 / vertical - 1.0).abs());
        left.axial = greater(left.axial, (now.1 / axial - 1.0).abs());
    }
    left.energy = energies.drift() / start.abs();
    left.iterations = float(iterations) / float(steps);
    Ok(left)
}

/// The energy of a declared scene at a momentum and a parameter, J: that of its continuous limit without a bias.
fn energy<L: Effect<Scalar = f64, Group = SO3, Advected = Vector3<f64>>>(
    lagrangian: &L,
    momentum: &Vector3<f64>,
    w: &Vector3<f64>,
) -> f64 {
    let rates =
        inertia(lagrangian, &lagrangian.advected()).lu().solve(momentum).unwrap_or_else(|| Vector3::repeat(f64::NAN));
    0.5 * rates.dot(momentum) - lagrangian.limit(None, w).l
}
