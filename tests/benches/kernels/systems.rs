//! Eight scenes of several bodies on one core: one after another, and in SIMD lanes. A step is one of all eight. Chains on ball
//! joints: by the attitudes of their links, and as bodies with joints, in equal motions.
//!
//! Each of the eight has its own initial state. Their steps alone and in lanes agree, which is checked before the
//! timing, as the two kinds of chains do.

use core::array::from_fn;
use core::fmt::Debug;

use declarations::{Alike, DoublePendulum, FallingBody, TopOnCart, TwoBodies};
use liestep::effects::PrincipalBody;
use liestep::groups::{R2, R3};
use liestep::mechanics::{Along, DiagonalNonstandardInertia, Each};
use liestep::methods::{Chain, Joint, Link, Multibody};
use liestep::motion::{Batch, Batchable, Integrator};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, Stepper};
use nalgebra::{SVector, Vector2, Vector3, Vector6};
use simba::simd::AutoF64x8;

use crate::kernel::{Effort, Failure, Group, Kernel};

const SCENES: usize = 8;
const STEP: f64 = 0.01;
const EFFORT: Effort = Effort { batch: 500, rounds: 200, counted: 500 };

/// A small turn, different for each scene and body.
fn turn(scene: usize, body: usize) -> SO3 {
    #[allow(clippy::cast_precision_loss)] // small counts
    let (a, b) = (scene as f64, body as f64);
    SO3::exp(Vector3::new(0.5 + 0.05 * a, 0.1 * b, -0.3 + 0.02 * a * b))
}

/// Components of a velocity.
fn velocity<const D: usize>(scene: usize) -> SVector<f64, D> {
    #[allow(clippy::cast_precision_loss)] // small counts
    SVector::from_fn(|k, _| 0.5 - 0.3 * (k % 4) as f64 + 0.04 * scene as f64)
}

fn body() -> Result<NonstandardInertia, Failure> {
    NonstandardInertia::from_principal_moments(Vector3::new(0.5, 0.4, 1.0 / 3.0)).map_err(Into::into)
}

/// A stepper with its initial state.
type SceneStart<M> = Result<(M, <M as Integrator>::State), Failure>;

/// Eight scenes one after another, and in lanes.
fn group<M>(name: impl Into<String>, scene: fn(usize) -> SceneStart<M>) -> Group
where
    M: Batchable<AutoF64x8> + Integrator<State: PartialEq + Debug> + 'static,
{
    let scenes = move || (0..SCENES).map(scene).collect::<Result<Vec<_>, _>>();
    let alone = Kernel::new("alone", move || {
        let mut alone = scenes()?;
        Ok(move |steps| {
            for (stepper, state) in &mut alone {
                stepper.run(state, u64::from(steps))?;
            }
            Ok(0)
        })
    });
    let in_lanes = Kernel::new("in lanes", move || {
        let mut scenes = scenes()?;
        let mut batch = Batch::<AutoF64x8, M>::new(&scenes)?;
        batch.run(u64::from(EFFORT.batch));
        for (number, (stepper, state)) in scenes.iter_mut().enumerate() {
            stepper.run(state, u64::from(EFFORT.batch))?;
            assert_eq!(&batch.state(number), state, "number {number}");
        }
        Ok(move |steps| {
            batch.run(u64::from(steps));
            Ok(0)
        })
    });
    Group::new(name, EFFORT, [alone, in_lanes])
}

/// A row of bodies with alignment potentials between neighbours.
fn row<const N: usize>() -> Group {
    group(format!("row of {N}"), |number| {
        let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.0))?;
        let scene = Each::<N>::of([PrincipalBody { J_d }]) + Along::<N>::of([Alike { kappa: 2.0 }]);
        let stepper = Stepper::new(scene, STEP)?;
        let velocities = Bodies([velocity(number); N]);
        let state = stepper.start(from_fn::<_, N, _>(|body| turn(number, body)), velocities)?;
        Ok((stepper, state))
    })
}

/// Rods of one metre on ball joints from a pivot, by their attitudes and by places and joints. They start bent and turning.
fn chain<const N: usize>() -> Group {
    const END: Vector3<f64> = Vector3::new(0.0, 0.0, -0.5);
    let inertia = || NonstandardInertia::from_principal_moments(Vector3::new(0.09, 0.08, 0.02));
    let turns = || from_fn::<_, N, _>(|body| turn(body % 5, body % 3));
    let velocities = || from_fn::<_, N, _>(|body| velocity::<3>(body % 5) * 0.2);
    let ready = move || {
        let central = inertia()?;
        let J_d = NonstandardInertia::new(central.as_matrix() + END * END.transpose())?;
        let links = [Link { J_d, m: 1.0, c: END, rho: END * 2.0 }; N];
        let stepper = Chain { links, g: 9.81, up: Vector3::z() }.stepper(STEP)?;
        let state = stepper.start(turns(), Bodies(velocities()))?;
        Ok::<_, Failure>((stepper, state))
    };
    let bodies = move || {
        let mut system = Multibody::new();
        let (mut end, mut moving, mut places, mut velocity) = (Vector3::zeros(), Vector3::zeros(), vec![], vec![]);
        for (attitude, turning) in turns().into_iter().zip(velocities()) {
            let body = system.body(FallingBody { m: 1.0, J_d: inertia()?, g: 9.81, up: Vector3::z() });
            let above = body.checked_sub(1);
            let point = if above.is_some() { END } else { Vector3::zeros() };
            system.join(Joint::ball([point, -END]), above, body);
            let (along, across) = (attitude.as_matrix() * END, attitude.as_matrix() * turning.cross(&END));
            places.push((attitude, R3::from(end + along)));
            let shift = moving + across;
            velocity.push(Vector6::from_fn(|k, _| if k < 3 { turning[k] } else { shift[k - 3] }));
            (end, moving) = (end + along * 2.0, moving + across * 2.0);
        }
        let stepper = system.stepper(STEP)?;
        let state = stepper.start(&places, &velocity)?;
        Ok::<_, Failure>((stepper, state))
    };
    let by_attitudes = Kernel::new("links", move || {
        let (stepper, mut state) = ready()?;
        Ok(move |steps: u32| Ok(stepper.run(&mut state, steps.into())?))
    });
    let by_joints = Kernel::new("bodies and joints", move || {
        let ((chain, mut links), (stepper, mut state)) = (ready()?, bodies()?);
        let mut other = state.clone();
        for _ in 0..20 {
            chain.step(&mut links)?;
            stepper.step(&mut other)?;
        }
        let apart =
            |body: usize| (links.attitude()[body].as_matrix() - stepper.attitude(&other, body).0.as_matrix()).amax();
        assert!((0..N).map(apart).fold(0.0, f64::max) < 1e-11, "the chains have other motions");
        Ok(move |steps: u32| Ok(stepper.run(&mut state, steps.into())?))
    });
    Group::new(format!("chain of {N}"), Effort { batch: 200, rounds: 20, counted: 100 }, [by_attitudes, by_joints])
}

pub(crate) fn groups() -> Vec<Group> {
    let pendulum = |number| {
        let stepper = Stepper::new(DoublePendulum::asymmetric(), STEP)?;
        let state = stepper.start((turn(number, 0), turn(number, 1)), velocity(number))?;
        Ok((stepper, state))
    };
    let cart = |number| {
        let top = TopOnCart { J_d: body()?, s: Vector3::z() * 0.4, M: 2.0, g: 9.81 };
        let stepper = Stepper::new(top, STEP)?;
        let state = stepper.start((turn(number, 0), R2::from(Vector2::zeros())), velocity(number))?;
        Ok((stepper, state))
    };
    let two = |number| {
        let (K_1, K_2) = (body()?, body()?);
        let (J_1, J_2) = (K_1.to_inertia(), K_2.to_inertia());
        let scene = TwoBodies { m_1: 1.0, m_2: 0.4, K_1, K_2, J_1, J_2, G: 1.0 };
        let stepper = Stepper::new(scene, STEP)?;
        let [near, far] = [0.0, 4.0].map(|x| R3::from(Vector3::x() * x));
        // The two bodies move side by side.
        let turning = velocity::<3>(number);
        let moving: SVector<f64, 12> =
            from_fn::<_, 12, _>(|k| if k % 6 < 3 { turning[k % 3] } else { 0.1 * turning[k % 3] }).into();
        let state = stepper.start((turn(number, 0), near, turn(number, 1), far), moving)?;
        Ok((stepper, state))
    };
    let small = [group("double pendulum", pendulum), group("top on a cart", cart), group("two-body problem", two)];
    let many = [row::<4>(), row::<32>(), chain::<5>(), chain::<20>()];
    small.into_iter().chain(many).collect()
}
