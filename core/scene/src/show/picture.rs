//! The picture of a run: a path, and curves over time.

use liestep_plot::{
    Area, BLUE, Colour, GREEN, INK, Line, ORANGE, PURPLE, Panel, Path, PlotResult, SKY, VERMILION, Vertical, YELLOW,
    heading, legend, px, render, sphere,
};
use nalgebra::Vector3;

use crate::file::picture::{Curve, Plane, SpherePicture, Trace};
use crate::file::sample::Sample;
use crate::file::scene::SceneFile;
use crate::file::system::System;
use crate::run::make::Run;

/// Colours of a vector's components.
const COLOURS: [Colour; 3] = [BLUE, ORANGE, GREEN];
/// Colours of bodies, which further bodies repeat.
const BODY_COLOURS: [Colour; 8] = [BLUE, ORANGE, GREEN, PURPLE, SKY, VERMILION, INK, YELLOW];

impl SceneFile {
    /// The picture of a run as SVG.
    ///
    /// # Errors
    ///
    /// Only errors of the drawing library, for an impossible layout.
    pub fn picture(&self, run: &Run) -> PlotResult<String> {
        let (picture, samples) = (&self.picture, run.samples());
        // A step that was chosen for an accuracy has more digits than are useful.
        let step = format!("{:.4e}", run.step()).parse().unwrap_or(run.step());
        let subtitle = format!("{}, h = {step} s{}", self.sum(), run.average);
        let path = |area: &Area<'_>| picture.draw_path(area, samples);
        let curve = |curve: &Curve, area: &Area<'_>| curve.draw(area, samples, &picture.axis.0);
        draw((&self.title, &subtitle), &[], path, &picture.panels, curve)
    }
}

impl System {
    /// The picture of a run as SVG: the paths of the centres of mass, the angle of each body's turn since the start,
    /// and the change of the energy.
    ///
    /// # Errors
    ///
    /// Only errors of the drawing library, for an impossible layout.
    pub fn picture(&self, run: &Run) -> PlotResult<String> {
        let samples = run.samples();
        let Some(start) = samples.first() else { return Err("a run has a state".into()) };
        let ([across, up], axes) = match self.picture.plane.unwrap_or_else(|| plane_of(samples)) {
            Plane::Xy => (["x, m", "y, m"], [0, 1]),
            Plane::Xz => (["x, m", "z, m"], [0, 2]),
            Plane::Yz => (["y, m", "z, m"], [1, 2]),
        };
        let names: Vec<_> = self.names().zip(BODY_COLOURS.into_iter().cycle()).collect();
        let of_bodies = |point: &dyn Fn(&Sample, usize) -> (f64, f64)| -> Vec<Line> {
            let points = |body| samples.iter().map(|sample| point(sample, body)).collect();
            let bodies = names.iter().enumerate();
            bodies.map(|(body, (_, colour))| Line { colour: *colour, width: 3, points: points(body) }).collect()
        };
        let place = |sample: &Sample, body: usize| {
            let position = sample.bodies[body].position;
            (position[axes[0]], position[axes[1]])
        };
        let turn = |sample: &Sample, body: usize| {
            let [now, before] = [sample, start].map(|sample| sample.bodies[body].attitude);
            let cosine = ((before.as_matrix().transpose() * now.as_matrix()).trace() - 1.0) / 2.0;
            (sample.time, cosine.clamp(-1.0, 1.0).acos().to_degrees())
        };
        let path = |area: &Area<'_>| {
            let (title, lines) = ("Ways of the centres of mass", of_bodies(&place));
            Panel { title, across, up, vertical: Vertical::Linear, function: false, lines }.draw(area)
        };
        let turns = Panel::over_time("Turned from the start by", "degrees", Vertical::Linear, of_bodies(&turn));
        let energy = over_time("Energy: how far from its start", "J", Vertical::Logarithmic, samples, &|sample| {
            (sample.energy - start.energy).abs()
        });
        let subtitle = format!("{}, h = {} s", self.sum(), self.step);
        draw((&self.title, &subtitle), &names, path, &[turns, energy], Panel::draw)
    }
}

/// The plane across the direction in which positions vary the least. Among equal directions y comes first, then x.
fn plane_of(samples: &[Sample]) -> Plane {
    let spread = |axis: usize| {
        let places = samples.iter().flat_map(|sample| &sample.bodies).map(|body| body.position[axis]);
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        high - low
    };
    let [x, y, z] = [0, 1, 2].map(spread);
    // Ranges that differ by rounding errors are equal.
    let least = x.min(y).min(z) + 1e-9 * x.max(y).max(z);
    match (y <= least, x <= least) {
        (true, _) => Plane::Xz,
        (_, true) => Plane::Yz,
        _ => Plane::Xy,
    }
}

/// A heading with a legend of the bodies, a path on the left, and curves below each other on the right.
fn draw<C>(
    (title, subtitle): (&str, &str),
    bodies: &[(&str, Colour)],
    path: impl Fn(&Area<'_>) -> PlotResult,
    curves: &[C],
    curve: impl Fn(&C, &Area<'_>) -> PlotResult,
) -> PlotResult<String> {
    render((1200, 640), |area| {
        let (header, body) = area.split_vertically(px(if bodies.is_empty() { 64 } else { 88 }));
        heading(&header, title, subtitle)?;
        legend(&header, (16, 74), bodies)?;
        let (left, right) = body.split_horizontally(px(520));
        path(&left)?;
        for (place, which) in right.split_evenly((curves.len().max(1), 1)).iter().zip(curves) {
            curve(which, place)?;
        }
        Ok(())
    })
}

impl SpherePicture {
    fn draw_path(&self, area: &Area<'_>, samples: &[Sample]) -> PlotResult {
        let axis = self.axis.0;
        let point = |s: &Sample| match self.path {
            Trace::Axis => s.bodies[0].matrix() * axis,
            Trace::Momentum => s.bodies[0].momentum.normalize(),
            Trace::Velocity => s.bodies[0].velocity.normalize(),
        };
        let points: Vec<_> = samples.iter().map(point).collect();
        let title = match self.path {
            Trace::Axis => "Path of the body's axis in space",
            Trace::Momentum => "Path of the angular momentum in the body",
            Trace::Velocity => "Path of the angular velocity in the body",
        };
        sphere(area, &Path { title, colour: PURPLE, width: 2, points: &points, axis: (Vector3::z(), "e₃") })
    }
}

impl Curve {
    fn draw(self, area: &Area<'_>, samples: &[Sample], axis: &Vector3<f64>) -> PlotResult {
        let Some(start) = samples.first() else {
            return Ok(());
        };
        let one = |title, up, vertical, height: &dyn Fn(&Sample) -> f64| {
            over_time(title, up, vertical, samples, height).draw(area)
        };
        let three = |title, up, vector: &dyn Fn(&Sample) -> Vector3<f64>| {
            let lines = COLOURS.iter().enumerate();
            let lines = lines.map(|(k, colour)| line(samples, *colour, &|s| vector(s)[k])).collect();
            Panel::over_time(title, up, Vertical::Linear, lines).draw(area)?;
            let names = ["1", "2", "3"];
            let entries: Vec<_> = names.into_iter().zip(COLOURS).collect();
            legend(area, (500, 12), &entries)
        };
        let along = |s: &Sample| (s.angular_momentum - start.angular_momentum).z.abs();
        let away = |s: &Sample| (s.angular_momentum - start.angular_momentum).norm();
        let tilt = |s: &Sample| (s.bodies[0].matrix() * axis).angle(&Vector3::z()).to_degrees();
        let unit = "kg m²/s";
        match self {
            Self::Rates => three("Angular velocity in the body", "rad/s", &|s| s.bodies[0].velocity),
            Self::Tilt => one("Tilt of the axis from e₃", "degrees", Vertical::Linear, &tilt),
            Self::Energy => one("Energy", "J", Vertical::Linear, &|s| s.energy),
            Self::EnergyError => {
                one("Energy: how far from its start", "J", Vertical::Logarithmic, &|s| (s.energy - start.energy).abs())
            }
            Self::Momentum => three("Angular momentum in space", unit, &|s| s.angular_momentum),
            Self::VerticalMomentumError => {
                one("Angular momentum along e₃: how far from its start", unit, Vertical::Logarithmic, &along)
            }
            Self::MomentumError => {
                one("Angular momentum in space: how far from its start", unit, Vertical::Logarithmic, &away)
            }
        }
    }
}

fn line(samples: &[Sample], colour: Colour, height: &dyn Fn(&Sample) -> f64) -> Line {
    Line { colour, width: 3, points: samples.iter().map(|s| (s.time, height(s))).collect() }
}

/// A panel with one curve.
fn over_time<'a>(
    title: &'a str,
    up: &'a str,
    vertical: Vertical,
    samples: &[Sample],
    height: &dyn Fn(&Sample) -> f64,
) -> Panel<'a> {
    Panel::over_time(title, up, vertical, vec![line(samples, BLUE, height)])
}
