//! Splittings in lanes are those of each member alone, to the bit.

#![allow(non_snake_case)] // the letters of the field

use liestep::effects::{Gravity, PrincipalBody};
use liestep::mechanics::{DiagonalNonstandardInertia, Inertia, InertiaError, Sum, Term};
use liestep::methods::{ExactBody, ProcessedScheme, SplitBody, SplittingScheme, SymmetricBody};
use liestep::motion::{Batchable, Integrator, Plan};
use liestep::{SO3, SetupError, State, StepError, Stepper};
use liestep_ensemble::{Ensemble, Failure, Member, Shard};
use nalgebra::Vector3;
use simba::simd::AutoF64x8;

const MEMBERS: u64 = 21;
const STEPS: u64 = 150;

type Scene = Sum<PrincipalBody, Gravity>;
type StateOf<P> = State<SO3, <Scene as Term>::Advected, <P as Plan<Scene>>::Kept>;

/// A body, in one order of its moments, and what is heavy in it, on the third axis or beside. The spin of member 6 has
/// no digit left within a step; the others turn from slowly to several radians a step.
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
    (shard.rows.step.clone(), values, format!("{:?}", shard.failures))
}

/// Kept on the way, so that runs are of unequal lengths.
fn assert_same<P>(
    name: &str,
    is_symmetric: bool,
    beside: f64,
    make: impl Fn(Top) -> Result<Stepper<Scene, P>, SetupError> + Copy + Send + Sync + 'static,
) where
    P: Plan<Scene> + Clone + 'static,
    Stepper<Scene, P>: Batchable<AutoF64x8> + Integrator<State = StateOf<P>>,
{
    let member = move |member: &Member<'_>| -> Result<_, Failure> {
        let top = top(member, is_symmetric, beside)?;
        let velocity = Vector3::new(0.3, 0.2, top.spin);
        let stepper = make(top)?;
        let state = stepper.start(SO3::exp(Vector3::x() * member.uniform("tilt", 0.1..2.0)), velocity)?;
        Ok((stepper, state))
    };
    let kept = |ensemble: Ensemble<Stepper<Scene, P>>| {
        let of_attitude =
            |state: &StateOf<P>| -> [f64; 3] { state.attitude().as_matrix().column(0).into_owned().into() };
        let ensemble = ensemble.every(40).keep(["x", "y", "z"], move |run| of_attitude(run.state));
        ensemble.keep(["p", "q", "r"], |run| run.state.momentum().into()).chunk(0, &|| false).unwrap()
    };
    let together = kept(Ensemble::new("tops", MEMBERS, STEPS, member));
    let alone = kept(Ensemble::one_by_one("tops", MEMBERS, STEPS, member).chunks_of(MEMBERS));
    assert!(bits(&together) == bits(&alone), "{name}: {:?}, {:?}", together.failures, alone.failures);
    let [failed] = together.failures.as_slice() else { panic!("{name}: {:?}", together.failures) };
    let is_named = matches!(failed.failure, Failure::Step(StepError::AngleWithoutDigits { .. }));
    assert!(failed.member == 6 && is_named, "{name}: {failed:?}");
}

#[test]
fn symmetric_bodies_in_lanes_move_as_alone() {
    let split = |scheme| move |top: Top| Stepper::split(top.scene, 0.05, SymmetricBody::new(&top.inertia)?, scheme);
    // With the turn about the axis taken out, and without.
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
    assert_same("seven rotations", false, 0.2, |top| {
        Stepper::split(top.scene, 0.05, SplitBody::<7>::new(&top.inertia)?, SplittingScheme::NYSTROM_6)
    });
    assert_same("processed", false, 0.2, |top| {
        Stepper::processed(top.scene, 0.05, ExactBody::new(&top.inertia), ProcessedScheme::SIX_A)
    });
}

/// Unlike schemes share no lanes; nor do bodies of which one spins about an axis of its own.
#[test]
fn unlike_splittings_have_lanes_of_their_own() {
    assert_same("two schemes by turns", true, 0.0, |top| {
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
