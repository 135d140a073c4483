//! Orders, measured at motions of `tests/data`.

use declarations::Motion;
use liestep::mechanics::Regular;
use liestep::motion::Plan;
use liestep::{SO3, StateOf, Stepper};
use liestep_refinement::Refinement;
use nalgebra::{Matrix3, Vector3};
use workbench::measure::{relative, steps_in};

/// The tops whose equations are nonlinear in every variable: three of the thesis, and one without any symmetry.
pub const TOPS: [&str; 4] = ["looping A", "cuspidal B", "third A", "chaotic"];

/// The plateau: errors of attitude and velocity above the rounding of some thousand stages.
const PLATEAU: f64 = 2e-13;

/// The end of a motion: attitude and body velocity.
pub type End = (SO3, Vector3<f64>);

/// The state after a number of steps.
pub fn run<S, P>(stepper: &Stepper<S, P>, mut state: StateOf<S, P>, steps: u32) -> StateOf<S, P>
where
    S: Regular<Scalar = f64, Group = SO3>,
    P: Plan<S>,
{
    stepper.run(&mut state, steps.into()).unwrap();
    state
}

/// The end of a motion after a number of steps.
pub fn end<S, P>(stepper: &Stepper<S, P>, motion: &Motion, steps: u32) -> End
where
    S: Regular<Scalar = f64, Group = SO3>,
    P: Plan<S>,
{
    let state = run(stepper, stepper.start(motion.attitude, motion.velocity).unwrap(), steps);
    (state.attitude(), stepper.velocity(&state))
}

/// The error of attitude and body velocity together, relative to the sizes of both.
pub fn error(end: &End, (attitude, velocity): &(Matrix3<f64>, Vector3<f64>)) -> f64 {
    relative(end.0.as_matrix(), attitude).hypot(relative(&end.1, velocity))
}

/// The order of a method from its errors at the time `t` after these numbers of steps.
///
/// `run` makes that number of steps of a length and returns their end.
pub fn measured(name: &str, (motion, t): (&str, f64), counts: &[u32], run: impl Fn(&Motion, f64, u32) -> End) -> f64 {
    let read = Motion::read(motion);
    let reference = read.at(t);
    let errors = Refinement::of(counts.iter().map(|&steps| {
        let h = t / f64::from(steps);
        (h, error(&run(&read, h, steps), &reference))
    }));
    let order = errors.order_above(PLATEAU).expect(name);
    println!("{name}, {motion}: order {order:.3}\n{errors}");
    order
}

/// Asserts the order of a method.
pub fn assert_order(
    (name, expected): (&str, u32),
    (motion, t): (&str, f64),
    counts: &[u32],
    run: impl Fn(&Motion, f64, u32) -> End,
) {
    let order = measured(name, (motion, t), counts, run);
    assert!((order - f64::from(expected)).abs() < 0.1, "{name}, {motion}: order {order}");
}

/// Asserts the order of a scene's own step, for a coarsest step and its halvings.
pub fn assert_own_order<L: Regular<Scalar = f64, Group = SO3>>(
    motion: &str,
    expected: u32,
    (t, coarsest): (f64, f64),
    lagrangian: impl Fn(&Motion) -> L,
) {
    #[allow(clippy::cast_possible_truncation)] // some hundreds
    let counts = [1, 2, 4, 8, 16].map(|times| times * steps_in(t, coarsest) as u32);
    assert_order(("its own step", expected), (motion, t), &counts, |motion, h, steps| {
        end(&Stepper::new(lagrangian(motion), h).unwrap(), motion, steps)
    });
}

/// A list of `count` numbers of steps, each about `ratio` times the one before.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small positive numbers
pub fn counts(first: u32, ratio: f64, count: i32) -> Vec<u32> {
    (0..count).map(|k| (f64::from(first) * ratio.powi(k)).round() as u32).collect()
}
