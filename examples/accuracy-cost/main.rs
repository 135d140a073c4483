//! The time to an accuracy: structure-preserving methods compared with explicit Runge–Kutta methods on seven scenes.
//!
//! ```text
//! cargo run --release -p liestep-accuracy-cost --example accuracy-cost
//! cargo run --release -p liestep-accuracy-cost --example accuracy-cost -- --quick --out costs
//! cargo run --release -p liestep-accuracy-cost --example accuracy-cost -- --quick --asked
//! cargo run --release -p liestep-accuracy-cost --example accuracy-cost -- --readme
//! ```
//!
//! Each method integrates each scene for 10 s and for 100 s with shorter and shorter steps. The error is that of the
//! attitude and the body velocity at the end, against references to 25 digits and more; the cost is the time of one
//! processor for the run, without the folding of constants and without output. The tables list our cheapest method for
//! each error, and compare its time with that of the fastest rival. The rivals integrate unit quaternion and momentum.
//! All runs are written as CSV. `with_heyoka.py` runs a Taylor integrator on the same scenes.
//!
//! With `--asked` the library chooses the method for an accuracy, and its time is compared with that of the fastest
//! fixed choice; the column `trials` is the cost of the choice itself, in such runs.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::{Command, ExitCode};
use std::time::Duration;

use accuracy_cost::figure::{Panel, figure};
use accuracy_cost::measure::ladder;
use accuracy_cost::report::MethodRuns;
use accuracy_cost::scenes::Scene;
use accuracy_cost::{methods, report};
use liestep_refinement::Effort;
use workbench::args::{Failure, example};
use workbench::output::{Output, print};
use workbench::progress::Progress;

const HELP: &str = "Measures what each accuracy costs in time, with our methods and with others'

Options:
      --quick         Fewer and shorter runs: all is done within a minute
      --scene <NAME>  Only this scene: looping, cuspidal, third, chaotic, free, sprung or orbiting
      --heyoka        Run with_heyoka.py, too, where Python has heyoka
      --readme        Put the table of ratios into the examples' page and the figure into README, too
      --asked         Ask for accuracies instead, and see what the choices take beside the best fixed ones
      --out <DIR>     The folder for the figure and the runs [default: out/accuracy-cost]
  -h, --help          Print this
";

#[allow(clippy::struct_excessive_bools)] // each is a word of its own
struct Arguments {
    quick: bool,
    scene: Option<String>,
    asked: bool,
    readme: bool,
    heyoka: bool,
    out: PathBuf,
}

fn main() -> ExitCode {
    example(HELP, |words| {
        let mut arguments = Arguments {
            quick: false,
            scene: None,
            asked: false,
            readme: false,
            heyoka: false,
            out: "out/accuracy-cost".into(),
        };
        while let Some(option) = words.option()? {
            match option.as_str() {
                "quick" => arguments.quick = true,
                "scene" => arguments.scene = Some(words.text()?),
                "asked" => arguments.asked = true,
                "heyoka" => arguments.heyoka = true,
                "readme" => arguments.readme = true,
                "out" => arguments.out = words.folder()?,
                _ => return Err(words.unknown()),
            }
        }
        compare(&arguments)
    })
}

/// The output of the script, or the reason why it doesn't run.
fn with_heyoka(arguments: &Arguments) -> String {
    let mut python = Command::new("python3");
    python.arg(concat!(env!("CARGO_MANIFEST_DIR"), "/with_heyoka.py")).arg("--out").arg(&arguments.out);
    if let Some(scene) = &arguments.scene {
        python.args(["--scene", scene]);
    }
    match python.output() {
        Ok(output) => String::from_utf8_lossy(&output.stdout).into_owned(),
        Err(cause) => format!("heyoka is left out: python3 doesn't run: {cause}"),
    }
}

/// The durations of the integration of each scene, s.
const TIMES: [f64; 2] = [10.0, 100.0];

fn compare(arguments: &Arguments) -> Result<(), Failure> {
    // The effort, and the ratio between two successive steps.
    let effort = |t: f64| {
        if arguments.quick {
            (Effort { longest: 2e-4 * t, repeated: Duration::from_millis(2) }, 1.6)
        } else {
            (Effort { longest: 4e-3 * t, repeated: Duration::from_millis(15) }, 1.25)
        }
    };
    let mut scenes = Vec::from(Scene::all());
    if let Some(wanted) = &arguments.scene {
        scenes.retain(|scene| scene.short == wanted);
        if scenes.is_empty() {
            return Err(format!("no scene is called {wanted}; see --help").into());
        }
    }
    if arguments.asked {
        print(&format!("{}\n", accuracy_cost::asked::compare(&scenes, effort)))?;
        return Ok(());
    }
    let mut output = Output::new(arguments.out.clone())?;
    let (mut text, mut data, mut results) = (String::new(), report::Data::default(), Vec::new());
    let count: usize = scenes.iter().map(|scene| TIMES.len() * methods::all(scene).len()).sum();
    let mut progress = Progress::new(count.try_into()?);
    for scene in &scenes {
        let methods = methods::all(scene);
        for t in TIMES {
            let mut measured = Vec::new();
            for method in &methods {
                progress.add(0, &format!("{}, {}", scene.name, method.name));
                measured.push(MethodRuns::new(method, ladder(method, scene, t, effort(t))));
                progress.add(1, &format!("{}, {}", scene.name, method.name));
            }
            let title = format!("{}, {t} s", scene.name);
            // Writing to a string can't fail.
            let _ = write!(text, "{title}\n\n{}\n\n{}\n\n", report::costs(&measured), report::best(&measured));
            data.add(scene.short, t, &measured);
            results.push((title, measured));
        }
    }
    drop(progress);
    let readme = report::ratios(&results);
    let panels: Vec<_> = results.iter().map(|(title, methods)| Panel { title: title.clone(), methods }).collect();
    let picture = figure(&panels)?;
    if arguments.readme {
        report::put_into_readme(&readme, &picture)?;
    }
    output.write("accuracy-cost.svg", &picture)?;
    output.write("accuracy-cost.csv", &data.to_csv())?;
    if arguments.heyoka {
        let _ = write!(text, "{}\n\n", with_heyoka(arguments));
    }
    print(&format!("{text}{readme}\n{output}"))?;
    Ok(())
}
