//! Samples, steps and event functions for the run of one body.

use std::sync::Arc;

use liestep::groups::LieGroup as _;
use liestep::motion::{AnyMotion, AnyState, AnyStepper, Integrator, Moment};
use liestep::{SO3, recording};
use nalgebra::{Matrix3, Vector3};

use crate::file::event::{Direction, Event, Quantity};
use crate::file::pointing::View;
use crate::file::sample::{BodySample, Sample};
use crate::file::scene::SceneFile;
use crate::run::make::{Course, EventFunction};

/// The stepper of a scene, and its initial state.
pub type MemberStart = (AnyStepper, AnyState);

/// An integrator of a body on SO(3).
pub trait BodyIntegrator: Integrator<Scalar = f64> {
    /// The attitude, body to space.
    fn attitude(motion: &Self::Motion) -> SO3;

    /// The angular momentum, body frame, kg m²/s.
    fn momentum(motion: &Self::Motion) -> Vector3<f64>;

    /// All numbers of the state.
    fn numbers(motion: &Self::Motion) -> &[f64];

    /// The angular velocity, body frame, rad/s.
    fn rate(velocity: Self::Velocity) -> Vector3<f64>;

    /// The components of the momentum in space, on any group.
    fn in_space(now: &Moment<'_, Self>) -> Vec<f64>;
}

impl BodyIntegrator for AnyStepper {
    fn attitude(motion: &AnyMotion) -> SO3 {
        SO3::from_matrix_unchecked(Matrix3::from_row_slice(motion.attitude()))
    }

    fn momentum(motion: &AnyMotion) -> Vector3<f64> {
        Vector3::from_column_slice(motion.momentum())
    }

    fn numbers(motion: &AnyMotion) -> &[f64] {
        motion.numbers()
    }

    fn rate(velocity: Vec<f64>) -> Vector3<f64> {
        Vector3::from_column_slice(&velocity)
    }

    fn in_space(now: &Moment<'_, Self>) -> Vec<f64> {
        now.integrator().spatial_momentum(now)
    }
}

/// The sample of a scene with these numbers at this moment.
pub(crate) fn sample<I: BodyIntegrator>(view: &View, now: &Moment<'_, I>) -> Sample {
    let group = &view.group;
    let (time, energy, gap, momentum) = (now.time(), now.energy(), 0.0, nalgebra::zero());
    let quaternions = Arc::clone(&group.quaternions);
    if group.is_rotation() {
        let body = BodySample::turning(I::attitude(now), I::rate(now.velocity()), I::momentum(now));
        let angular_momentum = body.matrix() * body.momentum;
        let vectors = [body.velocity, body.momentum, angular_momentum];
        let vectors = vectors.iter().flat_map(Vector3::as_slice);
        let ends = [energy, body.attitude.defect()];
        let seen = view.numbers((&body.matrix(), &body.velocity), (time, I::numbers(now)));
        let numbers = body.quaternion.iter().chain(vectors).chain(&ends).chain(&seen).copied().collect();
        return Sample { time, energy, momentum, angular_momentum, gap, bodies: vec![body], numbers, quaternions };
    }
    let integrator = now.integrator();
    let (mut attitude, in_space) = (vec![0.0; group.attitude().len()], group.in_space());
    let mut numbers = vec![0.0; in_space.start + 2];
    integrator.write(now, &integrator.inertia(), &mut attitude, &mut numbers);
    numbers.splice(in_space.start..in_space.start, I::in_space(now));
    Sample { time, energy, momentum, angular_momentum: momentum, gap, bodies: Vec::new(), numbers, quaternions }
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
    let watch = |event: &Event| -> (_, EventFunction<_>) {
        let kind = kind(event.direction);
        (if event.stops { kind.terminal() } else { kind }, Box::new(function(event.quantity, file)))
    };
    file.event.iter().map(watch).collect()
}

/// An event of a scene for the members of its ensemble: its name, its kind, the function that passes zero at the event,
/// and whether the event ends the motion.
pub type MemberEvent<I> = (String, recording::Event, Box<dyn Fn(&Moment<'_, I>) -> f64 + Send + Sync>, bool);

impl SceneFile {
    /// The events to be detected for the members of an ensemble.
    pub fn member_events<I: BodyIntegrator>(&self) -> impl Iterator<Item = MemberEvent<I>> {
        let of = move |Event { name, quantity, direction, stops, .. }: &Event| -> MemberEvent<I> {
            (name.clone(), kind(*direction), Box::new(function(*quantity, self)), *stops)
        };
        self.event.iter().map(of)
    }
}

/// The kind of event for a direction.
pub(crate) fn kind(direction: Direction) -> recording::Event {
    match direction {
        Direction::Rising => recording::Event::rising(),
        Direction::Falling => recording::Event::falling(),
        Direction::Either => recording::Event::crossing(),
    }
}

/// The function that rises through zero with the quantity through its value. A tilt is that of the picture's axis, body
/// frame.
fn function<I: BodyIntegrator>(
    quantity: Quantity,
    file: &SceneFile,
) -> impl Fn(&Moment<'_, I>) -> f64 + Send + Sync + use<I> + 'static {
    let (axis, view) = (file.picture.axis.0, file.view());
    move |now| match quantity {
        // The cosine is smooth at the vertical, unlike the angle.
        Quantity::Tilt(angle) => angle.cos() - (I::attitude(now).as_matrix() * axis).z,
        Quantity::Speed(speed) => I::rate(now.velocity()).norm_squared() - speed * speed,
        Quantity::Velocity(component, rate) => I::rate(now.velocity())[component] - rate,
        Quantity::Axis(component, part) => (I::attitude(now).as_matrix() * axis)[component] - part,
        Quantity::Energy(_) | Quantity::Column(..) => of_any(quantity, now, || sample(&view, now)),
    }
}

/// The function of a quantity that all scenes have; NaN for one of a single body.
pub(crate) fn of_any<I: Integrator<Scalar = f64>>(
    quantity: Quantity,
    now: &Moment<'_, I>,
    sample: impl Fn() -> Sample,
) -> f64 {
    match quantity {
        Quantity::Energy(energy) => now.energy() - energy,
        Quantity::Column(place, value) => sample().numbers[place] - value,
        _ => f64::NAN,
    }
}
