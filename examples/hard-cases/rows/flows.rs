//! P5: two ways to write the flow, and two ways to write the scene.

use declarations::Motion;
use liestep::Stepper;
use liestep::effects::{Gravity, PrincipalBody};
use liestep::groups::LieGroup as _;
use liestep::mechanics::DiscreteLagrangian as _;
use liestep::motion::DiscreteEulerPoincare;
use nalgebra::Vector3;
use workbench::measure::{greater, relative};

use crate::curves::Curves;
use crate::row::{Effort, Failure, Row};

const STEPS: u32 = 1000;

/// The flow (2.5) takes `μ` from `F` itself, and so rounds it to `ε J/h` in every step: such errors walk to
/// `n^{3/2} ε`.
const ROUNDING: f64 = 4.0 * 31_623.0 * f64::EPSILON;

pub(crate) fn p5(_: Effort, _: &mut Curves) -> Result<Row, Failure> {
    let mut row =
        Row::new("P5", "(2.5) and (2.8); the sum of effects and (3.13), 1000 steps", "round-off, 4 n^{3/2} ε");
    for motion in [Motion::looping(), Motion::chaotic()] {
        for h in [0.001, 0.01] {
            let stepper = Stepper::new(motion.top.clone(), h)?;
            let mut state = stepper.start(motion.attitude, motion.velocity)?;
            let on_increments = DiscreteEulerPoincare::new(motion.top.clone(), h)?;
            let mut w = state.advected();
            let mut f = stepper.flow().invert_legendre_minus(&state.momentum(), &w, &Vector3::zeros())?;
            let top = &motion.top;
            let body = PrincipalBody { J_d: top.J_d };
            let scene = Stepper::new(body + Gravity { m: top.m, g: top.g, rho: top.rho, up: top.up }, h)?;
            let mut summed = scene.start(motion.attitude, motion.velocity)?;
            let (mut flows, mut sums) = (0.0, 0.0);
            for _ in 0..STEPS {
                stepper.step(&mut state)?;
                scene.step(&mut summed)?;
                (f, w) = on_increments.step(&f, &w)?;
                let momentum = top.legendre_minus(&f.matrix(), &w, h);
                flows = greater(flows, relative(&momentum, &state.momentum()) * h * motion.velocity.norm());
                flows = greater(flows, relative(&w, &state.advected()));
                sums = greater(sums, relative(&summed.momentum(), &state.momentum()));
                sums = greater(sums, relative(&summed.attitude().matrix(), &state.attitude().matrix()));
            }
            let name = motion.name;
            row = row.at_most(&format!("{name}, h = {h}: the two flows"), flows, ROUNDING).at_most(
                &format!("{name}, h = {h}: sum and struct"),
                sums,
                ROUNDING,
            );
        }
    }
    Ok(row)
}
