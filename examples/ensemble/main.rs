//! Three ensembles: the loss of a tumbling satellite's attitude, a map of the chaos of a heavy top, and a Poincaré
//! section of it.
//!
//! ```text
//! cargo run --release -p liestep-examples --example ensemble
//! cargo run --release -p liestep-examples --example ensemble -- --quick
//! cargo run --release -p liestep-examples --example ensemble -- --share 2/8 --out shared     one task of an array; the last draws
//! ```
//!
//! An interrupted run is resumed by the next one. The folders `satellite`, `map` and `section` have the files; polars
//! and pandas read them.

mod map;
mod satellite;
mod section;

use std::path::PathBuf;
use std::process::ExitCode;

use liestep::motion::Integrator;
use liestep_ensemble::{Ensemble, Local, Report, Store, Summary, share_of};
use plotters::prelude::{Circle, RGBColor, Rectangle};
use plotters::style::Color as _;
use workbench::args::{Failure as Mistake, example};
use workbench::output::{Output, print};
use workbench::plot::{Area, BLUE, GREEN, Line, ORANGE, Panel, PlotResult, Vertical, heading, legend, px, render};
use workbench::progress::Progress;

use map::Grid;

const HELP: &str =
    "Runs three ensembles and draws how soon a tumbling satellite is lost, where a top is chaotic, and a section of it

Options:
      --quick        A few hundred members, in the place of some thousands
      --threads <N>  So many threads; 0 for as many as there are cores [default: 0]
      --share <I/N>  Only this share of the chunks, from 0/N on; the run that makes the last of them draws
      --out <DIR>    The folder for files and figures [default: out/ensemble]
  -h, --help         Print this
";

struct Arguments {
    quick: bool,
    threads: usize,
    share: (u64, u64),
    out: PathBuf,
}

fn main() -> ExitCode {
    example(HELP, |words| {
        let mut arguments = Arguments { quick: false, threads: 0, share: (0, 1), out: "out/ensemble".into() };
        while let Some(option) = words.option()? {
            match option.as_str() {
                "quick" => arguments.quick = true,
                "threads" => {
                    let text = words.text()?;
                    let threads = text.parse().map_err(|_| format!("'{text}' for '--threads' isn't a number"))?;
                    arguments.threads = threads;
                }
                "share" => arguments.share = share_of(&words.text()?)?,
                "out" => arguments.out = words.folder()?,
                _ => return Err(words.unknown()),
            }
        }
        run(&arguments)
    })
}

fn run(arguments: &Arguments) -> Result<(), Mistake> {
    let mut output = Output::new(arguments.out.clone())?;
    let (members, grid) =
        if arguments.quick { (256, Grid { tilts: 24, spins: 16 }) } else { (4_096, Grid { tilts: 96, spins: 64 }) };
    let (satellites, tops) = (satellite::ensemble(members), grid.ensemble());
    let orbits = if arguments.quick { section::ensemble(32, 8_000) } else { section::ensemble(64, 40_000) };
    let (satellites_in, report) = made(&satellites, arguments, "satellite")?;
    let (map_in, of_map) = made(&tops, arguments, "map")?;
    let (section_in, of_section) = made(&orbits, arguments, "section")?;
    let missing = report.missing + of_map.missing + of_section.missing;
    if missing > 0 {
        print(&format!("{missing} chunks are left to other shares, of which the last to end draws the figures.\n"))?;
        return Ok(());
    }
    let spread = satellite::spread(&satellites, &satellites_in)?;
    let exponents = grid.exponents(&tops, &map_in)?;
    output.write("satellite.svg", &of_spread(&spread)?)?;
    output.write("map.svg", &of_exponents(grid, &exponents)?)?;
    let crossings = section::crossings(&orbits, &section_in)?;
    output.write("section.svg", &of_section_points(&crossings)?)?;
    let points: usize = crossings.iter().map(|orbit| orbit.points.len()).sum();
    let off = crossings.iter().fold(0.0_f64, |off, orbit| off.max(orbit.off.abs()));
    let lost = spread.iter().find(|(_, [_, half, _])| *half > 10.0).map_or(f64::NAN, |(time, _)| *time);
    let largest = exponents.iter().flatten().fold(0.0_f64, |largest, exponent| largest.max(*exponent));
    let chaotic = exponents.iter().flatten().filter(|exponent| **exponent > CHAOTIC).count();
    let energy = match report.reduced("energy") {
        Some(Summary::Moments(moments)) => format!("{:.4} ± {:.4} J", moments.mean, moments.variance().sqrt()),
        _ => String::new(),
    };
    print(&format!(
        "{} satellites, {} and {} tops; {} failed.\n\
         Energy of the satellites: {energy}.\n\
         Half of them point more than 10° from the nominal one after {lost} s.\n\
         {chaotic} of {} points of the map have an exponent over 20 s above {CHAOTIC}/s, the largest is {largest:.2}/s.\n\
         The section has {points} points; no energy is off by more than {off:.1e} J at the end.\n\n{output}",
        report.outcome.finished,
        of_map.outcome.finished,
        of_section.outcome.finished,
        report.outcome.failed() + of_map.outcome.failed() + of_section.outcome.failed(),
        exponents.len(),
    ))?;
    Ok(())
}

/// A limit well above `ln(T)/T`, the exponent of a regular motion.
const CHAOTIC: f64 = 0.4;

fn made<M: Integrator>(ensemble: &Ensemble<M>, arguments: &Arguments, name: &str) -> Result<(Store, Report), Mistake> {
    let store = Store::folder(arguments.out.join(name))?;
    let (share, shares) = arguments.share;
    let progress = std::sync::Mutex::new(Progress::new(ensemble.chunks()));
    let tell = |_| {
        if let Ok(mut progress) = progress.lock() {
            progress.add(1, name);
        }
    };
    let report = ensemble.run_telling(&Local::threads(arguments.threads).share(share, shares), &store, &tell)?;
    for fault in &report.faults {
        eprintln!("note: {fault}; it was made anew");
    }
    Ok((store, report))
}

fn of_spread(spread: &[(f64, [f64; 3])]) -> PlotResult<String> {
    let colours = [GREEN, BLUE, ORANGE];
    let line = |(place, colour): (usize, &RGBColor)| {
        let points = spread.iter().map(|(time, angles)| (*time, angles[place])).collect();
        Line { colour: *colour, width: 3, points }
    };
    let lines = colours.iter().enumerate().map(line).collect();
    render((820, 420), |area| {
        let (header, body) = area.split_vertically(px(60));
        heading(
            &header,
            "A tumbling satellite",
            "moments and rates known to 1 %: how far from the nominal one it points",
        )?;
        let (panel, names) = body.split_vertically(px(325));
        Panel::over_time("", "angle, degrees", Vertical::Linear, lines).draw(&panel)?;
        legend(&names, (16, 8), &[("a tenth below", GREEN), ("half below", BLUE), ("nine tenths below", ORANGE)])
    })
}

fn of_exponents(grid: Grid, exponents: &[Option<f64>]) -> PlotResult<String> {
    let largest = exponents.iter().flatten().fold(CHAOTIC, |largest, exponent| largest.max(*exponent));
    render((820, 560), |area| {
        let (header, body) = area.split_vertically(px(60));
        heading(
            &header,
            "Where a heavy top is chaotic",
            "exponent over 20 s, from white (none) to blue (the largest); tilt 0.1 to 3 rad →, spin 0 to 8 rad/s ↑",
        )?;
        squares(&body, grid, |number| exponents[number].map(|exponent| (exponent / largest).clamp(0.0, 1.0)))
    })
}

fn of_section_points(crossings: &[section::Orbit]) -> PlotResult<String> {
    const COLOURS: [RGBColor; 3] = [BLUE, ORANGE, GREEN];
    render((820, 620), |area| {
        let (header, body) = area.split_vertically(px(60));
        heading(
            &header,
            "A Poincaré section of a heavy top",
            "where its second axis rises through the horizontal plane: nutation −π to π rad →, p₂ −12.5 to 12.5 kg m²/s ↑",
        )?;
        let (width, height) = body.dim_in_pixel();
        let margin = f64::from(px(16));
        #[allow(clippy::cast_possible_truncation)] // inside of the picture
        let place = |part: f64, room: u32| (margin + part * (f64::from(room) - 2.0 * margin)) as i32;
        for (orbit, colour) in crossings.iter().zip(COLOURS.iter().cycle()) {
            for [nutation, across] in &orbit.points {
                let right = 0.5 + nutation / (2.0 * core::f64::consts::PI);
                let down = 0.5 - across / (2.0 * section::LARGEST);
                body.draw(&Circle::new((place(right, width), place(down, height)), 2, colour.filled()))?;
            }
        }
        Ok(())
    })
}

/// A square for each point of the grid, the darker the larger its value; grey if there is no value.
fn squares(area: &Area<'_>, grid: Grid, value: impl Fn(usize) -> Option<f64>) -> PlotResult {
    let (width, height) = area.dim_in_pixel();
    let margin = px(16);
    let place = |part: u64, whole: u64, room: u32| -> Result<i32, Mistake> {
        Ok(i32::try_from(u64::from(margin) + part * u64::from(room - 2 * margin) / whole)?)
    };
    for number in 0..grid.tilts * grid.spins {
        let (across, up) = (number % grid.tilts, grid.spins - 1 - number / grid.tilts);
        let corner = |across, up| -> Result<(i32, i32), Mistake> {
            Ok((place(across, grid.tilts, width)?, place(up, grid.spins, height)?))
        };
        let colour = value(usize::try_from(number)?).map_or(RGBColor(200, 200, 200), shade);
        area.draw(&Rectangle::new([corner(across, up)?, corner(across + 1, up + 1)?], colour.filled()))?;
    }
    Ok(())
}

/// A colour between white and the blue of the figures.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // between two bytes
fn shade(value: f64) -> RGBColor {
    let mixed = |end: u8| (255.0 + (f64::from(end) - 255.0) * value).round() as u8;
    RGBColor(mixed(BLUE.0), mixed(BLUE.1), mixed(BLUE.2))
}
