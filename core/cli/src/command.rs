//! The command line.

use std::path::PathBuf;

use clap::builder::{PathBufValueParser, TypedValueParser as _};
use clap::{Arg, ArgAction, ArgGroup, ArgMatches, Command, ValueHint, value_parser};
use clap_complete::Shell;
use liestep_ensemble::share_of;

use crate::failure::Failure;
use crate::output::print;

const CODES: &str = "\
Exit codes:
  0  all is done; members of an ensemble that can't exist are counted
  1  a file can't be read or is wrong; the message has its line and column
  2  the command line is wrong
  3  a run stopped: a step or a start that isn't possible; of an ensemble, members broke down
  4  a result can't be written or printed
  130  Ctrl-C has stopped an ensemble, which keeps its finished files; the message has the command that goes on";

/// An example of a file, and how its keys are found.
const SCENE: &str = "\
A scene is a file of TOML, as this one of a body in space:

  [body]
  moments = [1, 2, 3]                      # kg m²
  [start]
  yaw_pitch_roll = [0, \"5 deg\", 0]
  velocity = [0, 0.1, 5]                   # rad/s, body frame
  [torque]
  torque = [0, 0, 0.01]                    # N m, or over time: { csv = \"FILE\", columns = [\"x\", \"y\", \"z\"], between = \"steps\" }
  [run]
  step = 0.01                              # s, or an accuracy
  duration = 10                            # s

Several bodies are tables [[body]] with [[joint]], whose numbers may change over time, too, or by { formula = \"2 * sin(3 * t)\" }:
NUMBERS. Along an [orbit] a duration may be \"3 orbits\". Further tables are [orbit] with a tle, [[control]], [[wheel]], [[pointing]], [output],
[sweep] and [ensemble]. A key that isn't known is answered by those that its table has. The page of `liestep-scene` has all of them,
and examples/scenes many scenes.";

fn scene() -> String {
    SCENE.replace("NUMBERS", &liestep_scene::changing_numbers())
}

pub(crate) fn command() -> Command {
    let scenes = || files("The scene files");
    let verify = || {
        flag("verify", "Read every file that is there, and set damaged ones aside; without, their names are trusted")
    };
    Command::new("liestep")
        .version(env!("CARGO_PKG_VERSION"))
        .about("Simulates rigid bodies from scene files, by steps that keep what the motion conserves")
        .after_help(CODES)
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommand(
            Command::new("run")
                .about("Simulates scenes and draws them")
                .after_help(scene())
                .arg(scenes())
                .arg(out())
                .arg(flag("csv", "Also write a table as CSV, while it runs"))
                .arg(flag("arrow", "Also write the table as a stream of Arrow IPC, .arrows, while it runs; in Python pyarrow.ipc.open_stream(path).read_pandas() reads it"))
                .arg(flag("html", "Also write a page that plays the motion, to be opened in a browser")),
        )
        .subcommand(Command::new("check").about("Reads scenes and makes their first step").after_help(scene()).arg(scenes()))
        .subcommand(
            Command::new("sweep")
                .about("Runs every scene of a file's table `sweep`, and prints a row of FILE.sweep.csv for each")
                .arg(scenes())
                .arg(out()),
        )
        .subcommand(
            Command::new("ensemble")
                .about("Runs the members that a file's table `ensemble` draws, and keeps them in files of Arrow IPC in the folder FILE.ensemble; stopped at any moment, or with more `members`, the next run goes on")
                .arg(scenes())
                .arg(
                    Arg::new("threads")
                        .long("threads")
                        .value_name("N")
                        .help("The number of threads; 0 for as many as there are processors")
                        .default_value("0")
                        .value_parser(value_parser!(usize)),
                )
                .arg(
                    Arg::new("share")
                        .long("share")
                        .value_name("I/N")
                        .help("Only this share of the members, from 0/N on: for an array of jobs, which write to one folder")
                        .value_parser(share_of),
                )
                .arg(verify())
                .arg(out()),
        )
        .subcommand(
            Command::new("report")
                .about("Prints what has become of an ensemble's members by now; of their files it reads the heads, or sums of a thousand of these")
                .arg(scenes())
                .arg(verify())
                .arg(out()),
        )
        .subcommand(derive())
        .subcommand(fmu())
        .subcommand(import())
        .subcommand(
            Command::new("replay")
                .about("Makes pages that play recorded runs, to be opened in a browser")
                .arg(files("Tables that were written by `run --csv`"))
                .arg(out()),
        )
        .subcommand(
            Command::new("completions")
                .about("Prints what a shell needs to complete these commands")
                .arg(Arg::new("SHELL").required(true).value_parser(value_parser!(Shell))),
        )
}

fn derive() -> Command {
    Command::new("derive")
        .about("Prints what is derived of an effect, or of a scene")
        .arg(Arg::new("NAME").help("An effect or a scene file; all effects are listed if it is left away"))
        .arg(flag("latex", "The equations as LaTeX"))
        .arg(flag("rust", "The straight-line code of a step in Rust"))
        .arg(flag("c", "A step as C99 without dependencies"))
        .arg(flag("header", "The declarations of that step, for other units"))
        .arg(flag("gpu", "A step of many members as one text in OpenCL C, CUDA and C99"))
        .arg(
            flag(
                "compensated",
                "With --c, --header or --gpu: what rounding takes from a sum is added to its next change",
            )
            .requires("form")
            .conflicts_with_all(["latex", "rust", "js", "certificate"]),
        )
        .arg(flag("js", "A step in JavaScript"))
        .arg(flag("certificate", "The step as data with its claims, for `python -m liestep.verify`"))
        .group(
            ArgGroup::new("form").args(["latex", "rust", "c", "header", "gpu", "js", "certificate"]).requires("NAME"),
        )
}

fn fmu() -> Command {
    Command::new("fmu")
        .about("Writes scenes as units of other simulations by FMI 3.0: the source, and a binary where there is `cc`")
        .arg(files("The scene files"))
        .arg(flag("fmi2", "FMI 2.0, whose variables are numbers"))
        .arg(out())
}

fn import() -> Command {
    Command::new("import")
        .about("Writes a scene for each model of a robot, with what has no counterpart as comments")
        .arg(files("Models of URDF, SDF or MJCF"))
        .arg(flag("floating", "The root link of URDF is a body that floats; without, it is space"))
        .arg(out())
}

fn files(help: &'static str) -> Arg {
    let named = PathBufValueParser::new();
    Arg::new("FILE").help(help).required(true).num_args(1..).value_parser(named).value_hint(ValueHint::FilePath)
}

fn out() -> Arg {
    // An empty path is no folder.
    let named = PathBufValueParser::new()
        .try_map(|folder: PathBuf| if folder.as_os_str().is_empty() { Err("a folder has a name") } else { Ok(folder) });
    let out = Arg::new("out").long("out").value_name("DIR").help("The folder for the results").default_value("out");
    out.value_parser(named).value_hint(ValueHint::DirPath)
}

fn flag(name: &'static str, help: &'static str) -> Arg {
    Arg::new(name).long(name).help(help).action(ArgAction::SetTrue)
}

/// Prints the completions for a shell.
pub(crate) fn complete(given: &ArgMatches) -> Result<(), Failure> {
    let Some(shell) = given.get_one::<Shell>("SHELL") else { return Ok(()) };
    let mut script = Vec::new();
    clap_complete::generate(*shell, &mut command(), "liestep", &mut script);
    print(&String::from_utf8_lossy(&script))
}
