//! Several declarations in one: programs that add what theirs compute.

use liestep_derivation::{Array, Carried, MOST_TERMS, Operation, Parameter, Program, Role, Source, Staged, Stages};

use crate::error::LateError;
use crate::specialised::{Fold, Value};

/// A term, and where its numbers begin among those of all.
struct Part<'a> {
    staged: &'a Staged,
    parameters: usize,
    constants: usize,
    carried: usize,
    terms: usize,
}

impl Part<'_> {
    fn moved(&self, source: Source) -> Value {
        let first = match source.array {
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

    /// The terms of a step; only one part has the right side, and zero is that of the others.
    fn terms(&self, fold: &mut Fold, has_target: bool) -> Vec<Value> {
        fold.append(&self.staged.programs.terms, |source| self.of_solve(source, has_target), Fold::kept)
    }

    fn of_solve(&self, source: Source, has_target: bool) -> Value {
        if source.array == Array::Target && !has_target { Value::of(0.0) } else { self.moved(source) }
    }

    /// Residual and Jacobian.
    fn system(&self, fold: &mut Fold, has_target: bool) -> Vec<Value> {
        let terms = self.terms(fold, has_target);
        let input = |source: Source| match source.array {
            // Beyond what is handed to the iterations they are computed anew.
            Array::Terms if self.terms + source.at < MOST_TERMS => {
                Value::Input(Source::new(Array::Terms, self.terms + source.at))
            }
            Array::Terms => terms[source.at],
            _ => self.of_solve(source, has_target),
        };
        fold.append(&self.staged.programs.newton_system, input, Fold::kept)
    }

    /// `l`, momentum and Hessian at a velocity: those of `½ ξ·Jξ + s·ξ − V` where it is quadratic.
    fn at_velocity(&self, fold: &mut Fold) -> [Vec<Value>; 3] {
        if let Some(programs) = &self.staged.programs.at_velocity {
            return programs.each_ref().map(|program| self.append(fold, program));
        }
        let at_rest = self.append(fold, &self.staged.programs.at_rest);
        let size = dimension(self.staged);
        let velocity: Vec<Value> = (0..size).map(|at| Value::Input(Source::new(Array::Velocity, at))).collect();
        let (hessian, rest) = at_rest.split_at(size * size);
        let image: Vec<Value> = hessian.chunks(size).map(|row| dot(fold, row, &velocity)).collect();
        let (square, linear) = (dot(fold, &velocity, &image), dot(fold, &rest[..size], &velocity));
        let kinetic = fold.multiply(square, Value::of(0.5));
        let sum = fold.add(kinetic, linear);
        let l = fold.subtract(sum, rest[size]);
        [vec![l], added(fold, image, &rest[..size]), hessian.to_vec()]
    }
}

/// Components of covectors.
fn dimension(staged: &Staged) -> usize {
    staged.programs.kick_before.outputs.len()
}

fn dot(fold: &mut Fold, a: &[Value], b: &[Value]) -> Value {
    a.iter().zip(b).fold(Value::of(0.0), |sum, (&a, &b)| {
        let product = fold.multiply(a, b);
        fold.add(sum, product)
    })
}

fn added(fold: &mut Fold, a: Vec<Value>, b: &[Value]) -> Vec<Value> {
    a.into_iter().zip(b).map(|(a, &b)| fold.kept(Operation::Add(0, 0), [a, b])).collect()
}

/// Residual and Jacobian, multiplied by this power of `1 + |y|²`, as `Coordinates::raised` does it.
fn raised(fold: &mut Fold, system: Vec<Value>, size: usize, power: u32) -> Vec<Value> {
    if power == 0 {
        return system;
    }
    let (residual, jacobian) = system.split_at(size);
    let half: Vec<Value> = (0..size).map(|at| Value::Input(Source::new(Array::Half, at))).collect();
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

/// What the parts compute, added.
fn sum_of<P>(parts: &[P], mut of: impl FnMut(&P, &mut Fold) -> Vec<Value>) -> Program {
    let mut fold = Fold::default();
    let mut sum: Option<Vec<Value>> = None;
    for part in parts {
        let one = of(part, &mut fold);
        sum = Some(match sum {
            Some(sum) => added(&mut fold, sum, &one),
            None => one,
        });
    }
    fold.program(&sum.unwrap_or_default())
}

/// One behind the other.
fn beside(parts: &[Part<'_>], mut of: impl FnMut(usize, &Part<'_>, &mut Fold) -> Vec<Value>) -> Program {
    let mut fold = Fold::default();
    let all: Vec<Value> = parts.iter().enumerate().flat_map(|(at, part)| of(at, part, &mut fold)).collect();
    fold.program(&all)
}

fn programs(parts: &[Part<'_>]) -> Stages<Program> {
    let stage = |program: fn(&Stages<Program>) -> &Program| {
        sum_of(parts, |part, fold| part.append(fold, program(&part.staged.programs)))
    };
    // Of kinetic parts, rotors and forces: each has the unknown in it. The first has the right side.
    let first = parts.iter().position(|part| part.staged.parts[0]).unwrap_or(0);
    let is_solved = |at: usize| at == first || parts[at].staged.parts[0];
    let solved: Vec<(usize, &Part<'_>)> = parts.iter().enumerate().filter(|(at, _)| is_solved(*at)).collect();
    let system = |is_whole: bool| {
        let (mut fold, mut sum, mut power) = (Fold::default(), Vec::new(), 0);
        for (at, part) in &solved {
            let (size, own) = (dimension(part.staged), part.staged.denominators);
            let one = part.system(&mut fold, *at == first);
            let both = power.max(own);
            let one = raised(&mut fold, one, size, both - own);
            // What is added up so far is multiplied as one.
            sum = if *at == first {
                one
            } else {
                let before = raised(&mut fold, sum, size, both - power);
                added(&mut fold, before, &one)
            };
            power = both;
        }
        sum.truncate(if is_whole { sum.len() } else { dimension(parts[first].staged) });
        fold.program(&sum)
    };
    let kicked: Vec<&Part<'_>> = parts.iter().filter(|part| part.staged.parts[1]).collect();
    let derivatives = kicked.iter().map(|part| Some((*part, part.staged.programs.kick_derivative.as_ref()?)));
    let derivatives: Option<Vec<_>> = derivatives.collect();
    let of_lagrangian: Vec<(&Part<'_>, &[Program; 6])> =
        parts.iter().filter_map(|part| Some((part, part.staged.programs.lagrangian.as_ref()?))).collect();
    let of_one =
        |(part, programs): &(&Part<'_>, &[Program; 6]), fold: &mut Fold, at: usize| part.append(fold, &programs[at]);
    let is_nonlinear = parts.iter().any(|part| !part.staged.is_quadratic);
    let at_velocity = |at: usize| sum_of(parts, |part, fold| std::mem::take(&mut part.at_velocity(fold)[at]));
    Stages {
        constants: beside(parts, |_, part, fold| part.append(fold, &part.staged.programs.constants)),
        terms: {
            let mut terms =
                beside(parts, |at, part, fold| if is_solved(at) { part.terms(fold, at == first) } else { Vec::new() });
            terms.outputs.truncate(MOST_TERMS);
            terms
        },
        kick_before: stage(|programs| &programs.kick_before),
        newton_system: system(true),
        newton_residual: system(false),
        kick_after: stage(|programs| &programs.kick_after),
        kick_derivative: derivatives
            .filter(|derivatives| !derivatives.is_empty())
            .map(|derivatives| sum_of(&derivatives, |(part, program), fold| part.append(fold, program))),
        momentum_jacobian: stage(|programs| &programs.momentum_jacobian),
        at_rest: stage(|programs| &programs.at_rest),
        at_velocity: is_nonlinear.then(|| [0, 1, 2].map(at_velocity)),
        lagrangian: (!of_lagrangian.is_empty())
            .then(|| [0, 1, 2, 3, 4, 5].map(|at| sum_of(&of_lagrangian, |one, fold| of_one(one, fold, at)))),
    }
}

/// The sum of several.
pub(crate) fn summed(terms: &[&Staged]) -> Result<Staged, LateError> {
    let (mut parts, mut names): (Vec<Part<'_>>, Vec<String>) = (Vec::new(), Vec::new());
    let (mut parameters, mut carried) = (Vec::<Parameter>::new(), Vec::<Carried>::new());
    for &staged in terms {
        let alike = names.iter().filter(|name| **name == staged.name).count();
        let name = if alike == 0 { staged.name.clone() } else { format!("{}{}", staged.name, alike + 1) };
        let of_solve =
            |part: &Part<'_>| if part.staged.parts[0] { part.staged.programs.terms.outputs.len() } else { 0 };
        let of_constants = |part: &Part<'_>| part.staged.programs.constants.outputs.len();
        parts.push(Part {
            staged,
            parameters: parameters.iter().map(|parameter| parameter.kind.len()).sum(),
            constants: parts.iter().map(of_constants).sum(),
            carried: carried.iter().map(|carried| carried.shape.0 * carried.shape.1).sum(),
            terms: parts.iter().map(of_solve).sum(),
        });
        let first = parameters.len();
        carried
            .extend(staged.carried.iter().map(|one| Carried { field: one.field.map(|field| first + field), ..*one }));
        let named = |one: &Parameter| Parameter { name: format!("{name}.{}", one.name), kind: one.kind };
        parameters.extend(staged.parameters.iter().map(named));
        names.push(staged.name.clone());
    }
    let first = parts.first().ok_or(LateError::Nothing)?.staged;
    if let Some(other) = parts.iter().find(|part| part.staged.factors != first.factors) {
        let names: Vec<&str> = other.staged.factors.iter().map(|factor| factor.name.as_str()).collect();
        return Err(LateError::Group { declared: names.join(", ") });
    }
    let all = || parts.iter().map(|part| part.staged);
    let solved = || all().filter(|staged| staged.parts[0]);
    let derivations: Vec<&str> = all().map(|staged| staged.derivation.as_str()).collect();
    let in_all = |end: &usize| solved().all(|staged| staged.blocks.contains(end));
    Ok(Staged {
        name: names.join(" + "),
        role: all().map(|staged| staged.role).find(|&role| role == Role::Lagrangian).unwrap_or(first.role),
        factors: first.factors.clone(),
        derivation: derivations.join("\n"),
        has_kinetic: all().any(|staged| staged.has_kinetic),
        is_expensive: false,
        parts: [0, 1, 2].map(|part| all().any(|staged| staged.parts[part])),
        denominators: solved().map(|staged| staged.denominators).max().unwrap_or(0),
        has_constant_inertia: all().all(|staged| staged.has_constant_inertia),
        is_quadratic: all().all(|staged| staged.is_quadratic),
        is_self_adjoint: all().all(|staged| staged.is_self_adjoint),
        in_increment: first.in_increment,
        blocks: solved().next().map_or_else(Vec::new, |one| one.blocks.iter().copied().filter(in_all).collect()),
        programs: programs(&parts),
        parameters,
        carried,
    })
}
