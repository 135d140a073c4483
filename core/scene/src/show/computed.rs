//! The part of a page that computes the motion anew: the step as a script, its numbers, and what may be changed.

use std::fmt::Write as _;

use liestep_derivation::ParameterKind;
use liestep_late::{constant, is_exact, javascript};
use nalgebra::Vector3;

use crate::run::model::{Model, ModelParameter};
use crate::show::text::Text;

const COMPUTE: &str = include_str!("compute.js");
/// The part that is beside the page's own script.
pub(crate) const CHANGE: &str = include_str!("change.js");

/// A number that may be changed.
struct Slider {
    name: String,
    unit: &'static str,
    value: f64,
    range: [f64; 2],
    /// The places of the number, among those of `of`.
    places: Vec<usize>,
    of: &'static str,
}

/// The range of a slider for a value: from zero, or beyond it, to twice the value.
fn around(value: f64) -> [f64; 2] {
    if value == 0.0 { [-1.0, 1.0] } else { [f64::min(0.0, 2.0 * value), f64::max(0.0, 2.0 * value)] }
}

/// The sliders of a parameter: of a symmetric matrix those of its diagonal, and of other entries that aren't zero.
fn sliders<'m>(model: &'m Model, parameter: &'m ModelParameter) -> impl Iterator<Item = Slider> + 'm {
    let (rows, columns) = parameter.kind.shape();
    let is_symmetric = parameter.kind == ParameterKind::Inertia;
    parameter.places().enumerate().filter_map(move |(at, place)| {
        let ((i, j), value) = ((at / columns, at % columns), model.numbers[place]);
        let is_repeated = is_symmetric && j < i;
        if is_repeated || rows > 1 && columns > 1 && i != j && value == 0.0 {
            return None;
        }
        let index = match (rows, columns) {
            (1, 1) => String::new(),
            (_, 1) => format!(" {}", i + 1),
            _ => format!(" {} {}", i + 1, j + 1),
        };
        let mirrored = (is_symmetric && i != j).then_some(parameter.first + j * columns + i);
        // A body without inertia has no step.
        let [low, high] = around(value);
        let range = if parameter.is_inertia() && i == j && value > 0.0 { [0.2 * value, high] } else { [low, high] };
        let places = std::iter::once(place).chain(mirrored).collect();
        let unit = parameter.unit.unwrap_or_default();
        Some(Slider { name: parameter.name.clone() + &index, unit, value, range, places, of: "numbers" })
    })
}

impl Model {
    /// The inertias of effects, which follow that of the body: the first of their places, that of the body, the rows of its
    /// matrix, and whether it is the nonstandard one.
    fn linked(&self) -> Option<(&ModelParameter, Vec<&ModelParameter>)> {
        let body = self.parameters.iter().find(|one| one.is_inertia() && one.name.starts_with("body."))?;
        let others = self.parameters.iter().filter(|one| one.is_inertia() && !one.name.starts_with("body."));
        Some((body, others.collect()))
    }

    fn all_sliders(&self) -> Vec<Slider> {
        let linked = self.linked().map(|(_, others)| others).unwrap_or_default();
        let is_free =
            |one: &&ModelParameter| one.unit.is_some() && !linked.iter().any(|other| other.first == one.first);
        let mut all: Vec<Slider> =
            self.parameters.iter().filter(is_free).flat_map(|parameter| sliders(self, parameter)).collect();
        let fastest = self.velocity.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        let bound = if fastest > 0.0 { 2.0 * fastest } else { 1.0 };
        let three = |name: &str, unit, value: &dyn Fn(usize) -> f64, bound: f64, of| -> Vec<Slider> {
            let one = |k: usize| {
                let (name, range) = (format!("{name}{}", ["₁", "₂", "₃"][k]), [-bound, bound]);
                Slider { name, unit, value: value(k), range, places: vec![k], of }
            };
            (0..3).map(one).collect()
        };
        all.extend(three("start: Ω", "rad/s", &|k| self.velocity[k], bound, "velocity"));
        all.extend(three("start: turned about e", "°", &|_| 0.0, 180.0, "turn"));
        all
    }

    /// Whether a page computes the motion of the program to the bit.
    pub(crate) fn is_exact(&self) -> bool {
        is_exact(self.declaration).unwrap_or_default()
    }

    /// The script that has the step, the numbers and the sliders; none where the step can't be written.
    pub(crate) fn script(&self, axis: &Vector3<f64>) -> Option<String> {
        let (text, is_exact) = (javascript(self.declaration).ok()?, self.is_exact());
        let list = |numbers: &[f64]| numbers.iter().map(|one| format!("{one:?}")).collect::<Vec<_>>().join(",");
        let mut script = format!("/* The step. */\n{text}const model = {{ step: {}, ", constant(self.declaration));
        let _ = writeln!(script, "isExact: {is_exact}, h: {:?}, steps: {},", self.step, self.steps);
        let _ = writeln!(script, "gamma: [{}], axis: [{}],", list(&self.gammas), list(axis.as_slice()));
        let _ = writeln!(script, "numbers: [{}],", list(&self.numbers));
        let _ = writeln!(script, "attitude: [{}], momentum: [{}],", list(&self.attitude), list(&self.momentum));
        let _ = writeln!(script, "velocity: [{}], isByMomentum: {},", list(&self.velocity), self.is_by_momentum);
        let linked = self.linked().map_or_else(String::new, |(body, others)| {
            let places: Vec<_> = others.iter().map(|one| one.first.to_string()).collect();
            let (is_diagonal, is_nonstandard) =
                (body.kind == ParameterKind::DiagonalInertia, body.name.ends_with("_d"));
            let places = places.join(",");
            format!(
                "body: {}, isDiagonal: {is_diagonal}, isNonstandard: {is_nonstandard}, places: [{places}]",
                body.first
            )
        });
        let _ = writeln!(script, "linked: {{ {linked} }},\nsliders: [");
        for Slider { name, unit, value, range: [low, high], places, of } in self.all_sliders() {
            let places: Vec<_> = places.iter().map(usize::to_string).collect();
            let _ = write!(script, "{{name:{},unit:{},value:{value:?},", Text(&name), Text(unit));
            let _ = writeln!(script, "low:{low:?},high:{high:?},of:\"{of}\",places:[{}]}},", places.join(","));
        }
        Some(script + "] };\n" + COMPUTE)
    }
}
