//! The scale: how long files and functions may be.

use std::fs;

use super::{files, root};

/// The lines of the longest file, and of the longest function.
const LONGEST: [usize; 2] = [500, 80];

/// The lines of the longest function, which rustfmt has closed where it begins.
fn longest_function(text: &str) -> usize {
    let lines: Vec<&str> = text.lines().collect();
    let length = |start: usize| {
        let (indent, item) = lines[start].split_at(lines[start].len() - lines[start].trim_start().len());
        let begins = item.starts_with("fn ") || (item.starts_with(['p', 'c']) && item.contains(" fn "));
        let mut rest = lines[start..].iter().map(|line| line.strip_prefix(indent).unwrap_or_default());
        let end = rest.position(|rest| !rest.starts_with(' ') && rest.ends_with(['}', ';']));
        if begins { end.map_or(0, |end| end + 1) } else { 0 }
    };
    (0..lines.len()).map(length).max().unwrap_or(0)
}

#[test]
fn files_and_functions_are_short() {
    let Some(root) = root() else { return };
    let mut mistakes = Vec::new();
    for path in files(root, "", "rs") {
        let text = fs::read_to_string(root.join(&path)).unwrap();
        for (found, most, of) in
            [(text.lines().count(), LONGEST[0], "the file"), (longest_function(&text), LONGEST[1], "a function")]
        {
            if found > most {
                mistakes.push(format!("{path}: {found} lines of {of}, and at most {most}"));
            }
        }
    }
    assert!(mistakes.is_empty(), "{}", mistakes.join("\n"));
}
