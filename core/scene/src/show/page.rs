//! A page that plays a motion: one file that loads nothing else.
//!
//! The script uses no scene graph and no charting library, which would add megabytes to each page.

use std::fmt::{self, Write as _};

use nalgebra::{Matrix3, SymmetricEigen, UnitQuaternion, Vector3};

const SCRIPT: &str = include_str!("page.js");
const STYLE: &str = include_str!("page.css");

/// Most frames of a page, more than a screen displays in minutes. A longer run is thinned.
const MOST_FRAMES: usize = 10_000;

/// Most events of a page. More lines couldn't be distinguished.
const MOST_EVENTS: usize = 1000;

/// The contents of a page. Lists have the same length.
pub(crate) struct Page<'a> {
    pub(crate) title: &'a str,
    pub(crate) about: &'a str,
    pub(crate) figure: &'a Figure,
    /// s.
    pub(crate) times: &'a [f64],
    /// Body to space; none on a group without a body.
    pub(crate) attitudes: &'a [UnitQuaternion<f64>],
    pub(crate) charts: &'a [Chart],
    /// Times in s, and names.
    pub(crate) events: &'a [(f64, String)],
}

/// Curves over time in one panel.
#[derive(Clone, Debug)]
pub(crate) struct Chart {
    title: &'static str,
    unit: &'static str,
    /// Whether the scale is logarithmic.
    logarithmic: bool,
    lines: Vec<(String, Vec<f64>)>,
}

impl Chart {
    pub(crate) fn linear(title: &'static str, unit: &'static str, lines: Vec<(String, Vec<f64>)>) -> Self {
        Self { title, unit, logarithmic: false, lines }
    }

    pub(crate) fn logarithmic(title: &'static str, unit: &'static str, lines: Vec<(String, Vec<f64>)>) -> Self {
        Self { title, unit, logarithmic: true, lines }
    }
}

/// The displayed shape of a body, in units of the sphere's radius: a box, or a drum for a symmetric body.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    /// Half edges, body frame.
    sides: [Vector3<f64>; 3],
    /// The drum's axis among the half edges.
    drum: Option<usize>,
    /// The middle of the body, relative to the point about which it turns.
    middle: Vector3<f64>,
    /// The body axis whose tip draws the path.
    axis: Vector3<f64>,
}

/// The largest half edge: of a body on a pivot, and of any other.
const HEAVY_SIZE: f64 = 0.28;
const SIZE: f64 = 0.5;
/// Distance from the pivot to the middle of the body.
const MIDDLE: f64 = 0.55;
/// Least half edge, so that the edge of a sheet is visible.
const LEAST: f64 = 0.025;
/// Relative difference below which two edges count as equal.
const SAME: f64 = 0.01;

impl Figure {
    /// The shape for this inertia; `arm` is the centre of mass of a heavy body.
    pub(crate) fn of(inertia: &Matrix3<f64>, arm: Option<Vector3<f64>>, axis: &Vector3<f64>) -> Self {
        // The axes of a diagonal inertia stay in their order.
        let is_principal = (0..3).all(|i| (0..3).all(|j| i == j || inertia[(i, j)] == 0.0));
        let (moments, frame) = if is_principal {
            (inertia.diagonal(), Matrix3::identity())
        } else {
            let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(*inertia);
            (eigenvalues, eigenvectors)
        };
        // ∫ x² of a box is a third of its half edge squared, times the mass.
        let half = moments.map(|moment| (0.5 * moments.sum() - moment).max(0.0).sqrt());
        let size = if arm.is_some() { HEAVY_SIZE } else { SIZE };
        let half = (half * (size / half.max())).map(|edge| edge.max(LEAST));
        let drum = (0..3).find(|k| {
            let (one, other) = (half[(k + 1) % 3], half[(k + 2) % 3]);
            let alone = half[*k];
            (one - other).abs() < SAME * size && (one - alone).abs() > SAME * size
        });
        let middle = arm.and_then(|arm| arm.try_normalize(0.0)).map_or_else(Vector3::zeros, |arm| arm * MIDDLE);
        let sides = [0, 1, 2].map(|k| frame.column(k) * half[k]);
        Self { sides, drum, middle, axis: *axis }
    }
}

/// A text in a script, escaped so that it can't end the script.
struct Text<'a>(&'a str);

impl fmt::Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_char('"')?;
        for letter in self.0.chars() {
            match letter {
                '"' | '\\' | '<' | '>' | '&' | '\u{2028}' | '\u{2029}' => write!(f, "\\u{:04x}", u32::from(letter))?,
                letter if letter.is_control() => write!(f, "\\u{:04x}", u32::from(letter))?,
                letter => f.write_char(letter)?,
            }
        }
        f.write_char('"')
    }
}

/// A text in a page, with its markup escaped.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The digits of base 64.
const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Single-precision numbers in base 64, as a text in a script.
fn numbers(values: impl IntoIterator<Item = f64>) -> String {
    let bytes: Vec<u8> = values
        .into_iter()
        .flat_map(|value| {
            #[allow(clippy::cast_possible_truncation)] // seven digits are more than a screen resolves
            let single = value as f32;
            single.to_le_bytes()
        })
        .collect();
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4 + 2);
    text.push('"');
    for chunk in bytes.chunks(3) {
        let bits = chunk.iter().fold(0_u32, |bits, byte| bits << 8 | u32::from(*byte)) << (8 * (3 - chunk.len()));
        for place in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * place) & 63) as usize];
            text.push(if place <= chunk.len() { char::from(letter) } else { '=' });
        }
    }
    text.push('"');
    text
}

fn vector(v: &Vector3<f64>) -> String {
    format!("[{:.5},{:.5},{:.5}]", v.x, v.y, v.z)
}

impl fmt::Display for Page<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let stride = self.times.len().div_ceil(MOST_FRAMES).max(1);
        let last = self.times.len().saturating_sub(1);
        let frames = || (0..self.times.len()).filter(move |frame| frame % stride == 0 || *frame == last);
        let Figure { sides, drum, middle, axis } = self.figure;
        let title = escaped(self.title);
        write!(
            f,
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; \
             style-src 'unsafe-inline'; img-src data:\">\n<link rel=\"icon\" href=\"data:,\">\n<title>{title}</title>\n\
             <style>\n{STYLE}</style>\n</head>\n<body>\n<header><h1>{title}</h1><p>{}</p></header>\n\
             <main><section id=\"view\"></section><section id=\"charts\"></section></main>\n<footer id=\"controls\"></footer>\n\
             <script>\nconst motion = {{\n",
            escaped(self.about)
        )?;
        let sides: Vec<_> = sides.iter().map(vector).collect();
        let drum = drum.map_or_else(|| "null".to_owned(), |axis| axis.to_string());
        writeln!(f, "sides: [{}], drum: {drum}, middle: {}, axis: {},", sides.join(","), vector(middle), vector(axis))?;
        writeln!(f, "times: {},", numbers(frames().map(|frame| self.times[frame])))?;
        let attitude = |frame: usize| {
            let q = self.attitudes[frame];
            [q.w, q.i, q.j, q.k]
        };
        let shown = frames().filter(|_| !self.attitudes.is_empty());
        writeln!(f, "attitudes: {},", numbers(shown.flat_map(attitude)))?;
        writeln!(f, "events: [")?;
        for (time, name) in self.events.iter().take(MOST_EVENTS) {
            writeln!(f, "[{time:?}, {}],", Text(name))?;
        }
        writeln!(f, "],\ncharts: [")?;
        for Chart { title, unit, logarithmic, lines } in self.charts {
            writeln!(f, "{{title: {}, unit: {}, logarithmic: {logarithmic}, lines: [", Text(title), Text(unit))?;
            for (name, values) in lines {
                writeln!(f, "{{name: {}, values: {}}},", Text(name), numbers(frames().map(|frame| values[frame])))?;
            }
            writeln!(f, "]}},")?;
        }
        write!(f, "]}};\n{SCRIPT}</script>\n</body>\n</html>\n")
    }
}
