//! What is kept of a run of one body, and the functions of its events.

use liestep::groups::Advected;
use liestep::motion::{AnyState, AnyStepper, Integrator, Moment};
use liestep::{SO3, recording};
use nalgebra::Vector3;

use crate::file::event::{Direction, Event, Quantity};
use crate::file::sample::{BodySample, Sample};
use crate::file::scene::SceneFile;
use crate::run::make::{Course, EventFunction};

/// What steps a scene, and the state that it starts from.
pub type MemberStart = (AnyStepper<SO3, ()>, AnyState<SO3, ()>);

/// The motion of one body now.
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

/// The length and the table of a run of this many steps.
pub(crate) fn course(file: &SceneFile, steps: u64) -> Course<'_> {
    Course {
        steps,
        end: file.run.duration,
        stride: file.output.stride(steps),
        columns: file.columns(),
        listed: file.listed(),
    }
}

/// The events that a run looks for.
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

/// An event of a scene for the members of its ensemble: its name, what counts, the function that passes zero there, and
/// whether the motion ends with it.
pub type MemberEvent<I> = (String, recording::Event, Box<dyn Fn(&Moment<'_, I>) -> f64 + Send + Sync>, bool);

impl SceneFile {
    /// The events that members are watched for.
    pub fn member_events<I: Integrator<Group = SO3>>(&self) -> impl Iterator<Item = MemberEvent<I>> {
        let axis = self.picture.axis.0;
        let of = move |Event { name, quantity, direction, stops }: &Event| -> MemberEvent<I> {
            (name.clone(), kind(*direction), Box::new(function(*quantity, axis)), *stops)
        };
        self.event.iter().map(of)
    }
}

/// What counts as the event.
fn kind(direction: Direction) -> recording::Event {
    match direction {
        Direction::Rising => recording::Event::rising(),
        Direction::Falling => recording::Event::falling(),
        Direction::Either => recording::Event::crossing(),
    }
}

/// The function that rises through zero as the quantity rises through its value; a tilt is that of this body axis.
fn function<I: Integrator<Group = SO3>>(
    quantity: Quantity,
    axis: Vector3<f64>,
) -> impl Fn(&Moment<'_, I>) -> f64 + Send + Sync + 'static {
    move |now| match quantity {
        // By the cosine, which is smooth at the vertical.
        Quantity::Tilt(angle) => angle.cos() - (now.attitude().as_matrix() * axis).z,
        Quantity::Speed(speed) => now.velocity().norm_squared() - speed * speed,
        Quantity::Energy(energy) => now.energy() - energy,
        Quantity::Velocity(component, rate) => now.velocity()[component] - rate,
        Quantity::Axis(component, part) => (now.attitude().as_matrix() * axis)[component] - part,
    }
}
