//! Pages that compute the motion anew: their script, run by node, has the bits of the program's table.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::called::{TOP, folder, printed, table};

/// Whether node is installed; if it isn't, a reason is printed.
fn has_node() -> bool {
    let found = Command::new("node").arg("--version").output().is_ok();
    if !found {
        println!("skipped: there is no `node`");
    }
    found
}

/// The part of a page that has the step, the numbers and the start.
fn model(page: &str) -> Option<&str> {
    let (_, behind) = page.split_once("\n/* The step. */\n")?;
    Some(behind.split_once("\n/* End of the model. */\n")?.0)
}

/// The momenta after each `every`-th step by a page's script, with a number in the place of a slider's.
fn by_node(folder: &Path, page: &str, (steps, every): (usize, usize), change: &str) -> Vec<Vec<f64>> {
    let model = model(page).expect("a model");
    let script = format!(
        "{model}
const values = model.sliders.map(({{ value }}) => value), set = (name, value) => {{
  const k = model.sliders.findIndex(slider => slider.name === name);
  if (k < 0) throw new Error(model.sliders.map(slider => slider.name).join());
  values[k] = value;
}};
{change}
const course = begun(values), lines = [];
const show = () => lines.push([...course.state.momentum].join(\",\"));
for (let n = 1, _ = show(); n <= {steps}; n++) {{ if (!advanced(course)) throw new Error(`refused: ${{n}}`); if (n % {every} === 0) show(); }}
console.log(\"names\\n\" + lines.join(\"\\n\"));
"
    );
    fs::write(folder.join("page.js"), script).unwrap();
    let run = Command::new("node").current_dir(folder).arg("page.js").output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    table(&String::from_utf8(run.stdout).unwrap())
}

/// The page of a scene, and the momenta of its table.
fn run(folder: &Path, text: &str) -> (String, Vec<Vec<f64>>) {
    fs::write(folder.join("scene.toml"), text).unwrap();
    printed(folder, &["run", "scene.toml", "--csv", "--html", "--out", "."]);
    let rows = table(&fs::read_to_string(folder.join("scene.csv")).unwrap());
    let page = fs::read_to_string(folder.join("scene.html")).unwrap();
    (page, rows.into_iter().map(|row| row[1..4].to_vec()).collect())
}

fn bits(rows: &[Vec<f64>]) -> Vec<u64> {
    rows.iter().flatten().map(|number| number.to_bits()).collect()
}

const EVERY: usize = 100;
const STEPS: usize = 10_000;

/// The scene with so many steps, and the momentum as its table.
fn long(text: &str) -> String {
    let (before, _) = text.split_once("[run]").unwrap();
    let method = text.lines().find(|line| line.starts_with("method")).unwrap_or_default();
    let step = text.lines().find(|line| line.starts_with("step")).unwrap();
    let seconds: f64 =
        step.split_once('=').unwrap().1.trim().trim_matches('"').trim_end_matches(" ms").parse().unwrap();
    let seconds = if step.contains("ms") { seconds * 1e-3 } else { seconds };
    let mut long = format!("{before}[run]\n{step}\n{method}\n");
    let _ = write!(long, "duration = {:?}\n[output]\ncolumns = [\"momentum\"]\nevery = {EVERY}\n", seconds * 1e4);
    long
}

const FREE: &str = "title = \"free\"\n[body]\nmoments = [1, 2, 2.5]\n[start]\neuler = [0.1, 0.2, 0.3]\nvelocity = [0.01, 2, 0.01]\n[run]\nstep = 0.01\n";
const LOADED: &str = "title = \"loaded\"\n[body]\nJ = [[2, 0.1, 0], [0.1, 3, 0.2], [0, 0.2, 4]]\n[gravity]\nm = 1\ng = 9.81\nrho = [0.1, 0, 1]\nup = [0, 0, 1]\n\
    [rotor]\nspin = [0, 0, 1]\n[start]\neuler = [0.1, 0.2, 0.3]\nmomentum = [0.5, 2, 20]\n[run]\nstep = \"10 ms\"\n";

/// Ten thousand steps of scenes without functions of the engine.
#[test]
fn a_page_has_the_bits_of_the_program() {
    if !has_node() {
        return;
    }
    let composed = format!("{FREE}method = {{ composition = \"Suzuki 4\" }}\n");
    let own = include_str!("../../../../examples/scenes/own-lagrangian.toml");
    for (name, text) in [("free", FREE), ("top", TOP), ("loaded", LOADED), ("composed", &composed), ("own", own)] {
        let folder = folder(&format!("computed-{name}"));
        let (page, rows) = run(&folder, &long(text));
        assert!(page.contains("isExact: true"), "{name}");
        let found = by_node(&folder, &page, (STEPS, EVERY), "");
        assert_eq!(rows.len(), STEPS / EVERY + 1, "{name}");
        assert_eq!(bits(&found), bits(&rows), "{name}");
    }
}

/// A slider's number has the bits of a file with that number; inertias of effects follow that of the body.
#[test]
fn a_slider_is_a_number_of_the_file() {
    if !has_node() {
        return;
    }
    let folder = folder("computed-slider");
    let (page, rows) = run(&folder, &long(TOP));
    let heavier = long(&TOP.replace("m = \"1 kg\"", "m = \"1.3 kg\"").replace("m = 1\n", "m = 1.3\n"));
    assert_ne!(heavier, long(TOP));
    let (_, other) = run(&folder, &heavier);
    let found = by_node(&folder, &page, (STEPS, EVERY), "set(\"gravity.m\", 1.3);");
    assert_eq!(bits(&found), bits(&other));
    assert_ne!(bits(&found), bits(&rows));
    // A turn of the start about the vertical is seen in space alone, another one in the body.
    let apart = |axis: &str| {
        let turned = by_node(&folder, &page, (100, EVERY), &format!("set(\"start: turned about {axis}\", 37);"));
        turned[1].iter().zip(&rows[1]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    assert!(apart("e₃") < 1e-10 && apart("e₁") > 1e-3, "{:e} {:e}", apart("e₃"), apart("e₁"));
    let faster = by_node(&folder, &page, (1, 1), "set(\"start: Ω₃\", 6.5); set(\"body.J_d 3\", 2.5);");
    assert!((faster[0][2] - rows[0][2]).abs() > 0.1, "{faster:?}");
}

/// A step with functions of the engine says so, and agrees to rounding; scenes that no page computes have no sliders.
#[test]
fn functions_of_the_engine_are_said() {
    if !has_node() {
        return;
    }
    let folder = folder("computed-functions");
    let geodesic = LOADED.replace("[gravity]", "kinetic = \"geodesic\"\n[gravity]");
    let (page, rows) = run(&folder, &long(&geodesic));
    assert!(page.contains("isExact: false") && page.contains("Computed in this page"));
    let found = by_node(&folder, &page, (1_000, EVERY), "");
    let apart = found.iter().zip(&rows).flat_map(|(a, b)| a.iter().zip(b)).map(|(a, b)| (a - b).abs());
    assert!(apart.fold(0.0, f64::max) < 1e-9);
    let exact = long(&FREE.replace("[run]", "[run]\nmethod = \"exact\""));
    let (page, _) = run(&folder, &exact.replace("every = 100", "every = 1000"));
    assert!(model(&page).is_none() && !page.contains("details"));
}

/// The weight of a page, of ten thousand frames and of a step with functions of the browser.
#[test]
fn a_page_is_light() {
    let folder = folder("computed-weight");
    let (page, _) = run(&folder, TOP);
    let times = 4 * 201 * 4 / 3;
    assert!(page.len() - times < 61_000, "{}", page.len());
    let (page, _) = run(&folder, &TOP.replace("duration = 2", "duration = 100"));
    assert!(page.len() < 120_000, "{}", page.len());
    let (page, _) =
        run(&folder, &TOP.replace("4]\n", "4]\nkinetic = \"sixth-order\"\n").replace("[drag]\nc = 1e-3\n", ""));
    assert!(page.len() < 180_000, "{}", page.len());
}
