//! The choice of a scene's type, once a run.

use workbench::switched::Switched;

use super::effects::Table;
use super::file::{Pace, SceneFile};
use super::run::{Question, Run, Stopped, Task, ask, simulate};

/// Simulates the sum of the body and those effects that the file has.
///
/// All subsets of the effects would be 256 types and minutes of compiling. These are four, as an effect with an unknown
/// part makes each iteration longer, and that of magnetic damping raises the degree of the equation; in each, what the
/// file hasn't is switched off. Every run has the bits of the sum of just those that the file has.
pub(crate) fn run(file: &SceneFile) -> Result<Run, Stopped> {
    let body = file.body();
    macro_rules! switched {
        ($effect:ident) => {
            Switched(file.$effect.as_ref().map(|table| table.effect(&body)))
        };
    }
    let potentials = body + switched!(gravity) + switched!(gravity_gradient) + switched!(dipole) + switched!(spring);
    let with_rotor = potentials + switched!(rotor);
    match &file.run.pace {
        Pace::Step { step, steps } => {
            let task = Task { file, step: *step, steps: *steps };
            let dragged = with_rotor + switched!(drag);
            if file.magnetic_damping.is_some() {
                simulate(dragged + switched!(magnetic_damping) + switched!(torque), &task)
            } else if file.force().is_some() {
                simulate(dragged + switched!(torque), &task)
            } else if file.rotor.is_some() {
                simulate(with_rotor, &task)
            } else {
                simulate(potentials, &task)
            }
        }
        Pace::Accuracy(tolerance) => {
            let question = Question { file, tolerance: *tolerance.get_ref() };
            if file.rotor.is_some() { ask(with_rotor, &question) } else { ask(potentials, &question) }
        }
    }
}
