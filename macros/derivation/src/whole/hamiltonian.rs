//! A step of a Hamiltonian `h(μ, w)` as programs, for any group with coordinates `F = τ(2y)`.
//!
//! The action `Σ h ⟨m, ξ⟩ − (h/2) (h(m, w) + h(m, F⁻¹·w))` with `hξ = τ⁻¹(F)` is varied by `m` and by the attitude:
//!
//! ```text
//! ξ = ½ (∂h/∂μ(m, w) + ∂h/∂μ(m, F⁻¹·w))      a = μ − (h/2) ∂h/∂w ⋄ w (m, w)      (dτ⁻¹_hξ)* m = a
//! μ⁺ = Ad*_F a − (h/2) ∂h/∂w ⋄ w (m, w⁺)     w⁺ = F⁻¹·w                          g⁺ = g F
//! ```
//!
//! No velocity needs to have a momentum, so that `∂²h/∂μ²` may be singular. The step is its own adjoint, of order two, and a
//! Poisson map, as it has a generating function. With the Hamiltonian of a Lagrangian `½ ξ·Jξ − V(w)` it is the step of
//! `trapezoid(Cayley)`. The equations are solved by fixed-point iteration in `y` and `m`.

use super::actions::change;
use super::factor::MatrixFactor;
use super::matrix::Matrix;
use super::tangent::{Dual, along};
use super::values::{Value, Words};
use super::writer::Writer;
use super::{MOST_OPERATIONS, StepRefusal};
use crate::staged::{Array, Program, Source, StagedDeclaration};

/// The programs of a Hamiltonian's step, or code for them. The momentum `m` within a step stands in the array of velocities.
#[derive(Clone, Debug, PartialEq)]
pub struct HamiltonianStep<P = Program> {
    /// The next half coordinates and `m`, of both, momentum, advected, parameters and the step; then the squares of the changes
    /// and of the results, of either.
    pub iterate: P,
    /// Attitude, momentum and advected after a step, of attitude and all of that.
    pub finish: P,
    /// The advected parameters, of attitude and parameters.
    pub seen: P,
    /// The velocity `∂h/∂μ`, of a momentum in the array of velocities, advected and parameters.
    pub velocity: P,
    /// The energy, J, of the same.
    pub energy: P,
    /// The momentum in space, of attitude and momentum.
    pub spatial: P,
    /// The sum of the factors' distances from their groups, of the attitude.
    pub defect: P,
}

impl HamiltonianStep {
    /// Writes the step of a Hamiltonian, with the factors of its group.
    ///
    /// # Errors
    ///
    /// The reason why there is none.
    pub fn of(staged: &StagedDeclaration) -> Result<(Self, Vec<MatrixFactor>), StepRefusal> {
        let writer = Writer::of(staged)?;
        let Some([h, velocity, _]) = &staged.programs.at_velocity else { return Err(StepRefusal::NoKinetic) };
        let diamond = writer.diamond(h);
        let programs = Self {
            iterate: writer.iterated(velocity, &diamond),
            finish: writer.finished(&diamond),
            seen: writer.seen(),
            velocity: velocity.clone(),
            energy: h.clone(),
            spatial: writer.spatial(),
            defect: writer.defect(),
        };
        let operations: usize = programs.all().iter().map(|program| program.operations.len()).sum();
        if operations > MOST_OPERATIONS {
            return Err(StepRefusal::TooLong { most: MOST_OPERATIONS });
        }
        Ok((programs, writer.factors))
    }
}

impl<P> HamiltonianStep<P> {
    /// All programs, in the order of the fields.
    pub const fn all(&self) -> [&P; 7] {
        let Self { iterate, finish, seen, velocity, energy, spatial, defect } = self;
        [iterate, finish, seen, velocity, energy, spatial, defect]
    }

    /// The programs in that order.
    pub fn from_all([iterate, finish, seen, velocity, energy, spatial, defect]: [P; 7]) -> Self {
        Self { iterate, finish, seen, velocity, energy, spatial, defect }
    }
}

impl Writer<'_> {
    /// `∂h/∂w ⋄ w`: the derivatives of `h` along `exp(−s E_k)·w`.
    fn diamond(&self, h: &Program) -> Program {
        let (mut words, mut all) = (Words::default(), Vec::new());
        for factor in &self.factors {
            for generator in &factor.basis.generators {
                let mut turned = vec![Value::ZERO; self.entries];
                for (entry, &number) in turned[factor.entry..].iter_mut().zip(generator) {
                    *entry = Value::of(number);
                }
                let advected = self.moved(&mut words, &turned);
                let read = |source: Source| -> Dual {
                    match source.array {
                        Array::Advected => advected[source.at],
                        _ => (Value::Input(source), Value::ZERO),
                    }
                };
                all.push(along(&mut words, h, &read)[0].1);
            }
        }
        words.program(&all)
    }

    /// The advected parameters after a step.
    fn moved_by(&self, words: &mut Words, d: &[Matrix]) -> Vec<Value> {
        let mut next = Vec::new();
        for (w, carried) in self.advected(Array::Advected).iter().zip(&self.staged.carried) {
            let moved = change(words, &self.factors, carried.action, w, d);
            next.extend(w.plus(words, &moved).entries);
        }
        next
    }

    fn iterated(&self, velocity: &Program, diamond: &Program) -> Program {
        let (mut words, n) = (Words::default(), self.dimension());
        let [half, m, momentum] = [Array::Half, Array::Velocity, Array::Momentum].map(|array| Value::inputs(array, n));
        let advected = Value::inputs(Array::Advected, self.carried);
        let d = self.increments(&mut words, &half);
        let next = self.moved_by(&mut words, &d);
        let before = at(&mut words, velocity, &advected);
        let after = at(&mut words, velocity, &next);
        let sum = words.added(&before, &after);
        // `y = hξ/2`, and `ξ` is half the sum.
        let half_step = half_step(&mut words);
        let quarter = words.multiply(half_step, Value::of(0.5));
        let made: Vec<Value> = sum.iter().map(|&entry| words.multiply(entry, quarter)).collect();
        let a = kicked(&mut words, diamond, &momentum, &advected);
        // The tangent by half the coordinates is twice that by the coordinates.
        let mut pulled = Vec::new();
        for factor in &self.factors {
            for column in factor.tangent(&mut words, factor.own(&made)) {
                let paired = words.dot(&column, factor.own(&a));
                pulled.push(words.multiply(paired, Value::of(0.5)));
            }
        }
        let mut all = [made.clone(), pulled.clone()].concat();
        for (new, old) in [(&made, &half), (&pulled, &m)] {
            let change = words.subtracted(new, old);
            all.extend([words.dot(&change, &change), words.dot(new, new)]);
        }
        words.program(&all)
    }

    fn finished(&self, diamond: &Program) -> Program {
        let (mut words, n) = (Words::default(), self.dimension());
        let [half, momentum] = [Array::Half, Array::Momentum].map(|array| Value::inputs(array, n));
        let d = self.increments(&mut words, &half);
        let next = self.moved_by(&mut words, &d);
        let a = kicked(&mut words, diamond, &momentum, &Value::inputs(Array::Advected, self.carried));
        let mut change = Vec::new();
        for (factor, d) in self.factors.iter().zip(&d) {
            change.extend(factor.coadjoint_change(&mut words, d, factor.own(&a)));
        }
        let moved = words.added(&a, &change);
        let momentum = kicked(&mut words, diamond, &moved, &next);
        let mut all = Vec::new();
        for (factor, d) in self.factors.iter().zip(&d) {
            let g = factor.read(Array::Attitude);
            all.extend(factor.advanced(&mut words, &g, d).entries);
        }
        words.program(&[all, momentum, next].concat())
    }
}

/// A program at these advected parameters.
fn at(words: &mut Words, program: &Program, advected: &[Value]) -> Vec<Value> {
    words.append(program, |source| match source.array {
        Array::Advected => advected[source.at],
        _ => Value::Input(source),
    })
}

/// `μ − (h/2) ∂h/∂w ⋄ w` at these advected parameters.
fn kicked(words: &mut Words, diamond: &Program, momentum: &[Value], advected: &[Value]) -> Vec<Value> {
    let diamond = at(words, diamond, advected);
    let half_step = half_step(words);
    let kick: Vec<Value> = diamond.iter().map(|&entry| words.multiply(entry, half_step)).collect();
    words.subtracted(momentum, &kick)
}

fn half_step(words: &mut Words) -> Value {
    words.multiply(Value::Input(Source::new(Array::Step, 0)), Value::of(0.5))
}
