//! P6: damping far stronger than the inertia.

use liestep::effects::{Drag, MagneticDamping, PrincipalBody};
use liestep::mechanics::{DiagonalNonstandardInertia, Effect, Regular};
use liestep::{NonstandardInertia, SO3, Stepper, force};
use nalgebra::{UnitQuaternion, Vector3};

use crate::row::{Effort, Failure, Row};

/// A torque `−c Ω` that acts only at the beginning of the step: of first order, and implicit in the momentum.
#[force(group = SO3, work = -c * vee(F).dot(&eta))]
#[derive(Clone, Copy, Debug)]
struct OneSidedDrag {
    /// The coefficient, N m s.
    c: f64,
}

const H: f64 = 0.05;

/// An energy, in J, below which the squares of Newton's unknown underflow.
const NOTHING: f64 = 1e-280;

/// Whether the energy decreases in every step until it underflows, and the number of sign changes of a component of the
/// velocity.
fn decay<L>(scene: L) -> Result<(bool, u32), Failure>
where
    L: Effect<Scalar = f64, Group = SO3> + Regular,
{
    let stepper = Stepper::new(scene, H)?;
    let mut state = stepper.start(SO3::identity(), Vector3::new(1.0, 4.0, 0.5))?;
    let (mut falls, mut flips) = (true, 0);
    for _ in 0..200 {
        let (energy, velocity) = (stepper.energy(&state), stepper.velocity(&state));
        stepper.step(&mut state)?;
        let after = stepper.energy(&state);
        if after < NOTHING {
            break;
        }
        falls &= after < energy;
        // The middle component is the largest, and precession doesn't reverse it.
        flips += u32::from(stepper.velocity(&state).y * velocity.y < 0.0);
    }
    Ok((falls, flips))
}

pub(crate) fn p6(_: Effort) -> Result<Row, Failure> {
    let inertia = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5))?;
    let body = PrincipalBody { J_d: inertia };
    let J = NonstandardInertia::from(inertia).to_inertia();
    let mut row = Row::new(
        "P6",
        "drag with c h up to 10⁴ J; damping alone",
        "monotone decay without a change of sign; ends on the major axis",
    );
    for ratio in [1.0, 10.0, 1e4] {
        let c = ratio * 3.0 / H;
        let (falls, flips) = decay(body + Drag { c, J })?;
        let (one_sided_falls, one_sided_flips) = decay(body + OneSidedDrag { c })?;
        row = row
            .holds(&format!("Drag, c h = {ratio} J: energy falls in every step"), falls)
            .holds(&format!("Drag, c h = {ratio} J: {flips} changes of sign in 200 steps"), flips == 0)
            .holds(&format!("declared at one end, c h = {ratio} J: falls in every step"), one_sided_falls)
            .holds(&format!("declared at one end, c h = {ratio} J: {one_sided_flips} changes of sign"), {
                one_sided_flips == 0
            });
    }

    let drag = Stepper::new(body + Drag { c: 0.05, J }, H)?;
    let field = Vector3::new(0.0, 0.6, 0.8);
    let magnetic = Stepper::new(body + MagneticDamping { k: 0.2, field, J }, H)?;
    let start = Vector3::new(2.0, 0.1, 0.1);
    let mut slowed = drag.start(SO3::identity(), start)?;
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.3, -0.2));
    let mut held = magnetic.start(attitude, start)?;
    for _ in 0..40_000 {
        drag.step(&mut slowed)?;
        magnetic.step(&mut held)?;
    }
    let off = |velocity: Vector3<f64>| velocity.xy().norm().atan2(velocity.z.abs());
    Ok(row.at_most("weak drag: last axis from the major one, rad", off(drag.velocity(&slowed)), 1e-3).at_most(
        "magnetic damping: last axis from the major one, rad",
        off(magnetic.velocity(&held)),
        1e-4,
    ))
}
