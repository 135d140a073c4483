//! The choice of a scene's type, once a run.

use liestep::{CayleyRetraction, DiscreteLagrangian, Effect, SO3, Sum, WithKinetic};

use super::effects::Table;
use super::file::{Pace, SceneFile};
use super::run::{Question, Run, Stopped, Task, ask, simulate};

type Outcome = Result<Run, Stopped>;

/// A body with some effects on it.
pub(super) trait Scene:
    Effect<Scalar = f64, Group = SO3, Retraction = CayleyRetraction, Kinetic = WithKinetic>
{
}

impl<S: Effect<Scalar = f64, Group = SO3, Retraction = CayleyRetraction, Kinetic = WithKinetic>> Scene for S {}

/// How many effects a scene can have beside its body. All subsets of all eight would be 256 types and minutes of
/// compiling; these are 93.
pub(super) const MOST_EFFECTS: usize = 3;

/// Simulates the sum of the body and those effects that the file has.
pub(crate) fn run(file: &SceneFile) -> Outcome {
    match &file.run.pace {
        Pace::Step { step, steps } => three::gravity(file.body(), &Task { file, step: *step, steps: *steps }),
        Pace::Accuracy(tolerance) => {
            conservative::run(file.body(), &Question { file, tolerance: *tolerance.get_ref() })
        }
    }
}

/// A function for each effect, which adds it or not and goes on to the next: together they have a type for every
/// subset, and each run takes one path to its own. With an effect added, `$fewer` can still be.
macro_rules! at_most {
    ($number:ident, then $fewer:ident: $first:ident $($rest:ident)+) => {
        mod $number {
            use super::{Scene, Task, Outcome, Sum, Table, $fewer};
            pub(super) use super::simulate;

            at_most!(function $fewer: $first $($rest)+);
        }
    };
    (function $fewer:ident: $effect:ident $next:ident $($rest:ident)*) => {
        pub(super) fn $effect<S: Scene>(scene: S, task: &Task<'_>) -> Outcome {
            match &task.file.$effect {
                Some(table) => $fewer::$next(Sum::new(scene, Table::effect(table.get_ref(), &task.file.body())), task),
                None => $next(scene, task),
            }
        }

        at_most!(function $fewer: $next $($rest)*);
    };
    (function $fewer:ident: $last:ident) => {};
}

/// No more effects: whichever would be next, the scene is complete.
mod none {
    pub(super) use super::simulate;
    pub(super) use super::simulate as spring;
    pub(super) use super::simulate as rotor;
    pub(super) use super::simulate as drag;
    pub(super) use super::simulate as magnetic_damping;
    pub(super) use super::simulate as torque;
}

at_most!(one, then none: dipole spring rotor drag magnetic_damping torque simulate);
at_most!(two, then one: gravity_gradient dipole spring rotor drag magnetic_damping torque simulate);
at_most!(three, then two: gravity gravity_gradient dipole spring rotor drag magnetic_damping torque simulate);

/// The sums that an accuracy can be asked of: 26 types.
mod conservative {
    use liestep::effects::PrincipalBody;

    use super::{DiscreteLagrangian, Outcome, Question as Task, Sum, Table, ask};

    pub(super) trait Scene: super::Scene + DiscreteLagrangian<Advected: 'static> + Clone + 'static {}

    impl<S: super::Scene + DiscreteLagrangian<Advected: 'static> + Clone + 'static> Scene for S {}

    /// Simulates the sum of the body and those effects that the file has.
    pub(super) fn run(body: PrincipalBody, question: &Task<'_>) -> Outcome {
        three::gravity(body, question)
    }

    mod none {
        pub(super) use super::ask as simulate;
        pub(super) use super::ask as spring;
        pub(super) use super::ask as rotor;
    }

    use ask as simulate;
    at_most!(one, then none: dipole spring rotor simulate);
    at_most!(two, then one: gravity_gradient dipole spring rotor simulate);
    at_most!(three, then two: gravity gravity_gradient dipole spring rotor simulate);
}
