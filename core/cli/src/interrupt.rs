//! Ctrl-C, which stops an ensemble at its next steps.

use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::SIGINT;
use signal_hook::flag::register;

/// Sets `stop` by Ctrl-C from now on.
pub(crate) fn sets(stop: &Arc<AtomicBool>) -> io::Result<()> {
    register(SIGINT, Arc::clone(stop)).map(drop)
}

/// This program's command line, as a shell reads it.
pub(crate) fn command_line() -> String {
    let words = std::env::args_os().map(|word| quoted(&word.to_string_lossy()));
    words.collect::<Vec<_>>().join(" ")
}

fn quoted(word: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || "-_./=:,+@%".contains(letter);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}
