//! Plans with known answers, and tasks that have none.

#![allow(clippy::cast_precision_loss)] // small counts

use std::f64::consts::{PI, TAU};

use liestep::effects::{Gravity, RigidBody};
use liestep::gradients::{Input, Plant};
use liestep::groups::{LieGroup as _, SE3};
use liestep::laws::samples::Random;
use liestep::mechanics::{Effect as _, Sum, Term as _};
use liestep::motion::Propagator as _;
use liestep::with::Method;
use liestep::{NonstandardInertia, SO3, StepError, Stepper, force, lagrangian};
use liestep_control::{Control, ControlError, ControlPlan, Cost, Target, Verdict};
use liestep_late::{Declaration, Whole, numbers};
use nalgebra::{Matrix4, SVector, UnitQuaternion, Vector3, Vector4};

mod estimates;
mod kept;
mod whole;

type Body = Stepper<RigidBody>;
/// The cost of the shortest time.
const TIME: Cost = Cost { time: 1.0, effort: 0.0 };

type At = Target<SO3, Vector3<f64>>;

fn body(moments: [f64; 3], h: f64) -> Body {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::from(moments)).expect("a body");
    Stepper::new(RigidBody { J_d }, h).expect("a stepper")
}

fn turned(angles: [f64; 3]) -> SO3 {
    UnitQuaternion::from_scaled_axis(Vector3::from(angles)).into()
}

/// A turn from rest to rest.
fn slew(stepper: &Body, steps: usize, angles: [f64; 3]) -> Control<'_, Body> {
    let start = stepper.start(SO3::identity(), Vector3::zeros()).expect("a start");
    Control::new(stepper, start, steps, Target::rest(turned(angles)))
}

fn torques(plan: &ControlPlan<Body>) -> Vec<Vector3<f64>> {
    let torque = |input: &Input<Vector3<f64>, ()>| match input {
        Input::Force(torque) => *torque,
        _ => panic!("a force was chosen, not {input:?}"),
    };
    plan.inputs.iter().map(torque).collect()
}

/// The least effort is `½∫u² dt = 6 J² θ²/T³`, to second order in the step.
#[test]
fn the_least_effort_of_a_turn_about_one_axis() {
    let exact = 6.0 * 9.0 * 1.2 * 1.2 / 8.0;
    let error = |steps: u32| {
        let stepper = body([2.0, 3.0, 4.0], 2.0 / f64::from(steps));
        let plan = slew(&stepper, steps as usize, [0.0, 1.2, 0.0]).solve().expect("a task");
        assert_eq!(plan.verdict, Verdict::Converged);
        plan.cost / exact - 1.0
    };
    let errors = [25, 50, 100, 200].map(error);
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1] - 4.0).abs() < 0.02, "{errors:?}");
    }
    assert!(errors[3].abs() < 1e-4, "{errors:?}");
}

/// The multipliers are the derivatives of the least cost by the target, as found from plans to neighbouring targets.
#[test]
fn multipliers_are_the_price_of_the_target() {
    let stepper = body([1.0, 2.0, 2.5], 0.05);
    let start = stepper.start(turned([0.3, 0.0, 0.2]), Vector3::new(0.2, -0.1, 0.4)).expect("a start");
    let cost = |target: At| {
        let plan = Control::new(&stepper, start, 40, target).solve().expect("a task");
        assert_eq!(plan.verdict, Verdict::Converged);
        plan
    };
    let (end, momentum) = (turned([0.9, -0.8, 0.4]), Vector3::new(0.1, 0.5, -0.2));
    let plan = cost(Target { attitude: Some(end), momentum: Some(momentum) });
    for k in 0..6 {
        let beside = |by: f64| {
            let axis = Vector3::from_fn(|i, _| if i == k % 3 { by } else { 0.0 });
            if k < 3 {
                let end = end.compose(&turned(axis.into()));
                cost(Target { attitude: Some(end), momentum: Some(momentum) }).cost
            } else {
                cost(Target { attitude: Some(end), momentum: Some(momentum + axis) }).cost
            }
        };
        let slope = (beside(1e-4) - beside(-1e-4)) / 2e-4;
        // A multiplier is minus the derivative of the least cost.
        let found = -plan.multipliers[k];
        assert!((found - slope).abs() < 1e-6 * (1.0 + slope.abs()), "{k}: {found}, not {slope}");
    }
}

/// The optimum precesses, as Bilimoria and Wie found in 1993; about the axis itself it takes `2√π = 3.5449`.
#[test]
fn the_shortest_half_turn_of_a_sphere() {
    let stepper = body([1.0; 3], 3.5 / 200.0);
    let plan = half_turn(&stepper, 200).solve().expect("a task");
    assert_eq!(plan.verdict, Verdict::Converged, "{:?}", plan.residual);
    assert!(plan.duration <= 3.2435, "{}", plan.duration);
    // A discrete plan is no faster than the continuous optimum, up to the error of the step.
    assert!(plan.duration > 3.2425, "{}", plan.duration);
    assert!(torques(&plan).iter().all(|torque| torque.amax() <= 1.0));
}

/// A half turn whose guessed torque goes round once: on the way about the eigenaxis the gradient vanishes by symmetry.
fn half_turn(stepper: &Body, steps: usize) -> Control<'_, Body> {
    let guess = move |step, axis| {
        let share = step as f64 / steps as f64;
        match axis {
            0 => 0.5 * (TAU * (share - 0.1)).cos(),
            1 => 0.5 * (TAU * (share - 0.4)).cos(),
            _ if 2 * step < steps => 0.9,
            _ => -0.9,
        }
    };
    slew(stepper, steps, [0.0, 0.0, PI]).bounds(|_, _| (-1.0, 1.0)).minimise(TIME).guess(guess)
}

/// Random first guesses on either side all lead to a plan, and nearly all to the shortest.
#[test]
fn half_turns_from_many_starts() {
    let stepper = body([1.0; 3], 3.5 / 40.0);
    let mut shortest = 0;
    for seed in 0..12 {
        let mut random = Random::new(seed);
        let aside: [Vector3<f64>; 3] = [random.sample(), random.sample(), random.sample()];
        let spin = |step| if step < 20 { 0.9 } else { -0.9 };
        let guess = move |step: usize, axis| if axis == 2 { spin(step) } else { 0.5 * aside[3 * step / 40][axis] };
        let plan = half_turn(&stepper, 40).guess(guess).solve().expect("a task");
        assert_eq!(plan.verdict, Verdict::Converged, "{seed}: {:?}", plan.residual);
        shortest += usize::from((plan.duration - 3.240_685_638_585).abs() < 1e-9);
    }
    assert!(shortest >= 10, "{shortest}");
}

/// An arc without inputs conserves the momentum in space to rounding.
#[test]
fn an_arc_without_inputs_keeps_the_momentum() {
    let stepper = body([1.0, 2.0, 2.5], 0.02);
    let coasts = |step: usize| (30..90).contains(&step);
    let bounds = |step, _| if coasts(step) { (0.0, 0.0) } else { (-4.0, 4.0) };
    let plan = slew(&stepper, 120, [0.9, -0.7, 1.1]).bounds(bounds).solve().expect("a task");
    assert_eq!(plan.verdict, Verdict::Converged, "{:?}", plan.residual);
    let momentum = |k: usize| plan.stepper.spatial_momentum(&plan.states[k]);
    assert!(momentum(30).norm() > 0.1);
    for k in 30..=90 {
        assert!((momentum(k) - momentum(30)).norm() < 1e-13, "{k}");
    }
    assert!(torques(&plan)[30..90].iter().all(|torque| *torque == Vector3::zeros()));
    assert!(torques(&plan).iter().all(|torque| torque.amax() <= 4.0));
}

/// Random bodies turn to random attitudes.
#[test]
fn random_slews_converge() {
    let mut random = Random::new(7);
    let mut most = 0;
    for number in 0..100 {
        let sides: Vector3<f64> = random.sample::<Vector3<f64>>().map(|side| 1.0 + 0.8 * side);
        let squares = sides.component_mul(&sides);
        let moments = [squares.y + squares.z, squares.z + squares.x, squares.x + squares.y];
        let angles: Vector3<f64> = random.sample::<Vector3<f64>>() * 1.7;
        let stepper = body(moments, 0.05);
        let plan = slew(&stepper, 40, angles.into()).solve().expect("a task");
        assert_eq!(plan.verdict, Verdict::Converged, "{number}: {moments:?}, {angles:?}, {:?}", plan.residual);
        assert!(plan.residual.largest() <= 1e-10);
        let last = plan.states.last().expect("states");
        assert!((last.attitude().matrix() - turned(angles.into()).matrix()).amax() < 1e-9);
        assert!(plan.iterations <= 15, "{number}: {} iterations for {moments:?}, {angles:?}", plan.iterations);
        most = most.max(plan.iterations);
    }
    assert!(most > 2, "the tasks are too easy");
}

/// The digits of a plan double in each iteration near it, which takes right second derivatives: those of steps between
/// moving ends, by a torque and by a free duration.
#[test]
fn near_a_plan_the_digits_double() {
    let residuals = |task: Control<'_, Body>| {
        let shown = std::cell::RefCell::new(Vec::new());
        let note = |_: usize, residual: &liestep_control::Residual| {
            shown.borrow_mut().push(residual.largest());
            true
        };
        let plan = task.progress(note).solve().expect("a task");
        assert_eq!(plan.verdict, Verdict::Converged, "{:?}", plan.residual);
        shown.into_inner()
    };
    let stepper = body([1.0, 2.0, 2.5], 0.1);
    let start = stepper.start(turned([0.3, -0.2, 0.5]), Vector3::new(1.0, -0.8, 0.6)).expect("a start");
    let target = At { attitude: Some(turned([-0.9, 1.1, 0.4])), momentum: Some(Vector3::new(-0.5, 0.9, 1.2)) };
    let task = || Control::new(&stepper, start, 20, target);
    let free = task().minimise(Cost { time: 5.0, effort: 1.0 });
    for (name, task) in [("torque", task()), ("duration", free)] {
        let residuals = residuals(task);
        let near = residuals.windows(2).filter(|pair| pair[0] < 1e-2 && pair[0] > 1e-5);
        let mut count = 0;
        for pair in near {
            count += 1;
            assert!(pair[1] < 1e-10 + 30.0 * pair[0] * pair[0], "{name}: {residuals:?}");
        }
        assert!(count > 0, "{name}: {residuals:?}");
    }
}

/// A half turn has two ways of equal cost: each is found from a guess on its side.
#[test]
fn both_ways_of_a_half_turn() {
    let stepper = body([2.0, 3.0, 4.0], 0.02);
    let plans = [1.0, -1.0].map(|side| {
        let towards = move |step, axis| if axis == 2 { side * if step < 50 { 10.0 } else { -10.0 } } else { 0.0 };
        let plan = slew(&stepper, 100, [0.0, 0.0, PI]).guess(towards).solve().expect("a task");
        assert_eq!(plan.verdict, Verdict::Converged);
        (plan.cost, torques(&plan)[0].z)
    });
    assert!((plans[0].0 - plans[1].0).abs() < 1e-8 * plans[0].0, "{plans:?}");
    assert!(plans[0].1 > 1.0 && plans[1].1 < -1.0, "{plans:?}");
}

/// A torque of at most `u` turns a body by at most `u T²/4J` about an axis, from rest to rest.
#[test]
fn bounds_that_are_too_tight_have_a_certificate() {
    let stepper = body([2.0; 3], 0.02);
    let task =
        |bound: f64| slew(&stepper, 50, [0.6, 0.0, 0.0]).bounds(move |_, _| (-bound, bound)).solve().expect("a task");
    let plan = task(4.0);
    let Verdict::Infeasible { ref direction, gap } = plan.verdict else {
        panic!("{:?}, {:?} after {}", plan.verdict, plan.residual, plan.iterations)
    };
    assert!(gap > 0.01, "{gap}");
    let size: f64 = direction.iter().map(|entry| entry * entry).sum();
    assert!((size - 1.0).abs() < 1e-12);
    assert!(torques(&plan).iter().all(|torque| torque.iter().all(|entry| entry.is_finite() && entry.abs() <= 4.0)));
    // A plan exists on the other side of the limit 4 J θ/T² = 4.8.
    assert_eq!(task(4.9).verdict, Verdict::Converged);
}

#[test]
fn a_start_that_is_the_end_needs_nothing() {
    let stepper = body([1.0, 2.0, 2.5], 0.1);
    let plan = slew(&stepper, 20, [0.0; 3]).solve().expect("a task");
    assert_eq!((plan.verdict, plan.iterations, plan.cost), (Verdict::Converged, 0, 0.0));
    let bounded = slew(&stepper, 20, [0.0; 3]).bounds(|_, _| (-1.0, 1.0)).solve().expect("a task");
    assert_eq!(bounded.verdict, Verdict::Converged);
    assert!(bounded.cost < 1e-9);
}

/// One step has three inputs for three conditions, and there is one plan.
#[test]
fn one_step() {
    let stepper = body([1.0, 2.0, 2.5], 0.5);
    let start = stepper.start(SO3::identity(), Vector3::zeros()).expect("a start");
    let momentum = Vector3::new(0.2, 0.1, -0.3);
    let plan =
        Control::new(&stepper, start, 1, Target { attitude: None, momentum: Some(momentum) }).solve().expect("a task");
    assert_eq!(plan.verdict, Verdict::Converged);
    assert!((plan.states[1].momentum() - momentum).norm() < 1e-10);
    // Three inputs can't meet six conditions.
    let plan = slew(&stepper, 1, [0.3, 0.2, 0.1]).solve().expect("a task");
    assert!(!matches!(plan.verdict, Verdict::Converged), "{:?}", plan.verdict);
}

/// A failing step is an error in the first guess; later the search goes round it.
#[test]
fn steps_that_cannot_be_made() {
    let stepper = body([1.0, 2.0, 2.5], 0.5);
    let refused = slew(&stepper, 10, [1.0, 0.0, 0.0]).guess(|_, _| 100.0).solve();
    let Err(ControlError::Step(0, StepError::BeyondSolvable { .. })) = refused else {
        panic!("{:?}", refused.map(|plan| plan.verdict));
    };
    // Half a turn in five steps is near the largest step.
    let plan = slew(&body([1.0, 2.0, 2.5], 0.2), 5, [3.0, 0.0, 0.0]).solve().expect("a task");
    assert!(plan.inputs.iter().flat_map(Input::scalars).all(f64::is_finite));
    assert!(matches!(plan.verdict, Verdict::Converged | Verdict::Stalled(_)), "{:?}", plan.verdict);
}

#[test]
fn tasks_that_are_none() {
    let stepper = body([1.0, 2.0, 2.5], 0.1);
    let task = || slew(&stepper, 3, [0.1; 3]);
    let error = |task: Control<'_, _>| task.solve().err();
    let unusable = |what| Some(ControlError::Unusable(what));
    let force = Input::Force(Vector3::zeros());
    assert_eq!(error(task().bounds(|_, axis| if axis == 1 { (1.0, 0.0) } else { (0.0, 1.0) })), unusable("bounds"));
    assert_eq!(error(task().bounds(|_, _| (f64::NAN, 1.0))), unusable("bounds"));
    assert_eq!(error(task().input(force, [3])), unusable("input"));
    assert_eq!(error(task().input(force, [])), unusable("input"));
    assert_eq!(error(task().input(force, [1, 1])), unusable("input"));
    assert_eq!(error(slew(&stepper, 0, [0.1; 3])), unusable("input"));
    assert_eq!(error(task().minimise(Cost { time: 1.0, effort: -1.0 })), unusable("cost"));
    assert_eq!(error(task().guess(|_, _| f64::NAN)), unusable("first guess"));
    let start = stepper.start(SO3::identity(), Vector3::zeros()).expect("a start");
    let nowhere = Target { attitude: None, momentum: Some(Vector3::repeat(f64::NAN)) };
    assert_eq!(error(Control::new(&stepper, start, 3, nowhere)), unusable("target"));
}

/// The search reports its iterations, and stops on request.
#[test]
fn progress() {
    let stepper = body([1.0, 2.0, 2.5], 0.1);
    let shown = std::cell::Cell::new(0);
    let task = slew(&stepper, 20, [1.0, 0.5, 0.2]).progress(|iteration, _| {
        shown.set(shown.get() + 1);
        iteration < 2
    });
    assert_eq!((task.solve().expect("a task").verdict, shown.get()), (Verdict::Cancelled, 3));
    let short = slew(&stepper, 20, [1.0, 0.5, 0.2]).until(1e-10, 1);
    assert_eq!(short.solve().expect("a task").verdict, Verdict::Exhausted);
}

/// The least cost of a turn to this target.
fn cost<P: Plant>(stepper: &P, start: P::State, target: Target<P::Attitude, P::Vector>) -> f64 {
    let plan = Control::new(stepper, start, 20, target).bounds(|_, _| (-4.0, 4.0)).solve().expect("a task");
    assert_eq!(plan.verdict, Verdict::Converged, "{:?}", plan.residual);
    plan.cost
}

/// A heavy top that is declared by a text has the plan of the compiled one, and that of Python.
#[test]
fn a_text_is_planned_as_what_is_compiled() {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 1.4, 2.0)).expect("a body");
    let top = RigidBody { J_d } + Gravity { m: 0.5, g: 2.0, rho: Vector3::new(0.1, 0.0, 0.3), up: Vector3::z() };
    let terms =
        [RigidBody::<f64>::DECLARATION, Gravity::<f64>::DECLARATION].map(Declaration::parse).map(Result::unwrap);
    let declaration = Declaration::sum(&terms).expect("a sum");
    let values = declaration.described(&numbers(&top)).expect("numbers");
    let whole: Whole = Whole::of(declaration, &values, 0.1, Method::default()).expect("a stepper");
    let stepper = Stepper::new(top, 0.1).expect("a stepper");
    let (attitude, end) = (turned([0.4, 0.0, 0.0]), SO3::from_euler_angles(0.3, 1.5, 0.2));
    let rows = |attitude: SO3| attitude.as_matrix().transpose().as_slice().to_vec();
    let at_rest = Target { attitude: Some(rows(end)), momentum: Some(vec![0.0; 3]) };
    let costs = [
        cost(&stepper, stepper.start(attitude, Vector3::zeros()).expect("a start"), Target::rest(end)),
        cost(&whole, whole.start(&rows(attitude), &[0.0; 3]).expect("a start"), at_rest),
    ];
    assert!(costs.iter().all(|cost| (cost / 1.473_736_859_111_866 - 1.0).abs() < 1e-12), "{costs:?}");
}

/// A torque that is an input of a declaration.
#[force(group = SO3, given(u = torque), gradients, work = 0.5 * h * u * (eta + eta_next)[2])]
#[derive(Clone, Copy, Debug)]
struct Wheel {
    torque: f64,
}

/// The least effort from rest to a spin `J_3 ω` by a declared torque is that of a constant one, `½ (J_3 ω)²/T`.
#[test]
fn what_a_step_is_given_is_chosen() {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.0)).expect("a body");
    let scene: Sum<RigidBody, Wheel> = RigidBody { J_d } + Wheel { torque: 0.0 };
    let stepper = Stepper::new(scene, 0.1).expect("a stepper");
    let start = stepper.start(SO3::identity(), Vector3::zeros()).expect("a start");
    let like = Input::Values(stepper.scene().advected());
    let target = Target { attitude: None, momentum: Some(Vector3::new(0.0, 0.0, 1.5)) };
    let task = Control::new(&stepper, start, 20, target).input(like, [0]);
    // The other two components of the momentum are always zero, so that conditions on them have no effect.
    let plan = task.solve().expect("a task");
    assert!(plan.states.iter().all(|state| state.momentum().x == 0.0));
    assert_eq!(plan.verdict, Verdict::Converged, "{:?}", plan.residual);
    assert!((plan.cost - 0.5 * 1.5 * 1.5 / 2.0).abs() < 1e-9, "{}", plan.cost);
    let Input::Values(((), given)) = plan.inputs[7] else { panic!("values were chosen") };
    assert!((given.0[0] - 0.75).abs() < 1e-9, "{given:?}");
}

/// A rigid body with a position.
#[lagrangian(group = SE3, gradients, l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Copy, Debug)]
struct Flyer {
    J: Matrix4<f64>,
}

/// The cost of a straight flight is `½∫f² = 6 m² L²/T³`; a turn adds to it.
#[test]
fn a_body_flies() {
    let J = Matrix4::from_diagonal(&Vector4::new(2.0, 1.5, 1.0, 3.0));
    let stepper = Stepper::new(Flyer { J }, 0.02).expect("a stepper");
    let start = stepper.start(SE3::identity(), SVector::<f64, 6>::zeros()).expect("a start");
    let cost = |angles: Vector3<f64>, place: Vector3<f64>| {
        let end = SE3::from_rotation_and_translation(UnitQuaternion::from_scaled_axis(angles), place);
        let plan = Control::new(&stepper, start, 100, Target::rest(end)).solve().expect("a task");
        assert_eq!(plan.verdict, Verdict::Converged, "{:?}", plan.residual);
        let last = plan.states.last().expect("states").attitude();
        assert!((last.matrix() - end.matrix()).amax() < 1e-9);
        plan.cost
    };
    let straight = cost(Vector3::zeros(), Vector3::new(0.0, 1.5, 0.0));
    assert!((straight / (6.0 * 9.0 * 2.25 / 8.0) - 1.0).abs() < 2e-4, "{straight}");
    assert!(cost(Vector3::new(0.8, -0.5, 1.0), Vector3::new(0.5, 1.5, -1.0)) > straight);
}
