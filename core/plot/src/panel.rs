//! A panel: axes, and lines in them.

use std::ops::Range;

use plotters::prelude::*;

use super::canvas::{Area, PlotResult, at, px};
use super::envelope::{crest, envelope};
use super::style::{GRID, INK, letters};
use super::thin::thinned;

/// A line of one colour.
pub struct Line {
    /// The colour of the line.
    pub colour: RGBColor,
    /// The width in half pixels; wider if another line would hide this one.
    pub width: u32,
    /// The points, across and up, in the units of the axes.
    pub points: Vec<(f64, f64)>,
}

/// The scale of the vertical axis.
#[derive(Clone, Copy, PartialEq)]
pub enum Vertical {
    /// A scale of equal distances.
    Linear,
    /// Powers of ten, with the highest of many points in a pixel: deviations pass through zero all the time.
    Logarithmic,
}

/// Axes with their names, a title, and lines.
pub struct Panel<'a> {
    /// The title above the axes.
    pub title: &'a str,
    /// The name of the horizontal axis.
    pub across: &'a str,
    /// The name of the vertical axis.
    pub up: &'a str,
    /// The scale of the vertical axis.
    pub vertical: Vertical,
    /// Whether lines are functions of the horizontal axis; otherwise they are paths.
    pub function: bool,
    /// The lines, from behind to the front.
    pub lines: Vec<Line>,
}

/// The name of the time axis.
const SECONDS: &str = "time, s";
/// The time, s, from which on an axis counts hours, as seconds have five digits.
const HOURS_FROM: f64 = 1e4;

/// The least deviation, below a double's rounding at one.
const FLOOR: f64 = 1e-17;

impl<'a> Panel<'a> {
    /// A panel of functions of time.
    #[must_use]
    pub fn over_time(title: &'a str, up: &'a str, vertical: Vertical, lines: Vec<Line>) -> Self {
        Self { title, across: SECONDS, up, vertical, function: true, lines }
    }
}

impl Panel<'_> {
    /// Draws the panel into the area.
    pub fn draw(&self, area: &Area<'_>) -> PlotResult {
        let (width, height) = area.dim_in_pixel();
        // A column is two pixels wide, about the width of a line.
        let columns = width / px(2);
        let seconds = range(self.lines.iter().flat_map(|line| &line.points).map(|p| p.0), 0.0);
        let (unit, across) =
            if self.across == SECONDS && seconds.end >= HOURS_FROM { (3600.0, "time, h") } else { (1.0, self.across) };
        let mut lines: Vec<Line> = self.lines.iter().map(|line| self.prepared(line, columns)).collect();
        lines.iter_mut().flat_map(|line| &mut line.points).for_each(|point| point.0 /= unit);
        let all = || lines.iter().flat_map(|line| &line.points);
        let x_range = seconds.start / unit..seconds.end / unit;
        let y_range = match self.vertical {
            Vertical::Linear => range(all().map(|p| p.1), 0.06),
            Vertical::Logarithmic => decades(all().map(|p| p.1)),
        };
        // The axes take a part of the area, so these scales are too large, on the fine side.
        let (wide, up) = (f64::from(width) / length(&x_range), f64::from(height) / length(&y_range));
        let (x_step, y_step) = (tick_step(&x_range), tick_step(&y_range));
        area.draw_text(self.title, &letters(13, INK), (at(16), at(6)))?;
        let mut chart = ChartBuilder::on(area)
            .margin_top(px(if self.title.is_empty() { 10 } else { 28 }))
            .margin_right(px(20))
            .margin_left(px(8))
            .margin_bottom(px(6))
            .x_label_area_size(px(if across.is_empty() { 22 } else { 38 }))
            .y_label_area_size(px(66))
            .build_cartesian_2d(x_range, y_range)?;
        let tick = |y: &f64| match self.vertical {
            Vertical::Linear => decimal(*y, y_step),
            Vertical::Logarithmic => power_of_ten(*y),
        };
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID.stroke_width(px(1)))
            .axis_style(INK.stroke_width(px(1)))
            .label_style(letters(11, INK))
            .axis_desc_style(letters(12, INK))
            .x_desc(across)
            .y_desc(self.up)
            .x_labels(9)
            .y_labels(if area.dim_in_pixel().1 > px(260) { 7 } else { 5 })
            .x_label_formatter(&|x| decimal(*x, x_step))
            .y_label_formatter(&tick)
            .draw()?;
        for line in lines {
            let points = thinned(&line.points, |(x, y)| (x * wide, y * up));
            chart.draw_series(LineSeries::new(points, line.colour.stroke_width(line.width)))?;
        }
        Ok(())
    }

    fn prepared(&self, line: &Line, columns: u32) -> Line {
        let points = match self.vertical {
            Vertical::Linear if self.function => envelope(&line.points, columns),
            Vertical::Linear => line.points.iter().copied().filter(|(x, y)| (x + y).is_finite()).collect(),
            Vertical::Logarithmic => {
                let crest = crest(&line.points, columns);
                // A zero deviation would be drawn as a line down to the bottom.
                let nothing = crest.iter().all(|(_, y)| *y <= FLOOR);
                let shown = crest.into_iter().filter(|(_, y)| nothing || *y > FLOOR);
                shown.map(|(x, y)| (x, y.max(FLOOR).log10())).collect()
            }
        };
        Line { points, ..*line }
    }
}

/// The range from the least to the greatest value, with a margin in units of its length; 0 to 1 if there are none.
fn range(values: impl Iterator<Item = f64>, margin: f64) -> Range<f64> {
    let (low, high) = values
        .filter(|v| v.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return 0.0..1.0;
    }
    // A constant is drawn in the middle, not magnified to its rounding errors.
    let size = low.abs().max(high.abs());
    let constant = high - low <= 1e-9 * size;
    let room = match (constant, size > 0.0) {
        (true, true) => (0.1 * size).max(f64::MIN_POSITIVE.sqrt()),
        (true, false) => 1.0,
        (false, _) => margin * (high - low),
    };
    low - room..high + room
}

fn decades(exponents: impl Iterator<Item = f64>) -> Range<f64> {
    let tight = range(exponents, 0.0);
    let (low, high) = (tight.start.floor(), tight.end.ceil());
    low..high.max(low + 2.0)
}

fn length(range: &Range<f64>) -> f64 {
    range.end - range.start
}

/// A tenth of the range, about the distance of two labels.
fn tick_step(range: &Range<f64>) -> f64 {
    length(range) / 10.0
}

/// A decimal with as many places as a distance of about this size needs.
fn decimal(value: f64, distance: f64) -> String {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped
    let places = (-distance.log10().floor()).clamp(0.0, 12.0) as usize;
    let text = if places > 6 || value.abs() >= 1e6 { format!("{value:.1e}") } else { format!("{value:.places$}") };
    let text = if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    };
    if text == "-0" { "0".to_owned() } else { text.replace('-', "−") }
}

fn power_of_ten(exponent: f64) -> String {
    let superscript = |character: char| match character {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        _ => '⁰',
    };
    if (exponent - exponent.round()).abs() > 1e-6 {
        return String::new();
    }
    let digits: String = format!("{exponent:.0}").chars().map(superscript).collect();
    format!("10{digits}")
}
