//! Error against time of a method, with shorter and shorter steps.

use liestep_refinement::{Effort, Refinement};

use crate::methods::Method;
use crate::scenes::{Scene, error};

/// All informative runs of a method, each with a step shorter than the one before by a factor.
pub fn ladder(method: &Method, scene: &Scene, t: f64, (effort, ratio): (Effort, f64)) -> Refinement {
    let Some(exact) = scene.reference(t) else { return Refinement::default() };
    let prepare = |parameter| (method.prepare)(scene, t, parameter);
    Refinement::timed(method.parameters(t, ratio), effort, prepare, |end| error(end, exact))
}
