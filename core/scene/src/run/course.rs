//! Samples, steps and event functions for the run of one body.

use liestep::groups::Advected;
use liestep::motion::{AnyState, AnyStepper, Integrator, Moment};
use liestep::{SO3, recording};
use nalgebra::Vector3;

use crate::file::event::{Direction, Event, Quantity};
use crate::file::sample::{BodySample, Sample};
use crate::file::scene::SceneFile;
use crate::run::make::{Course, EventFunction};

/// The stepper of a scene, and its initial state.
pub type MemberStart = (AnyStepper<SO3, ()>, AnyState<SO3, ()>);

/// The sample of one body at this moment.
pub(crate) fn sample<I: Integrator<Group = SO3>>(now: &Moment<'_, I>) -> Sample {
    let body = BodySample::turning(now.attitude(), now.velocity(), now.momentum());
    Sample {
        time: now.time(),
        energy: now.energy(),
        momentum: nalgebra::zero(),
        angular_momentum: body.matrix() * body.momentum,
        gap: 0.0,
        bodies: vec![body],
    }
}

/// The length and the table of a run with this many steps.
pub(crate) fn course(file: &SceneFile, steps: u64) -> Course<'_> {
    Course {
        steps,
        end: file.run.duration,
        stride: file.output.stride(steps),
        columns: file.columns(),
        listed: file.listed(),
    }
}

/// The events that a run detects.
pub(crate) fn watches<A: Advected<SO3> + 'static>(
    file: &SceneFile,
) -> Vec<(recording::Event, EventFunction<AnyStepper<SO3, A>>)> {
    let axis = file.picture.axis.0;
    let watch = |event: &Event| -> (_, EventFunction<_>) {
        let kind = kind(event.direction);
        (if event.stops { kind.terminal() } else { kind }, Box::new(function(event.quantity, axis)))
    };
    file.event.iter().map(watch).collect()
}

/// An event of a scene for the members of its ensemble: its name, its kind, the function that passes zero at the event,
/// and whether the event ends the motion.
pub type MemberEvent<I> = (String, recording::Event, Box<dyn Fn(&Moment<'_, I>) -> f64 + Send + Sync>, bool);

impl SceneFile {
    /// The events to be detected for the members of an ensemble.
    pub fn member_events<I: Integrator<Group = SO3>>(&self) -> impl Iterator<Item = MemberEvent<I>> {
        let axis = self.picture.axis.0;
        let of = move |Event { name, quantity, direction, stops }: &Event| -> MemberEvent<I> {
            (name.clone(), kind(*direction), Box::new(function(*quantity, axis)), *stops)
        };
        self.event.iter().map(of)
    }
}

/// The kind of event for a direction.
fn kind(direction: Direction) -> recording::Event {
    match direction {
        Direction::Rising => recording::Event::rising(),
        Direction::Falling => recording::Event::falling(),
        Direction::Either => recording::Event::crossing(),
    }
}

/// The function that rises through zero with the quantity through its value. A tilt is that of `axis`, body frame.
fn function<I: Integrator<Group = SO3>>(
    quantity: Quantity,
    axis: Vector3<f64>,
) -> impl Fn(&Moment<'_, I>) -> f64 + Send + Sync + 'static {
    move |now| match quantity {
        // The cosine is smooth at the vertical, unlike the angle.
        Quantity::Tilt(angle) => angle.cos() - (now.attitude().as_matrix() * axis).z,
        Quantity::Speed(speed) => now.velocity().norm_squared() - speed * speed,
        Quantity::Energy(energy) => now.energy() - energy,
        Quantity::Velocity(component, rate) => now.velocity()[component] - rate,
        Quantity::Axis(component, part) => (now.attitude().as_matrix() * axis)[component] - part,
    }
}
