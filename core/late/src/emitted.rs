//! The programs of a step that texts contain, with the constants that one of them reads.

use std::collections::BTreeMap;

use liestep_derivation::whole::{Value, WholeStep, Words};
use liestep_derivation::{Array, Program, Source};

/// The programs by their names; none for one that the step doesn't have. All but the last are called by the step in C.
pub(crate) type Emitted = Vec<(&'static str, Option<Program>)>;

/// The programs of a step. Constants that only other programs read, as those of derivatives, are left out.
pub(crate) fn emitted(step: &WholeStep) -> Emitted {
    let all = &step.programs;
    let others = [
        ("target", Some(&all.target)),
        ("iterate", Some(&all.iterate)),
        ("again", Some(&all.again)),
        ("finish", Some(&all.finish)),
        ("safe", all.safe.as_ref()),
        ("seen", Some(&all.seen)),
        ("restored", Some(&all.restored)),
        ("defect", Some(&all.defect)),
        ("rest", Some(&all.rest)),
        ("newton", Some(&all.newton)),
    ];
    let mut places = BTreeMap::new();
    let inputs = others.iter().filter_map(|(_, program)| *program).flat_map(|program| &program.inputs);
    places.extend(inputs.filter(|source| source.array == Array::Constants).map(|source| (source.at, 0)));
    for (place, (_, at)) in places.iter_mut().enumerate() {
        *at = place;
    }
    let mut words = Words::default();
    let constants = words.append(&all.constants, Value::Input);
    let read: Vec<Value> = places.keys().map(|&at| constants[at]).collect();
    let moved = |program: &Program| {
        let inputs = program.inputs.iter().map(|&source| match source.array {
            Array::Constants => Source::new(Array::Constants, places[&source.at]),
            _ => source,
        });
        Program { inputs: inputs.collect(), ..program.clone() }
    };
    let others = others.into_iter().map(|(name, program)| (name, program.map(moved)));
    [("constants", Some(words.program(&read)))].into_iter().chain(others).collect()
}

/// The name of an array in a text.
pub(crate) const fn name(array: Array) -> &'static str {
    match array {
        Array::Step => "h",
        Array::Parameters => "parameters",
        Array::Constants => "constants",
        Array::Advected => "advected",
        Array::Next => "next",
        Array::Element => "element",
        Array::Increment => "increment",
        Array::Inverse => "inverse",
        Array::InverseIncrement => "inverse_increment",
        Array::Half => "half",
        Array::Velocity => "velocity",
        Array::Target => "target",
        Array::Attitude => "attitude",
        Array::Momentum => "momentum",
        Array::History => "history",
        Array::Factors => "factors",
    }
}
