//! A page that plays a motion: one file that loads nothing else.
//!
//! The script uses no scene graph and no charting library, which would add megabytes to each page.

use std::fmt;

use nalgebra::{Matrix3, SymmetricEigen, UnitQuaternion, Vector3};

use crate::file::shape::Shape;
use crate::run::model::Model;
use crate::show::computed::CHANGE;
use crate::show::text::Text;

const SCRIPT: &str = include_str!("page.js");
const STYLE: &str = include_str!("page.css");

/// Most frames of a page, more than a screen displays in minutes, and those of all bodies together, but for the least of each.
/// A longer run is thinned.
const MOST_FRAMES: usize = 10_000;
const MOST_PLACES: usize = 40_000;
const LEAST_FRAMES: usize = 200;

/// Most events of a page. More lines couldn't be distinguished.
const MOST_EVENTS: usize = 1000;

/// The contents of a page. Lists have the same length.
pub(crate) struct Page<'a> {
    pub(crate) title: &'a str,
    pub(crate) about: &'a str,
    /// The body axis whose tip draws the path of a single body.
    pub(crate) axis: &'a Vector3<f64>,
    /// Bodies; none on a group without any.
    pub(crate) bodies: &'a [ShownBody],
    /// Lines from the centre of mass of a body, by its number, to points of it.
    pub(crate) rods: &'a [(usize, Vector3<f64>)],
    /// s.
    pub(crate) times: &'a [f64],
    pub(crate) charts: &'a [Chart],
    /// Times in s, and names.
    pub(crate) events: &'a [(f64, String)],
    /// The step and the start, where the page can compute the motion anew.
    pub(crate) model: Option<&'a Model>,
}

/// A body, and its motion.
#[derive(Clone, Debug)]
pub(crate) struct ShownBody {
    pub(crate) name: String,
    pub(crate) figure: Figure,
    /// Attitudes, body to space.
    pub(crate) attitudes: Vec<UnitQuaternion<f64>>,
    /// Positions, m; none of a body that turns about a point.
    pub(crate) positions: Vec<Vector3<f64>>,
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

/// The displayed shape of a body: a box, or a surface of revolution. A body that turns about a point is shown in units of the
/// sphere's radius, several bodies in m.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    /// Half edges, body frame.
    sides: [Vector3<f64>; 3],
    /// The axis of revolution among the half edges.
    round: Option<usize>,
    /// Heights and radii of a surface of revolution, in half edges.
    profile: Vec<[f64; 2]>,
    /// The middle of the body, relative to the point about which it turns, or to its centre of mass.
    middle: Vector3<f64>,
}

/// The profile of a drum.
const DRUM: [[f64; 2]; 4] = [[-1.0, 0.0], [-1.0, 1.0], [1.0, 1.0], [1.0, 0.0]];

/// The largest half edge: of a body on a pivot, and of any other.
const HEAVY_SIZE: f64 = 0.28;
const SIZE: f64 = 0.5;
/// Distance from the pivot to the middle of the body.
const MIDDLE: f64 = 0.55;
/// Least half edge, so that the edge of a sheet is visible.
const LEAST: f64 = 0.025;
/// Least half edge of one of several bodies, relative to its largest.
const THIN: f64 = 0.05;
/// Relative difference below which two edges count as equal.
const SAME: f64 = 0.01;

/// Half the edges of a box with these moments of inertia by its mass, m.
///
/// ∫ x² of a box is a third of its half edge squared, times the mass.
fn half_edges(moments: &Vector3<f64>) -> Vector3<f64> {
    moments.map(|moment| (3.0 * (0.5 * moments.sum() - moment)).max(0.0).sqrt())
}

/// Principal moments and axes; those of a diagonal tensor stay in their order.
fn principal(inertia: &Matrix3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let is_principal = (0..3).all(|i| (0..3).all(|j| i == j || inertia[(i, j)] == 0.0));
    if is_principal {
        return (inertia.diagonal(), Matrix3::identity());
    }
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(*inertia);
    (eigenvalues, eigenvectors)
}

impl Figure {
    /// The shape of a body that turns about a point, by its inertia; `arm` is the centre of mass of a heavy one.
    pub(crate) fn of(inertia: &Matrix3<f64>, arm: Option<Vector3<f64>>) -> Self {
        let (moments, frame) = principal(inertia);
        let half = half_edges(&moments);
        let size = if arm.is_some() { HEAVY_SIZE } else { SIZE };
        let half = half * (size / half.max());
        let middle = arm.and_then(|arm| arm.try_normalize(0.0)).map_or_else(Vector3::zeros, |arm| arm * MIDDLE);
        Self { middle, ..Self::with(half, LEAST, &frame) }
    }

    /// A box with these half edges along the axes of a frame, at least as long as the least, or a drum if two are equal.
    fn with(half: Vector3<f64>, least: f64, frame: &Matrix3<f64>) -> Self {
        let (size, half) = (half.max(), half.map(|edge| edge.max(least)));
        let round = (0..3).find(|k| {
            let (one, other) = (half[(k + 1) % 3], half[(k + 2) % 3]);
            let alone = half[*k];
            (one - other).abs() < SAME * size && (one - alone).abs() > SAME * size
        });
        let sides = [0, 1, 2].map(|k| frame.column(k) * half[k]);
        Self { sides, round, profile: DRUM.into(), middle: Vector3::zeros() }
    }

    /// The shape of one of several bodies, m: its own, or the box with its inertia by its mass; a point mass is a ball of this
    /// radius.
    pub(crate) fn among_several(shape: Option<&Shape>, by_mass: Option<Matrix3<f64>>, point: f64) -> Self {
        match (shape, by_mass) {
            (Some(Shape::Box(edges)), _) => Self { round: None, ..Self::with(edges * 0.5, 0.0, &Matrix3::identity()) },
            (Some(Shape::Round(round)), _) => {
                let caps = if round.has_caps { round.radius } else { 0.0 };
                let (half, cylinder) = (0.5 * round.length + caps, 0.5 * round.length);
                Self::turned(&round.axis, half, round.radius, profile(cylinder / half, round.has_caps))
            }
            (Some(Shape::Sphere(radius)), _) => Self::turned(&Vector3::z(), *radius, *radius, profile(0.0, true)),
            (None, Some(inertia)) => {
                let (moments, frame) = principal(&inertia);
                let half = half_edges(&moments);
                Self::with(half, THIN * half.max(), &frame)
            }
            (None, None) => Self::turned(&Vector3::z(), point, point, profile(0.0, true)),
        }
    }

    /// A surface of revolution about an axis, with half of its length and its radius.
    fn turned(axis: &Vector3<f64>, half: f64, radius: f64, profile: Vec<[f64; 2]>) -> Self {
        let one = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
        let sides = [axis * half, one * radius, axis.cross(&one) * radius];
        Self { sides, round: Some(0), profile, middle: Vector3::zeros() }
    }
}

/// The profile of a cylinder that ends at this height, with half balls above it if there are caps.
fn profile(cylinder: f64, has_caps: bool) -> Vec<[f64; 2]> {
    if !has_caps {
        return DRUM.into();
    }
    // Quarters of an arc, which are six chords.
    let arc = (0..=6).map(|k| f64::from(k) * std::f64::consts::FRAC_PI_2 / 6.0);
    let upper: Vec<[f64; 2]> = arc.map(|turn| [cylinder + (1.0 - cylinder) * turn.sin(), turn.cos()]).collect();
    let mut all: Vec<[f64; 2]> = upper.iter().rev().map(|[height, radius]| [-height, *radius]).collect();
    all.extend(upper);
    // The ends are points.
    all.first_mut().into_iter().for_each(|end| end[1] = 0.0);
    all.last_mut().into_iter().for_each(|end| end[1] = 0.0);
    all
}

/// A script without its indentation and its lines of comments.
fn light(script: &str) -> String {
    let lines = script.lines().map(str::trim_start).filter(|line| !line.is_empty() && !line.starts_with("//"));
    lines.flat_map(|line| [line, "\n"]).collect()
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
        let most = (MOST_PLACES / self.bodies.len().max(1)).clamp(LEAST_FRAMES, MOST_FRAMES);
        let stride = self.times.len().div_ceil(most).max(1);
        let last = self.times.len().saturating_sub(1);
        let frames = || (0..self.times.len()).filter(move |frame| frame % stride == 0 || *frame == last);
        // A page that computes the same motion needs only its times.
        let is_computed = self.model.is_some_and(Model::is_exact);
        let written = || frames().filter(move |_| !is_computed);
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
        writeln!(f, "axis: {},", vector(self.axis))?;
        writeln!(f, "times: {},", numbers(frames().map(|frame| self.times[frame])))?;
        writeln!(f, "bodies: [")?;
        for ShownBody { name, figure, attitudes, positions } in self.bodies {
            let Figure { sides, round, profile, middle } = figure;
            let sides: Vec<_> = sides.iter().map(vector).collect();
            let round = round.map_or_else(|| "null".to_owned(), |axis| axis.to_string());
            let profile = profile.iter().filter(|_| figure.round.is_some());
            let profile: Vec<_> = profile.map(|[height, radius]| format!("[{height:.5},{radius:.5}]")).collect();
            let attitude = |frame: usize| {
                let q = attitudes[frame];
                [q.w, q.i, q.j, q.k]
            };
            let position = |frame: usize| positions.get(frame).into_iter().flat_map(|place| place.iter().copied());
            write!(f, "{{name: {}, sides: [{}], round: {round}, ", Text(name), sides.join(","))?;
            write!(f, "profile: [{}], middle: {}, ", profile.join(","), vector(middle))?;
            write!(f, "\nattitudes: {}, ", numbers(written().flat_map(attitude)))?;
            writeln!(f, "positions: {}}},", numbers(frames().flat_map(position)))?;
        }
        let rods: Vec<_> = self.rods.iter().map(|(body, point)| format!("[{body},{}]", vector(point))).collect();
        writeln!(f, "],\nrods: [{}],", rods.join(","))?;
        writeln!(f, "events: [")?;
        for (time, name) in self.events.iter().take(MOST_EVENTS) {
            writeln!(f, "[{time:?}, {}],", Text(name))?;
        }
        writeln!(f, "],\ncharts: [")?;
        for Chart { title, unit, logarithmic, lines } in self.charts {
            writeln!(f, "{{title: {}, unit: {}, logarithmic: {logarithmic}, lines: [", Text(title), Text(unit))?;
            for (name, values) in lines {
                writeln!(f, "{{name: {}, values: {}}},", Text(name), numbers(written().map(|frame| values[frame])))?;
            }
            writeln!(f, "]}},")?;
        }
        let script = self.model.and_then(|model| model.script(self.axis));
        let (step, change) = script.as_ref().map_or(("", ""), |script| (&**script, CHANGE));
        write!(f, "]}};\n{}</script>\n</body>\n</html>\n", light(&[step, SCRIPT, change].concat()))
    }
}
