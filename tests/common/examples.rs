//! Examples as programs, for the tests that run them.

use std::collections::HashMap;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use serde_json::Value;

/// The profile of `cargo test` or `cargo test --release`, detected by debug assertions, so that its build results are
/// reused.
const PROFILE: &str = if cfg!(debug_assertions) { "dev" } else { "release" };

/// The executables of these examples, built if necessary.
///
/// Their paths depend on the target, the profile and cargo's settings, so cargo reports them. The option `--workspace`
/// also builds the program: then the macros' packages are also packages of a program, as in the tests' build, and cargo
/// reuses its results. Without that option it would build the library and the macros a second time.
pub fn built(names: &[&str]) -> HashMap<String, PathBuf> {
    let mut build = Command::new(env!("CARGO"));
    build.args(["build", "--workspace", "--quiet", "--message-format=json-render-diagnostics", "--profile", PROFILE]);
    build.args(["--bin", "liestep"]);
    build.args(names.iter().flat_map(|name| ["--example", name]));
    let output = build.stderr(Stdio::inherit()).output().unwrap();
    assert!(output.status.success(), "the examples {names:?} can't be built");
    let messages = output.stdout.split(|byte| *byte == b'\n').filter(|line| !line.is_empty());
    let executable = |line| {
        let message: Value = serde_json::from_slice(line).unwrap();
        Some((message["target"]["name"].as_str()?.to_owned(), message["executable"].as_str()?.into()))
    };
    messages.filter_map(executable).collect()
}
