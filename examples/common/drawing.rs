//! The frame of examples that draw two panels: their option, lines, and the picture.

use std::process::ExitCode;

use plotters::style::RGBColor;

use crate::args::{Failure, example};
use crate::output::{Output, print};
use crate::plot::{Line, Panel, PlotResult, Vertical, heading, legend, px, render};

/// Runs an example whose only option is the folder of its figures, and prints its report and the names of its files.
pub fn drawing(help: &str, folder: &str, run: impl FnOnce(&mut Output) -> Result<String, Failure>) -> ExitCode {
    example(help, |words| {
        let mut folder = folder.into();
        while let Some(option) = words.option()? {
            match option.as_str() {
                "out" => folder = words.folder()?,
                _ => return Err(words.unknown()),
            }
        }
        let mut output = Output::new(folder)?;
        let report = run(&mut output)?;
        Ok(print(&format!("{report}{output}"))?)
    })
}

/// A line through points, or one over time.
pub fn line(colour: RGBColor, width: u32, points: Vec<(f64, f64)>) -> Line {
    Line { colour, width, points }
}

/// A panel of paths in a plane.
pub fn path<'a>(title: &'a str, [across, up]: [&'a str; 2], lines: Vec<Line>) -> Panel<'a> {
    Panel { title, across, up, vertical: Vertical::Linear, function: false, lines }
}

/// Two panels, one above the other, in a picture of this size; the second begins at this height below the heading.
pub fn stacked(
    (size, second): ((u32, u32), u32),
    [title, about]: [&str; 2],
    names: &[(&str, RGBColor)],
    panels: &[Panel<'_>; 2],
) -> PlotResult<String> {
    render(size, |area| {
        let (header, body) = area.split_vertically(px(84));
        heading(&header, title, about)?;
        legend(&header, (16, 68), names)?;
        let (above, below) = body.split_vertically(px(second));
        panels[0].draw(&above)?;
        panels[1].draw(&below)
    })
}
