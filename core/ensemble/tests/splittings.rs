//! Members stepped by splittings in lanes equal members stepped alone, to the bit.

use liestep::effects::{Gravity, PrincipalBody, RigidBody};
use liestep::mechanics::{DiagonalNonstandardInertia, Inertia, InertiaError, RigidScene, Sum, Term};
use liestep::methods::{ExactBody, ProcessedScheme, SplittingScheme, SymmetricBody};
use liestep::motion::{Batch, Batchable, Integrator, Plan};
use liestep::{SO3, SetupError, State, StepError, Stepper};
use liestep_ensemble::{Ensemble, Failure, Member, MemberFailure, Shard};
use nalgebra::{Matrix3, Rotation3, Vector3};
use simba::simd::AutoF64x8;

const MEMBERS: u64 = 21;
const STEPS: u64 = 150;

type Scene = Sum<PrincipalBody, Gravity>;
type StateOf<S, P> = State<SO3, <S as Term>::Advected, <P as Plan<S>>::Kept>;

/// A body with moments in one order, and its weight, on the third axis or beside it. Member 6 turns so fast that its
/// angle has no digit left within a step; the others turn from slowly to several radians a step.
struct Top {
    scene: Scene,
    inertia: Inertia,
    spin: f64,
}

fn top(member: &Member<'_>, is_symmetric: bool, beside: f64) -> Result<Top, InertiaError> {
    let mut moments = Vector3::new(member.uniform("J_1", 1.0..1.2), 1.5, member.uniform("J_3", 1.6..1.95));
    if is_symmetric {
        moments.y = moments.x;
    }
    let body = PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(moments)? };
    let rho = Vector3::new(beside, -beside, member.uniform("rho", 0.2..0.8));
    let spin =
        if member.number() == 6 { 1e18 } else { 0.3 * 1.25_f64.powi(i32::try_from(member.number()).unwrap_or(0)) };
    let scene = body + Gravity { m: 1.0, g: 9.81, rho, up: Vector3::z() };
    Ok(Top { scene, inertia: Inertia::from_principal_moments(moments)?, spin })
}

fn bits(shard: &Shard) -> (Vec<u64>, Vec<u64>, String) {
    let values = shard.rows.columns.iter().flatten().map(|value| value.to_bits()).collect();
    (shard.rows.step.clone(), values, format!("{:?}", shard.outcome.failures))
}

fn assert_same<S, P>(
    name: &str,
    is_symmetric: bool,
    beside: f64,
    make: impl Fn(Top) -> Result<Stepper<S, P>, SetupError> + Copy + Send + Sync + 'static,
) where
    S: RigidScene<Scalar = f64> + Clone + 'static,
    P: Plan<S> + Clone + 'static,
    Stepper<S, P>: Batchable<AutoF64x8> + Integrator<State = StateOf<S, P>>,
{
    let failures = same(name, is_symmetric, beside, make);
    let [failed] = failures.as_slice() else { panic!("{name}: {failures:?}") };
    let is_named = matches!(failed.failure, Failure::Step(StepError::AngleWithoutDigits { .. }));
    assert!(failed.member == 6 && is_named, "{name}: {failed:?}");
}

/// Compares rows recorded at times that divide the run unequally; returns the failures, which are equal, too.
fn same<S, P>(
    name: &str,
    is_symmetric: bool,
    beside: f64,
    make: impl Fn(Top) -> Result<Stepper<S, P>, SetupError> + Copy + Send + Sync + 'static,
) -> Vec<MemberFailure>
where
    S: RigidScene<Scalar = f64> + Clone + 'static,
    P: Plan<S> + Clone + 'static,
    Stepper<S, P>: Batchable<AutoF64x8> + Integrator<State = StateOf<S, P>>,
{
    let member = move |member: &Member<'_>| -> Result<_, Failure> {
        let top = top(member, is_symmetric, beside)?;
        let velocity = Vector3::new(0.3, 0.2, top.spin);
        let stepper = make(top)?;
        let state = stepper.start(SO3::exp(Vector3::x() * member.uniform("tilt", 0.1..2.0)), velocity)?;
        Ok((stepper, state))
    };
    let kept = |ensemble: Ensemble<Stepper<S, P>>| {
        let of_attitude =
            |state: &StateOf<S, P>| -> [f64; 3] { state.attitude().as_matrix().column(0).into_owned().into() };
        let ensemble = ensemble.every(40).keep(["x", "y", "z"], move |run| of_attitude(run.state));
        ensemble.keep(["p", "q", "r"], |run| run.state.momentum().into()).chunk(0, &|| false).unwrap()
    };
    let together = kept(Ensemble::new("tops", MEMBERS, STEPS, member).chunks_of(MEMBERS));
    let alone = kept(Ensemble::one_by_one("tops", MEMBERS, STEPS, member).chunks_of(MEMBERS));
    assert!(bits(&together) == bits(&alone), "{name}: {:?}, {:?}", together.outcome.failures, alone.outcome.failures);
    together.outcome.failures
}

#[test]
fn symmetric_bodies_in_lanes_move_as_alone() {
    let split = |scheme| move |top: Top| Stepper::split(top.scene, 0.05, SymmetricBody::new(&top.inertia)?, scheme);
    // The turn about the third axis is merged with others for a weight on the axis, and isn't for one beside it.
    for beside in [0.0, 0.2] {
        assert_same("Strang", true, beside, split(SplittingScheme::STRANG));
        assert_same("Nyström", true, beside, split(SplittingScheme::NYSTROM_11));
        assert_same("force gradient", true, beside, split(SplittingScheme::FORCE_GRADIENT_4));
    }
    assert_same("compensated", true, 0.0, |top| {
        let scheme = SplittingScheme::NYSTROM_6;
        Ok(Stepper::split(top.scene, 0.05, SymmetricBody::new(&top.inertia)?, scheme)?.compensated())
    });
}

#[test]
fn other_bodies_in_lanes_move_as_alone() {
    assert_same("exact", false, 0.2, |top| {
        Stepper::split(top.scene, 0.05, ExactBody::new(&top.inertia), SplittingScheme::NYSTROM_6)
    });
    assert_same("processed", false, 0.2, |top| {
        Stepper::processed(top.scene, 0.05, ExactBody::new(&top.inertia), ProcessedScheme::SIX_A)
    });
    assert_same("compensated, exact", false, 0.2, |top| {
        let scheme = SplittingScheme::NYSTROM_6;
        Ok(Stepper::split(top.scene, 0.05, ExactBody::new(&top.inertia), scheme)?.compensated())
    });
    assert_same("compensated, processed", false, 0.2, |top| {
        let scheme = ProcessedScheme::SIX_A;
        Ok(Stepper::processed(top.scene, 0.05, ExactBody::new(&top.inertia), scheme)?.compensated())
    });
    // The step is limited, by the spin of the last members too.
    let failures = same("a declared flow", false, 0.2, |top| {
        let flow = top.scene.first;
        Stepper::split(top.scene, 0.02, flow, SplittingScheme::STRANG)
    });
    assert!(failures.iter().any(|failed| failed.member == 6) && failures.len() < 8, "{failures:?}");
}

/// The body and its weight, in turned axes if `is_turned`.
fn turned(top: &Top, is_turned: bool) -> Result<(Sum<RigidBody, Gravity>, Inertia), SetupError> {
    let turn = if is_turned { Rotation3::new(Vector3::new(0.4, -0.3, 0.7)).into_inner() } else { Matrix3::identity() };
    let matrix = turn * top.inertia.as_matrix() * turn.transpose();
    let unusable = |_| SetupError::Unlike { lane: 0 };
    let inertia = Inertia::new((matrix + matrix.transpose()) * 0.5).map_err(unusable)?;
    let body = RigidBody { J_d: inertia.to_nonstandard() };
    Ok((body + top.scene.second, inertia))
}

#[test]
fn bodies_in_other_axes_move_in_lanes_as_alone() {
    assert_same("turned axes", false, 0.2, |top| {
        let (scene, inertia) = turned(&top, true)?;
        Stepper::split(scene, 0.05, ExactBody::new(&inertia), SplittingScheme::NYSTROM_6)
    });
    assert_same("some turned", false, 0.2, |top| {
        let (scene, inertia) = turned(&top, top.inertia.as_matrix().m33 > 1.8)?;
        Stepper::split(scene, 0.05, ExactBody::new(&inertia), SplittingScheme::STRANG)
    });
}

/// States inside the processor share no lanes with one that was stepped by another step, and has yet to enter it.
#[test]
fn a_processed_body_of_another_step_has_lanes_of_its_own() {
    let moments = Vector3::new(1.1, 1.5, 1.7);
    let inertia = Inertia::from_principal_moments(moments).unwrap();
    let body = PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(moments).unwrap() };
    let scene = body + Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.1, 0.0, 0.4), up: Vector3::z() };
    let of_step = |h| {
        let flow = ExactBody::new(&inertia);
        Stepper::processed(scene, h, flow, ProcessedScheme::SIX_A).unwrap().compensated()
    };
    let [stepper, other] = [0.05, 0.04].map(of_step);
    let start = stepper.start(SO3::exp(Vector3::x() * 0.4), Vector3::new(0.3, 0.2, 2.0)).unwrap();
    let begun = |by: &_| {
        let mut state = start;
        Stepper::run(by, &mut state, 10).unwrap();
        state
    };
    let (inside, outside) = (begun(&stepper), begun(&other));
    let bodies = |states: &[_]| states.iter().map(|state| (stepper.clone(), *state)).collect::<Vec<_>>();
    let lanes = |states: &[_]| Batch::<AutoF64x8, _>::new(&bodies(states));
    assert!(matches!(lanes(&[inside, inside, outside]), Err(SetupError::Unlike { lane: 2 })));
    assert!(matches!(lanes(&[outside, inside]), Err(SetupError::Unlike { lane: 1 })));
    for state in [inside, outside] {
        let (mut batch, mut alone) = (lanes(&[state; 3]).unwrap(), state);
        batch.run(7);
        stepper.run(&mut alone, 7).unwrap();
        assert_eq!(batch.state(2), alone);
    }
}

/// Members of unlike schemes share no lanes; spheres share them with other bodies.
#[test]
fn unlike_splittings_have_lanes_of_their_own() {
    assert_same("two alternating schemes", true, 0.0, |top| {
        let scheme =
            if top.inertia.as_matrix().m33 > 1.8 { SplittingScheme::STRANG } else { SplittingScheme::NYSTROM_6 };
        Stepper::split(top.scene, 0.05, SymmetricBody::new(&top.inertia)?, scheme)
    });
    assert_same("some spherical", true, 0.2, |mut top| {
        let moments = top.inertia.as_matrix().diagonal();
        if moments.z < 1.8 {
            let moments = Vector3::repeat(moments.x);
            top.inertia = Inertia::from_principal_moments(moments).map_err(|_| SetupError::Unlike { lane: 0 })?;
            let J_d = DiagonalNonstandardInertia::from_principal_moments(moments);
            top.scene.first.J_d = J_d.map_err(|_| SetupError::Unlike { lane: 0 })?;
        }
        Stepper::split(top.scene, 0.05, SymmetricBody::new(&top.inertia)?, SplittingScheme::STRANG)
    });
}
