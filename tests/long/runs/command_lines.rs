//! Invalid command lines of examples: a message and an exit code, before any computation.

use std::collections::HashMap;
use std::path::PathBuf;
use std::process::{Command, Output};
use std::sync::OnceLock;

use checks::examples;

/// Runs an example in a folder for temporary files.
fn run(example: &str, arguments: &[&str]) -> Output {
    static EXAMPLES: OnceLock<HashMap<String, PathBuf>> = OnceLock::new();
    let names = ["accuracy-cost", "derive", "hard-cases", "heavy-top"];
    let program = &EXAMPLES.get_or_init(|| examples::built(&names))[example];
    Command::new(program).current_dir(env!("CARGO_TARGET_TMPDIR")).args(arguments).output().unwrap()
}

/// Checks that a command line is refused with this message, without a panic and before a report.
#[track_caller]
fn refused(example: &str, arguments: &[&str], message: &str) {
    let output = run(example, arguments);
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(matches!(output.status.code(), Some(1 | 2)), "{arguments:?}: {:?} {text}", output.status);
    assert!(text.starts_with("error: ") && text.contains(message), "{arguments:?}: {text}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
}

#[test]
fn steps_and_times() {
    let nonsense = [
        ("nan", "must be a finite number above zero"),
        ("inf", "must be a finite number above zero"),
        ("-0.01", "must be a finite number above zero"),
        ("0", "must be a finite number above zero"),
        ("1e400", "must be a finite number above zero"),
        ("1e-400", "must be a finite number above zero"),
        ("ten", "not a number; write seconds, as in 0.01"),
        ("", "not a number; write seconds, as in 0.01"),
        ("0,01", "not a number; write seconds, as in 0.01"),
    ];
    for (value, message) in nonsense {
        refused("heavy-top", &[&format!("--step={value}")], message);
        refused("heavy-top", &[&format!("--time={value}")], message);
        // The value may also follow a space: no number looks like an option.
        refused("heavy-top", &["--step", value], message);
    }
    refused("heavy-top", &["--step", "1e-300", "--time", "1"], "take a larger step");
    refused(
        "heavy-top",
        &["--step", "10", "--time", "1"],
        "--time 1 is shorter than one --step 10; nothing would happen",
    );
    refused("heavy-top", &["--step", "1e300"], "--time 200 is shorter than one --step 1e300;");
    // A step in which no body can turn so far.
    refused("heavy-top", &["--step", "5", "--time", "10", "--out", "steps"], "no solution at the step");
}

/// Output folders that are files, are below a file, or have no name.
#[test]
fn folders() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
    refused("heavy-top", &["--time=2", "--out", file], "cannot write to");
    refused("heavy-top", &["--time=2", "--out", &format!("{file}/out")], "cannot write to");
    refused("heavy-top", &["--time=2", "--out="], "a value is required");
    for example in ["accuracy-cost", "hard-cases"] {
        refused(example, &["--out", file], "cannot write to");
        refused(example, &["--out", &format!("{file}/out")], "cannot write to");
        refused(example, &["--out="], "a value is required");
    }
}

/// Output that can't be printed leads to a message and an exit code.
#[test]
#[cfg(target_os = "linux")]
fn a_full_disk() {
    run("derive", &[]);
    let program = &examples::built(&["derive"])["derive"];
    let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
    let output = Command::new(program).arg("heavy-top").stdout(full).output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.starts_with("error: ") && text.contains("No space left on device"), "{text}");
}

#[test]
fn words() {
    refused("heavy-top", &["--case", "falling"], "invalid value 'falling'");
    refused("heavy-top", &["--reading", "c"], "invalid value 'c'");
    refused("heavy-top", &["--speed", "1"], "unexpected argument");
    refused("accuracy-cost", &["--scene", "falling"], "no scene is called falling");
    refused("accuracy-cost", &["--scene="], "no scene is called");
    refused("accuracy-cost", &["--quick=1"], "unexpected value");
    refused("accuracy-cost", &["looping"], "unexpected argument");
    refused("hard-cases", &["--row", "Z9"], "--row is one of S1");
    refused("hard-cases", &["--row="], "--row is one of S1");
    refused("hard-cases", &["--short"], "unexpected argument");
    refused("derive", &["no-such-top"], "invalid value 'no-such-top'");
}
