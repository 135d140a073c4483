//! Energy, spatial momentum and body rates of every method.

use super::quantities::Series;
use crate::args::Schedule;
use crate::output::Output;
use crate::plot::{Area, BLUE, GREEN, Line, ORANGE, Panel, PlotResult, Vertical, heading, legend, px, render};

/// What the figures are of: the variational run first, then its rivals.
pub struct Figures<'a> {
    pub schedule: Schedule,
    pub series: &'a [Series],
}

const HEADER: u32 = 84;

/// For how long single flips can be told apart in a small panel, s.
const DISTINCT: f64 = 200.0;

impl Figures<'_> {
    /// Writes all of them.
    pub fn write(&self, output: &mut Output) -> PlotResult {
        output.write("energy.svg", &self.energy()?)?;
        output.write("spatial-momentum.svg", &self.momentum()?)?;
        output.write("body-rates.svg", &self.body_rates()?)?;
        Ok(())
    }

    fn energy(&self) -> PlotResult<String> {
        render((900, 700), |area| {
            let body = self.header(area, "Energy of a free body that flips")?;
            let (above, below) = body.split_vertically(px(308));
            self.energy_ratio("Energy over its initial value").draw(&above)?;
            self.energy_error("How far it strays").draw(&below)
        })
    }

    fn momentum(&self) -> PlotResult<String> {
        render((900, 480), |area| {
            let body = self.header(area, "Spatial angular momentum of a free body: how far from its start")?;
            self.momentum_error("").draw(&body)
        })
    }

    fn body_rates(&self) -> PlotResult<String> {
        render((900, 900), |area| {
            let (header, body) = area.split_vertically(px(HEADER));
            heading(&header, "Body rates: the middle axis flips", &self.setting())?;
            let axes = [("Ω_X", ORANGE), ("Ω_Y", BLUE), ("Ω_Z", GREEN)];
            legend(&header, (16, 68), &axes)?;
            for (place, series) in body.split_evenly((self.series.len(), 1)).iter().zip(self.series) {
                // The middle axis is drawn last, on top.
                let lines = [0, 2, 1].map(|axis: usize| Line {
                    colour: axes[axis].1,
                    width: 3,
                    points: series.bounded(|q| q.rates[axis]),
                });
                Panel::over_time(series.name, "rad/s", Vertical::Linear, lines.into()).draw(place)?;
            }
            Ok(())
        })
    }

    pub fn energy_ratio<'a>(&self, title: &'a str) -> Panel<'a> {
        self.panel(title, "E / E(0)", Vertical::Linear, Series::relative_energy)
    }

    fn energy_error<'a>(&self, title: &'a str) -> Panel<'a> {
        self.panel(title, "|E − E(0)| / E(0)", Vertical::Logarithmic, |s| s.energy_error().collect())
    }

    pub fn momentum_error<'a>(&self, title: &'a str) -> Panel<'a> {
        self.panel(title, "|RΠ − RΠ(0)| / |Π(0)|", Vertical::Logarithmic, |s| s.momentum_error().collect())
    }

    /// The rate about the middle axis, of all methods, while flips can be told apart.
    pub fn flips<'a>(&self, title: &'a str) -> Panel<'a> {
        self.panel(title, "Ω_Y, rad/s", Vertical::Linear, |s| {
            let mut rates = s.bounded(|q| q.rates.y);
            rates.retain(|(time, _)| *time <= DISTINCT);
            rates
        })
    }

    fn setting(&self) -> String {
        format!("J = diag(1, 2, 3) kg m², Ω(0) = (0.01, 2, 0.02) rad/s, h = {} s", self.schedule.step)
    }

    /// Draws the title, the setting and the legend, and returns the rest.
    pub fn header<'a>(&self, area: &Area<'a>, title: &str) -> PlotResult<Area<'a>> {
        let (header, body) = area.split_vertically(px(HEADER));
        heading(&header, title, &self.setting())?;
        let entries: Vec<_> = self.series.iter().map(|s| (s.name, s.colour)).collect();
        legend(&header, (16, 68), &entries)?;
        Ok(body)
    }

    fn panel<'a>(
        &self,
        title: &'a str,
        up: &'a str,
        vertical: Vertical,
        points: impl Fn(&Series) -> Vec<(f64, f64)>,
    ) -> Panel<'a> {
        // The variational line comes first in the legend and last, on top, in the drawing.
        let lines = self.series.iter().rev().map(|s| Line { colour: s.colour, width: 3, points: points(s) });
        Panel::over_time(title, up, vertical, lines.collect())
    }
}
