//! Tests of the page that locates each equation of the thesis: every number has a row, and every file and test exists.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

const PAGE: &str = include_str!("../../core/src/conventions/equations.md");

/// The number of numbered equations in each chapter.
const NUMBERED: [(u32, u32); 3] = [(1, 32), (2, 10), (3, 20)];

fn rows() -> impl Iterator<Item = Vec<&'static str>> {
    let lines = PAGE.lines().filter_map(|line| line.strip_prefix('|')?.strip_suffix('|'));
    lines.map(|row| row.split('|').map(str::trim).collect())
}

/// The numbers in a cell, including those within a range.
fn numbers(cell: &str) -> Vec<(u32, u32)> {
    let parts: Vec<&str> = cell.split(['(', ')']).collect();
    let number = |part: &str| {
        let (chapter, equation) = part.split_once('.')?;
        Some((chapter.parse().ok()?, equation.parse().ok()?))
    };
    let mut numbers: Vec<(u32, u32)> = Vec::new();
    for (i, part) in parts.iter().enumerate() {
        let Some((chapter, equation)) = number(part) else { continue };
        let first =
            if i >= 2 && parts[i - 1] == "–" { numbers.last().map_or(equation, |last| last.1 + 1) } else { equation };
        numbers.extend((first..=equation).map(|equation| (chapter, equation)));
    }
    numbers
}

#[test]
fn every_numbered_equation_has_a_row() {
    assert_eq!(numbers("(1.7)–(1.9), x; (1.11)"), [(1, 7), (1, 8), (1, 9), (1, 11)]);
    // The rows of tables that have a column of tests.
    let found: BTreeSet<_> = rows().filter(|row| row.len() == 4).flat_map(|row| numbers(row[0])).collect();
    let expected: BTreeSet<_> =
        NUMBERED.iter().flat_map(|&(chapter, last)| (1..=last).map(move |equation| (chapter, equation))).collect();
    assert_eq!(found, expected);
    // Each row links to the equation's place, or to the rule that derives it.
    let linked = |row: &[&str]| links(row[2]).next().is_some();
    let unlinked: Vec<_> = rows().filter(|row| row.len() == 4 && !numbers(row[0]).is_empty() && !linked(row)).collect();
    assert!(unlinked.is_empty(), "{unlinked:?}");
    for figure in 1..=10 {
        let name = format!("3.{figure}");
        assert!(rows().any(|row| row.len() == 3 && row[0].split(", ").any(|part| part == name)), "figure {name}");
    }
}

/// The links of a cell, by the labels of the definitions at the end of the page.
fn links(cell: &str) -> impl Iterator<Item = &str> {
    let mut parts = cell.split('[').skip(1).peekable();
    core::iter::from_fn(move || {
        let (label, after) = parts.next()?.split_once(']')?;
        // In `[text][label]` the label counts.
        let is_text = after.is_empty() && parts.peek().is_some();
        Some((label, is_text))
    })
    .filter_map(|(label, is_text)| (!is_text).then_some(label))
}

/// The anchor of the heading `# A title` in rustdoc's addresses.
fn anchor(heading: &str) -> String {
    let letters = heading.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
    letters.chars().filter(|c| c.is_alphanumeric() || *c == '-' || *c == '_').collect()
}

/// Each link has its definition; a link into a chapter of the guide leads to a heading, under which the equations of
/// its row are printed.
#[test]
fn links_lead_to_equations() {
    let guide = include_str!("../../core/src/guide/thesis.md");
    let definition = |label: &str| PAGE.lines().find_map(|line| line.strip_prefix(&format!("[{label}]: ")));
    let mut printed = 0;
    for row in rows().filter(|row| row.len() == 4 && !numbers(row[0]).is_empty()) {
        for label in links(row[2]) {
            let target = definition(label).unwrap_or_else(|| panic!("{label} is nowhere"));
            let Some((page, heading)) = target.split_once('#') else { continue };
            assert_eq!(page, "crate::guide::thesis", "{label}");
            let mut lines = guide.lines().map(str::trim);
            assert!(lines.any(|line| line.starts_with('#') && anchor(line) == heading), "{heading} isn't a heading");
            let section: Vec<&str> =
                lines.take_while(|line| !line.starts_with("# ") && !line.starts_with("## ")).collect();
            for (chapter, equation) in numbers(row[0]).into_iter().filter(|_| row[2].starts_with("printed in")) {
                let number = format!("({chapter}.{equation})");
                let is_printed = |line: &&str| line.strip_suffix(&number).is_some_and(|left| left.contains(['=', '⟨']));
                assert!(section.iter().any(is_printed), "{number} isn't printed under {heading}");
                printed += 1;
            }
        }
    }
    assert_eq!(printed, 14, "(1.7) to (1.10), (1.13), (1.15) and (3.5) to (3.12)");
}

#[test]
fn files_and_tests_exist() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut tests = 0;
    for row in rows() {
        let mut source: Option<String> = None;
        for cell in &row {
            for word in cell.split('`').skip(1).step_by(2) {
                if word.contains('/') && word.contains('.') {
                    let text = fs::read_to_string(root.join(word));
                    source = Some(text.unwrap_or_else(|error| panic!("{word}: {error}")));
                }
            }
        }
        // The names in the last column, each in the file before it.
        let mut file = "";
        for word in row.last().unwrap().split('`').skip(1).step_by(2) {
            if word.contains('/') {
                file = word;
                source = fs::read_to_string(root.join(word)).ok();
            } else if row.len() >= 3 && !file.is_empty() {
                let text = source.as_deref().unwrap_or_default();
                // The definition of a test: a function, or an entry of a list from which a macro generates tests.
                let forms = [format!("fn {word}("), format!("fn {word}<"), format!("{word} \""), format!("{word} on_")];
                assert!(forms.iter().any(|form| text.contains(form)), "{file} has no test {word}");
                tests += 1;
            }
        }
        // A row of a table with tests names one.
        let heading = row[0].is_empty() || row[0].starts_with("---") || row[0] == "equation";
        assert!(row.len() != 4 || heading || !file.is_empty(), "nothing checks {}", row[0]);
    }
    assert!(tests > 60, "{tests} tests are named");
}

/// Every figure of the pages exists, and every figure is on a page.
#[test]
fn figures_are_shown() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut shown = BTreeSet::new();
    for page in ["README.md", "examples/README.md", "examples/scenes/README.md", "examples/figures/thesis/README.md"] {
        let page = root.join(page);
        let text = fs::read_to_string(&page).unwrap();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split_once(')')) {
            if Path::new(link.0).extension().is_some_and(|extension| extension == "svg") {
                let file = page.parent().unwrap().join(link.0).canonicalize();
                shown.insert(file.unwrap_or_else(|error| panic!("{}: {}: {error}", page.display(), link.0)));
            }
        }
    }
    let mut kept = BTreeSet::new();
    for folder in ["", "scenes", "thesis"] {
        for entry in fs::read_dir(root.join("examples/figures").join(folder)).unwrap() {
            let path = entry.unwrap().path().canonicalize().unwrap();
            if path.extension().is_some_and(|extension| extension == "svg") {
                kept.insert(path);
            }
        }
    }
    assert_eq!(shown, kept);
    assert!((1..=10).all(|figure| kept.iter().any(|path| path.ends_with(format!("thesis/3-{figure}.svg")))));
}
