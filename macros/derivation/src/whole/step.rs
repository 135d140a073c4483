//! The programs of a whole step.

use super::actions::{at_attitude, change};
use super::basis::Form;
use super::certified::{self, Subject};
use super::factor::MatrixFactor;
use super::limit::Limit;
use super::matrix::Matrix;
use super::solved::Factorisation;
use super::values::{Value, Words};
use super::writer::Writer;
use super::{MOST_OPERATIONS, StepRefusal};
use crate::declared::Role;
use crate::staged::{Array, Program, Source, StagedDeclaration};

/// The sizes of a state's parts, and their places: attitude, momentum, advected parameters, half the coordinates of the last
/// increment and their difference to those before, a guess of the next, and the number of steps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// The number of components of a momentum.
    pub n: usize,
    /// The number of entries of an attitude.
    pub entries: usize,
    /// The number of advected and given numbers.
    pub carried: usize,
    /// The number of blocks of the Newton system with a determinant of their own.
    pub dets: usize,
    /// The number of factors whose increments may be far from the identity.
    pub near: usize,
    /// The number of factors that [`Programs::restored`] restores.
    pub attitudes: usize,
}

impl Sizes {
    /// The place of the momentum.
    #[must_use]
    pub const fn momentum(&self) -> usize {
        self.entries
    }

    /// The place of the advected parameters.
    #[must_use]
    pub const fn advected(&self) -> usize {
        self.entries + self.n
    }

    /// The place of half the coordinates of the last increment, and of their difference.
    #[must_use]
    pub const fn history(&self) -> usize {
        self.advected() + self.carried
    }

    /// The place of the guess.
    #[must_use]
    pub const fn guess(&self) -> usize {
        self.history() + 2 * self.n
    }

    /// The number of numbers of a state.
    #[must_use]
    pub const fn state(&self) -> usize {
        self.guess() + self.n + 1
    }
}

/// The programs of a step, or code for them. Each names its inputs; all but the first may read the constants.
#[derive(Clone, Debug, PartialEq)]
pub struct Programs<P = Program> {
    /// The constants, of parameters and step.
    pub constants: P,
    /// The target `a` of the momentum equation (2.7), and `a·a`, of momentum and advected.
    pub target: P,
    /// A Newton iteration, of half, target and advected: the next half, the squares of the update and of the next half, then
    /// for each block of the Jacobian its determinant and the product of its diagonal, and its factors.
    pub iterate: P,
    /// An iteration by the old Jacobian, of half, target, advected, and factors with the determinants before them: the next
    /// half, and both squares.
    pub again: P,
    /// The state after the step, without the number of steps, of half, target, momentum, advected, attitude and history; then
    /// the sum of momentum and advected, and for each factor whose increment may be far from the identity a number, whose product with the square
    /// of `s` is below one if `s` times the increment is near it.
    pub finish: P,
    /// The Newton system for a solve with care, of half, target and advected: the residual, the Jacobian row by row, the update, and the
    /// determinant and the product of the diagonal of each block.
    pub newton: P,
    /// The branch of a solution, of half, step, parameters and advected: the last numbers of [`finish`](Self::finish); then of `h` times the Jacobian
    /// of the momentum along `exp(t E_j) F` the determinant and the product of the diagonal of each block, and the trace of
    /// each factor's part.
    pub branch: P,
    /// Determinants and diagonals of the inertia where it varies, of parameters and advected.
    pub safe: Option<P>,
    /// The covectors `A(w)` of the reactions of constraints on velocities, of advected parameters and constants; then the
    /// squares of their parts across those before.
    pub reactions: Option<P>,
    /// The advected parameters, of attitude and parameters.
    pub seen: P,
    /// The distance from the group and a nearer matrix, of the attitude, for each factor that
    /// [is restored](MatrixFactor::is_restored).
    pub restored: P,
    /// The sum of the factors' distances from their groups, of the attitude.
    pub defect: P,
    /// The inertia at rest, row by row, of parameters and advected.
    pub inertia: P,
    /// The velocity by the inertia at rest, of momentum, parameters and advected; an estimate where the continuous limit isn't
    /// quadratic.
    pub velocity: P,
    /// The momentum, of velocity, parameters and advected.
    pub momentum: P,
    /// The derivative of the momentum by the velocity, of velocity, parameters and advected, where the continuous limit isn't
    /// quadratic.
    pub hessian: Option<P>,
    /// The energy, J, of velocity, parameters and advected.
    pub energy: P,
    /// The momentum in space, of attitude and momentum.
    pub spatial: P,
    /// The trace of the Jacobian at rest, then its determinants and diagonals, of advected and parameters.
    pub rest: P,
}

impl<P> Programs<P> {
    /// Maps all programs; those of a usual step come first.
    ///
    /// # Errors
    ///
    /// The first error of the map.
    pub fn try_map<'a, Q, E>(&'a self, mut make: impl FnMut(&'a P) -> Result<Q, E>) -> Result<Programs<Q>, E> {
        Ok(Programs {
            target: make(&self.target)?,
            iterate: make(&self.iterate)?,
            again: make(&self.again)?,
            finish: make(&self.finish)?,
            safe: self.safe.as_ref().map(&mut make).transpose()?,
            reactions: self.reactions.as_ref().map(&mut make).transpose()?,
            constants: make(&self.constants)?,
            newton: make(&self.newton)?,
            branch: make(&self.branch)?,
            seen: make(&self.seen)?,
            restored: make(&self.restored)?,
            defect: make(&self.defect)?,
            inertia: make(&self.inertia)?,
            velocity: make(&self.velocity)?,
            momentum: make(&self.momentum)?,
            hessian: self.hessian.as_ref().map(&mut make).transpose()?,
            energy: make(&self.energy)?,
            spatial: make(&self.spatial)?,
            rest: make(&self.rest)?,
        })
    }
}

impl Programs {
    /// The operations of all programs.
    fn operations(&self) -> usize {
        let all = [&self.target, &self.iterate, &self.again, &self.finish, &self.seen, &self.restored];
        all.iter().map(|program| program.operations.len()).sum()
    }
}

/// A step of a declaration as programs.
#[derive(Clone, Debug)]
pub struct WholeStep {
    /// The sizes of a state's parts.
    pub sizes: Sizes,
    /// The factors of the group.
    pub factors: Vec<MatrixFactor>,
    /// The programs.
    pub programs: Programs,
}

impl WholeStep {
    /// Writes the step of a declaration.
    ///
    /// # Errors
    ///
    /// The reason why there is none.
    pub fn of(staged: &StagedDeclaration) -> Result<Self, StepRefusal> {
        if staged.role == Role::Hamiltonian {
            return Err(StepRefusal::Hamiltonian);
        }
        if !staged.has_kinetic {
            return Err(StepRefusal::NoKinetic);
        }
        let dimension: usize = staged.factors.iter().map(|factor| factor.generators.len()).sum();
        let constraints = staged.constraints.each.len();
        if constraints >= dimension {
            return Err(StepRefusal::Fixed { constraints, dimension });
        }
        if constraints > 0 && !staged.is_quadratic {
            return Err(StepRefusal::NotQuadraticVelocity);
        }
        let too_long = StepRefusal::TooLong { most: MOST_OPERATIONS };
        // An elimination has `n³/3` products alone.
        if dimension.pow(3) / 3 > MOST_OPERATIONS {
            return Err(too_long);
        }
        let writer = Writer::of(staged)?;
        let programs = writer.programs();
        if programs.operations() > MOST_OPERATIONS {
            return Err(too_long);
        }
        let Programs { iterate, finish, seen, spatial, defect, .. } = &programs;
        if let Some(claim) = certified::mistake(&writer, &Subject { iterate, finish, seen, spatial, defect }) {
            return Err(StepRefusal::Wrong { claim });
        }
        let count = |is_one: fn(&MatrixFactor) -> bool| writer.factors.iter().filter(|factor| is_one(factor)).count();
        let (n, numbers) = (writer.dimension(), programs.iterate.outputs.len());
        let sizes = Sizes {
            n,
            entries: writer.entries,
            carried: writer.carried,
            dets: (numbers - n * n - n - 2) / 2,
            near: count(|factor| factor.form != Form::Translation),
            attitudes: count(MatrixFactor::is_restored),
        };
        Ok(Self { sizes, factors: writer.factors, programs })
    }

    /// Writes the changes of attitude, momentum and advected parameters that the program `finish` adds to them, of its inputs.
    /// Advected parameters after the step, which a force may see, have the rounding errors in the array of factors added to
    /// their change.
    ///
    /// # Errors
    ///
    /// The reason why there is no step.
    pub fn changes(staged: &StagedDeclaration) -> Result<Program, StepRefusal> {
        Ok(Writer::of(staged)?.changes())
    }

    /// Writes the tangent map of a step along one direction: `(ζ⁺, δμ⁺)` after the step, of half, momentum, advected and
    /// constants, for a displacement `ζ` in the array of velocities and a change `δμ` in that of histories.
    ///
    /// # Errors
    ///
    /// The reason why there is no step.
    pub fn tangent(staged: &StagedDeclaration) -> Result<Program, StepRefusal> {
        let Self { programs, .. } = Self::of(staged)?;
        Ok(Writer::of(staged)?.tangent(&programs.target, &programs.finish, false))
    }

    /// Writes two derivatives of a step by state and constants, whose advected parameters have changes of their own. The
    /// first is the tangent map along one direction, `(ζ⁺, δμ⁺, δw⁺)`, as [`tangent`](Self::tangent), with `δw` in the array
    /// of next advected values and `δc` in that of factors. The second is its transpose: the derivatives of a scalar by `ζ`,
    /// `μ`, `w` and `c` before the step, of those by `ζ⁺` in the array of velocities, by `μ⁺` in that of histories and by
    /// `w⁺` in that of next advected values.
    ///
    /// # Errors
    ///
    /// The reason why there is no step.
    pub fn derivatives(&self, staged: &StagedDeclaration) -> Result<[Program; 2], StepRefusal> {
        let (writer, Programs { target, finish, .. }) = (Writer::of(staged)?, &self.programs);
        Ok([writer.tangent(target, finish, true), writer.backwards(target, finish)])
    }
}

impl Writer<'_> {
    fn programs(&self) -> Programs {
        let Limit { inertia, safe, velocity, momentum, hessian, energy } = self.limit();
        let [iterate, newton] = self.iterate_and_newton();
        Programs {
            constants: self.staged.programs.constants.clone(),
            target: self.target(),
            iterate,
            again: self.again(),
            finish: self.finish(),
            newton,
            branch: self.branch(),
            // The determinants of an inertia bound no Jacobian with constraints.
            safe: (!self.staged.has_constant_inertia && !self.is_constrained()).then_some(safe),
            reactions: self.reactions(),
            seen: self.seen(),
            restored: self.restored(),
            defect: self.defect(),
            inertia,
            velocity,
            momentum,
            hessian,
            energy,
            spatial: self.spatial(),
            rest: self.rest(),
        }
    }

    fn target(&self) -> Program {
        let mut words = Words::default();
        let mut target = Value::inputs(Array::Momentum, self.dimension());
        if self.staged.parts[1] {
            let kick = words.append(&self.staged.programs.kick_before, Value::Input);
            target = words.added(&target, &kick);
        }
        target.push(words.dot(&target, &target));
        words.program(&target)
    }

    /// Programs of a Newton iteration: the usual one, and the system for a solve with care.
    fn iterate_and_newton(&self) -> [Program; 2] {
        let (mut words, half) = (Words::default(), Value::inputs(Array::Half, self.dimension()));
        let (residual, jacobian) = self.system(&mut words, &half, &Value::Input);
        let Factorisation { factors, determinants } = self.pattern.factorise(&mut words, &jacobian);
        let update = self.pattern.solve(&mut words, &factors, determinants[0][0], &residual);
        let determinants = determinants.as_flattened();
        let newton = words.program(&[residual.as_slice(), &jacobian.entries, &update, determinants].concat());
        let next = updated(&mut words, &half, &update);
        [words.program(&[next.as_slice(), determinants, &factors].concat()), newton]
    }

    fn branch(&self) -> Program {
        let (mut words, n) = (Words::default(), self.dimension());
        let half = Value::inputs(Array::Half, n);
        let (mut all, d) = (self.nearness(&mut words, &half), self.increments(&mut words, &half));
        let factors = self.factors.iter().zip(&d);
        let elements: Vec<Value> = factors.flat_map(|(factor, d)| factor.element(&mut words, d).entries).collect();
        let read = |source: Source| match source.array {
            Array::Element => elements[source.at],
            _ => Value::Input(source),
        };
        let jacobian = self.with_increments(&mut words, &self.staged.programs.momentum_jacobian, &d, &read);
        let step = Value::Input(Source::new(Array::Step, 0));
        let jacobian = Matrix { rows: n, columns: n, entries: jacobian }.scaled(&mut words, step);
        let jacobian = self.branch_with_constraints(&mut words, &d, &jacobian);
        let determinants = self.pattern.factorise(&mut words, &jacobian).determinants;
        all.extend(determinants.as_flattened());
        for factor in &self.factors {
            let own = factor.component..factor.component + factor.dimension();
            all.push(own.fold(Value::ZERO, |sum, k| words.add(sum, jacobian.at(k, k))));
        }
        words.program(&all)
    }

    fn again(&self) -> Program {
        let (mut words, n) = (Words::default(), self.dimension());
        let half = Value::inputs(Array::Half, n);
        let residual = self.residual(&mut words, &half);
        let before = 2 * self.pattern.determinants();
        let factors = Value::inputs(Array::Factors, before + n * n);
        let update = self.pattern.solve(&mut words, &factors[before..], factors[0], &residual);
        let next = updated(&mut words, &half, &update);
        words.program(&next)
    }

    fn finish(&self) -> Program {
        let (mut words, n) = (Words::default(), self.dimension());
        let half = Value::inputs(Array::Half, n);
        let d = self.increments(&mut words, &half);
        let mut next = Vec::new();
        for (w, carried) in self.advected(Array::Advected).iter().zip(&self.staged.carried) {
            let moved = change(&mut words, &self.factors, carried.action, w, &d);
            next.extend(w.plus(&mut words, &moved).entries);
        }
        let momentum = self.transported(&mut words, &d, &next);
        let sum = momentum.iter().chain(&next).fold(Value::ZERO, |sum, &entry| words.add(sum, entry));
        let mut attitude = Vec::new();
        for (factor, d) in self.factors.iter().zip(&d) {
            let g = factor.read(Array::Attitude);
            attitude.extend(factor.advanced(&mut words, &g, d).entries);
        }
        let history = Value::inputs(Array::History, 2 * n);
        let differences = words.subtracted(&half, &history[..n]);
        let second = words.subtracted(&differences, &history[n..]);
        let both = words.added(&differences, &second);
        let guess = words.added(&half, &both);
        let near = self.nearness(&mut words, &half);
        words.program(&[attitude, momentum, next, half, differences, guess, vec![sum], near].concat())
    }

    fn nearness(&self, words: &mut Words, half: &[Value]) -> Vec<Value> {
        self.factors.iter().filter_map(|factor| factor.nearness(words, factor.own(half))).collect()
    }

    /// The changes have no rounding of the momentum's size: the kick before the solve is taken for itself, not as `a − μ`.
    fn changes(&self) -> Program {
        let (mut words, half) = (Words::default(), Value::inputs(Array::Half, self.dimension()));
        let d = self.increments(&mut words, &half);
        let errors = Value::inputs(Array::Factors, self.carried);
        let mut moved = Vec::new();
        for (w, carried) in self.advected(Array::Advected).iter().zip(&self.staged.carried) {
            moved.extend(change(&mut words, &self.factors, carried.action, w, &d).entries);
        }
        let corrected = words.added(&moved, &errors);
        let next = words.added(&Value::inputs(Array::Advected, self.carried), &corrected);
        let before = self.staged.parts[1].then(|| words.append(&self.staged.programs.kick_before, Value::Input));
        let kicks = match (before, self.kick_after(&mut words, &d, &next)) {
            (Some(before), Some(after)) => Some(words.added(&before, &after)),
            (before, after) => before.or(after),
        };
        let mut momentum = self.turned(&mut words, &d, &Value::inputs(Array::Target, self.dimension()));
        if let Some(kicks) = kicks {
            momentum = words.added(&momentum, &kicks);
        }
        let mut all = Vec::new();
        for (factor, d) in self.factors.iter().zip(&d) {
            let g = factor.read(Array::Attitude);
            all.extend(factor.change(&mut words, &g, d).entries);
        }
        words.program(&[all, momentum, moved].concat())
    }

    /// The momentum after the step: `μ + (Ad*_F a − a) + (a − μ)` and the kick after the solve.
    fn transported(&self, words: &mut Words, d: &[Matrix], next: &[Value]) -> Vec<Value> {
        let n = self.dimension();
        let (momentum, target) = (Value::inputs(Array::Momentum, n), Value::inputs(Array::Target, n));
        let target = self.reacted(words, &Value::inputs(Array::Half, n), &target);
        let mut moved = self.turned(words, d, &target);
        if self.staged.parts[1] || self.is_constrained() {
            let kick = words.subtracted(&target, &momentum);
            moved = words.added(&moved, &kick);
        }
        if let Some(kick) = self.kick_after(words, d, next) {
            moved = words.added(&moved, &kick);
        }
        let momentum = words.added(&momentum, &moved);
        self.projected(words, &momentum, next)
    }

    /// `Ad*_F a − a`.
    fn turned(&self, words: &mut Words, d: &[Matrix], target: &[Value]) -> Vec<Value> {
        let factors = self.factors.iter().zip(d);
        factors.flat_map(|(factor, d)| factor.coadjoint_change(words, d, factor.own(target))).collect()
    }

    /// The kick after the solve, if there is one.
    fn kick_after(&self, words: &mut Words, d: &[Matrix], next: &[Value]) -> Option<Vec<Value>> {
        let read = |source: Source| match source.array {
            Array::Next => next[source.at],
            _ => Value::Input(source),
        };
        let program = &self.staged.programs.kick_after;
        self.staged.parts[2].then(|| self.with_increments(words, program, d, &read))
    }

    fn attitudes(&self) -> Vec<Matrix> {
        self.factors.iter().map(|factor| factor.read(Array::Attitude)).collect()
    }

    pub(super) fn seen(&self) -> Program {
        let (mut words, g, mut all) = (Words::default(), self.attitudes(), Vec::new());
        for (at, one) in self.staged.carried.iter().enumerate() {
            let inverse = &|words: &mut Words, k: usize| self.factors[k].inverse(words, &g[k]);
            all.extend(at_attitude(&mut words, one.action, &self.in_space(at), &g, inverse).entries);
        }
        words.program(&all)
    }

    fn restored(&self) -> Program {
        let mut words = Words::default();
        let all = self.factors.iter().zip(self.attitudes());
        let all: Vec<Value> = all.filter_map(|(factor, g)| factor.restored(&mut words, &g)).flatten().collect();
        words.program(&all)
    }

    pub(super) fn defect(&self) -> Program {
        let mut words = Words::default();
        let sum = self.factors.iter().fold(Value::ZERO, |sum, factor| {
            let defect = factor.defect(&mut words, &factor.read_all(Array::Attitude));
            words.add(sum, defect)
        });
        words.program(&[sum])
    }

    pub(super) fn spatial(&self) -> Program {
        let (mut words, mut all) = (Words::default(), Vec::new());
        let momentum = Value::inputs(Array::Momentum, self.dimension());
        for (factor, g) in self.factors.iter().zip(self.attitudes()) {
            all.extend(factor.in_space(&mut words, &g, factor.own(&momentum)));
        }
        words.program(&all)
    }

    fn rest(&self) -> Program {
        let (mut words, n) = (Words::default(), self.dimension());
        let read = |source: Source| match source.array {
            Array::Half | Array::Target => Value::ZERO,
            _ => Value::Input(source),
        };
        let (_, jacobian) = self.system(&mut words, &vec![Value::ZERO; n], &read);
        let determinants = self.pattern.factorise(&mut words, &jacobian).determinants;
        let trace = (0..n).fold(Value::ZERO, |sum, k| words.add(sum, jacobian.at(k, k)));
        words.program(&[&[trace], determinants.as_flattened()].concat())
    }
}

/// Half the coordinates less their update, and the squares of update and result.
fn updated(words: &mut Words, half: &[Value], update: &[Value]) -> Vec<Value> {
    let mut next = words.subtracted(half, update);
    let squares = [words.dot(update, update), words.dot(&next, &next)];
    next.extend(squares);
    next
}
