//! How to add a method: a Störmer–Verlet step on SO(3), which works at once with all functions around a step.
//!
//! ```text
//! cargo run --release -p liestep-examples --example how-to-add-a-method
//! ```

use std::error::Error;
use std::f64::consts::FRAC_PI_2;

use liestep::effects::{Gravity, RigidBody};
use liestep::groups::LieGroup as _;
use liestep::mechanics::{DiscreteLagrangian, Operations, SceneVisitor, inertia};
use liestep::methods::CompositionScheme;
use liestep::motion::{Cost, Motion, Plan, Remedy, StepReport, Summation};
use liestep::nalgebra::{Matrix3, UnitQuaternion, Vector3};
use liestep::with::Compensable;
use liestep::{NonstandardInertia, SO3, SetupError, StepError, Stepper};

/// Half a kick of the potential, turns about the body's principal axes, half a kick: order 2, without an equation to
/// solve.
///
/// Each turn is the exact motion for the energy `p_k²/(2 J_k)`. All parts are Poisson maps that conserve the momentum
/// about the vertical, so their product is. It is for scenes of a body in its principal axes and potentials.
struct Verlet<S: DiscreteLagrangian> {
    h: f64,
    moments: Vector3<f64>,
    constants: S::Constants,
}

/// The axes and their shares of the step, the same forwards and backwards.
const TURNS: [(usize, f64); 5] = [(0, 0.5), (1, 0.5), (2, 1.0), (1, 0.5), (0, 0.5)];
/// Larger turns would be possible, but a poor approximation.
const LARGEST_TURN: f64 = FRAC_PI_2;

/// [`Summation`] performs all sums, so they may be compensated.
impl<S: DiscreteLagrangian> Compensable for Verlet<S> {}

impl<S: DiscreteLagrangian<Scalar = f64, Group = SO3>> Verlet<S> {
    fn new(scene: &S, h: f64) -> Result<Self, SetupError> {
        let (inertia, moments) = (inertia(scene, &scene.advected()), inertia(scene, &scene.advected()).diagonal());
        if inertia != Matrix3::from_diagonal(&moments) {
            return Err(SetupError::Parameter { field: "J_d", cause: "is not diagonal" });
        }
        Ok(Self { h, moments, constants: scene.constants(h) })
    }
}

impl<S: DiscreteLagrangian<Scalar = f64, Group = SO3>> Plan<S> for Verlet<S> {
    /// A step needs no memory of the one before.
    type Kept = ();

    fn step_size(&self) -> f64 {
        self.h
    }

    fn refolded(&self, scene: &S, h: f64) -> Result<Self, SetupError> {
        Self::new(scene, h)
    }

    fn keep(&self, _: &S, _: &Motion<SO3, S::Advected>) {}

    #[inline(always)]
    fn step<M: Summation<SO3, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        (): &mut (),
    ) -> Result<StepReport, StepError> {
        // A copy, because an error must leave the motion unchanged.
        let mut next = *motion;
        // The kick of the scene is that of half the step.
        next.push(&S::kick_before(&self.constants, &next.now().advected()));
        for (axis, share) in TURNS {
            let momentum = next.now().momentum();
            let angle = share * self.h * momentum[axis] / self.moments[axis];
            if angle.abs() > LARGEST_TURN {
                let (turn, largest) = (angle.abs(), self.h * LARGEST_TURN / angle.abs());
                return Err(StepError::BeyondSolvable { step: self.h, largest, turn, body: None });
            }
            // F − I, without the cancellation of cos − 1.
            let about = Vector3::ith(axis, 1.0).cross_matrix();
            let increment = about * angle.sin() + about * about * (2.0 * (0.5 * angle).sin().powi(2));
            next.turn(&increment);
            next.push(&SO3::adjoint_transpose_increment(&increment, &momentum));
        }
        next.push(&S::kick_before(&self.constants, &next.now().advected()));
        if !next.now().momentum().iter().all(|entry| entry.is_finite()) {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        next.finish(|| scene.advected());
        *motion = next;
        Ok(StepReport::of(0))
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        visitor.term("Störmer–Verlet with turns about the principal axes");
    }

    fn cost(&self) -> Cost {
        // A turn about an axis costs two sines and about as many other operations.
        Cost::of_stages(Operations { step: 80, iteration: 0 }, 5)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let body = RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5))? };
    let scene = body + Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.3, 0.2, 0.4), up: Vector3::z() };
    let verlet = |h| Stepper::with_plan(scene, Verlet::new(&scene, h)?);
    let (attitude, velocity) = (UnitQuaternion::from_scaled_axis(Vector3::x() * 0.8), Vector3::new(0.5, 1.0, 3.0));

    // The order is 2: half the step, a quarter of the error.
    let exact = Stepper::composed(scene, 0.01, CompositionScheme::KAHAN_LI_8)?;
    let mut there = exact.start(attitude, velocity)?;
    exact.run(&mut there, 200)?;
    let error = |h, steps| -> Result<f64, Box<dyn Error>> {
        let stepper = verlet(h)?;
        let mut state = stepper.start(attitude, velocity)?;
        stepper.run(&mut state, steps)?;
        Ok((state.momentum() - there.momentum()).norm())
    };
    let ratio = error(0.01, 200)? / error(0.005, 400)?;
    println!("with half the step the error is smaller by {ratio:.3}");
    assert!((ratio - 4.0).abs() < 0.1);

    // Compensated sums: the rounding error of the vertical momentum in 10⁵ steps.
    let (plain, compensated) = (verlet(1e-3)?, verlet(1e-3)?.compensated());
    let (mut a, mut b) = (plain.start(attitude, velocity)?, compensated.start(attitude, velocity)?);
    let vertical = a.momentum_along(&Vector3::z());
    plain.run(&mut a, 100_000)?;
    compensated.run(&mut b, 100_000)?;
    let losses = [&*a, &*b].map(|motion| (motion.momentum_along(&Vector3::z()) - vertical).abs());
    println!("of the vertical momentum rounding takes {:.1e}, compensated {:.1e} kg m²/s", losses[0], losses[1]);
    assert!(losses[0] < 1e-11 && losses[1] < 0.1 * losses[0]);

    // A step that would turn the body too far is replaced by substeps.
    let careful = verlet(0.1)?.or_substeps(16);
    let mut state = careful.start(attitude, Vector3::new(0.0, 0.0, 30.0))?;
    let report = careful.step(&mut state)?;
    assert_eq!(report.remedy, Some(Remedy::Substeps(2)));
    Ok(())
}

#[test]
fn a_method_of_ones_own_steps() -> Result<(), Box<dyn Error>> {
    main()
}
