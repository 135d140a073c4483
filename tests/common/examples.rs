//! Examples as programs, for the tests that run them.

use std::collections::HashMap;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use serde_json::Value;

/// That of `cargo test` or `cargo test --release`, by the only sign of it that a test has: what it has built is used.
const PROFILE: &str = if cfg!(debug_assertions) { "dev" } else { "release" };

/// The executables of these examples, built where they aren't yet.
///
/// Where a build puts them depends on its target, its profile and the settings of cargo, which is therefore asked. The
/// program is built beside them: with it the macros' packages are also packages of a program, as in the tests' build, and
/// cargo takes what that has built. Without it, it builds the library and the macros a second time.
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
