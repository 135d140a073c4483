//! Figures of error against time, a panel for each scene.

use plotters::prelude::*;
use workbench::plot::{Area, BLUE, GREEN, ORANGE, PURPLE, PlotResult, heading, legend, px, render};

use crate::methods::Family;
use crate::report::MethodRuns;

/// The runs of one scene over one time.
pub struct Panel<'a> {
    pub title: String,
    pub methods: &'a [MethodRuns],
}

/// The colour of methods without one of their own.
const GREY: RGBColor = RGBColor(150, 150, 150);

const ABOUT: &str = "error of attitude and rate against time of one processor; grey: each stage solves an equation, and errs in the whole motion";
/// The picture is as wide as some 140 letters.
const _: () = assert!(ABOUT.len() < 140);

/// The lines of a panel: kinds of methods, by the names of [`liestep::Stepper`]'s functions.
const KINDS: [(Kind, &str, RGBColor); 6] = [
    (Kind::Rival, "Runge–Kutta", ORANGE),
    (Kind::Steps, "Stepper::new, composed", GREY),
    (Kind::OtherFlows, "split, another flow", GREEN),
    (Kind::Exact, "split, ExactBody", BLUE),
    (Kind::ProcessedSplitting, "processed", BLACK),
    (Kind::Collocation, "collocated", PURPLE),
];

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Rival,
    Steps,
    OtherFlows,
    Exact,
    ProcessedSplitting,
    Collocation,
}

fn kind(method: &MethodRuns) -> Kind {
    let name = method.name.as_str();
    let is_flow = name.starts_with("K6,") && name != "K6, Suzuki 6 to 8";
    match name {
        _ if method.family == Family::Rival => Kind::Rival,
        _ if name.starts_with("Gauss") => Kind::Collocation,
        _ if name.starts_with("exact, processed") => Kind::ProcessedSplitting,
        _ if name.starts_with("exact") => Kind::Exact,
        _ if is_flow => Kind::OtherFlows,
        _ => Kind::Steps,
    }
}

/// The lower envelope of each kind of method: the best that a user can choose.
pub fn figure(panels: &[Panel<'_>]) -> PlotResult<String> {
    const COLUMNS: usize = 2;
    let rows = panels.len().div_ceil(COLUMNS);
    let height = 70 + 300 * u32::try_from(rows)?;
    render((1000, height), |area| {
        heading(area, "What accuracy costs in time", ABOUT)?;
        legend(area, (16, 60), &KINDS.map(|(_, name, colour)| (name, colour)))?;
        let (_, below) = area.split_vertically(px(76));
        for (panel, place) in panels.iter().zip(below.split_evenly((rows, COLUMNS))) {
            panel.draw(&place)?;
        }
        Ok(())
    })
}

impl Panel<'_> {
    fn draw(&self, area: &Area<'_>) -> PlotResult {
        let points = || self.methods.iter().flat_map(costs);
        let (least, most) = points().fold((f64::INFINITY, 0.0_f64), |(low, high), (x, _)| (low.min(x), high.max(x)));
        if !least.is_finite() {
            return Ok(());
        }
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, ("sans-serif", px(13)))
            .margin(px(8))
            .x_label_area_size(px(34))
            .y_label_area_size(px(56))
            .build_cartesian_2d((0.8 * least..1.2 * most).log_scale(), (1e-14..1.0).log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(RGBColor(226, 226, 226).stroke_width(px(1)))
            .x_desc("µs")
            .y_desc("error")
            .label_style(("sans-serif", px(11)))
            .x_label_formatter(&|x| format!("{x:.0}"))
            .y_label_formatter(&|y| format!("{y:.0e}"))
            .draw()?;
        for (drawn, _, colour) in KINDS {
            let line = envelope(self.methods.iter().filter(|method| kind(method) == drawn));
            chart.draw_series(LineSeries::new(line, colour.stroke_width(px(2))))?;
        }
        Ok(())
    }
}

/// The runs of a family that no other of its runs beats both in error and in cost, by cost.
fn envelope<'a>(methods: impl Iterator<Item = &'a MethodRuns>) -> Vec<(f64, f64)> {
    let mut runs: Vec<_> = methods.flat_map(costs).collect();
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best = f64::INFINITY;
    runs.retain(|(_, error)| {
        let keep = *error < best;
        best = best.min(*error);
        keep
    });
    runs
}

/// The time in µs and the error of each run.
fn costs(method: &MethodRuns) -> impl Iterator<Item = (f64, f64)> + '_ {
    method.runs.rows().iter().filter_map(|run| Some((run.seconds? * 1e6, run.error)))
}
