//! The picture of a run: a path, and curves over time.

use std::ops::Range;

use liestep::motion::Factor;
use liestep_plot::{
    Area, BLUE, Colour, GREEN, INK, Line, ORANGE, PURPLE, Panel, Path, PlotResult, SKY, VERMILION, Vertical, YELLOW,
    heading, legend, px, render, sphere,
};
use nalgebra::Vector3;

use crate::file::picture::{Curve, Picture, Plane, Trace};
use crate::file::sample::{BodySample, Sample};
use crate::file::scene::Scene;
use crate::file::scene_file::SceneFile;
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
        let subtitle = format!("{}, h = {step} s{}", self.file.sum(), run.average);
        self.file.drawn(run, &subtitle)
    }
}

impl SceneFile {
    fn drawn(&self, run: &Run, subtitle: &str) -> PlotResult<String> {
        let (picture, samples) = (&self.picture, run.samples());
        let names: Vec<_> = self.system.iter().flat_map(|system| system.names()).zip(colours()).collect();
        let default: &[Curve] = match &self.system {
            Some(_) => &[Curve::Turns, Curve::EnergyError],
            None if self.group.is_rotation() => &[Curve::Rates, Curve::Momentum, Curve::Energy],
            None => &[Curve::Attitude, Curve::Rates, Curve::Energy],
        };
        let curves = picture.panels.as_deref().unwrap_or(default);
        render((1200, 640), |area| {
            let (header, body) = area.split_vertically(px(if names.is_empty() { 64 } else { 88 }));
            heading(&header, &self.title, subtitle)?;
            legend(&header, (16, 74), &names)?;
            let panels = if self.group.is_rotation() {
                let (left, right) = body.split_horizontally(px(520));
                if self.system.is_some() {
                    picture.draw_ways(&left, samples)
                } else {
                    picture.draw_path(&left, samples)
                }?;
                right
            } else {
                body
            };
            let places = panels.split_evenly((curves.len().max(1), 1));
            places.iter().zip(curves).try_for_each(|(place, curve)| curve.draw(place, samples, self))
        })
    }

    /// The places of the momentum in space among the numbers of a sample, of several bodies that of the angular momentum.
    fn in_space(&self) -> Range<usize> {
        match &self.system {
            Some(system) => system.joint_columns() - 4..system.joint_columns() - 1,
            None => self.group.in_space(),
        }
    }
}

fn colours() -> impl Iterator<Item = Colour> {
    BODY_COLOURS.into_iter().cycle()
}

/// The ways of bodies, by the coordinates of each in a sample.
fn of_bodies(samples: &[Sample], point: &dyn Fn(&Sample, usize) -> (f64, f64)) -> Vec<Line> {
    let points = |body| samples.iter().map(|sample| point(sample, body)).collect();
    let bodies = samples.first().map_or(0, |start| start.bodies.len());
    (0..bodies).zip(colours()).map(|(body, colour)| Line { colour, width: 3, points: points(body) }).collect()
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

impl Picture {
    fn draw_ways(&self, area: &Area<'_>, samples: &[Sample]) -> PlotResult {
        let ([across, up], axes) = match self.plane.unwrap_or_else(|| plane_of(samples)) {
            Plane::Xy => (["x, m", "y, m"], [0, 1]),
            Plane::Xz => (["x, m", "z, m"], [0, 2]),
            Plane::Yz => (["y, m", "z, m"], [1, 2]),
        };
        let lines = of_bodies(samples, &|sample, body| axes.map(|axis| sample.bodies[body].position[axis]).into());
        let title = "Ways of the centres of mass";
        Panel { title, across, up, vertical: Vertical::Linear, function: false, lines }.draw(area)
    }

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
    fn draw(self, area: &Area<'_>, samples: &[Sample], file: &SceneFile) -> PlotResult {
        let (group, axis, in_space) = (&file.group, file.picture.axis.0, file.in_space());
        let Some(start) = samples.first() else {
            return Ok(());
        };
        let one = |title, up, vertical, height: &dyn Fn(&Sample) -> f64| {
            over_time(title, up, vertical, samples, height).draw(area)
        };
        let several = |title, up, part: Range<usize>, names: &[&str]| {
            let lines = part.clone().zip(colours());
            let lines = lines.map(|(place, colour)| line(samples, colour, &|s| s.numbers[place])).collect();
            Panel::over_time(title, up, Vertical::Linear, lines).draw(area)?;
            let entries: Vec<_> = names.iter().copied().zip(colours()).take(MOST_NAMES).collect();
            legend(area, (500, 12), &entries)
        };
        let each = |title, up, height: &dyn Fn(&BodySample, &BodySample) -> f64| {
            let lines = of_bodies(samples, &|s, body| (s.time, height(&s.bodies[body], &start.bodies[body])));
            Panel::over_time(title, up, Vertical::Linear, lines).draw(area)
        };
        let away = |s: &Sample| {
            let pairs = s.numbers[in_space.clone()].iter().zip(&start.numbers[in_space.clone()]);
            pairs.map(|(now, start)| (now - start).powi(2)).sum::<f64>().sqrt()
        };
        let along = |s: &Sample| (s.angular_momentum - start.angular_momentum).z.abs();
        let tilt = |body: &BodySample, _: &BodySample| (body.matrix() * axis).angle(&Vector3::z()).to_degrees();
        let turned = |now: &BodySample, before: &BodySample| {
            let cosine = ((before.matrix().transpose() * now.matrix()).trace() - 1.0) / 2.0;
            cosine.clamp(-1.0, 1.0).acos().to_degrees()
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
            Self::Rates if file.system.is_some() => each("Angular velocities", rate, &|body, _| body.velocity.norm()),
            Self::Rates => several(
                titled("Angular velocity in the body", "Velocity of the body"),
                rate,
                group.velocity(),
                components,
            ),
            Self::Tilt => each("Tilt of the axis from e₃", "degrees", &tilt),
            Self::Turns => each("Turned from the start by", "degrees", &turned),
            Self::Energy => one("Energy", joules, Vertical::Linear, &|s| s.energy),
            Self::EnergyError => one("Energy: how far from its start", joules, Vertical::Logarithmic, &|s| {
                (s.energy - start.energy).abs()
            }),
            Self::Momentum => {
                several(titled("Angular momentum in space", "Momentum in space"), unit, in_space, components)
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
