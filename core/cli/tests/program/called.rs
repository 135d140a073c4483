//! Calls of the program, and a scene for them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub(crate) const TOP: &str = include_str!("scenes/top.toml");

/// The program. Its library is compiled already; this test doesn't compile the scene's types a second time.
pub(crate) const PROGRAM: &str = env!("CARGO_BIN_EXE_liestep");

/// A folder for one test.
pub(crate) fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    // An earlier build may have left files of another format.
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

pub(crate) fn called(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(PROGRAM).current_dir(folder).args(arguments).output().unwrap()
}

pub(crate) fn simulate(folder: &Path, files: &[&str]) -> Output {
    called(folder, &[&["run", "--csv", "--out", "."], files].concat())
}

/// Asserts this exit code, a message that contains this text, and no output.
pub(crate) fn refuses(folder: &Path, arguments: &[&str], code: i32, message: &str) {
    let output = called(folder, arguments);
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(text.starts_with("error: ") && text.contains(message), "{text}");
    assert!(output.stdout.is_empty() && output.status.code() == Some(code), "{arguments:?}: {text}");
}

/// The program's message about a text that it refuses.
pub(crate) fn refused(folder: &Path, text: &str) -> String {
    fs::write(folder.join("top.toml"), text).unwrap();
    let output = simulate(folder, &["top.toml"]);
    assert!(!output.status.success() && output.stdout.is_empty(), "{text}");
    String::from_utf8(output.stderr).unwrap()
}

/// The rows of the table of a scene, after a run.
pub(crate) fn rows(folder: &Path, text: &str) -> Vec<Vec<f64>> {
    fs::write(folder.join("scene.toml"), text).unwrap();
    printed(folder, &["run", "scene.toml", "--csv", "--out", "."]);
    table(&fs::read_to_string(folder.join("scene.csv")).unwrap())
}

pub(crate) fn table(csv: &str) -> Vec<Vec<f64>> {
    csv.lines().skip(1).map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

/// The largest difference between two tables.
pub(crate) fn apart(rows: &[Vec<f64>], others: &[Vec<f64>]) -> f64 {
    assert_eq!(rows.len(), others.len());
    rows.iter().flatten().zip(others.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

pub(crate) fn printed(folder: &Path, arguments: &[&str]) -> String {
    let output = called(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}
