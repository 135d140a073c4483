//! The picture: readings with their fit, and the accuracy for longer records.

use nalgebra::Vector3;
use workbench::args::Failure;
use workbench::plot::{
    BLUE, GREEN, Line, ORANGE, PURPLE, Panel, PlotResult, SKY, Vertical, YELLOW, heading, legend, px, render,
};

use crate::{READINGS, Reference, STEP, TopFit, deviations, measured, truth};

/// The part of the record in the picture, s: more would overlap.
const SHOWN: f64 = 4.0;

pub(crate) fn picture(fits: &[(Reference, TopFit)]) -> Result<String, Failure> {
    let first = fits.first().ok_or("no fit to draw")?;
    let (read, fitted) = (measured(READINGS, 1)?, first.0.readings(READINGS)?);
    let rates = |values: &[Vector3<f64>], component: usize| -> Vec<(f64, f64)> {
        let timed = values.iter().enumerate().map(|(n, value)| (n as f64 * STEP, value[component]));
        timed.take_while(|(time, _)| *time <= SHOWN).collect()
    };
    let mut lines: Vec<Line> = Vec::new();
    for component in 0..2 {
        // The readings are pale and wide, so that both are visible.
        lines.push(Line { colour: [SKY, YELLOW][component], width: 9, points: rates(&read, component) });
        lines.push(Line { colour: [BLUE, GREEN][component], width: 2, points: rates(&fitted, component) });
    }
    let records: Vec<usize> = (1..=20).map(|part| part * READINGS / 20).collect();
    let mut spread = vec![Vec::new(); 4];
    for count in records {
        let deviations = deviations(&truth().fit(&truth().readings(count)?, 2)?);
        for (line, number) in spread.iter_mut().zip([0, 1, 2, 3]) {
            line.push((count as f64 * STEP, deviations[number]));
        }
    }
    let colours = [BLUE, ORANGE, GREEN, PURPLE];
    let spread = spread.into_iter().zip(colours).map(|(points, colour)| Line { colour, width: 3, points }).collect();
    let drawn: PlotResult<String> = render((1000, 420), |area| {
        heading(area, "The inertia of a top from a gyroscope", "readings of seed 1, and what a record can tell")?;
        let (_, body) = area.split_vertically(px(56));
        let (left, right) = body.split_horizontally(px(500));
        Panel::over_time(
            "Ω1 and Ω2: readings (sky, yellow), and the fit (blue, green)",
            "rad/s",
            Vertical::Linear,
            lines,
        )
        .draw(&left)?;
        let names = "Standard deviation of what is fitted";
        let panel = Panel { across: "record, s", ..Panel::over_time(names, "", Vertical::Logarithmic, spread) };
        panel.draw(&right)?;
        legend(&right, (250, 40), &[("ln J_d1", BLUE), ("ln J_d2", ORANGE)])?;
        legend(&right, (250, 58), &[("ln J_d3", GREEN), ("rho 1, m", PURPLE)])
    });
    drawn
}
