//! One program of each door, as README has it: a file and a text in Python, of which the tip of the top after ten seconds is
//! compared with a Runge–Kutta method. The listing in Rust is a test of `tests/common`, the step in C of `core/late`.

use std::fs;
use std::path::Path;
use std::process::Command;

use nalgebra::Vector3;

/// The tip by the method DOP853 of `SciPy` in quaternions, at a tolerance of 1e-13.
const TIP: [f64; 3] = [0.576_090_70, 0.407_715_11, 0.708_440_47];

/// The first listing of README in this language that starts with `beginning`.
fn listing(language: &str, beginning: &str) -> String {
    let readme = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md")).unwrap();
    let fence = format!("```{language}\n");
    let mut blocks = readme.split(&fence).skip(1).filter_map(|rest| rest.split("```").next());
    blocks.find(|block| block.starts_with(beginning)).expect("a listing").to_owned()
}

fn assert_tip(tip: Vector3<f64>) {
    let off = (tip - Vector3::from(TIP)).norm();
    println!("off by {off:e}");
    assert!(off < 1e-5, "{tip}");
}

#[test]
fn a_file() {
    let scene = liestep_scene::Scene::parse("README.md", &listing("toml", "title = \"A heavy top\"")).unwrap();
    let run = scene.run().unwrap();
    let last = run.samples().last().unwrap();
    assert!((last.time - 10.0).abs() < 1e-9);
    assert_tip(last.bodies[0].attitude.as_matrix() * Vector3::z());
}

/// The Python program of README, run by the interpreter that `LIESTEP_PYTHON` names, or by `python3`, if that has the
/// package.
#[test]
fn python() {
    let python = std::env::var("LIESTEP_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let has_package = Command::new(&python).args(["-c", "import liestep"]).output();
    if !has_package.is_ok_and(|output| output.status.success()) {
        println!("skipped: {python} has no package liestep (core/python/run --install builds and tests it)");
        return;
    }
    // Attitudes are rotations of SciPy where it is installed, else matrices.
    let tip = "turns = run.attitude\nprint(*getattr(turns, 'as_matrix', lambda: turns)()[-1][:, 2])";
    let program = listing("python", "import liestep").replace("run.plot()", tip);
    let output = Command::new(&python).args(["-c", &program]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let numbers = String::from_utf8(output.stdout).unwrap();
    let numbers: Vec<f64> = numbers.split_whitespace().map(|number| number.parse().unwrap()).collect();
    assert_tip(Vector3::from_column_slice(&numbers));
}
