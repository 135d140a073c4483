//! The costs of steps, in time and in instructions.
//!
//! ```text
//! cargo bench -p liestep-benches -- TABLE [FILTER]                 times of the kernels with FILTER in their names
//! cargo bench -p liestep-benches -- TABLE instructions [FILTER]    their instructions a step, by valgrind
//! cargo bench -p liestep-benches -- TABLE count NAME 1000          1000 steps of one kernel and nothing else
//! ```
//!
//! | table | |
//! |---|---|
//! | `heavy-top` | a step derived, by hand and by Runge–Kutta; declared kinetic terms beside each other |
//! | `scenes` | an effect in a step, by the program `scenes.rs` |
//! | `files` | scenes from files, by machine code with `--features machine` |
//! | `methods` | every method, in seven scenes |
//! | `gradients` | derivatives of steps |
//! | `recording` | recorded runs |
//! | `systems` | several bodies, in SIMD lanes; those of one body are a bench of `liestep-lanes` |
//! | `ensemble` | members of an ensemble of 1,000 steps, with and without files, on one and two threads, with failures |
//!
//! | other words | |
//! |---|---|
//! | `zero-cost` | the instructions of the free body in this program and in one of its own |
//! | `members` | the time of a member of a file's ensemble, and of its steps in lanes |
//! | `memory 100000000` | the most memory of so many steps that are recorded as a file |
//! | `many 10000000` | the most memory of an ensemble of so many members of ten steps |
//! | `splittings` | symmetric tops by splittings in lanes, beside heyoka where Python has it |
//! | `control [STEPS]...` | the time of a search for a control |
//! | `compile-time` | the incremental build of a crate with one declaration |

mod by_hand;
mod compile_time;
mod control;
mod ensemble;
mod files;
mod gradients;
mod heavy_top;
mod kernel;
mod methods;
mod recording;
mod splittings;
#[allow(dead_code)] // the scenes are a program of their own
mod stepping;
mod systems;

use std::process::Command;

use kernel::{Failure, Group, arguments, built, measure};

type Table = (&'static str, fn() -> Result<Vec<Group>, Failure>);

const TABLES: [Table; 7] = [
    ("heavy-top", heavy_top::groups),
    ("files", || Ok(files::groups())),
    ("methods", || Ok(methods::groups())),
    ("gradients", gradients::groups),
    ("recording", || Ok(recording::groups())),
    ("systems", || Ok(systems::groups())),
    ("ensemble", || Ok(ensemble::groups())),
];

/// The most memory of this process so far, where Linux reports it.
fn most_memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.unwrap_or("not reported by this system").trim().to_owned()
}

/// Runs the program of the scenes with these words.
fn scenes(words: &[&str]) -> Result<(), Failure> {
    let status = Command::new(built("scenes", &[], None)?).args(words).status()?;
    if status.success() { Ok(()) } else { Err("the scenes' program has failed".into()) }
}

fn main() -> Result<(), Failure> {
    let words = arguments();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["zero-cost"] => scenes(&words),
        ["scenes", words @ ..] => scenes(words),
        ["members"] => files::members(),
        ["memory", steps] => recording::memory(steps.parse()?),
        ["many", members] => ensemble::memory(members.parse()?),
        ["splittings"] => splittings::splittings(),
        ["control", steps @ ..] => control::print(steps),
        ["compile-time"] => Ok(compile_time::print()?),
        [table, words @ ..] => {
            let (name, groups) = TABLES.iter().find(|(name, _)| name == table).ok_or_else(|| {
                let names: Vec<_> = TABLES.iter().map(|(name, _)| *name).collect();
                format!("no table is called `{table}`; the tables are scenes, {}", names.join(", "))
            })?;
            if *name == "heavy-top" && !words.contains(&"count") {
                heavy_top::check()?;
            }
            measure(&[*name], groups()?, words)
        }
        [] => {
            scenes(&[])?;
            TABLES.iter().try_for_each(|(name, groups)| {
                println!("\n{name}");
                measure(&[*name], groups()?, &[])
            })
        }
    }
}
