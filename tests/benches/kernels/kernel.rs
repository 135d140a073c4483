//! Kernels in groups: their times side by side, and their instructions by valgrind.
//!
//! Kernels of a group take turns within one run, so that other load of the machine affects all of them alike, and are
//! compared with the first. Load only slows, and affects longer batches more often, so the fastest batch of each counts.
//! Instructions of a step don't depend on load: they are the count of `2N` steps minus that of `N`.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// The reason why something wasn't measured.
pub(crate) type Failure = Box<dyn std::error::Error>;

/// Runs this number of steps, and returns the number of Newton's iterations if they are counted, otherwise zero.
pub(crate) type Run = Box<dyn FnMut(u32) -> Result<u64, Failure>>;

/// A kernel: its name, and a closure that makes it ready to run.
pub(crate) struct Kernel {
    name: String,
    ready: Box<dyn Fn() -> Result<Run, Failure>>,
}

impl Kernel {
    pub(crate) fn new<R>(name: impl Into<String>, ready: impl Fn() -> Result<R, Failure> + 'static) -> Self
    where
        R: FnMut(u32) -> Result<u64, Failure> + 'static,
    {
        Self { name: name.into(), ready: Box::new(move || Ok(Box::new(ready()?))) }
    }
}

/// Steps of a batch, the number of batches, and the steps of a count of instructions.
///
/// A batch is long enough to hide the clock, and short enough that some aren't disturbed by other programs.
#[derive(Clone, Copy)]
pub(crate) struct Effort {
    pub(crate) batch: u32,
    pub(crate) rounds: u32,
    pub(crate) counted: u32,
}

/// Kernels that are compared with the first.
pub(crate) struct Group {
    pub(crate) name: String,
    pub(crate) effort: Effort,
    pub(crate) kernels: Vec<Kernel>,
}

/// Nanoseconds of a step in each round, and iterations of a step.
struct Times {
    ns: Vec<f64>,
    iterations: f64,
}

impl Group {
    pub(crate) fn new(name: impl Into<String>, effort: Effort, kernels: impl IntoIterator<Item = Kernel>) -> Self {
        Self { name: name.into(), effort, kernels: kernels.into_iter().collect() }
    }

    /// The name of a kernel among those of all groups.
    fn full(&self, kernel: &Kernel) -> String {
        if self.name.is_empty() { kernel.name.clone() } else { format!("{}: {}", self.name, kernel.name) }
    }

    #[allow(clippy::cast_precision_loss)] // far below 2⁵³
    fn times(&self) -> Result<Vec<Times>, Failure> {
        let Effort { batch, rounds, .. } = self.effort;
        let mut runs = self.kernels.iter().map(|kernel| (kernel.ready)()).collect::<Result<Vec<_>, _>>()?;
        let mut all: Vec<_> = runs.iter().map(|_| Times { ns: Vec::new(), iterations: 0.0 }).collect();
        for _ in 0..rounds {
            for (run, times) in runs.iter_mut().zip(&mut all) {
                let start = Instant::now();
                let iterations = run(batch)?;
                times.ns.push(start.elapsed().as_secs_f64() * 1e9 / f64::from(batch));
                times.iterations = iterations as f64 / f64::from(batch);
            }
        }
        Ok(all)
    }

    /// The time of a step in the fastest batch of each kernel, ns.
    #[allow(dead_code)] // a program without bounds of its own has no need of it
    pub(crate) fn fastest(&self) -> Result<Vec<f64>, Failure> {
        Ok(self.times()?.iter().map(|times| quantile(&times.ns, 0.0)).collect())
    }

    fn print_times(&self) -> Result<(), Failure> {
        let all = self.times()?;
        let first = &all[0].ns;
        let title = format!("{}, ns a step", self.name);
        println!(
            "{:<44}{:>11}{:>11}{:>11}{:>9}{:>9}{:>9}",
            title, "fastest", "median", "90 %", "ratio", "median", "gain"
        );
        for (kernel, Times { ns, iterations }) in self.kernels.iter().zip(&all) {
            let [fastest, median, slow] = [0.0, 0.5, 0.9].map(|part| quantile(ns, part));
            let ratio = fastest / quantile(first, 0.0);
            let ratios: Vec<f64> = ns.iter().zip(first).map(|(one, first)| one / first).collect();
            print!("{:<44}{fastest:>11.1}{median:>11.1}{slow:>11.1}", kernel.name);
            print!("{ratio:>9.2}{:>9.2}{:>9.2}", quantile(&ratios, 0.5), 1.0 / ratio);
            println!("{}", if *iterations > 0.0 { format!("{iterations:>9.2} iterations") } else { String::new() });
        }
        Ok(())
    }

    /// Counts each kernel in a process of its own.
    fn print_instructions(&self, table: &[&str]) -> Result<(), Failure> {
        let (program, mut first) = (std::env::current_exe()?, None);
        println!("{:<44}{:>12}{:>9}", self.name, "instructions", "ratio");
        for kernel in &self.kernels {
            let name = self.full(kernel);
            let words = [table, &["count", &name]].concat();
            let count = instructions(&program, &words, self.effort.counted)?;
            println!("{:<44}{count:>12.1}{:>9.2}", kernel.name, count / *first.get_or_insert(count));
        }
        Ok(())
    }
}

fn quantile(values: &[f64], part: f64) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    #[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, clippy::cast_sign_loss)] // some thousand
    let place = (values.len() as f64 * part) as usize;
    values[place]
}

/// The words after the program's name, without the `--bench` that cargo adds.
pub(crate) fn arguments() -> Vec<String> {
    std::env::args().skip(1).filter(|argument| argument != "--bench").collect()
}

/// Measures as the words of the command line say: `count NAME STEPS` runs one kernel and nothing else; `instructions` counts, nothing
/// times, and both take a part of the names that are wanted. The words in `table` lead the program to these groups.
pub(crate) fn measure(table: &[&str], groups: Vec<Group>, words: &[&str]) -> Result<(), Failure> {
    if let ["count", name, steps] = words {
        for group in &groups {
            if let Some(kernel) = group.kernels.iter().find(|kernel| group.full(kernel) == *name) {
                (kernel.ready)()?(steps.parse()?)?;
                return Ok(());
            }
        }
        return Err(format!("there is no kernel `{name}`").into());
    }
    let (is_count, filter) = match words {
        ["instructions", filter @ ..] => (true, filter),
        filter => (false, filter),
    };
    let mut found = false;
    for mut group in groups {
        let is_wanted = |name: &str| filter.iter().all(|part| name.contains(part));
        let all = std::mem::take(&mut group.kernels);
        group.kernels = all.into_iter().filter(|kernel| is_wanted(&group.full(kernel))).collect();
        if !group.kernels.is_empty() {
            found = true;
            if is_count { group.print_instructions(table)? } else { group.print_times()? }
        }
    }
    if found { Ok(()) } else { Err(format!("no kernel has {} in its name", filter.join(" and ")).into()) }
}

/// Instructions a step of a program whose last argument is a number of steps, from a run and one twice as long.
#[allow(clippy::cast_precision_loss)] // far below 2⁵³
pub(crate) fn instructions(program: &Path, arguments: &[&str], steps: u32) -> Result<f64, Failure> {
    let [once, twice] = [steps, 2 * steps].map(|steps| count(program, arguments, steps));
    Ok((twice? - once?) as f64 / f64::from(steps))
}

fn count(program: &Path, arguments: &[&str], steps: u32) -> Result<u64, Failure> {
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]);
    let output = valgrind.arg(program).args(arguments).arg(steps.to_string()).output();
    let output = output.map_err(|cause| format!("valgrind doesn't run: {cause}"))?;
    let report = String::from_utf8_lossy(&output.stderr);
    let collected = report.lines().find_map(|line| line.split_once("Collected :"));
    let (_, number) = collected.ok_or_else(|| format!("valgrind counted nothing: {report}"))?;
    Ok(number.trim().parse()?)
}

/// Builds a benchmark of this package by cargo with further options, and returns its path.
#[allow(dead_code)] // some benches build another
pub(crate) fn built(bench: &str, options: &[&str], flags: Option<&str>) -> Result<PathBuf, Failure> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["bench", "--no-run", "--bench", bench]).args(options);
    if let Some(flags) = flags {
        cargo.env("RUSTFLAGS", flags);
    }
    let output = cargo.output()?;
    let report = String::from_utf8_lossy(&output.stderr);
    let executable = report.lines().find_map(|line| line.trim().strip_prefix("Executable"));
    let place = executable.and_then(|line| line.split_once('(')?.1.strip_suffix(')'));
    Ok(place.ok_or_else(|| format!("{bench} isn't built: {report}"))?.into())
}
