//! The variables of a unit: the time, parameters and inputs, the start, and outputs.

use crate::run::model::{Model, ModelParameter};

/// The part of a variable in a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Time,
    /// A parameter that may change between steps.
    Parameter,
    Input,
    /// A parameter of the start.
    Start,
    Output,
}

/// A variable, and the place of its first number.
#[derive(Clone, Debug)]
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) place: usize,
    /// Rows and columns.
    pub(super) shape: (usize, usize),
    pub(super) unit: String,
    pub(super) part: Part,
    /// The numbers at the start; none where they follow from others.
    pub(super) start: Vec<f64>,
}

impl Variable {
    pub(super) const fn len(&self) -> usize {
        self.shape.0 * self.shape.1
    }
}

/// Effects whose parameter another program may turn while the motion goes on.
const INPUTS: [&str; 2] = ["torque.torque", "thrust.thrust"];

/// The variables of a model in the order of their places.
pub(super) fn variables(model: &Model, energy: &str) -> Vec<Variable> {
    let (entries, n) = (model.attitude.len(), model.momentum.len());
    let mut place = 0;
    let mut all = Vec::new();
    let mut add = |name: &str, shape: (usize, usize), unit: &str, part, start: &[f64]| {
        let length = shape.0 * shape.1;
        all.push(Variable { name: name.to_owned(), place, shape, unit: unit.to_owned(), part, start: start.to_vec() });
        place += length;
    };
    add("time", (1, 1), "s", Part::Time, &[]);
    for parameter in &model.parameters {
        let ModelParameter { name, kind, unit, .. } = parameter;
        let is_input = INPUTS.contains(&&**name) || name.starts_with("force.");
        let part = if is_input { Part::Input } else { Part::Parameter };
        add(name, kind.shape(), unit.unwrap_or_default(), part, &model.numbers[parameter.places()]);
    }
    if model.parameters.is_empty() {
        add("nothing", (1, 1), "", Part::Parameter, &[0.0]);
    }
    let is_body = (entries, n) == (9, 3);
    let attitude = if is_body { (3, 3) } else { (entries, 1) };
    let [rate, momentum] = if is_body { ["rad/s", "kg m²/s"] } else { [""; 2] };
    add("attitude_at_start", attitude, "", Part::Start, &model.attitude);
    if model.is_by_momentum {
        add("momentum_at_start", (n, 1), momentum, Part::Start, &model.momentum);
    } else {
        add("velocity_at_start", (n, 1), rate, Part::Start, &model.velocity);
    }
    add("attitude", attitude, "", Part::Output, &[]);
    add("momentum", (n, 1), momentum, Part::Output, &[]);
    add("velocity", (n, 1), rate, Part::Output, &[]);
    add("energy", (1, 1), energy, Part::Output, &[]);
    all
}
