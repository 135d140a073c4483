//! Several declarations in one: programs that add what theirs compute.

use liestep_derivation::{Array, Carried, Operation, Parameter, Program, Role, Source, StagedDeclaration, Stages};

use crate::error::LateError;
use crate::specialised::{Fold, Value};

/// A term, and where its numbers begin among those of all.
#[derive(Clone, Copy)]
struct Part<'a> {
    staged: &'a StagedDeclaration,
    parameters: usize,
    constants: usize,
    carried: usize,
    /// The right side is that of one term, and zero that of the others.
    has_target: bool,
}

impl Part<'_> {
    fn moved(&self, source: Source) -> Value {
        let first = match source.array {
            Array::Target if !self.has_target => return Value::of(0.0),
            Array::Parameters => self.parameters,
            Array::Constants => self.constants,
            Array::Advected | Array::Next => self.carried,
            _ => 0,
        };
        Value::Input(Source::new(source.array, first + source.at))
    }

    fn append(&self, fold: &mut Fold, program: &Program) -> Vec<Value> {
        fold.append(program, |source| self.moved(source), Fold::kept)
    }

    /// `l`, momentum and Hessian at a velocity: those of `½ ξ·Jξ + s·ξ − V` where it is quadratic.
    fn at_velocity(&self, fold: &mut Fold) -> [Vec<Value>; 3] {
        if let Some(programs) = &self.staged.programs.at_velocity {
            return programs.each_ref().map(|program| self.append(fold, program));
        }
        let at_rest = self.append(fold, &self.staged.programs.at_rest);
        let size = dimension(self.staged);
        let velocity = inputs(Array::Velocity, size);
        let (hessian, rest) = at_rest.split_at(size * size);
        let image: Vec<Value> = hessian.chunks(size).map(|row| dot(fold, row, &velocity)).collect();
        let (square, linear) = (dot(fold, &velocity, &image), dot(fold, &rest[..size], &velocity));
        let kinetic = fold.multiply(square, Value::of(0.5));
        let sum = fold.add(kinetic, linear);
        [vec![fold.subtract(sum, rest[size])], added(fold, &image, &rest[..size]), hessian.to_vec()]
    }
}

/// Components of covectors.
fn dimension(staged: &StagedDeclaration) -> usize {
    staged.programs.kick_before.outputs.len()
}

fn inputs(array: Array, count: usize) -> Vec<Value> {
    (0..count).map(|at| Value::Input(Source::new(array, at))).collect()
}

fn dot(fold: &mut Fold, a: &[Value], b: &[Value]) -> Value {
    a.iter().zip(b).fold(Value::of(0.0), |sum, (&a, &b)| {
        let product = fold.multiply(a, b);
        fold.add(sum, product)
    })
}

fn added(fold: &mut Fold, a: &[Value], b: &[Value]) -> Vec<Value> {
    a.iter().zip(b).map(|(&a, &b)| fold.kept(Operation::Add(0, 0), [a, b])).collect()
}

/// Residual and Jacobian, multiplied by this power of `1 + |y|²`, as `Coordinates::raised` does it.
fn raised(fold: &mut Fold, system: Vec<Value>, size: usize, power: u32) -> Vec<Value> {
    if power == 0 {
        return system;
    }
    let (residual, jacobian) = system.split_at(size);
    let half = inputs(Array::Half, size);
    let square = dot(fold, &half, &half);
    let d = fold.add(square, Value::of(1.0));
    let below = (1..power).fold(Value::of(1.0), |product, _| fold.multiply(product, d));
    let (factor, slope) = (fold.multiply(below, d), fold.multiply(below, Value::of(2.0 * f64::from(power))));
    let mut raised: Vec<Value> = residual.iter().map(|&entry| fold.multiply(entry, factor)).collect();
    for (row, &defect) in jacobian.chunks(size).zip(residual) {
        for (&entry, &y) in row.iter().zip(&half) {
            let outer = fold.multiply(defect, y);
            let (scaled, moved) = (fold.multiply(entry, factor), fold.multiply(outer, slope));
            raised.push(fold.add(scaled, moved));
        }
    }
    raised
}

/// What is computed for each part, added.
fn sum_of<P>(parts: impl IntoIterator<Item = P>, mut of: impl FnMut(P, &mut Fold) -> Vec<Value>) -> Program {
    let mut fold = Fold::default();
    let mut sum: Option<Vec<Value>> = None;
    for part in parts {
        let one = of(part, &mut fold);
        sum = Some(sum.map_or_else(|| one.clone(), |sum| added(&mut fold, &sum, &one)));
    }
    fold.program(&sum.unwrap_or_default())
}

/// Residual and Jacobian of kinetic parts, rotors and forces, all with the unknown in them.
fn system(solved: &[&Part<'_>], outputs: usize) -> Program {
    let (mut fold, mut sum, mut power) = (Fold::default(), Vec::new(), 0);
    for part in solved {
        let (size, own) = (dimension(part.staged), part.staged.denominators);
        let both = own.max(power);
        let one = part.append(&mut fold, &part.staged.programs.newton_system);
        let one = raised(&mut fold, one, size, both - own);
        sum = if part.has_target {
            one
        } else {
            // What is added up so far is multiplied as one.
            let before = raised(&mut fold, sum, size, both - power);
            added(&mut fold, &before, &one)
        };
        power = both;
    }
    sum.truncate(outputs);
    fold.program(&sum)
}

fn programs(parts: &[Part<'_>]) -> Stages<Program> {
    let stage = |program: fn(&Stages<Program>) -> &Program| {
        sum_of(parts, |part, fold| part.append(fold, program(&part.staged.programs)))
    };
    let mut constants = Fold::default();
    let of_all: Vec<Value> =
        parts.iter().flat_map(|part| part.append(&mut constants, &part.staged.programs.constants)).collect();
    let solved: Vec<&Part<'_>> = parts.iter().filter(|part| part.has_target || part.staged.parts[0]).collect();
    let size = parts.first().map_or(0, |part| dimension(part.staged));
    let kicked = parts.iter().filter(|part| part.staged.parts[1]);
    let derivatives: Option<Vec<_>> =
        kicked.map(|part| Some((part, part.staged.programs.kick_derivative.as_ref()?))).collect();
    let derivatives = derivatives.filter(|derivatives| !derivatives.is_empty());
    let of_lagrangian = |at: usize| {
        let programs = parts.iter().filter_map(|part| Some((part, &part.staged.programs.lagrangian.as_ref()?[at])));
        sum_of(programs, |(part, program), fold| part.append(fold, program))
    };
    let at_velocity = |at: usize| sum_of(parts, |part, fold| std::mem::take(&mut part.at_velocity(fold)[at]));
    let mut all = parts.iter().map(|part| part.staged);
    Stages {
        constants: constants.program(&of_all),
        kick_before: stage(|programs| &programs.kick_before),
        newton_system: system(&solved, usize::MAX),
        newton_residual: system(&solved, size),
        kick_after: stage(|programs| &programs.kick_after),
        kick_derivative: derivatives
            .map(|derivatives| sum_of(derivatives, |(part, program), fold| part.append(fold, program))),
        momentum_jacobian: stage(|programs| &programs.momentum_jacobian),
        at_rest: stage(|programs| &programs.at_rest),
        at_velocity: all.clone().any(|staged| !staged.is_quadratic).then(|| [0, 1, 2].map(at_velocity)),
        lagrangian: all
            .any(|staged| staged.programs.lagrangian.is_some())
            .then(|| [0, 1, 2, 3, 4, 5].map(of_lagrangian)),
    }
}

/// What is of the place is added, and what is of the numbers that are carried stands in the order of the terms.
fn derivatives(parts: &[Part<'_>]) -> Option<[Program; 4]> {
    let all = parts.iter().map(|part| Some((part, part.staged.derivatives.as_ref()?)));
    let all = all.collect::<Option<Vec<_>>>()?;
    let of = |at: usize, of_place: usize| {
        let (mut fold, mut sum, mut behind) = (Fold::default(), Vec::new(), Vec::new());
        for (part, programs) in &all {
            // The weights are those of all terms.
            let mut one = Part { has_target: true, ..**part }.append(&mut fold, &programs[at]);
            behind.extend(one.split_off(of_place.min(one.len())));
            sum = if sum.is_empty() { one } else { added(&mut fold, &sum, &one) };
        }
        fold.program(&[sum, behind].concat())
    };
    Some([of(0, usize::MAX), of(1, usize::MAX), of(2, dimension(parts.first()?.staged)), of(3, 0)])
}

/// The sum of several.
pub(crate) fn summed(terms: &[&StagedDeclaration]) -> Result<StagedDeclaration, LateError> {
    let first = *terms.first().ok_or(LateError::Nothing)?;
    if let Some(other) = terms.iter().find(|staged| staged.factors != first.factors) {
        let names: Vec<&str> = other.factors.iter().map(|factor| factor.name.as_str()).collect();
        return Err(LateError::Group { declared: names.join(", ") });
    }
    if terms.iter().any(|staged| staged.energy.is_some()) {
        return Err(LateError::Pace);
    }
    let with_target = terms.iter().position(|staged| staged.parts[0]).unwrap_or(0);
    let (mut parts, mut parameters, mut carried) = (Vec::<Part<'_>>::new(), Vec::new(), Vec::<Carried>::new());
    for (at, &staged) in terms.iter().enumerate() {
        let alike = terms[..at].iter().filter(|other| other.name == staged.name).count();
        let name = if alike == 0 { staged.name.clone() } else { format!("{}{}", staged.name, alike + 1) };
        parts.push(Part {
            staged,
            parameters: parameters.iter().map(|parameter: &Parameter| parameter.kind.len()).sum(),
            constants: terms[..at].iter().map(|staged| staged.programs.constants.outputs.len()).sum(),
            carried: carried.iter().map(|carried| carried.shape.0 * carried.shape.1).sum(),
            has_target: at == with_target,
        });
        let first = parameters.len();
        carried
            .extend(staged.carried.iter().map(|one| Carried { field: one.field.map(|field| first + field), ..*one }));
        let named = |one: &Parameter| Parameter { name: format!("{name}.{}", one.name), kind: one.kind };
        parameters.extend(staged.parameters.iter().map(named));
    }
    let solved = || terms.iter().filter(|staged| staged.parts[0]);
    let in_all = |end: &usize| solved().all(|staged| staged.blocks.contains(end));
    let joined = |of: fn(&StagedDeclaration) -> &str, by: &str| {
        terms.iter().map(|staged| of(staged)).collect::<Vec<_>>().join(by)
    };
    Ok(StagedDeclaration {
        name: joined(|staged| &staged.name, " + "),
        role: terms.iter().map(|staged| staged.role).find(|&role| role == Role::Lagrangian).unwrap_or(first.role),
        factors: first.factors.clone(),
        derivation: joined(|staged| &staged.derivation, "\n"),
        has_kinetic: terms.iter().any(|staged| staged.has_kinetic),
        is_expensive: false,
        parts: [0, 1, 2].map(|part| terms.iter().any(|staged| staged.parts[part])),
        denominators: solved().map(|staged| staged.denominators).max().unwrap_or(0),
        has_constant_inertia: terms.iter().all(|staged| staged.has_constant_inertia),
        is_quadratic: terms.iter().all(|staged| staged.is_quadratic),
        is_self_adjoint: terms.iter().all(|staged| staged.is_self_adjoint),
        in_increment: first.in_increment,
        energy: None,
        blocks: solved().next().map_or_else(Vec::new, |one| one.blocks.iter().copied().filter(in_all).collect()),
        programs: programs(&parts),
        derivatives: derivatives(&parts),
        parameters,
        carried,
    })
}
