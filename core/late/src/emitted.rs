//! The programs of a step that texts contain, with the constants that one of them reads.

use std::collections::BTreeMap;

use liestep_derivation::whole::{Value, WholeStep, Words};
use liestep_derivation::{Array, Program, Source};

/// The programs of a step in a text.
pub(crate) struct Emitted {
    /// The programs by their names; none for one that the step doesn't have.
    pub(crate) programs: Vec<(&'static str, Option<Program>)>,
    /// The place of each constant among all constants of the step.
    pub(crate) constants: Vec<usize>,
}

/// The programs of a step, and more of its programs. Constants that none of them reads, as those of derivatives, are left
/// out, and those that only the additional programs read come last.
pub(crate) fn emitted(step: &WholeStep, more: &[(&'static str, &Program)]) -> Emitted {
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
    ];
    let more: Vec<_> = more.iter().map(|&(name, program)| (name, Some(program))).collect();
    let mut places = BTreeMap::new();
    for programs in [&others[..], &more[..]] {
        let inputs = programs.iter().filter_map(|(_, program)| *program).flat_map(|program| &program.inputs);
        let mut read: Vec<usize> =
            inputs.filter(|source| source.array == Array::Constants).map(|source| source.at).collect();
        read.sort_unstable();
        for at in read {
            let next = places.len();
            places.entry(at).or_insert(next);
        }
    }
    let mut words = Words::default();
    let constants = words.append(&all.constants, Value::Input);
    let mut read: Vec<(usize, usize)> = places.iter().map(|(&at, &place)| (place, at)).collect();
    read.sort_unstable();
    let kept: Vec<usize> = read.into_iter().map(|(_, at)| at).collect();
    let read: Vec<Value> = kept.iter().map(|&at| constants[at]).collect();
    let moved = |program: &Program| {
        let inputs = program.inputs.iter().map(|&source| match source.array {
            Array::Constants => Source::new(Array::Constants, places[&source.at]),
            _ => source,
        });
        Program { inputs: inputs.collect(), ..program.clone() }
    };
    let others = others.into_iter().chain(more).map(|(name, program)| (name, program.map(moved)));
    let programs = [("constants", Some(words.program(&read)))].into_iter().chain(others).collect();
    Emitted { programs, constants: kept }
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
