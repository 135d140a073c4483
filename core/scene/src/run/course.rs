//! Samples, steps and event functions for the run of one body.

use liestep::motion::{AnyMotion, AnyState, AnyStepper, Integrator, Moment};
use liestep::{SO3, recording};
use nalgebra::{Matrix3, Vector3};

use crate::file::event::{Direction, Event, Quantity};
use crate::file::sample::{BodySample, Sample};
use crate::file::scene::SceneFile;
use crate::run::make::{Course, EventFunction};

/// The stepper of a scene, and its initial state.
pub type MemberStart = (AnyStepper, AnyState);

/// An integrator of a body on SO(3).
pub trait Rotating: Integrator<Scalar = f64> {
    /// The attitude, body to space.
    fn attitude(motion: &Self::Motion) -> SO3;

    /// The angular momentum, body frame, kg m²/s.
    fn momentum(motion: &Self::Motion) -> Vector3<f64>;

    /// The angular velocity, body frame, rad/s.
    fn rate(velocity: Self::Velocity) -> Vector3<f64>;
}

impl Rotating for AnyStepper {
    fn attitude(motion: &AnyMotion) -> SO3 {
        SO3::from_matrix_unchecked(Matrix3::from_row_slice(motion.attitude()))
    }

    fn momentum(motion: &AnyMotion) -> Vector3<f64> {
        Vector3::from_column_slice(motion.momentum())
    }

    fn rate(velocity: Vec<f64>) -> Vector3<f64> {
        Vector3::from_column_slice(&velocity)
    }
}

/// The sample of one body at this moment.
pub(crate) fn sample<I: Rotating>(now: &Moment<'_, I>) -> Sample {
    let body = BodySample::turning(I::attitude(now), I::rate(now.velocity()), I::momentum(now));
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
pub(crate) fn watches(file: &SceneFile) -> Vec<(recording::Event, EventFunction<AnyStepper>)> {
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
    pub fn member_events<I: Rotating>(&self) -> impl Iterator<Item = MemberEvent<I>> {
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
fn function<I: Rotating>(
    quantity: Quantity,
    axis: Vector3<f64>,
) -> impl Fn(&Moment<'_, I>) -> f64 + Send + Sync + 'static {
    move |now| match quantity {
        // The cosine is smooth at the vertical, unlike the angle.
        Quantity::Tilt(angle) => angle.cos() - (I::attitude(now).as_matrix() * axis).z,
        Quantity::Speed(speed) => I::rate(now.velocity()).norm_squared() - speed * speed,
        Quantity::Energy(energy) => now.energy() - energy,
        Quantity::Velocity(component, rate) => I::rate(now.velocity())[component] - rate,
        Quantity::Axis(component, part) => (I::attitude(now).as_matrix() * axis)[component] - part,
    }
}
