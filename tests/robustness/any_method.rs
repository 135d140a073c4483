//! All functions around a step work with every method: the table of methods and additions, one by one.
//!
//! Combinations without a meaning don't compile: `tests/ui/fail/calls.rs`.

use checks::random::Random;
use declarations::{HeavyTop, Motion};
use liestep::groups::Advected;
use liestep::mechanics::{DiscreteLagrangian, Effect, Term};
use liestep::methods::{CompositionScheme, ExactBody, ProcessedScheme, SplittingScheme, SymmetricBody};
use liestep::motion::{GroupStepper, Integrator as _, Plan, Remedy, StepReport};
use liestep::prelude::*;
use liestep::recording::{Recorder, Table};
use liestep::with::{Checkpoint, CheckpointError, Compensable};
use nalgebra::{UnitQuaternion, Vector3};
use workbench::measure::relative;

/// The state of a stepper.
type State<S, P> = liestep::State<SO3, <S as Term>::Advected, <P as Plan<S>>::Kept>;

fn attitude() -> SO3 {
    UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.1, -0.3)).into()
}

const VELOCITY: Vector3<f64> = Vector3::new(0.5, 2.0, 3.0);

fn started<S, P>(stepper: &Stepper<S, P>) -> State<S, P>
where
    S: Effect<Scalar = f64, Group = SO3>,
    P: Plan<S>,
{
    stepper.start(attitude(), VELOCITY).unwrap()
}

/// One compiled copy of a step for all assertions, which are most of this file's code.
#[inline(never)]
fn step<S, P>(stepper: &Stepper<S, P>, state: &mut State<S, P>) -> Result<StepReport, StepError>
where
    S: Effect<Scalar = f64, Group = SO3>,
    P: Plan<S>,
{
    stepper.step(state)
}

/// The distance of two motions.
fn apart<S, P, K>(a: &State<S, P>, b: &liestep::State<SO3, S::Advected, K>) -> f64
where
    S: Effect<Scalar = f64, Group = SO3>,
    P: Plan<S>,
{
    relative(&a.momentum(), &b.momentum()).max((a.attitude().as_matrix() - b.attitude().as_matrix()).norm())
}

/// Checks that `run`, `steps` and `step` make the same steps, that a copy has identical bits, and that time is counted.
fn assert_runs<S, P>(name: &str, stepper: &Stepper<S, P>)
where
    S: Effect<Scalar = f64, Group = SO3>,
    P: Plan<S>,
{
    let start = started(stepper);
    let (mut stepped, mut run) = (start, start);
    for _ in 0..20 {
        step(stepper, &mut stepped).unwrap();
    }
    stepper.run(&mut run, 20).unwrap();
    // Splittings merge the flows at the ends of two steps.
    assert!(apart::<S, P, _>(&stepped, &run) < 1e-9, "{name}: run");
    let last = stepper.steps(start).take(20).last().unwrap().unwrap();
    assert_eq!(format!("{last:?}"), format!("{stepped:?}"), "{name}: steps");
    assert!((stepper.time(&run) - 20.0 * stepper.step_size()).abs() < 1e-15, "{name}: time");
    assert_eq!(run.steps(), 20, "{name}");
}

/// Checks that a force of zero changes nothing, to the bit, and that a torque in space changes the momentum by its
/// impulse.
fn assert_is_forced<S, P>(name: &str, stepper: &Stepper<S, P>)
where
    S: Effect<Scalar = f64, Group = SO3>,
    P: Plan<S>,
{
    let mut plain = started(stepper);
    let mut forced = plain;
    for _ in 0..5 {
        step(stepper, &mut plain).unwrap();
        stepper.step_forced(&mut forced, &Vector3::zeros()).unwrap();
    }
    assert_eq!(format!("{plain:?}"), format!("{forced:?}"), "{name}: no force");
    let before = forced.momentum();
    step(stepper, &mut plain).unwrap();
    let torque = Vector3::new(0.3, -0.2, 0.5);
    stepper.step_forced(&mut forced, &torque).unwrap();
    let impulse = torque * stepper.step_size();
    let gained = forced.momentum() - plain.momentum();
    // The bound is of first order in the step, by which the body turns meanwhile.
    let allowed = 2.0 * impulse.norm() * VELOCITY.norm() * stepper.step_size();
    assert!((gained - impulse).norm() < allowed, "{name}: {gained} for {impulse}, from {before}");
    // The next step starts from the pushed momentum.
    step(stepper, &mut forced).unwrap();
    assert!((forced.momentum() - plain.momentum()).norm() > 0.5 * impulse.norm(), "{name}: the push is lost");
    assert!(matches!(
        stepper.step_forced(&mut forced, &Vector3::from_element(f64::NAN)),
        Err(StepError::NonFinite { .. })
    ));
}

/// Checks that a torque on numbers is that on types, to the bit.
fn assert_is_forced_as_numbers<S, P>(name: &str, stepper: &Stepper<S, P>)
where
    S: Effect<Scalar = f64, Group = SO3> + Clone + 'static,
    P: Plan<S, Kept: 'static> + Clone + 'static,
{
    let (erased, mut typed) = (stepper.clone().into_any(), started(stepper));
    let mut state = erased.start_at(attitude(), VELOCITY).unwrap();
    for torque in [Vector3::new(0.3, -0.2, 0.5), Vector3::new(-1.0, 0.1, 0.0), Vector3::zeros()] {
        stepper.step_forced(&mut typed, &torque).unwrap();
        erased.step_forced(&mut state, torque.as_slice()).unwrap();
        assert_eq!(state.momentum(), typed.momentum().as_slice(), "{name}");
    }
    for wrong in [&[0.0; 2][..], &[0.0; 4], &[f64::NAN; 3]] {
        let before = state.clone();
        assert!(matches!(erased.step_forced(&mut state, wrong), Err(StepError::NonFinite { .. })), "{name}");
        assert_eq!(state, before, "{name}");
    }
}

/// Checks that the step of another method adopts a motion, and back.
fn assert_adopts<S, P>(name: &str, stepper: &Stepper<S, P>)
where
    S: Effect<Scalar = f64, Group = SO3> + Clone + liestep::mechanics::Regular,
    P: Plan<S>,
{
    let other = Stepper::new(stepper.scene().clone(), stepper.step_size()).unwrap();
    let mut state = started(stepper);
    stepper.run(&mut state, 7).unwrap();
    let mut adopted = other.adopt(&state);
    assert_eq!((adopted.attitude(), adopted.momentum()), (state.attitude(), state.momentum()), "{name}");
    step(&other, &mut adopted).unwrap();
    let mut back = stepper.adopt(&adopted);
    step(stepper, &mut back).unwrap();
    step(stepper, &mut state).unwrap();
    step(stepper, &mut state).unwrap();
    assert!(apart::<S, P, _>(&back, &state) < 1e-4, "{name}: adopt");
}

/// Checks that the largest solvable step is the step, and that a step of `−h` undoes it.
fn assert_has_limits_and_an_inverse<S, P>(name: &str, stepper: &Stepper<S, P>)
where
    S: DiscreteLagrangian<Scalar = f64, Group = SO3> + Clone,
    P: Plan<S>,
{
    let start = started(stepper);
    assert_eq!(stepper.max_step(&start).to_bits(), stepper.step_size().to_bits(), "{name}: max_step");
    let back = stepper.inverse().unwrap();
    let mut state = start;
    for _ in 0..10 {
        step(stepper, &mut state).unwrap();
    }
    let mut state = back.adopt(&state);
    for _ in 0..10 {
        step(&back, &mut state).unwrap();
    }
    assert!(apart::<S, P, _>(&start, &state) < 1e-12, "{name}: inverse");
}

/// Checks that a motion saved at random steps continues with identical bits, and that another method refuses the file.
fn assert_is_saved<S, P>(name: &str, stepper: &Stepper<S, P>, own: &mut Vec<Checkpoint<f64>>)
where
    S: Effect<Scalar = f64, Group = SO3>,
    P: Plan<S>,
{
    let mut random = Random::new(11);
    let mut state = started(stepper);
    for _ in 0..4 {
        stepper.run(&mut state, workbench::measure::steps_in(random.signed().abs(), 0.05)).unwrap();
        let text = serde_json::to_string(&stepper.checkpoint(&state)).unwrap();
        let stored: Checkpoint<f64> = serde_json::from_str(&text).unwrap();
        let (mut resumed, mut on) = (stepper.resume(&stored).unwrap(), state);
        for _ in 0..10 {
            assert_eq!(step(stepper, &mut on), step(stepper, &mut resumed), "{name}");
        }
        assert_eq!(format!("{on:?}"), format!("{resumed:?}"), "{name}: resumed");
    }
    for other in own.iter() {
        let refused = stepper.resume(other).unwrap_err();
        assert!(
            matches!(
                refused,
                CheckpointError::AnotherMethod { .. }
                    | CheckpointError::AnotherParameter { .. }
                    | CheckpointError::AnotherScene
            ),
            "{name}: {refused}"
        );
    }
    own.push(stepper.checkpoint(&state));
}

/// Checks that a recorder receives the steps of `run`, to the bit, and that between two steps there is a path from the
/// one to the other in the group, with the vertical momentum conserved.
fn assert_is_observed<A: Advected<SO3>>(name: &str, stepper: &GroupStepper<SO3, A>) {
    let start = stepper.start(attitude(), VELOCITY).unwrap();
    let (mut observed, mut stepped) = (start.clone(), start.clone());
    let mut recorder = Recorder::new(stepper, Table::new());
    let ended = stepper.observed(&mut observed).every(7, |now| recorder.record(now)).until(0.28).unwrap();
    assert_eq!(ended.steps, 28, "{name}");
    let table = recorder.finish().unwrap();
    for row in table.rows() {
        let velocity = stepper.velocity(&stepped);
        let numbers = [stepper.time(&stepped), velocity.x, velocity.y, velocity.z, stepper.energy(&stepped)];
        let recorded = [row[0], row[5], row[6], row[7], row[11]];
        assert_eq!(recorded.map(f64::to_bits), numbers.map(f64::to_bits), "{name}: recorded");
        stepper.run(&mut stepped, 7).unwrap();
    }
    assert_eq!(table.rows().len(), 5, "{name}");

    let mut next = start.clone();
    stepper.step(&mut next).unwrap();
    let at = |fraction| stepper.part(&start, fraction).unwrap();
    let distance = |a: SO3, b: SO3| (a.as_matrix() - b.as_matrix()).norm();
    assert_eq!((at(0.0).attitude(), at(0.0).momentum()), (start.attitude(), start.momentum()), "{name}: at the start");
    assert!(distance(at(1.0).attitude(), next.attitude()) < 1e-14, "{name}: at the end");
    assert!(relative(&at(1.0).momentum(), &next.momentum()) < 1e-13, "{name}: at the end");
    let vertical = start.momentum_along(&Vector3::z());
    for fraction in [-1.0, -0.3, 1e-40, 1e-9, 0.1, 0.5, 0.9] {
        let between = at(fraction);
        assert!(between.orthogonality_defect() < 4e-15, "{name}: at {fraction}");
        assert!((between.momentum_along(&Vector3::z()) - vertical).abs() < 2e-14, "{name}: at {fraction}");
        // The path has the velocity of the motion.
        let turned = distance(between.attitude(), start.attitude()) / std::f64::consts::SQRT_2;
        let expected = VELOCITY.norm() * 0.01 * f64::abs(fraction);
        assert!((turned - expected).abs() < 0.1 * expected + 1e-15, "{name}: turned by {turned} at {fraction}");
    }
    let later = stepper.state_at(&start, 0.107).unwrap();
    stepper.run(&mut next, 9).unwrap();
    let part = stepper.part(&next, 0.7).unwrap();
    // Runs of a splitting merge the flows at the ends of two steps.
    assert!(distance(later.attitude(), part.attitude()) < 1e-9, "{name}: later");
    let back = stepper.state_at(&stepper.adopt(&next), -0.1).unwrap();
    assert!(distance(back.attitude(), start.attitude()) < 1e-9, "{name}: back");
}

/// Checks all functions that every plan has.
fn assert_all<S, P>(name: &str, stepper: &Stepper<S, P>, own: &mut Vec<Checkpoint<f64>>)
where
    S: DiscreteLagrangian<Scalar = f64, Group = SO3> + liestep::mechanics::Regular + Clone,
    P: Plan<S>,
{
    assert_runs(name, stepper);
    assert_is_forced(name, stepper);
    assert_adopts(name, stepper);
    assert_has_limits_and_an_inverse(name, stepper);
    assert_is_saved(name, stepper, own);
}

/// Checks a plan, alone and with substeps as a remedy, which change nothing if there is a step.
fn assert_with_remedies<S, P>(name: &str, stepper: &Stepper<S, P>, own: &mut Vec<Checkpoint<f64>>)
where
    S: DiscreteLagrangian<Scalar = f64, Group = SO3> + liestep::mechanics::Regular + Clone + 'static,
    P: Plan<S, Kept: 'static> + Clone + 'static,
{
    assert_all(name, stepper, own);
    assert_is_forced_as_numbers(name, stepper);
    assert_is_observed(name, &stepper.clone().or_substeps(2).into_any().on_group::<SO3, S::Advected>().unwrap());
    let substeps = stepper.clone().or_substeps(8);
    assert_all(&format!("{name}, or substeps"), &substeps, own);
    let (mut plain, mut other) = (started(stepper), started(&substeps));
    for _ in 0..10 {
        let report = step(stepper, &mut plain).unwrap();
        assert_eq!(step(&substeps, &mut other).unwrap(), report, "{name}");
    }
    assert_eq!(format!("{plain:?}"), format!("{other:?}"), "{name}");
}

/// Checks a plan with compensated sums too, inside and outside of the remedy.
fn assert_everything<S, P>(name: &str, stepper: &Stepper<S, P>, own: &mut Vec<Checkpoint<f64>>)
where
    S: DiscreteLagrangian<Scalar = f64, Group = SO3> + liestep::mechanics::Regular + Clone + 'static,
    P: Plan<S, Kept: 'static> + Compensable + Clone + 'static,
{
    assert_with_remedies(name, stepper, own);
    let compensated = stepper.clone().compensated();
    assert_with_remedies(&format!("{name}, compensated"), &compensated, own);
    assert_all(&format!("{name}, or substeps, compensated"), &stepper.clone().or_substeps(8).compensated(), own);
    // The map is the same up to rounding.
    let (mut plain, mut carrying) = (started(stepper), started(&compensated));
    stepper.run(&mut plain, 50).unwrap();
    compensated.run(&mut carrying, 50).unwrap();
    assert!(apart::<S, P, _>(&plain, &carrying) < 1e-14, "{name}: compensated");
}

#[test]
fn every_method_goes_with_every_addition() {
    let (h, mut own) = (0.01, Vec::new());
    let top = HeavyTop::asymmetric();
    assert_everything("its own step", &Stepper::new(top.clone(), h).unwrap(), &mut own);
    for scheme in [CompositionScheme::SUZUKI_4, CompositionScheme::KAHAN_LI_6] {
        assert_everything(scheme.name(), &Stepper::composed(top.clone(), h, scheme).unwrap(), &mut own);
    }
    let flow = ExactBody::new(&top.ordinary_inertia());
    for scheme in [SplittingScheme::STRANG, SplittingScheme::FORCE_GRADIENT_4, SplittingScheme::FORCE_GRADIENT_5] {
        assert_everything(scheme.name(), &Stepper::split(top.clone(), h, flow, scheme).unwrap(), &mut own);
    }
    for scheme in ProcessedScheme::ALL {
        assert_everything(scheme.name(), &Stepper::processed(top.clone(), h, flow, scheme).unwrap(), &mut own);
    }
    let symmetric = HeavyTop::thesis();
    let flow = SymmetricBody::new(&symmetric.ordinary_inertia()).unwrap();
    let split = Stepper::split(symmetric, h, flow, SplittingScheme::NYSTROM_11).unwrap();
    assert_everything("exact", &split, &mut own);
    // Collocation compensates its own sums.
    assert_with_remedies("2 stages", &Stepper::collocated::<1>(top.clone(), h).unwrap(), &mut own);
    assert_with_remedies("8 stages", &Stepper::collocated::<4>(top, h).unwrap(), &mut own);
    // A single body.
    let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5)).unwrap();
    let body = Stepper::new(PrincipalBody { J_d }, h).unwrap();
    assert_everything("a free body", &body, &mut own);
}

/// The thesis' published step has no solution for (3.13), nor for its compositions: every remedy reports itself, and
/// conserves the invariants of every step.
#[test]
fn every_remedy_is_taken_where_there_is_no_step() {
    let Motion { top, attitude, velocity, .. } = Motion::looping();
    let vertical = |momentum: &Vector3<f64>, w: &Vector3<f64>| momentum.dot(w);

    let declared = Stepper::new(top.clone(), 0.1).unwrap();
    let mut state = declared.start(attitude, velocity).unwrap();
    let start = vertical(&state.momentum(), &state.advected());
    assert!(matches!(declared.step(&mut state), Err(StepError::BeyondSolvable { .. })));
    assert!(declared.max_step(&state) < 0.1 && declared.max_step(&state) > 0.05);

    let composed = Stepper::composed(top, 0.2, CompositionScheme::SUZUKI_4).unwrap();
    let mut state = composed.start(attitude, velocity).unwrap();
    let Err(StepError::BeyondSolvable { largest, .. }) = composed.step(&mut state) else { panic!("a step") };
    let part = Stepper::composed(composed.scene().clone(), largest, CompositionScheme::SUZUKI_4).unwrap();
    assert!(part.step(&mut part.adopt(&state)).is_ok(), "the largest step that is named, {largest}, is one");
    let mut substeps = composed.clone().or_substeps(16).compensated();
    assert!(substeps.max_step(&substeps.adopt(&state)) < 0.2, "what only a remedy makes is no step of the method");
    let mut state = substeps.start(attitude, velocity).unwrap();
    for _ in 0..10 {
        let report = substeps.step(&mut state).unwrap();
        assert!(matches!(report.remedy, Some(Remedy::Substeps(2 | 4))), "{report:?}");
    }
    assert!((vertical(&state.momentum(), &state.advected()) / start - 1.0).abs() < 1e-14);
    substeps = composed.clone().or_substeps(1).compensated();
    assert!(substeps.step(&mut state).is_err());
}
