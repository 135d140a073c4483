//! Figures 3.4 to 3.10 of the thesis, reproduced.

use nalgebra::Vector3;

use super::cases::{Case, Reading};
use super::quantities::{Quantities, Series};
use crate::output::Output;
use crate::plot::{Area, BLUE, GREEN, Line, PURPLE, Panel, Path, PlotResult, Vertical, heading, legend, px};
use crate::plot::{render, sphere};
use crate::run::{ENDING, Schedule};
use crate::table::short;

/// The content of the figures: the variational run first, then its rivals.
pub struct Figures<'a> {
    pub case: Case,
    pub reading: Reading,
    pub schedule: Schedule,
    pub series: &'a [Series],
}

/// The duration of close-ups, s: ten nutations.
const SHORT: f64 = 4.0;

/// The height of a figure's heading, px.
const HEADER: u32 = 62;

impl Figures<'_> {
    /// Writes all figures except the overview.
    pub fn write(&self, output: &mut Output) -> PlotResult {
        output.write("geometry.svg", &self.rigidity()?)?;
        output.write("vertical-momentum.svg", &self.momentum()?)?;
        output.write("energy.svg", &self.energy()?)?;
        output.write("body-rates.svg", &self.body_rates()?)?;
        self.write_tip(output)
    }

    /// Writes the path of the tip, figure 3.8, 3.9 or 3.10.
    pub fn write_tip(&self, output: &mut Output) -> PlotResult {
        output.write(&format!("tip-{}.svg", self.case), &self.tip()?)?;
        Ok(())
    }

    /// The case, the reading and the step, as printed beside every figure.
    pub fn setting(&self) -> String {
        let in_fact = if self.case.caveat(self.reading).is_some() { " (here looping)" } else { "" };
        format!("{}{in_fact}, {}, h = {} s", self.case, self.reading, self.schedule.step)
    }

    /// The names and colours of all series.
    pub fn legend(&self, area: &Area<'_>, place: (u32, u32)) -> PlotResult {
        let entries: Vec<_> = self.series.iter().map(|s| (s.name, s.colour)).collect();
        legend(area, place, &entries)
    }

    pub fn geometry<'a>(&self, title: &'a str) -> Panel<'a> {
        let lines = self.lines(self.schedule.end(), |q, _| q.defect);
        Panel::over_time(title, "‖RᵀR − I‖", Vertical::Logarithmic, lines)
    }

    pub fn vertical_momentum<'a>(&self, title: &'a str) -> Panel<'a> {
        let lines = self.lines(self.schedule.end(), |q, start| (q.vertical - start.vertical).abs());
        Panel::over_time(title, "|e₃·RΠ − its start|, kg m²/s", Vertical::Logarithmic, lines)
    }

    /// The oscillation of the variational energy, which is of the order of the scheme.
    pub fn energy_short<'a>(&self, title: &'a str) -> Panel<'a> {
        let mut lines = self.lines(SHORT.min(self.schedule.end()), |q, start| q.energy - start.energy);
        // The rivals' lines coincide here.
        lines.iter_mut().take(1).for_each(|line| line.width = 7);
        Panel::over_time(title, "E − E(0), J", Vertical::Linear, lines)
    }

    /// The absolute energy error over the whole run, where an oscillation differs from a drift.
    pub fn energy_long<'a>(&self, title: &'a str) -> Panel<'a> {
        let mut lines = self.lines(self.schedule.end(), |q, start| (q.energy - start.energy).abs());
        // The oscillation would cover the rivals' drift.
        lines.reverse();
        Panel::over_time(title, "|E − E(0)|, J", Vertical::Logarithmic, lines)
    }

    /// The last seconds of the tip's path, in angles, where single loops and cusps are visible.
    pub fn close_up<'a>(&self, title: &'a str, series: &Series) -> Panel<'a> {
        let end = self.schedule.end();
        let points = unwound(series.between((end - SHORT).max(0.0), end));
        Panel {
            title,
            across: "azimuth of the tip, degrees",
            up: "tilt from the vertical, degrees",
            vertical: Vertical::Linear,
            function: false,
            lines: vec![Line { colour: series.colour, width: 3, points }],
        }
    }

    pub fn close_up_title(&self) -> String {
        format!("Its last {} s", short(SHORT.min(self.schedule.end())))
    }

    /// The second half of the run, as the thesis' 100 to 200 s, but only the part that is recorded in detail.
    pub fn late(&self) -> (f64, f64) {
        let end = self.schedule.end();
        ((end / 2.0).max(end - ENDING), end)
    }

    /// A line for every method, of a quantity as a function of its current and its initial state.
    fn lines(&self, end: f64, height: impl Fn(&Quantities, &Quantities) -> f64) -> Vec<Line> {
        // The variational line comes first in the legend and last, on top, in the drawing.
        let lines = self.series.iter().rev().map(|s| Line {
            colour: s.colour,
            width: 3,
            points: s.between(0.0, end).iter().map(|q| (q.time, height(q, &s.first()))).collect(),
        });
        lines.collect()
    }

    /// Figure 3.4: the distance of `R` from the rotations.
    pub fn rigidity(&self) -> PlotResult<String> {
        self.single(&[self.geometry("")], "3.4", "How far R leaves the rotations")
    }

    /// Figure 3.5: the momentum about the vertical.
    pub fn momentum(&self) -> PlotResult<String> {
        self.single(&[self.vertical_momentum("")], "3.5", "Angular momentum about the vertical")
    }

    /// Figure 3.6, (a) and (b): the energy.
    pub fn energy(&self) -> PlotResult<String> {
        let end = self.schedule.end();
        let [short, long] = [format!("(a) the first {} s", short(SHORT.min(end))), format!("(b) all {} s", short(end))];
        self.single(&[self.energy_short(&short), self.energy_long(&long)], "3.6", "Energy")
    }

    fn single(&self, panels: &[Panel<'_>], figure: &str, title: &str) -> PlotResult<String> {
        let height = u32::try_from(panels.len()).unwrap_or(1) * 390 + HEADER + 16;
        render((900, height), |area| {
            let (header, body) = area.split_vertically(px(HEADER + 16));
            heading(&header, title, &format!("{}; after figure {figure} of the thesis", self.setting()))?;
            self.legend(&header, (16, HEADER + 4))?;
            for (place, panel) in body.split_evenly((panels.len(), 1)).iter().zip(panels) {
                panel.draw(place)?;
            }
            Ok(())
        })
    }

    /// Figure 3.7: the body rates.
    pub fn body_rates(&self) -> PlotResult<String> {
        let end = SHORT.min(self.schedule.end());
        let axes = [("Ω_X, rad/s", BLUE), ("Ω_Y, rad/s", PURPLE), ("Ω_Z, rad/s", GREEN)];
        let name = self.series.first().map_or("", |s| s.name);
        render((900, 620), |area| {
            let (header, body) = area.split_vertically(px(HEADER));
            let subtitle = format!("{}, {name}; after figure 3.7 of the thesis", self.setting());
            heading(&header, &format!("Body rates, the first {} s", short(end)), &subtitle)?;
            for (axis, (place, (up, colour))) in body.split_evenly((3, 1)).iter().zip(axes).enumerate() {
                let points = self.series.iter().take(1).flat_map(|s| s.between(0.0, end));
                let line = Line { colour, width: 3, points: points.map(|q| (q.time, q.rates[axis])).collect() };
                let across = if axis == 2 { "time, s" } else { "" };
                let vertical = Vertical::Linear;
                Panel { title: "", across, up, vertical, function: true, lines: vec![line] }.draw(place)?;
            }
            Ok(())
        })
    }

    /// Figure 3.8, 3.9 or 3.10: the variational run beside the thesis' Runge–Kutta, which is the last of the series.
    pub fn tip(&self) -> PlotResult<String> {
        let (start, end) = self.late();
        let (Some(ours), Some(theirs)) = (self.series.first(), self.series.last()) else {
            return Err("no runs to draw".into());
        };
        render((1000, 800), |area| {
            let (header, body) = area.split_vertically(px(HEADER));
            let title = format!("Path of the tip on the sphere, {} s to {} s", short(start), short(end));
            let subtitle = format!("{}; after figure {} of the thesis", self.setting(), self.case.figure());
            heading(&header, &title, &subtitle)?;
            for (place, series) in body.split_evenly((1, 2)).iter().zip([ours, theirs]) {
                let (above, below) = place.split_vertically(px(470));
                tip_path(&above, (series.name, 1), series, (start, end))?;
                self.close_up(&self.close_up_title(), series).draw(&below)?;
            }
            Ok(())
        })
    }
}

/// The path of a run's tip on the sphere between two times, with a title and a line width.
pub fn tip_path(area: &Area<'_>, (title, width): (&str, u32), series: &Series, (start, end): (f64, f64)) -> PlotResult {
    let points: Vec<_> = series.between(start, end).iter().map(|q| q.tip).collect();
    sphere(area, &Path { title, colour: series.colour, width, points: &points, axis: (Vector3::z(), "e₃") })
}

/// Figure 3.3: the variational paths of some runs, side by side, with a name for each.
pub fn precessions(runs: &[(&str, &Series)], end: f64) -> PlotResult<String> {
    render((1140, 460), |area| {
        let (header, body) = area.split_vertically(px(HEADER));
        let subtitle = format!("the path of the tip, the first {} s; after figure 3.3 of the thesis", short(end));
        heading(&header, "Three kinds of precession", &subtitle)?;
        for (place, (title, series)) in body.split_evenly((1, runs.len())).iter().zip(runs) {
            tip_path(place, (title, 2), series, (0.0, end))?;
        }
        Ok(())
    })
}

/// Azimuth and tilt in degrees, the azimuth without jumps.
fn unwound(path: &[Quantities]) -> Vec<(f64, f64)> {
    let mut turns = 0.0;
    let mut before: Option<f64> = None;
    let angles = path.iter().map(|q| {
        let azimuth = q.tip.y.atan2(q.tip.x).to_degrees();
        if let Some(before) = before {
            turns -= 360.0 * ((azimuth - before) / 360.0).round();
        }
        before = Some(azimuth);
        (azimuth + turns, q.tip.xy().norm().atan2(q.tip.z).to_degrees())
    });
    angles.collect()
}
