//! A mistake in a scene file, with its place.

use std::fmt;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::string::FromUtf8Error;

use liestep_derivation::suggestion;

/// A mistake in a scene file or a failure of its run, with its place.
///
/// A mistake is displayed as `file:line:column: message`, with control characters [written out](visible).
#[derive(Clone, Debug, PartialEq)]
pub struct Mistake {
    path: PathBuf,
    /// Line and column, from one; none where there is no text.
    place: Option<(usize, usize)>,
    message: String,
    kind: Kind,
}

/// The place of a mistake in the text, and its message.
pub(crate) type SpanMessage = (Range<usize>, String);

/// The subject of a mistake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The file can't be read, or describes no scene.
    File,
    /// The run of a valid scene failed: a parameter is out of range, or a step is too long.
    Run,
    /// The table of a run can't be written.
    Table,
}

impl Mistake {
    pub(crate) fn unreadable(path: &Path, cause: &io::Error) -> Self {
        Self { path: path.to_owned(), place: None, message: format!("cannot be read: {cause}"), kind: Kind::File }
    }

    pub(crate) fn too_large(path: &Path, most: u64) -> Self {
        let message = format!("has more than {most} bytes, so it is no scene");
        Self { path: path.to_owned(), place: None, message, kind: Kind::File }
    }

    /// A mistake at the first byte that belongs to no character.
    pub(crate) fn not_text(path: &Path, error: &FromUtf8Error) -> Self {
        let (before, _) = error.as_bytes().split_at(error.utf8_error().valid_up_to());
        let before = String::from_utf8_lossy(before);
        Self::at(path, place(&before, before.len()), "isn't a text in UTF-8".to_owned())
    }

    pub(crate) fn of_toml(path: &Path, text: &str, error: &toml::de::Error) -> Self {
        let beginning = text.trim_start_matches('\u{feff}').trim_start();
        if beginning.starts_with('<') {
            return Self::at(path, place(text, text.len() - beginning.len()), is_xml(path));
        }
        let start = error.span().map_or(0, |span| span.start);
        Self::at(path, place(text, start), advised(error.message()))
    }

    pub(crate) fn at(path: &Path, place: (usize, usize), message: String) -> Self {
        Self { path: path.to_owned(), place: Some(place), message, kind: Kind::File }
    }

    pub(crate) fn of_run(path: &Path, place: (usize, usize), message: String) -> Self {
        Self { kind: Kind::Run, ..Self::at(path, place, message) }
    }

    pub(crate) fn of_table(path: &Path, message: String) -> Self {
        Self { path: path.to_owned(), place: None, message, kind: Kind::Table }
    }

    /// The mistake that a file lacks the table of this name.
    #[must_use]
    pub fn no_table(path: &Path, name: &str) -> Self {
        Self::at(path, (1, 1), format!("has no table `{name}`"))
    }

    /// Line and column in characters, from one; none for a file without a text.
    #[must_use]
    pub fn place(&self) -> Option<(usize, usize)> {
        self.place
    }

    /// Whether the file is wrong, its run, or the table of the run.
    #[must_use]
    pub fn kind(&self) -> Kind {
        self.kind
    }
}

/// The message about a file of XML, as a robot's model.
fn is_xml(path: &Path) -> String {
    format!(
        "is XML, and a scene is TOML: `liestep import {}` makes one of a robot's model, of URDF, SDF or MJCF",
        path.display()
    )
}

/// Words of other programs, each with the name that it stands for here, and advice for where that name is expected.
const OTHER_WORDS: [(&str, &str, &str); 27] = [
    ("hinge", "pin", "a hinge is a `pin`"),
    ("revolute", "pin", "a revolute joint is a `pin`"),
    ("spherical", "ball", "a spherical joint is a `ball`"),
    ("continuous", "pin", "a continuous joint is a `pin`"),
    ("prismatic", "slider", "a prismatic joint is a `slider`"),
    ("cylindrical", "cylinder", "a cylindrical joint is a `cylinder`"),
    ("planar", "plane", "a planar joint is a `plane`"),
    ("rod", "distance", "a rod without mass is a `distance`"),
    ("fixed", "weld", "a fixed joint is a `weld`"),
    ("world", "space", "the world is `space`"),
    ("ground", "space", "the ground is `space`"),
    (
        "gravitation",
        "gravity_gradient",
        "a weight is `gravity`, and a planet's pull that turns a body is `gravity_gradient`",
    ),
    ("gravitation", "gravity", "a weight is `gravity`"),
    ("flywheel", "wheel", "a flywheel in the body is a `wheel`"),
    ("wheel", "rotor", "a wheel that keeps its spin is a `rotor` of the body"),
    ("controller", "control", "a law of a torque is a `control`"),
    ("law", "control", "a law of a torque is a `control`"),
    ("damping", "drag", "damping against turning is `drag`"),
    ("damping", "joint", "damping against turning is `drag` of a `[[body]]`, and in a `[[joint]]` it is `damping`"),
    ("friction", "drag", "friction against turning is `drag`"),
    ("omega", "velocity", "the angular velocity is `velocity`, in the body"),
    ("matrix", "attitude", "the matrix of an attitude is `attitude`"),
    ("dcm", "attitude", "the matrix of an attitude is `attitude`, body to space"),
    ("earth", "nadir", "the direction of the planet is \"nadir\""),
    ("frame", "relative_to", "a start is `relative_to` the \"local vertical\""),
    ("mass", "m", "the mass is `m`"),
    ("inertia", "J", "a tensor of inertia is `J`, principal moments are `moments`"),
];

/// Keys that are often forgotten, and what they say.
const FORGOTTEN: [(&str, &str); 2] = [
    ("direction", "along an orbit write `direction = \"nadir\"`"),
    ("between", "a value holds until the next time by `between = \"steps\"`, and values are joined by `\"lines\"`"),
];

/// A message of the reader with a suggestion for an unknown name or a forgotten key.
pub(crate) fn advised(message: &str) -> String {
    // `unknown field `x`, expected one of `y`, `z``
    let mut names = message.split('`').skip(1).step_by(2);
    match names.next() {
        Some(unknown) if message.starts_with("unknown ") => {
            let names: Vec<&str> = names.collect();
            let other = OTHER_WORDS.iter().find(|(word, name, _)| unknown == *word && names.contains(name));
            let advice = other.map(|(_, _, advice)| format!("; {advice}"));
            format!("{message}{}", advice.unwrap_or_else(|| suggestion(unknown, names.into_iter())))
        }
        Some(key) if message.starts_with("missing field ") => {
            let advice = FORGOTTEN.iter().find(|(forgotten, _)| *forgotten == key);
            advice.map_or_else(|| message.to_owned(), |(_, advice)| format!("{message}; {advice}"))
        }
        _ if message.starts_with("invalid type: ") => typed(message),
        _ if message.contains("expected `nan`") => {
            "isn't a value: a number, a text in quotation marks, a list in brackets; what isn't there is left out"
                .to_owned()
        }
        _ => message.to_owned(),
    }
}

/// A message about a value of another type than expected, in words of files.
fn typed(message: &str) -> String {
    let Some((found, expected)) = message.split_once(", expected ") else { return message.to_owned() };
    let found = if found.ends_with(": map") { "invalid type: table" } else { found };
    let is_text = found.contains("string ") || found.ends_with("table");
    let expected = match expected {
        "a sequence" if is_text => {
            "a list of numbers, as [0, 0, 1]; effects of a single body take values over time, too, as { csv = \"FILE\", columns = [\"x\", \"y\", \"z\"], \
             between = \"steps\" } or { times = […], values = […], between = \"lines\" }"
        }
        "a sequence" => "a list of numbers, as [0, 0, 1]",
        "i64" | "u64" | "u32" | "usize" => "a whole number",
        "a map" | "map" => "a table",
        other => other,
    };
    format!("{found}, expected {expected}")
}

/// The lines of a text, by which the places of many ranges are found.
pub(crate) struct Lines<'a> {
    pub(crate) text: &'a str,
    /// The first byte of each line.
    starts: Vec<usize>,
}

impl<'a> Lines<'a> {
    pub(crate) fn of(text: &'a str) -> Self {
        let breaks = text.match_indices('\n').map(|(at, _)| at + 1);
        Self { text, starts: std::iter::once(0).chain(breaks).collect() }
    }

    /// Line and column, in characters, of a byte.
    pub(crate) fn place(&self, offset: usize) -> (usize, usize) {
        let offset = if self.text.is_char_boundary(offset) { offset } else { self.text.len() };
        let line = self.starts.partition_point(|start| *start <= offset);
        let start = self.starts.get(line.saturating_sub(1)).copied().unwrap_or_default();
        (line, self.text[start..offset].chars().count() + 1)
    }
}

/// Line and column, in characters, of a byte.
pub(crate) fn place(text: &str, offset: usize) -> (usize, usize) {
    Lines::of(text).place(offset)
}

/// Line and column of the beginning of a range.
pub(crate) fn place_of(text: &str, span: &Range<usize>) -> (usize, usize) {
    place(text, span.start)
}

/// A text with its control characters written out, as a terminal would obey them, and the two letters that no SVG may have.
/// Tabs and line feeds stay.
#[must_use]
pub fn visible(text: &str) -> String {
    let mut all = String::with_capacity(text.len());
    for character in text.chars() {
        let is_hidden = character.is_control() && !"\n\t".contains(character);
        if is_hidden || "\u{fffe}\u{ffff}".contains(character) {
            all.extend(character.escape_default());
        } else {
            all.push(character);
        }
    }
    all
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", visible(&self.path.display().to_string()))?;
        if let Some((line, column)) = self.place {
            write!(f, "{line}:{column}:")?;
        }
        write!(f, " {}", visible(&self.message))
    }
}

impl std::error::Error for Mistake {}
