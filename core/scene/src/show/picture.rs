//! The picture of a run: a path, and curves over time.

use std::ops::Range;

use liestep::motion::Factor;
use liestep_plot::{
    Area, BLUE, Colour, GREEN, INK, Line, ORANGE, PURPLE, Panel, Path, PlotResult, SKY, VERMILION, Vertical, YELLOW,
    heading, legend, px, render, sphere,
};
use nalgebra::Vector3;

use crate::file::common::Parts as _;
use crate::file::group::Group;
use crate::file::kinds::{Scene, of_parts};
use crate::file::picture::{Curve, Plane, SpherePicture, Trace};
use crate::file::sample::Sample;
use crate::file::scene::SceneFile;
use crate::file::system::System;
use crate::run::make::Run;

/// Colours of bodies and of a vector's components, which further ones repeat.
const BODY_COLOURS: [Colour; 8] = [BLUE, ORANGE, GREEN, PURPLE, SKY, VERMILION, INK, YELLOW];

impl Scene {
    /// The picture of a run as SVG: of several bodies the paths of their centres of mass, the angle of each body's turn since the
    /// start, and the change of the energy.
    ///
    /// # Errors
    ///
    /// Only errors of the drawing library, for an impossible layout.
    pub fn picture(&self, run: &Run) -> PlotResult<String> {
        // A step that was chosen for an accuracy has more digits than are useful.
        let step = format!("{:.4e}", run.step()).parse().unwrap_or(run.step());
        let subtitle = format!("{}, h = {step} s{}", of_parts!(self, parts => parts.sum()), run.average);
        of_parts!(self, parts => parts.drawn(run, &subtitle))
    }
}

impl SceneFile {
    fn drawn(&self, run: &Run, subtitle: &str) -> PlotResult<String> {
        let (picture, samples) = (&self.picture, run.samples());
        let curve = |curve: &Curve, area: &Area<'_>| curve.draw(area, samples, (&self.group, &picture.axis.0));
        if !self.group.is_rotation() {
            return render((1200, 640), |area| {
                let (header, body) = area.split_vertically(px(64));
                heading(&header, &self.title, subtitle)?;
                let places = body.split_evenly((picture.panels.len().max(1), 1));
                places.iter().zip(&picture.panels).try_for_each(|(place, panel)| curve(panel, place))
            });
        }
        let path = |area: &Area<'_>| picture.draw_path(area, samples);
        draw((&self.title, subtitle), &[], path, &picture.panels, curve)
    }
}

impl System {
    fn drawn(&self, run: &Run, subtitle: &str) -> PlotResult<String> {
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
        draw((&self.title, subtitle), &names, path, &[turns, energy], Panel::draw)
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

/// Most lines with names of their own in a legend.
const MOST_NAMES: usize = 8;

impl Curve {
    fn draw(self, area: &Area<'_>, samples: &[Sample], (group, axis): (&Group, &Vector3<f64>)) -> PlotResult {
        let Some(start) = samples.first() else {
            return Ok(());
        };
        let one = |title, up, vertical, height: &dyn Fn(&Sample) -> f64| {
            over_time(title, up, vertical, samples, height).draw(area)
        };
        let several = |title, up, part: Range<usize>, names: &[&str]| {
            let colours = || BODY_COLOURS.into_iter().cycle();
            let lines = part.clone().zip(colours());
            let lines = lines.map(|(place, colour)| line(samples, colour, &|s| s.numbers[place])).collect();
            Panel::over_time(title, up, Vertical::Linear, lines).draw(area)?;
            let entries: Vec<_> = names.iter().copied().zip(colours()).take(MOST_NAMES).collect();
            legend(area, (500, 12), &entries)
        };
        let away = |s: &Sample| {
            let pairs = s.numbers[group.in_space()].iter().zip(&start.numbers[group.in_space()]);
            pairs.map(|(now, start)| (now - start).powi(2)).sum::<f64>().sqrt()
        };
        let along = |s: &Sample| (s.angular_momentum - start.angular_momentum).z.abs();
        let tilt = |s: &Sample| match s.bodies.first() {
            Some(body) => (body.matrix() * axis).angle(&Vector3::z()).to_degrees(),
            None => f64::NAN,
        };
        let is_body = group.is_rotation();
        let (unit, rate) = if is_body { ("kg m²/s", "rad/s") } else { ("", "") };
        let joules = group.unit_of_energy();
        let components: Vec<&str> =
            group.factors.iter().flat_map(|factor| &factor.components).map(|(name, _)| name.as_str()).collect();
        let components: &[&str] = if is_body { &["1", "2", "3"] } else { &components };
        let titled = |of_body, of_group| if is_body { of_body } else { of_group };
        match self {
            Self::Attitude => {
                let columns: Vec<_> = group.factors.iter().flat_map(Factor::columns).collect();
                let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
                several("Attitude", "", group.attitude(), &names)
            }
            Self::Rates => several(
                titled("Angular velocity in the body", "Velocity of the body"),
                rate,
                group.velocity(),
                components,
            ),
            Self::Tilt => one("Tilt of the axis from e₃", "degrees", Vertical::Linear, &tilt),
            Self::Energy => one("Energy", joules, Vertical::Linear, &|s| s.energy),
            Self::EnergyError => one("Energy: how far from its start", joules, Vertical::Logarithmic, &|s| {
                (s.energy - start.energy).abs()
            }),
            Self::Momentum => {
                several(titled("Angular momentum in space", "Momentum in space"), unit, group.in_space(), components)
            }
            Self::VerticalMomentumError => {
                one("Angular momentum along e₃: how far from its start", unit, Vertical::Logarithmic, &along)
            }
            Self::MomentumError => {
                let of_group = "Momentum in space: how far from its start";
                let title = titled("Angular momentum in space: how far from its start", of_group);
                one(title, unit, Vertical::Logarithmic, &away)
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
