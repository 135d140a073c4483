//! The picture of a system: the ways of its bodies, and quantities over time.

use liestep_plot::{
    BLUE, Colour, GREEN, INK, Line, ORANGE, PURPLE, Panel, SKY, VERMILION, Vertical, YELLOW, heading, legend, px,
    render,
};
use nalgebra::Vector3;

use crate::file::arrangement::BODIES;
use crate::file::picture::Plane;
use crate::file::sample::Sample;
use crate::file::system::System;
use crate::run::make::Run;

/// One for each body.
const COLOURS: [Colour; BODIES] = [BLUE, ORANGE, GREEN, PURPLE, SKY, VERMILION, INK, YELLOW];

impl System {
    /// The picture of a run as SVG: the ways of the centres of mass, how far each body is turned from its start, and how
    /// far the energy is from its start.
    ///
    /// # Errors
    ///
    /// None but of the drawing library, for an impossible layout.
    pub fn picture(&self, run: &Run) -> Result<String, Box<dyn std::error::Error>> {
        let samples = run.samples();
        let Some(start) = samples.first() else { return Err("a run has a state".into()) };
        let ([across, up], axes) = match self.picture.plane {
            Plane::Xy => (["x, m", "y, m"], [0, 1]),
            Plane::Xz => (["x, m", "z, m"], [0, 2]),
            Plane::Yz => (["y, m", "z, m"], [1, 2]),
        };
        let of_bodies = |point: &dyn Fn(&Sample, usize) -> (f64, f64)| -> Vec<Line> {
            let line = |(body, colour): (usize, &Colour)| Line {
                colour: *colour,
                width: 3,
                points: samples.iter().map(|sample| point(sample, body)).collect(),
            };
            (0..self.bodies.len()).zip(&COLOURS).map(line).collect()
        };
        let way = |sample: &Sample, body: usize| {
            let place: Vector3<f64> = sample.bodies[body].position;
            (place[axes[0]], place[axes[1]])
        };
        let turn = |sample: &Sample, body: usize| {
            let [now, before] = [sample, start].map(|sample| sample.bodies[body].attitude);
            let cosine = ((before.as_matrix().transpose() * now.as_matrix()).trace() - 1.0) / 2.0;
            (sample.time, cosine.clamp(-1.0, 1.0).acos().to_degrees())
        };
        let error = |sample: &Sample| (sample.time, (sample.energy - start.energy).abs());
        let energy = vec![Line { colour: BLUE, width: 3, points: samples.iter().map(error).collect() }];
        let panels = [
            Panel::over_time("Turned from the start by", "degrees", Vertical::Linear, of_bodies(&turn)),
            Panel::over_time("Energy: how far from its start", "J", Vertical::Logarithmic, energy),
        ];
        let ways = Panel {
            title: "Ways of the centres of mass",
            across,
            up,
            vertical: Vertical::Linear,
            function: false,
            lines: of_bodies(&way),
        };
        let names: Vec<_> = self.names().zip(COLOURS).collect();
        render((1200, 640), |area| {
            let (header, body) = area.split_vertically(px(88));
            heading(&header, &self.title, &format!("{}, h = {} s", self.sum(), self.step))?;
            legend(&header, (16, 74), &names)?;
            let (left, right) = body.split_horizontally(px(520));
            ways.draw(&left)?;
            for (place, panel) in right.split_evenly((panels.len(), 1)).iter().zip(&panels) {
                panel.draw(place)?;
            }
            Ok(())
        })
    }
}
