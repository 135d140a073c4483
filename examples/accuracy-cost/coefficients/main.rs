//! Finds the coefficients of processed splittings, and those of the library again.
//!
//! ```text
//! cargo run --release --example coefficients
//! cargo run --release --example coefficients -- --kernel "kick/ drift kick drift"
//! cargo run --release --example coefficients -- --processor "processed 3-6 a" --stages 5 --unseen
//! ```
//!
//! A kernel's first half is written as drifts and kicks, up to the middle one; a slash marks kicks with a force
//! gradient. The solutions from random starts are printed with 30 digits, those first that leave the least error at the
//! next order. Which of them is best that error doesn't tell: with `--unseen` they are tried on ten asymmetric tops that
//! the seed draws, and what they cost there is printed beside those of the library.
//!
//! Without options those of the library are printed with 30 digits, with which the equations of their order hold to
//! 1e-30; or it is an error where no solution is as near as its numbers are rounded. Where solutions are a family, as
//! those of most processors are, it is the one that is nearest.

mod problem;
#[cfg(test)]
mod rivals;
mod search;
mod unseen;
mod words;

use std::fmt::Write as _;
use std::process::ExitCode;

use liestep::laws::samples::Random;
use liestep::methods::{Flow, ProcessedScheme};
use workbench::args::{Failure, example};
use workbench::double_double::DoubleDouble;
use workbench::output::print;

use problem::{Form, Problem, Wanted};
use search::{best, made_good};
use unseen::{LEVELS, Top, means};
use words::Part;

const HELP: &str = "Finds coefficients of processed splittings; without options those of the library, with 30 digits

Options:
      --kernel <HALF>     Kernels that begin so, such as \"kick/ drift kick drift\", to the middle one
      --processor <NAME>  Processors of the kernel of a scheme of the library
      --order <P>         The order of a kernel, 4 or 6 [default: 6]
      --stages <N>        The kicks of a processor [default: 5]
      --kick-first        Processors that begin with a kick
      --starts <N>        From how many random starts [default: 100]
      --keep <N>          How many are printed [default: 5]
      --seed <N>          Which random starts, and which tops [default: 1]
      --unseen            Try processors on ten tops
  -h, --help              Print this
";

struct Arguments {
    kernel: Option<String>,
    processor: Option<String>,
    order: usize,
    stages: usize,
    kick_first: bool,
    starts: u64,
    keep: usize,
    seed: u64,
    unseen: bool,
    /// Which of them were given.
    given: Vec<String>,
}

fn main() -> ExitCode {
    example(HELP, |line| {
        let mut arguments = Arguments {
            kernel: None,
            processor: None,
            order: 6,
            stages: 5,
            kick_first: false,
            starts: 100,
            keep: 5,
            seed: 1,
            unseen: false,
            given: Vec::new(),
        };
        while let Some(option) = line.option()? {
            match option.as_str() {
                "kernel" => arguments.kernel = Some(line.text()?),
                "processor" => arguments.processor = Some(line.text()?),
                "order" => arguments.order = line.one_of(&[("4", 4), ("6", 6)])?,
                "stages" => arguments.stages = line.count()?,
                "kick-first" => arguments.kick_first = true,
                "starts" => arguments.starts = line.count()?,
                "keep" => arguments.keep = line.count()?,
                "seed" => arguments.seed = line.count()?,
                "unseen" => arguments.unseen = true,
                _ => return Err(line.unknown()),
            }
            arguments.given.push(option);
        }
        find(&arguments)
    })
}

fn find(arguments: &Arguments) -> Result<(), Failure> {
    let only = |allowed: &[&str]| match arguments.given.iter().find(|option| !allowed.contains(&option.as_str())) {
        None => Ok(()),
        Some(option) => Err(Failure::from(format!("'--{option}' isn't for what is looked for here; see --help"))),
    };
    match (&arguments.kernel, &arguments.processor) {
        (Some(half), _) => {
            only(&["kernel", "order", "starts", "keep", "seed"])?;
            kernels(arguments, half)
        }
        (None, Some(name)) => {
            only(&["processor", "stages", "kick-first", "starts", "keep", "seed", "unseen"])?;
            processors(arguments, name)
        }
        (None, None) => {
            only(&[])?;
            library()
        }
    }
}

/// The form that is written as `kick/ drift kick`.
fn form(half: &str) -> Result<Form, Failure> {
    let parts: Vec<&str> = half.split_whitespace().collect();
    let kick_first = parts.first().is_some_and(|first| first.starts_with("kick"));
    let mut gradients = Vec::new();
    for (place, part) in parts.iter().enumerate() {
        match (kick_first == place.is_multiple_of(2), *part) {
            (true, "kick") | (false, "drift") => {}
            (true, "kick/") => gradients.push(place),
            _ => return Err(format!("drifts and kicks take turns, and {part} isn't the next").into()),
        }
    }
    if parts.len() < 2 {
        return Err("a kernel has a drift and a kick at least".into());
    }
    Ok(Form { kick_first, half: parts.len(), gradients })
}

fn kernels(arguments: &Arguments, half: &str) -> Result<(), Failure> {
    let problem = Problem::new(arguments.order, Wanted::Kernel(form(half)?));
    for (left, parts) in polished(&problem, arguments)? {
        print(&format!("{left:.4e} is left\n{}\n", text(&parts)))?;
    }
    Ok(())
}

/// What a solution leaves at the next order, and its drifts and kicks with 30 digits.
type Polished = (f64, Vec<Part<DoubleDouble>>);

/// The best solutions.
fn polished(problem: &Problem, arguments: &Arguments) -> Result<Vec<Polished>, Failure> {
    let found = best(problem, &mut Random::new(arguments.seed), arguments.starts, arguments.keep);
    let polish = |found: &search::Found| Some((found.left, problem.parts(&problem.polished(&found.unknowns)?)));
    let polished: Vec<_> = found.iter().filter_map(polish).collect();
    if polished.is_empty() {
        let (found, starts) = (found.len(), arguments.starts);
        return Err(format!("{found} solutions from {starts} starts, of which none can be polished").into());
    }
    print(&format!("{} of the best {} solutions have 30 digits\n\n", polished.len(), found.len()))?;
    Ok(polished)
}

/// A line for each part.
fn text(parts: &[Part<DoubleDouble>]) -> String {
    let mut text = String::new();
    for part in parts {
        // Writing to a string can't fail.
        let _ = match part {
            Part::Drift(a) => writeln!(text, "    drift {a:>33}"),
            Part::Kick(b, g) => writeln!(text, "    kick  {b:>33} {g:>33}"),
        };
    }
    text
}

/// A kernel of the library, with 30 digits.
fn kernel(scheme: &ProcessedScheme) -> Result<Vec<Part<DoubleDouble>>, Failure> {
    let parts: Vec<_> = scheme.kernel().shares().zip(scheme.kernel().gradients()).collect();
    let half = parts.len().div_ceil(2);
    let is_kick = |place: &usize| parts[*place].0.0 == Flow::Kick;
    let gradients = (0..half).filter(|place| is_kick(place) && parts[*place].1 != 0.0).collect();
    let form = Form { kick_first: is_kick(&0), half, gradients };
    let mut start: Vec<f64> = parts[..half].iter().map(|((_, share), _)| *share).collect();
    start.extend(form.gradients.iter().map(|place| parts[*place].1));
    let problem = Problem::new(order(scheme)?, Wanted::Kernel(form));
    start.resize(problem.unknowns(), 0.0);
    same(scheme, &problem, &made_good(&problem, &start))
}

/// Its processor, with 30 digits.
fn processor(scheme: &ProcessedScheme, kernel: Vec<Part<DoubleDouble>>) -> Result<Vec<Part<DoubleDouble>>, Failure> {
    let parts: Vec<_> = scheme.processor().collect();
    let kick_first = parts[0].1 == 0.0;
    let wanted = Wanted::Processor { kernel, stages: parts.len() / 2, kick_first };
    let shares = parts.iter().flat_map(|&(flow, share, gradient)| match flow {
        Flow::Drift => vec![share],
        Flow::Kick => vec![share, gradient],
    });
    let start: Vec<f64> = shares.skip(usize::from(kick_first)).collect();
    same(scheme, &Problem::new(order(scheme)?, wanted), &start)
}

/// The solution that these are the first digits of.
fn same(scheme: &ProcessedScheme, problem: &Problem, digits: &[f64]) -> Result<Vec<Part<DoubleDouble>>, Failure> {
    let polished = problem.polished(digits).ok_or_else(|| format!("{}: no solution is near", scheme.name()))?;
    let shares = problem.shares();
    let apart = digits[..shares].iter().zip(&polished).map(|(a, b)| (b.rounded() - a).abs()).fold(0.0, f64::max);
    if apart > 1e-15 {
        return Err(format!("{}: the solution that is near is {apart:.1e} apart", scheme.name()).into());
    }
    Ok(problem.parts(&polished))
}

fn order(scheme: &ProcessedScheme) -> Result<usize, Failure> {
    Ok(scheme.order().try_into()?)
}

fn processors(arguments: &Arguments, name: &str) -> Result<(), Failure> {
    let scheme = ProcessedScheme::ALL.into_iter().find(|scheme| scheme.name() == name);
    let scheme = scheme.ok_or_else(|| {
        let names: Vec<_> = ProcessedScheme::ALL.iter().map(|scheme| scheme.name().to_owned()).collect();
        format!("no scheme is called {name}; there are: {}", names.join(", "))
    })?;
    let (stages, kick_first) = (arguments.stages, arguments.kick_first);
    let wanted = Wanted::Processor { kernel: kernel(&scheme)?, stages, kick_first };
    let problem = Problem::new(order(&scheme)?, wanted);
    let all = polished(&problem, arguments)?;
    let tops = if arguments.unseen { Top::drawn(&mut Random::new(arguments.seed), 10)? } else { Vec::new() };
    if arguments.unseen {
        print(&format!("drifts to the errors {LEVELS:?}\n"))?;
        for scheme in ProcessedScheme::ALL {
            print(&format!("{:<16}{}\n", scheme.name(), costs(&tops, scheme)))?;
        }
    }
    for (left, parts) in all {
        print(&format!("\n{left:.4e} is left\n{}", text(&parts)))?;
        if arguments.unseen {
            print(&format!("{:<16}{}\n", "", costs(&tops, as_scheme(&scheme, &parts))))?;
        }
    }
    Ok(())
}

fn costs(tops: &[Top], scheme: ProcessedScheme) -> String {
    let cost = |mean: Option<f64>| mean.map_or_else(|| format!("{:>9}", "–"), |mean| format!("{mean:>9.1}"));
    means(tops, scheme).map(cost).concat()
}

/// The kernel of a scheme with another processor, for the rest of this run.
fn as_scheme(scheme: &ProcessedScheme, parts: &[Part<DoubleDouble>]) -> ProcessedScheme {
    let (mut rows, mut last) = (Vec::new(), 0.0);
    for part in parts {
        match part {
            Part::Drift(a) => last = a.rounded(),
            Part::Kick(b, g) => rows.push([last, b.rounded(), g.rounded()]),
        }
    }
    ProcessedScheme::new("found", scheme.order(), scheme.kernel(), Vec::leak(rows), last)
}

fn library() -> Result<(), Failure> {
    for scheme in ProcessedScheme::ALL {
        let kernel = kernel(&scheme)?;
        let processor = processor(&scheme, kernel.clone())?;
        print(&format!("{}\n  kernel\n{}  processor\n{}", scheme.name(), text(&kernel), text(&processor)))?;
    }
    Ok(())
}
