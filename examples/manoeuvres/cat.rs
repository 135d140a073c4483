//! A body that turns by changing its shape, as a cat does.

use std::f64::consts::TAU;

use liestep::gradients::Input;
use liestep::groups::{Factor, LieGroup, R1};
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use liestep_control::{Control, ControlPlan, Target};
use nalgebra::{SVector, UnitQuaternion, Vector3};
use workbench::args::Failure;
use workbench::drawing::path;
use workbench::plot::{BLUE, Line, ORANGE};

use crate::{Drawing, Part, found, given, picture};

/// A body with two wheels, whose angles about the body's first and second axis are `t_1` and `t_2`.
#[lagrangian(
    group(F = SO3, t_1 = R1, t_2 = R1),
    gradients,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        + J_w * ((t_1 + vee(F).x).powi(2) + (t_2 + vee(F).y).powi(2)) / (2.0 * h),
)]
#[derive(Clone, Debug)]
pub(crate) struct Cat {
    /// Nonstandard inertia of the body with its wheels, without the wheels' moments about their axes, kg m².
    J_d: NonstandardInertia,
    /// A wheel's moment about its axis, kg m².
    J_w: f64,
}

type Attitude = (SO3, R1, R1);
type Turn = ControlPlan<Stepper<Cat>>;

const MOMENTS: [f64; 3] = [0.7, 0.5, 0.9];
const WHEEL: f64 = 0.3;

/// The wheels' angles during the manoeuvre, rad.
fn wheels(plan: &Turn) -> Vec<(f64, f64)> {
    let turns = |attitude: Attitude| (attitude.1.translation().x, attitude.2.translation().x);
    plan.states.iter().map(|state| turns(state.attitude())).collect()
}

/// The plan of a turn about the third axis, and the turn predicted to second order by the area that the wheels' angles
/// enclose.
///
/// Without angular momentum the body has the velocity `−a_k ṫ_k` about the axes of the wheels, `a = J_w/(J + J_w)`. A
/// loop around an area `A` of the plane of `t_1` and `t_2`, from the first to the second, results in the turn
/// `½ ∮ [ξ, dξ] = a_1 a_2 A`.
fn turn(angle: f64) -> Result<(Turn, f64), Failure> {
    let (steps, seconds) = (200, 4.0);
    let J_d = NonstandardInertia::from_principal_moments(Vector3::from(MOMENTS))?;
    let stepper = Stepper::new(Cat { J_d, J_w: WHEEL }, seconds / f64::from(steps))?;
    let start = stepper.start(Attitude::identity(), SVector::zeros())?;
    let turned: SO3 = UnitQuaternion::from_scaled_axis(Vector3::z() * angle).into();
    let end: Attitude = (turned, R1::identity(), R1::identity());
    let shares = [0, 1].map(|k| WHEEL / (MOMENTS[k] + WHEEL));
    // The guess is one loop around that area, from rest to rest; at no loop the gradient vanishes by symmetry. With the
    // phase φ, t_1 = r (1 − cos φ)/2 and t_2 = r (½ sin 2φ − sin φ) enclose π r²/2.
    let radius = (angle / (shares[0] * shares[1] * TAU / 4.0)).sqrt();
    let guess = |step: usize, wheel: usize| {
        let phase = TAU * step as f64 / f64::from(steps);
        let bend = if wheel == 0 { 0.5 * phase.cos() } else { phase.sin() - 2.0 * (2.0 * phase).sin() };
        radius * WHEEL * (1.0 - shares[wheel]) * (TAU / seconds).powi(2) * bend
    };
    let plan = Control::new(&stepper, start, 200, Target::rest(end))
        .input(Input::Force(SVector::<f64, 5>::zeros()), [3, 4])
        .guess(guess)
        .solve()?;
    let places = wheels(&plan);
    let area: f64 = places.windows(2).map(|pair| 0.5 * (pair[0].0 * pair[1].1 - pair[1].0 * pair[0].1)).sum();
    Ok((plan, shares[0] * shares[1] * area))
}

/// A turn by wheels whose final angles are the initial ones.
pub(crate) fn cat() -> Drawing {
    let (plan, foretold) = turn(0.5)?;
    let momentum = |state: &liestep::StateOf<Cat>| {
        let attitude = state.attitude();
        (attitude.0.as_matrix() * <Attitude as Factor<0>>::components(&state.momentum())).norm()
    };
    let most = plan.states.iter().map(momentum).fold(0.0, f64::max);
    let report = format!(
        "{}; a turn of 0.5 rad, of the area {foretold:.4} rad; angular momentum at most {most:.0e} kg m²/s",
        found(&plan)?
    );
    let torques = |input: &Input<SVector<f64, 5>, _>| {
        let scalars: Vec<f64> = input.scalars();
        [scalars[3], scalars[4]]
    };
    let torques: Vec<[f64; 2]> = plan.inputs.iter().map(torques).collect();
    let lines = vec![Line { colour: BLUE, width: 4, points: wheels(&plan) }];
    let names = [("first", BLUE), ("second", ORANGE)];
    let parts = [
        Part::Lines(path("The wheels' turns", ["first wheel, rad", "second wheel, rad"], lines), &[]),
        given(("Torque on the wheels", "N m", &names), plan.stepper.step_size(), &torques),
    ];
    let below = "no angular momentum at any time; both wheels end where they began, and at rest";
    Ok((report, picture("A turn of 0.5 rad by two wheels alone", below, &parts)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The turn predicted by the area has the right sign, and the right size to second order in the wheels' angles,
    /// which is first order in the turn. For smaller turns the loop may have any orientation at nearly the same effort,
    /// and the search is slow.
    #[test]
    fn the_turn_is_that_of_the_area() {
        let off = |angle: f64| {
            let (plan, foretold) = turn(angle).expect("a plan");
            found(&plan).expect("a plan");
            foretold / angle - 1.0
        };
        let [large, small] = [0.8, 0.2].map(off);
        assert!(small.abs() < 0.04 && (large / small - 4.0).abs() < 0.3, "{large}, {small}");
    }
}
