//! Samples of one body, and the events of files.

use std::f64::consts::TAU;
use std::sync::Arc;

use liestep::groups::LieGroup as _;
use liestep::motion::{AnyMotion, AnyStepper, Integrator as _, Moment};
use liestep::{SO3, recording};
use nalgebra::{Matrix3, Vector3};

use crate::file::event::{Direction, Event, Quantity};
use crate::file::sample::{BodySample, Sample};
use crate::file::scene_file::SceneFile;
use crate::run::make::Watch;
use crate::run::motors::ENTRIES;
use crate::run::simulate::Sampler;
use crate::run::system::of_bodies;

/// The attitude of a body by its number, body to space.
fn attitude(motion: &AnyMotion, body: usize) -> SO3 {
    SO3::from_matrix_unchecked(Matrix3::from_row_slice(&motion.attitude()[ENTRIES * body..][..9]))
}

/// The angular velocity of a body by its number, body frame, rad/s.
fn rate(now: &Moment<'_, AnyStepper>, body: usize) -> Vector3<f64> {
    Vector3::from_column_slice(&now.velocity()[6 * body..][..3])
}

/// The sample of a scene at this moment.
pub(crate) fn sample(file: &SceneFile, now: &Moment<'_, AnyStepper>) -> Sample {
    if let Some(system) = &file.system {
        return of_bodies(system, file, now);
    }
    let group = &file.group;
    let (time, energy, gap, momentum) = (now.time(), now.energy(), 0.0, nalgebra::zero());
    let quaternions = Arc::clone(&group.quaternions);
    if group.is_rotation() {
        let body = BodySample::turning(attitude(now, 0), rate(now, 0), Vector3::from_column_slice(now.momentum()));
        let angular_momentum = body.matrix() * body.momentum;
        let vectors = [body.velocity, body.momentum, angular_momentum];
        let vectors = vectors.iter().flat_map(Vector3::as_slice);
        let ends = [energy, body.attitude.defect()];
        let seen = file.numbers(&[body], (time, now.numbers()));
        let numbers = body.quaternion.iter().chain(vectors).chain(&ends).chain(&seen).copied().collect();
        return Sample { time, energy, momentum, angular_momentum, gap, bodies: vec![body], numbers, quaternions };
    }
    let integrator = now.integrator();
    let (mut attitude, in_space) = (vec![0.0; group.attitude().len()], group.in_space());
    let mut numbers = vec![0.0; in_space.start + 2];
    integrator.write(now, &integrator.inertia(), &mut attitude, &mut numbers);
    numbers.splice(in_space.start..in_space.start, integrator.spatial_momentum(now));
    Sample { time, energy, momentum, angular_momentum: momentum, gap, bodies: Vec::new(), numbers, quaternions }
}

/// The kind of an event.
fn kind(event: &Event) -> recording::Event {
    let kind = match event.direction {
        Direction::Rising => recording::Event::rising(),
        Direction::Falling => recording::Event::falling(),
        Direction::Either => recording::Event::crossing(),
    };
    if let Quantity::Angle(..) = event.quantity { kind.period(TAU) } else { kind }
}

/// The event of a file, and the function that rises through zero with its quantity through its value. A tilt is that of an axis,
/// body frame.
pub(crate) fn watch(event: &Event, axis: Vector3<f64>, sampler: &Sampler) -> Watch {
    let (quantity, body, sampler) = (event.quantity, event.number, Arc::clone(sampler));
    let function = move |now: &Moment<'_, AnyStepper>| match quantity {
        // The cosine is smooth at the vertical, unlike the angle.
        Quantity::Tilt(angle) => angle.cos() - (attitude(now, body).as_matrix() * axis).z,
        Quantity::Speed(speed) => rate(now, body).norm_squared() - speed * speed,
        Quantity::Velocity(component, value) => rate(now, body)[component] - value,
        Quantity::Axis(component, part) => (attitude(now, body).as_matrix() * axis)[component] - part,
        Quantity::Energy(energy) => now.energy() - energy,
        Quantity::Column(place, value) => sampler(now).numbers[place] - value,
        Quantity::Angle(place, value) => {
            let turned = sampler(now).numbers[place] - value;
            turned - TAU * (turned / TAU).round()
        }
    };
    Watch { event: kind(event), function: Box::new(function), stops: event.stops }
}
