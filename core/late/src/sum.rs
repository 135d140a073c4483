//! A sum of declarations as one declaration, whose programs add the outputs of the terms' programs.

use liestep_derivation::whole::{Value, Words, constrained};
use liestep_derivation::{Array, Carried, Constraints, Parameter, Program, Role, Source, StagedDeclaration, Stages};

use crate::error::LateError;

/// A term of a sum, with the places of its numbers among those of all terms.
struct Part<'a> {
    staged: &'a StagedDeclaration,
    parameters: usize,
    constants: usize,
    carried: usize,
    /// Whether the term's system has the right side: that of one term has, and that of the others has zero.
    has_target: bool,
}

impl Part<'_> {
    /// Appends a program of the term.
    fn append(&self, words: &mut Words, program: &Program) -> Vec<Value> {
        words.append(program, |source| {
            let first = match source.array {
                Array::Target if !self.has_target => return Value::ZERO,
                Array::Parameters => self.parameters,
                Array::Constants => self.constants,
                Array::Advected | Array::Next => self.carried,
                _ => 0,
            };
            Value::Input(Source::new(source.array, first + source.at))
        })
    }

    /// `l`, momentum and Hessian at a velocity: those of `½ ξ·Jξ + s·ξ − V` where it is quadratic.
    fn at_velocity(&self, words: &mut Words) -> [Vec<Value>; 3] {
        if let Some(programs) = &self.staged.programs.at_velocity {
            return programs.each_ref().map(|program| self.append(words, program));
        }
        let at_rest = self.append(words, &self.staged.programs.at_rest);
        let size = dimension(self.staged);
        let velocity = Value::inputs(Array::Velocity, size);
        let (hessian, rest) = at_rest.split_at(size * size);
        let image: Vec<Value> = hessian.chunks(size).map(|row| words.dot(row, &velocity)).collect();
        let (square, linear) = (words.dot(&velocity, &image), words.dot(&rest[..size], &velocity));
        let kinetic = words.multiply(square, Value::of(0.5));
        let sum = words.add(kinetic, linear);
        [vec![words.subtract(sum, rest[size])], words.added(&image, &rest[..size]), hessian.to_vec()]
    }
}

/// The number of a covector's components.
fn dimension(staged: &StagedDeclaration) -> usize {
    staged.programs.kick_before.outputs.len()
}

/// Residual and Jacobian, multiplied by this power of `1 + |y|²`, as `Coordinates::raised` does it.
fn raised(words: &mut Words, system: Vec<Value>, size: usize, power: u32) -> Vec<Value> {
    if power == 0 {
        return system;
    }
    let (residual, jacobian) = system.split_at(size);
    let half = Value::inputs(Array::Half, size);
    let square = words.dot(&half, &half);
    let d = words.add(square, Value::ONE);
    let below = (1..power).fold(Value::ONE, |product, _| words.multiply(product, d));
    let (factor, slope) = (words.multiply(below, d), words.multiply(below, Value::of(2.0 * f64::from(power))));
    let mut raised: Vec<Value> = residual.iter().map(|&entry| words.multiply(entry, factor)).collect();
    for (row, &defect) in jacobian.chunks(size).zip(residual) {
        for (&entry, &y) in row.iter().zip(&half) {
            let outer = words.multiply(defect, y);
            let (scaled, moved) = (words.multiply(entry, factor), words.multiply(outer, slope));
            raised.push(words.add(scaled, moved));
        }
    }
    raised
}

/// The sum of the outputs that a function computes for each part.
fn sum_of<P>(parts: impl IntoIterator<Item = P>, mut of: impl FnMut(P, &mut Words) -> Vec<Value>) -> Program {
    let mut words = Words::default();
    let mut sum: Option<Vec<Value>> = None;
    for part in parts {
        let one = of(part, &mut words);
        sum = Some(sum.map_or_else(|| one.clone(), |sum| words.added(&sum, &one)));
    }
    words.program(&sum.unwrap_or_default())
}

/// Residual and Jacobian of the terms with an unknown part: kinetic ones, rotors and forces.
fn system(solved: &[&Part<'_>], outputs: usize) -> Program {
    let (mut words, mut sum, mut power) = (Words::default(), Vec::new(), 0);
    for part in solved {
        let (size, own) = (dimension(part.staged), part.staged.denominators);
        let both = own.max(power);
        let one = part.append(&mut words, &part.staged.programs.newton_system);
        let one = raised(&mut words, one, size, both - own);
        sum = if part.has_target {
            one
        } else {
            // The sum of the terms before is multiplied as one.
            let before = raised(&mut words, sum, size, both - power);
            words.added(&before, &one)
        };
        power = both;
    }
    sum.truncate(outputs);
    words.program(&sum)
}

fn programs(parts: &[Part<'_>]) -> Stages<Program> {
    let stage = |program: fn(&Stages<Program>) -> &Program| {
        sum_of(parts, |part, words| part.append(words, program(&part.staged.programs)))
    };
    let mut constants = Words::default();
    let of_terms: Vec<Value> =
        parts.iter().flat_map(|part| part.append(&mut constants, &part.staged.programs.constants)).collect();
    let solved: Vec<&Part<'_>> = parts.iter().filter(|part| part.has_target || part.staged.parts[0]).collect();
    let size = parts.first().map_or(0, |part| dimension(part.staged));
    let kicked = parts.iter().filter(|part| part.staged.parts[1]);
    let derivatives: Option<Vec<_>> =
        kicked.map(|part| Some((part, part.staged.programs.kick_derivative.as_ref()?))).collect();
    let derivatives = derivatives.filter(|derivatives| !derivatives.is_empty());
    let of_lagrangian = |at: usize| {
        let programs = parts.iter().filter_map(|part| Some((part, &part.staged.programs.lagrangian.as_ref()?[at])));
        sum_of(programs, |(part, program), words| part.append(words, program))
    };
    let at_velocity = |at: usize| sum_of(parts, |part, words| std::mem::take(&mut part.at_velocity(words)[at]));
    let mut all = parts.iter().map(|part| part.staged);
    Stages {
        constants: constants.program(&of_terms),
        kick_before: stage(|programs| &programs.kick_before),
        newton_system: system(&solved, usize::MAX),
        newton_residual: system(&solved, size),
        kick_after: stage(|programs| &programs.kick_after),
        kick_derivative: derivatives
            .map(|derivatives| sum_of(derivatives, |(part, program), words| part.append(words, program))),
        momentum_jacobian: stage(|programs| &programs.momentum_jacobian),
        at_rest: stage(|programs| &programs.at_rest),
        at_velocity: all.clone().any(|staged| !staged.is_quadratic).then(|| [0, 1, 2].map(at_velocity)),
        lagrangian: all
            .any(|staged| staged.programs.lagrangian.is_some())
            .then(|| [0, 1, 2, 3, 4, 5].map(of_lagrangian)),
    }
}

/// The sum of several declarations.
pub(crate) fn summed(terms: &[&StagedDeclaration]) -> Result<StagedDeclaration, LateError> {
    let first = *terms.first().ok_or(LateError::Nothing)?;
    if let Some(other) = terms.iter().find(|staged| staged.factors != first.factors) {
        let names: Vec<&str> = other.factors.iter().map(|factor| factor.name.as_str()).collect();
        return Err(LateError::Group { declared: names.join(", ") });
    }
    if terms.iter().any(|staged| staged.role == Role::Hamiltonian) {
        return Err(LateError::Hamiltonian);
    }
    if terms.iter().any(|staged| staged.energy.is_some()) {
        return Err(LateError::Pace);
    }
    let with_target = terms.iter().position(|staged| staged.parts[0]).unwrap_or(0);
    let constants = |terms: &[&StagedDeclaration]| -> usize {
        terms.iter().map(|staged| staged.programs.constants.outputs.len()).sum()
    };
    let length = |carried: &Carried| carried.shape.0 * carried.shape.1;
    let (mut parts, mut parameters, mut carried) = (Vec::new(), Vec::<Parameter>::new(), Vec::<Carried>::new());
    for (at, &staged) in terms.iter().enumerate() {
        let alike = terms[..at].iter().filter(|other| other.name == staged.name).count();
        let name = if alike == 0 { staged.name.clone() } else { format!("{}{}", staged.name, alike + 1) };
        let before: usize = parameters.iter().map(|parameter| parameter.kind.len()).sum();
        parts.push(Part {
            staged,
            parameters: before,
            constants: constants(&terms[..at]),
            carried: carried.iter().map(length).sum(),
            has_target: at == with_target,
        });
        let fields = parameters.len();
        carried.extend(staged.carried.iter().map(|one| Carried { field: one.field.map(|at| fields + at), ..*one }));
        let named = |one: &Parameter| Parameter { name: format!("{name}.{}", one.name), kind: one.kind };
        parameters.extend(staged.parameters.iter().map(named));
    }
    let solved = || terms.iter().filter(|staged| staged.parts[0]);
    let in_all = |end: &usize| solved().all(|staged| staged.blocks.contains(end));
    let joined = |of: fn(&StagedDeclaration) -> &str, by: &str| {
        terms.iter().map(|staged| of(staged)).collect::<Vec<_>>().join(by)
    };
    let constraints = parts.iter().flat_map(|part| {
        let own = &part.staged.constraints.each;
        own.iter()
            .map(move |constraint| constraint.map(|program| sum_of([part], |part, words| part.append(words, program))))
    });
    Ok(constrained(StagedDeclaration {
        name: joined(|staged| &staged.name, " + "),
        role: terms.iter().map(|staged| staged.role).find(|&role| role == Role::Lagrangian).unwrap_or(first.role),
        factors: first.factors.clone(),
        derivation: joined(|staged| &staged.derivation, "\n"),
        has_kinetic: terms.iter().any(|staged| staged.has_kinetic),
        has_force: terms.iter().any(|staged| staged.has_force),
        parts: [0, 1, 2].map(|part| terms.iter().any(|staged| staged.parts[part])),
        denominators: solved().map(|staged| staged.denominators).max().unwrap_or(0),
        has_constant_inertia: terms.iter().all(|staged| staged.has_constant_inertia),
        is_quadratic: terms.iter().all(|staged| staged.is_quadratic),
        is_self_adjoint: terms.iter().all(|staged| staged.is_self_adjoint),
        in_increment: first.in_increment,
        energy: None,
        blocks: solved().next().map_or_else(Vec::new, |one| one.blocks.iter().copied().filter(in_all).collect()),
        constraints: Constraints { each: constraints.collect(), ..Constraints::default() },
        programs: programs(&parts),
        parameters,
        carried,
    }))
}
