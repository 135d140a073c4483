//! A certificate of a step: its programs at a random point of the field of [`residue`](crate::judged::verify::residue),
//! where nothing is rounded.
//!
//! The verifier compares the programs of a declaration with its text, and takes the Cayley map, the transport and the solves
//! for right. Here they are proved, too: a step ends in the group, carries what is advected by the action of the group, and
//! conserves the momentum in space `Ad*_{g⁻¹} μ` but for its kicks; and an iteration is Newton's. Each claim is an identity of
//! rational functions. One that is wrong holds at a random point with a probability of its degree, some thousands, over
//! `2⁶¹`.

use super::values::{Value, Words};
use super::writer::Writer;
use crate::judged::verify::dual::Dual;
use crate::judged::verify::number::Number;
use crate::judged::verify::residue::Residue;
use crate::mathematics::symbolic::Rational;
use crate::staged::{Array, Operation, Program, Source};

/// The programs that a certificate is of.
pub(super) struct Subject<'a> {
    pub(super) iterate: &'a Program,
    pub(super) finish: &'a Program,
    pub(super) seen: &'a Program,
    pub(super) spatial: &'a Program,
    pub(super) defect: &'a Program,
}

/// Numbers by arrays.
type Numbers = Vec<(Array, Vec<Residue>)>;

/// The claim that is wrong, if one is. Nothing is claimed of generators and literals that aren't fractions of small numbers,
/// as their products are rounded.
pub(super) fn mistake(writer: &Writer, of: &Subject) -> Option<&'static str> {
    let n = writer.dimension();
    let mut next = Residue::stream(1);
    let mut some = |count: usize| (0..count).map(|_| next()).collect::<Vec<Residue>>();
    let parameters: usize = writer.staged.parameters.iter().map(|parameter| parameter.kind.len()).sum();
    let identity = writer.factors.iter().flat_map(|factor| {
        let size = factor.size();
        (0..size * size).map(move |at| if at / size == at % size { Residue::ONE } else { Residue::ZERO })
    });
    let zero = vec![Residue::ZERO; 2 * n + writer.carried];
    let mut numbers: Numbers = vec![
        (Array::Parameters, some(parameters)),
        (Array::Step, some(1)),
        (Array::Half, some(n)),
        (Array::History, zero.clone()),
        (Array::Target, zero.clone()),
        (Array::Momentum, zero.clone()),
        (Array::Advected, zero),
        (Array::Attitude, identity.collect()),
    ];
    let constants = &writer.staged.programs.constants;
    let known = run(constants, &numbers)?;
    set(&mut numbers, Array::Constants, known);
    // Two steps from the identity: one is the attitude, the other the step that is certified.
    let attitude = run(of.finish, &numbers)?[..writer.entries].to_vec();
    set(&mut numbers, Array::Attitude, attitude);
    set(&mut numbers, Array::Half, some(n));
    let advected = run(of.seen, &numbers)?;
    set(&mut numbers, Array::Advected, advected);
    set(&mut numbers, Array::Target, some(n));
    if is_exact(of.iterate) && is_exact(constants) && is_newtons(writer, of.iterate, &numbers) == Some(false) {
        return Some("an iteration isn't Newton's");
    }
    let is_known = |number: &f64| fraction(*number).is_some();
    let is_group_exact = writer.factors.iter().all(|factor| factor.basis.numbers().all(|number| is_known(&number)));
    if !is_group_exact {
        return None;
    }
    is_a_step(writer, of, numbers, &[some(n), some(n)])
}

/// The claims of the end of a step.
fn is_a_step(writer: &Writer, of: &Subject, mut numbers: Numbers, momenta: &[Vec<Residue>; 2]) -> Option<&'static str> {
    let (n, entries) = (writer.dimension(), writer.entries);
    let mut ends = Vec::new();
    // Kicks don't depend on the momentum.
    for momentum in momenta {
        set(&mut numbers, Array::Target, momentum.clone());
        set(&mut numbers, Array::Momentum, momentum.clone());
        ends.push(run(of.finish, &numbers)?);
    }
    let difference = |a: &[Residue], b: &[Residue]| a.iter().zip(b).map(|(&a, &b)| a - b).collect::<Vec<Residue>>();
    let [before, after] = [(&momenta[0], &momenta[1]), (&ends[0], &ends[1])].map(|(a, b)| (a.as_slice(), b.as_slice()));
    set(&mut numbers, Array::Momentum, difference(before.0, before.1));
    let start = run(of.spatial, &numbers)?;
    let place = entries..entries + n;
    set(&mut numbers, Array::Momentum, difference(&after.0[place.clone()], &after.1[place]));
    set(&mut numbers, Array::Attitude, ends[0][..entries].to_vec());
    // The reactions of constraints are impulses that depend on the momentum.
    if !writer.is_constrained() && run(of.spatial, &numbers)? != start {
        return Some("the momentum in space isn't conserved");
    }
    if run(of.seen, &numbers)? != ends[0][entries + n..entries + n + writer.carried] {
        return Some("what is advected isn't carried by the group");
    }
    (!run(of.defect, &numbers)?[0].is_zero()).then_some("a step leaves the group")
}

/// Whether the derivative of the residual along the update is the residual.
fn is_newtons(writer: &Writer, iterate: &Program, numbers: &Numbers) -> Option<bool> {
    let n = writer.dimension();
    let mut words = Words::default();
    let half = Value::inputs(Array::Half, n);
    let residual = writer.residual(&mut words, &half);
    let residual = words.program(&residual);
    if !is_exact(&residual) {
        return None;
    }
    let next = run(iterate, numbers)?;
    let along = evaluated(&residual, |source| {
        let value = read(numbers, source);
        let is_half = source.array == Array::Half;
        Dual { value, slope: if is_half { value - next[source.at] } else { Residue::ZERO } }
    });
    Some(along.iter().all(|entry| !entry.is_defined() || entry.slope == entry.value))
}

fn set(numbers: &mut Numbers, array: Array, to: Vec<Residue>) {
    numbers.retain(|(known, _)| *known != array);
    numbers.push((array, to));
}

fn read(numbers: &Numbers, source: Source) -> Residue {
    let found = numbers.iter().find(|(array, _)| *array == source.array);
    found.and_then(|(_, all)| all.get(source.at)).copied().unwrap_or(Residue::UNDEFINED)
}

/// The outputs of a program; none if one isn't defined.
fn run(program: &Program, numbers: &Numbers) -> Option<Vec<Residue>> {
    let outputs = evaluated(program, |source| read(numbers, source));
    outputs.iter().all(|output| output.is_defined()).then_some(outputs)
}

fn evaluated<T: Number>(program: &Program, input: impl Fn(Source) -> T) -> Vec<T> {
    let literal = |&number: &f64| T::of(fraction(number).unwrap_or(Rational::ONE));
    let mut values: Vec<T> =
        program.inputs.iter().map(|&source| input(source)).chain(program.literals.iter().map(literal)).collect();
    for &operation in &program.operations {
        let [a, b] = operation.operands().map(|at| values[at]);
        values.push(match operation {
            Operation::Negate(_) => -a,
            Operation::Add(..) => a + b,
            Operation::Subtract(..) => a - b,
            Operation::Multiply(..) => a * b,
            Operation::Divide(..) => a / b,
            Operation::Apply(function, _) => a.apply(function),
        });
    }
    program.outputs.iter().map(|&at| values[at as usize]).collect()
}

fn is_exact(program: &Program) -> bool {
    program.literals.iter().all(|&literal| fraction(literal).is_some())
}

/// The fraction with a small denominator, or with few decimals, that this is the nearest number to.
#[allow(clippy::cast_possible_truncation)] // as integers they are below 2⁵³
fn fraction(number: f64) -> Option<Rational> {
    let denominators = (1..=64).chain([100, 128, 256, 1_000, 10_000]);
    let fractions = denominators.map(|q: i32| (number * f64::from(q), q)).filter(|(p, _)| p.abs() < 1e12);
    let mut fractions = fractions.map(|(p, q)| Rational::new(p.round() as i128, q.into()));
    fractions.find(|fraction| fraction.to_f64().to_bits() == number.to_bits())
}
