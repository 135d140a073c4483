//! Mistakes and their messages in the compiler. Unusual settings in which a declaration has to compile and run are
//! separate tests: trybuild compiles all mistakes at once only if no program that must run is among them.

use std::process::Command;

/// The compiler that generated the messages in `fail/*.stderr`.
fn pinned() -> &'static str {
    let toolchain = include_str!("../../rust-toolchain.toml");
    let channel = toolchain.lines().find_map(|line| line.strip_prefix("channel = "));
    channel.expect("rust-toolchain.toml has a channel").trim_matches('"')
}

/// The version of the compiler at work, as `1.95.0`.
fn found() -> String {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).arg("--version").output().expect("rustc runs");
    let version = String::from_utf8_lossy(&output.stdout).into_owned();
    version.split_whitespace().nth(1).unwrap_or_default().to_owned()
}

#[test]
fn mistakes() {
    let (found, pinned) = (found(), pinned());
    if found == pinned {
        trybuild::TestCases::new().compile_fail("fail/*.rs");
    } else {
        println!("tests/ui/fail is skipped: this is rustc {found}, and the messages are those of {pinned}");
    }
}
