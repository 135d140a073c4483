//! The inertia of a top from the readings of a gyroscope in it, by derivatives of its motion.
//!
//! ```text
//! cargo run --release --example calibrate
//! cargo run --release --example calibrate -- --quick         three sets of readings in place of twenty
//! ```
//!
//! A gyroscope is read a hundred times a second for ten seconds. Twelve numbers determine what it reads: three moments,
//! the centre of mass, attitude and momentum at the start. The rank of the readings' Jacobian says how many of them can
//! be found out, and its null space which can't. The others are fitted, for readings with noise of twenty seeds.
//!
//! The tests assert that the rank is ten, that the two directions which physics hides are in the null space but for
//! `10⁻⁶` of them, and of the errors over twenty seeds, in the standard deviations of the fit's covariance: the root of
//! their mean square is within 0.2 of one, at most one of the hundred is above three, and none above 3.5. They don't
//! assert that all are below three, which isn't so: of a hundred normal numbers that far off there are 0.27 on average.
//! The seeds are fixed, so the test isn't one of luck.

#![allow(clippy::cast_precision_loss)] // a thousand readings

mod body;
mod fit;
mod picture;

use std::fmt::Write as _;
use std::process::ExitCode;

use body::{NAMES, NOISE, Numbers, Reference, measured, truth};
use fit::{FREE, Fitted, along, fit};
use nalgebra::DMatrix;
use workbench::args::{Failure, example};
use workbench::output::{Output, print};

const READINGS: usize = 1000;

const HELP: &str = "Fits the inertia of a top to the readings of a gyroscope

Options:
      --quick           Three sets of readings in place of twenty
      --out <DIR>       The folder for the figure [default: out/calibrate]
  -h, --help            Print this
";

fn main() -> ExitCode {
    example(HELP, |words| {
        let (mut seeds, mut folder) = (20, "out/calibrate".into());
        while let Some(option) = words.option()? {
            match option.as_str() {
                "quick" => seeds = 3,
                "out" => folder = words.folder()?,
                _ => return Err(words.unknown()),
            }
        }
        let mut output = Output::new(folder)?;
        let mut report = what_is_seen(&truth())?;
        let fits = (1..=seeds).map(|seed| fit(&measured(READINGS, seed)?)).collect::<Result<Vec<_>, Failure>>()?;
        report += &table(&fits)?;
        output.write("calibrate.svg", &picture::picture(&fits)?)?;
        Ok(print(&format!("{report}\n{output}"))?)
    })
}

/// The errors of the moments and of the centre of mass in standard deviations: the root of their mean square, the
/// largest, how many are above three, and how many there are.
fn errors(fits: &[Fitted]) -> (f64, f64, usize, usize) {
    let all: Vec<f64> = fits.iter().flat_map(Fitted::errors).map(f64::abs).collect();
    let spread = (all.iter().map(|error| error * error).sum::<f64>() / all.len() as f64).sqrt();
    (spread, all.iter().copied().fold(0.0, f64::max), all.iter().filter(|error| **error > 3.0).count(), all.len())
}

/// What the readings show.
struct Seen {
    /// The singular values of their Jacobian, its columns scaled to one length, by the largest of them.
    values: Vec<f64>,
    /// Its rank.
    rank: usize,
    /// Of each direction that physics hides, the part that isn't in the null space.
    residuals: Vec<f64>,
}

fn seen(reference: &Reference) -> Result<Seen, Failure> {
    let rows = reference.jacobian(&Numbers::zeros(), READINGS)?;
    let axes: Vec<Numbers> = (0..12).map(|number| Numbers::ith(number, 1.0)).collect();
    let mut jacobian = along(&rows, &axes);
    let lengths: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
    jacobian.column_iter_mut().zip(&lengths).for_each(|(mut column, length)| column /= *length);
    let svd = jacobian.svd(false, true);
    let largest = svd.singular_values.max();
    // What the steps' roundings leave of a zero is far below, what can be measured far above.
    let is_seen = |value: f64| value > 1e-9 * largest;
    let rank = svd.singular_values.iter().filter(|&&value| is_seen(value)).count();
    let mut values: Vec<f64> = svd.singular_values.iter().map(|value| value / largest).collect();
    values.sort_by(|a, b| b.total_cmp(a));
    let rows = svd.v_t.ok_or("no singular vectors")?;
    let unseen: Vec<_> = (0..12).filter(|&k| !is_seen(svd.singular_values[k])).collect();
    let mut residuals = Vec::new();
    let unseen = DMatrix::from_fn(unseen.len(), 12, |i, j| rows[(unseen[i], j)]);
    for (_, direction) in known(reference) {
        let scaled = DMatrix::from_fn(12, 1, |number, _| direction[number] * lengths[number]);
        let residual = (&scaled - unseen.transpose() * (&unseen * &scaled)).norm() / scaled.norm();
        residuals.push(residual);
    }
    Ok(Seen { values, rank, residuals })
}

fn what_is_seen(reference: &Reference) -> Result<String, Failure> {
    let Seen { values, rank, residuals } = seen(reference)?;
    let mut text = format!("{READINGS} readings of three rates, noise {NOISE} rad/s\n");
    let values: Vec<String> = values.iter().map(|value| format!("{value:.0e}")).collect();
    writeln!(text, "singular values of the Jacobian: {}", values.join(" "))?;
    writeln!(text, "its rank is {rank} of 12: the readings don't show")?;
    for ((name, direction), residual) in known(reference).into_iter().zip(residuals) {
        let what: Vec<String> = (0..12)
            .filter(|&number| direction[number] != 0.0)
            .map(|number| format!("{:+.2} {}", direction[number], NAMES[number]))
            .collect();
        writeln!(text, "  {name}, all but {residual:.0e} of it: {}", what.join(", "))?;
    }
    Ok(text)
}

/// What physics hides: a turn about the vertical, and inertia, weight and momentum that all grow in one proportion.
fn known(reference: &Reference) -> [(&'static str, Numbers); 2] {
    let (mut turn, mut scale) = (Numbers::zeros(), Numbers::zeros());
    turn.fixed_rows_mut::<3>(6).copy_from(&reference.vertical());
    scale.fixed_rows_mut::<3>(0).fill(1.0);
    scale.fixed_rows_mut::<3>(3).copy_from(&reference.rho);
    scale.fixed_rows_mut::<3>(9).copy_from(&reference.momentum);
    [("a turn about the vertical", turn), ("one scale of moments, centre of mass and momentum", scale)]
}

fn table(fits: &[Fitted]) -> Result<String, Failure> {
    let mut text =
        format!("\nfitted: {FREE} numbers, the third coordinate of the centre of mass measured with a ruler\n");
    let truth = truth();
    let (moments, rho) = (truth.inertia(), truth.rho);
    writeln!(
        text,
        "{:<8}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>14}",
        "seed", "J1", "J2", "J3", "rho 1", "rho 2", "rms", "furthest off"
    )?;
    let row = |values: [f64; 5]| values.map(|value| format!("{value:>10.5}")).concat();
    writeln!(text, "{:<8}{}", "truth", row([moments.x, moments.y, moments.z, rho.x, rho.y]))?;
    for (seed, fitted) in (1..).zip(fits) {
        let (j, rho) = (fitted.found.inertia(), fitted.found.rho);
        let worst = fitted.errors().into_iter().fold(0.0_f64, |worst, error| worst.max(error.abs()));
        let values = row([j.x, j.y, j.z, rho.x, rho.y]);
        writeln!(text, "{seed:<8}{values}{:>10.5}{worst:>10.1} dev.", fitted.rms)?;
    }
    let (spread, worst, above, count) = errors(fits);
    writeln!(
        text,
        "in standard deviations: root of the mean square {spread:.2}, furthest off {worst:.2}, {above} of {count} above 3"
    )?;
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The errors over twenty seeds are those that the covariance says: of a hundred normal numbers one in four sets has
    /// one above three standard deviations.
    #[test]
    fn the_inertia_is_found() {
        let fits: Vec<Fitted> =
            (1..=20).map(|seed| fit(&measured(READINGS, seed).expect("readings")).expect("a fit")).collect();
        let (spread, worst, above, _) = errors(&fits);
        assert!((spread - 1.0).abs() < 0.2 && above <= 1 && worst < 3.5, "{spread}, {worst}, {above}");
        assert!(fits.iter().all(|fitted| (fitted.rms / NOISE - 1.0).abs() < 0.1));
    }

    #[test]
    fn what_the_readings_dont_show_is_named() {
        let Seen { values, rank, residuals } = seen(&truth()).expect("a Jacobian");
        assert_eq!((rank, residuals.len()), (10, 2), "{values:?}");
        assert!(residuals.iter().all(|&residual| residual < 1e-6), "{residuals:?}");
    }

    /// The derivatives by the tangent map are those of differences.
    #[test]
    fn the_jacobian_is_that_of_the_readings() {
        let changes = Numbers::from_fn(|number, _| 0.01 * (number as f64 - 5.0));
        let all: Vec<usize> = (0..12).collect();
        let exact = truth().jacobian(&changes, 50).expect("a Jacobian");
        let found = truth().differences(&changes, 50, &all).expect("a Jacobian");
        for (exact, found) in exact.iter().zip(&found) {
            assert!((exact - found).amax() < 1e-5, "{exact} and {found}");
        }
    }
}
