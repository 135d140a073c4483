//! Instructions a step, by valgrind: the count of `2N` steps minus that of `N`.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The reason why counting failed.
pub(crate) type Uncounted = Box<dyn std::error::Error>;

/// Instructions a step of a program whose last argument is a number of steps, from a run and one twice as long.
#[allow(clippy::cast_precision_loss)] // far below 2⁵³
pub(crate) fn instructions(program: &Path, arguments: &[&str], steps: u32) -> Result<f64, Uncounted> {
    let [once, twice] = [steps, 2 * steps].map(|steps| count(program, arguments, steps));
    Ok((twice? - once?) as f64 / f64::from(steps))
}

fn count(program: &Path, arguments: &[&str], steps: u32) -> Result<u64, Uncounted> {
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]);
    let output = valgrind.arg(program).args(arguments).arg(steps.to_string()).output();
    let output = output.map_err(|cause| format!("valgrind doesn't run: {cause}"))?;
    let report = String::from_utf8_lossy(&output.stderr);
    let collected = report.lines().find_map(|line| line.split_once("Collected :"));
    let (_, number) = collected.ok_or_else(|| format!("valgrind counted nothing: {report}"))?;
    Ok(number.trim().parse()?)
}

/// Builds another benchmark and returns its path.
#[allow(dead_code)] // one bench of two builds another
pub(crate) fn built(bench: &str) -> Result<PathBuf, Uncounted> {
    let mut cargo = Command::new(env!("CARGO"));
    let output = cargo.args(["bench", "--no-run", "--bench", bench]).output()?;
    let report = String::from_utf8_lossy(&output.stderr);
    let executable = report.lines().find_map(|line| line.trim().strip_prefix("Executable"));
    let place = executable.and_then(|line| line.split_once('(')?.1.strip_suffix(')'));
    Ok(place.ok_or_else(|| format!("{bench} isn't built: {report}"))?.into())
}
