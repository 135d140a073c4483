//! Eight scenes of several bodies on one core: one after another, and in SIMD lanes. A step is one of all eight.
//!
//! Each of the eight has its own initial state. Their steps alone and in lanes agree, which is checked before the
//! timing.

use core::array::from_fn;
use core::fmt::Debug;

use declarations::{Alike, DoublePendulum, TopOnCart, TwoBodies};
use liestep::effects::PrincipalBody;
use liestep::groups::{R2, R3};
use liestep::mechanics::{Along, DiagonalNonstandardInertia, Each};
use liestep::motion::{Batch, Batchable, Integrator};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, Stepper};
use nalgebra::{SVector, Vector2, Vector3};
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
    small.into_iter().chain([row::<4>(), row::<32>()]).collect()
}
