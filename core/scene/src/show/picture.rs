//! The picture of a scene: a path on the sphere, and quantities over time.

use liestep_plot::{
    Area, BLUE, Colour, GREEN, Line, ORANGE, PURPLE, Panel, Path, PlotResult, Vertical, heading, legend, px, render,
    sphere,
};
use nalgebra::Vector3;

use crate::file::picture::{Curve, SpherePicture, Trace};
use crate::file::sample::Sample;
use crate::file::scene::SceneFile;
use crate::run::make::Run;

const COLOURS: [Colour; 3] = [BLUE, ORANGE, GREEN];

impl SceneFile {
    /// The picture of a run as SVG.
    ///
    /// # Errors
    ///
    /// None but of the drawing library, for an impossible layout.
    pub fn picture(&self, run: &Run) -> Result<String, Box<dyn std::error::Error>> {
        draw(self, run)
    }
}

fn draw(file: &SceneFile, run: &Run) -> PlotResult<String> {
    let (picture, samples) = (&file.picture, run.samples());
    render((1200, 640), |area| {
        let (header, body) = area.split_vertically(px(64));
        // A step that was chosen for an accuracy has more digits than anyone reads.
        let step = format!("{:.4e}", run.step()).parse().unwrap_or(run.step());
        let subtitle = format!("{}, h = {step} s", file.sum());
        heading(&header, &file.title, &subtitle)?;
        let (left, right) = body.split_horizontally(px(520));
        picture.draw_path(&left, samples)?;
        let panels = picture.panels.as_slice();
        for (place, quantity) in right.split_evenly((panels.len().max(1), 1)).iter().zip(panels) {
            quantity.draw(place, samples, &picture.axis.0)?;
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
            Panel::over_time(title, up, vertical, vec![line(samples, BLUE, height)]).draw(area)
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
