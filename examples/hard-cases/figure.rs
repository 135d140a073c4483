//! One figure of all that the rows leave.

use plotters::style::RGBColor;
use workbench::plot::{Area, Line, Panel, PlotResult, Vertical, heading, legend, px, render};

use crate::curves::{Curve, Curves};
use crate::rivals::GREY;

const COLUMNS: usize = 3;

/// A panel, and the names in it.
struct Place<'a> {
    panel: Panel<'a>,
    names: Vec<(&'static str, RGBColor)>,
}

/// A panel of the curves, the first of them drawn last, on top.
fn place<'a>(title: &'a str, (across, up): (&'a str, &'a str), vertical: Vertical, curves: &[Curve]) -> Place<'a> {
    let names = curves.iter().filter(|curve| !curve.name.is_empty()).map(|curve| (curve.name, curve.colour));
    let lines = curves.iter().rev();
    let lines = lines.map(|curve| Line { colour: curve.colour, width: 3, points: curve.points.clone() });
    let panel = Panel { title, across, up, vertical, function: true, lines: lines.collect() };
    Place { panel, names: names.collect() }
}

/// The same with the limits of the step, from the bottom to the top.
fn with_limits(mut place: Place<'_>, limits: [f64; 3], top: f64) -> Place<'_> {
    place.panel.function = false;
    for limit in limits {
        place.panel.lines.push(Line { colour: GREY, width: 2, points: vec![(limit, 0.0), (limit, top)] });
    }
    place.names.push(("surely solvable, fold, surely not", GREY));
    place
}

pub fn figure(curves: &Curves) -> PlotResult<String> {
    let count = ("log₁₀ of the number of steps", "‖RᵀR − I‖");
    let mut places: Vec<_> = curves
        .energies
        .iter()
        .map(|(title, lines)| place(title, ("time, s", "E / E(0)"), Vertical::Linear, lines))
        .collect();
    if !curves.angles.is_empty() {
        let step = |up| ("h, s", up);
        let angle = place("S1: turn of the first step", step("degrees"), Vertical::Linear, &curves.angles);
        let newton = place("S1: Newton iterations", step("iterations"), Vertical::Linear, &curves.iterations);
        places.push(with_limits(angle, curves.limits, 92.0));
        places.push(with_limits(newton, curves.limits, 10.0));
    }
    if !curves.tolerance.is_empty() {
        let axes = ("log₁₀ of the tolerance", "drift of E, relative");
        places.push(place("P4: when Newton stops early", axes, Vertical::Logarithmic, &curves.tolerance));
    }
    if !curves.orthogonality.is_empty() {
        let casimirs = (count.0, "|Δ p·w| / p·w");
        places.push(place("T3: orthogonality", count, Vertical::Logarithmic, &curves.orthogonality));
        places.push(place("T3: vertical momentum", casimirs, Vertical::Logarithmic, &curves.casimirs));
    }
    if !curves.composed.is_empty() {
        places.push(place("R1–R3: the same step again", count, Vertical::Logarithmic, &curves.composed));
    }
    let rows = places.len().div_ceil(COLUMNS);
    render((1500, 60 + 330 * u32::try_from(rows)?), |area| {
        let (header, body) = area.split_vertically(px(60));
        heading(
            &header,
            "Hard cases",
            "energies of the same body by several methods; steps up to the fold; what early stopping and rounding leave",
        )?;
        for (area, place) in body.split_evenly((rows, COLUMNS)).iter().zip(&places) {
            place.draw(area)?;
        }
        Ok(())
    })
}

impl Place<'_> {
    fn draw(&self, area: &Area<'_>) -> PlotResult {
        let (panel, names) = area.split_vertically(px(300));
        self.panel.draw(&panel)?;
        legend(&names, (16, 8), &self.names)
    }
}
