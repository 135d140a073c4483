//! Constraints on velocities in a step: the discrete Lagrange–d'Alembert equations.
//!
//! ```text
//! U(F, w) = a + Σ λ_k A_k(w)      c_k(F, w) = 0      μ⁺ = Ad*_F U(F, w) + k₁⁺ + Σ ν_k A_k(w⁺)
//! ```
//!
//! The multipliers `λ` need no unknowns of their own. With vectors `p_k` at right angles to each other that span the `A_k`,
//! and any scale `s`, both equations hold where
//!
//! ```text
//! r − Σ p_k (p_k·r)/(p_k·p_k) + Σ p_k s h c'_k/(p_k·p_k) = 0,      r = U − a
//! ```
//!
//! because its part along the `p_k` is the second sum, and the part across them the equation of motion. `c'_k` combines the
//! constraints as `p_k` does the `A_k`. With the trace of the inertia for `s` the symmetric part of the Jacobian at rest is
//! positive definite, so that eliminations need no pivots. The reaction `λ`
//! before a step is as large as it needs be; `ν` takes the momentum to velocities that satisfy the constraints, so that it is
//! that at the time, and changes no position: the next `λ` takes it up.

use super::matrix::Matrix;
use super::solved::Pattern;
use super::values::{Value, Words};
use super::writer::Writer;
use crate::staged::{Array, Constants, Program, Source, StagedDeclaration};

/// A covector of a reaction, and its part across those before.
struct Normal {
    own: Vec<Value>,
    across: Vec<Value>,
    /// The square of the part across.
    square: Value,
    /// The shares, negated, of the parts before in the covector.
    shares: Vec<Value>,
}

impl Normal {
    /// The constraint combined with those before, as the part across is.
    fn combined(&self, words: &mut Words, mut of_own: Vec<Value>, before: &[Vec<Value>]) -> Vec<Value> {
        for (&share, before) in self.shares.iter().zip(before) {
            of_own = plus(words, &of_own, share, before);
        }
        of_own
    }

    /// Adds to a Jacobian the row of the constraint, in the place of that along the normal.
    fn border(&self, words: &mut Words, jacobian: &Matrix, (scale, slope): (Value, &[Value]), rows: &mut Matrix) {
        let mut row = |k: usize, slope: Value| {
            let (moved, gap) = (words.dot(&jacobian.column(k), &self.across), words.multiply(scale, slope));
            let both = words.subtract(gap, moved);
            words.divide(both, self.square)
        };
        let row: Vec<Value> = slope.iter().enumerate().map(|(k, &slope)| row(k, slope)).collect();
        *rows = Matrix::of(jacobian.rows, jacobian.columns, |i, j| {
            let product = words.multiply(self.across[i], row[j]);
            words.add(rows.at(i, j), product)
        });
    }
}

/// Makes a sum with constraints a declaration that has a step: what they need at each iteration is among the constants.
#[must_use]
pub fn constrained(mut staged: StagedDeclaration) -> StagedDeclaration {
    if staged.constraints.each.is_empty() {
        return staged;
    }
    let n = staged.programs.kick_before.outputs.len();
    let mut words = Words::default();
    let mut all = words.append(&staged.programs.constants, Value::Input);
    staged.constraints.scale = all.len();
    // The scale is the trace of the inertia at the identity.
    let in_space = staged.in_space();
    let at_rest = words.append(&staged.programs.at_rest, |source| match source.array {
        Array::Advected => in_space[source.at],
        _ => Value::Input(source),
    });
    let trace = (0..n).fold(Value::ZERO, |sum, k| words.add(sum, at_rest[k * n + k]));
    let step = Value::Input(Source::new(Array::Step, 0));
    all.extend([trace, words.divide(Value::of(2.0), step)]);
    let (mut constants, mut at_rest) = (Constants(words.program(&all)), staged.programs.at_rest.clone());
    constants.fold(&mut at_rest);
    staged.programs.constants = constants.0;
    staged.constraints.at_rest = Some(at_rest);
    // Reactions couple all factors.
    staged.blocks.clear();
    staged
}

impl StagedDeclaration {
    /// The values in space of what is advected; of a configuration the identity.
    fn in_space(&self) -> Vec<Value> {
        let of_one = |one: &crate::staged::Carried| {
            let (rows, columns) = one.shape;
            let Some(field) = one.field else { return Matrix::identity(rows).entries };
            let first: usize = self.parameters[..field].iter().map(|parameter| parameter.kind.len()).sum();
            (first..first + rows * columns).map(|at| Value::Input(Source::new(Array::Parameters, at))).collect()
        };
        self.carried.iter().flat_map(of_one).collect()
    }
}

impl Writer<'_> {
    /// Whether there are constraints on velocities.
    pub(super) fn is_constrained(&self) -> bool {
        !self.staged.constraints.each.is_empty()
    }

    /// The covectors of the reactions at these advected parameters, each with its part across those before.
    fn normals(&self, words: &mut Words, advected: &dyn Fn(usize) -> Value) -> Vec<Normal> {
        let mut all: Vec<Normal> = Vec::new();
        for constraint in &self.staged.constraints.each {
            let own = words.append(&constraint.reaction, |source| match source.array {
                Array::Advected => advected(source.at),
                _ => Value::Input(source),
            });
            let (mut across, mut shares) = (own.clone(), Vec::new());
            for before in &all {
                let along = words.dot(&across, &before.across);
                let share = words.divide(along, before.square);
                let share = words.negate(share);
                across = plus(words, &across, share, &before.across);
                shares.push(share);
            }
            let square = words.dot(&across, &across);
            all.push(Normal { own, across, square, shares });
        }
        all
    }

    /// The Newton system with the constraints.
    pub(super) fn with_constraints(
        &self,
        words: &mut Words,
        half: &[Value],
        (residual, jacobian): (Vec<Value>, Option<Matrix>),
        other: &dyn Fn(Source) -> Value,
    ) -> (Vec<Value>, Option<Matrix>) {
        if !self.is_constrained() {
            return (residual, jacobian);
        }
        let d = self.increments(words, half);
        let scale = Value::Input(Source::new(Array::Constants, self.staged.constraints.scale));
        let normals = self.normals(words, &|at| other(Source::new(Array::Advected, at)));
        let (mut sum, mut rows) = (residual.clone(), jacobian.clone());
        let (mut values, mut slopes) = (Vec::new(), Vec::new());
        for (constraint, normal) in self.staged.constraints.each.iter().zip(&normals) {
            let value = self.at_increments(words, &constraint.at_increment, &d, other);
            let value = normal.combined(words, value, &values);
            let (along, gap) = (words.dot(&normal.across, &residual), words.multiply(scale, value[0]));
            let both = words.subtract(gap, along);
            let factor = words.divide(both, normal.square);
            sum = plus(words, &sum, factor, &normal.across);
            values.push(value);
            if let (Some(rows), Some(jacobian)) = (&mut rows, &jacobian) {
                let slope = self.at_increments(words, &constraint.slope, &d, other);
                let slope = self.in_coordinates(words, half, &slope);
                let slope = normal.combined(words, slope, &slopes);
                normal.border(words, jacobian, (scale, &slope), rows);
                slopes.push(slope);
            }
        }
        (sum, rows)
    }

    /// The right-trivialised Jacobian with the constraints, by which a solution is judged.
    pub(super) fn branch_with_constraints(&self, words: &mut Words, d: &[Matrix], jacobian: &Matrix) -> Matrix {
        let scale = Value::Input(Source::new(Array::Constants, self.staged.constraints.scale));
        let normals = self.normals(words, &|at| Value::Input(Source::new(Array::Advected, at)));
        let (mut rows, mut slopes) = (jacobian.clone(), Vec::new());
        for (constraint, normal) in self.staged.constraints.each.iter().zip(&normals) {
            let slope = self.at_increments(words, &constraint.slope, d, &Value::Input);
            let slope = normal.combined(words, slope, &slopes);
            normal.border(words, jacobian, (scale, &slope), &mut rows);
            slopes.push(slope);
        }
        rows
    }

    /// A program of the elements of the group.
    fn at_increments(
        &self,
        words: &mut Words,
        program: &Program,
        d: &[Matrix],
        other: &dyn Fn(Source) -> Value,
    ) -> Vec<Value> {
        let elements: Vec<Value> =
            self.factors.iter().zip(d).flat_map(|(factor, d)| factor.element(words, d).entries).collect();
        self.with_increments(words, program, d, &|source| match source.array {
            Array::Element => elements[source.at],
            Array::Constants => Value::Input(source),
            _ => other(source),
        })
    }

    /// The derivative by half the coordinates of one along `exp(t E_k) F`.
    fn in_coordinates(&self, words: &mut Words, half: &[Value], slope: &[Value]) -> Vec<Value> {
        let mut all = Vec::new();
        for factor in &self.factors {
            for column in factor.tangent(words, factor.own(half)) {
                all.push(words.dot(factor.own(slope), &column));
            }
        }
        all
    }

    /// The right side `a` with the reactions before the step, `U(F, w)` at a solution.
    pub(super) fn reacted(&self, words: &mut Words, half: &[Value], target: &[Value]) -> Vec<Value> {
        if !self.is_constrained() {
            return target.to_vec();
        }
        let free = self.free_residual(words, half);
        let square = words.dot(half, half);
        let raised = words.add(square, Value::ONE);
        let power = (0..self.staged.denominators).fold(Value::ONE, |product, _| words.multiply(product, raised));
        let per_step = Value::Input(Source::new(Array::Constants, self.staged.constraints.scale + 1));
        let factor = words.divide(per_step, power);
        let mut target = target.to_vec();
        for normal in self.normals(words, &|at| Value::Input(Source::new(Array::Advected, at))) {
            let along = words.dot(&normal.across, &free);
            let part = words.divide(along, normal.square);
            let impulse = words.multiply(factor, part);
            target = plus(words, &target, impulse, &normal.across);
        }
        target
    }

    /// The momentum with the reactions after a step, whose velocity satisfies the constraints.
    pub(super) fn projected(&self, words: &mut Words, momentum: &[Value], next: &[Value]) -> Vec<Value> {
        let Some(at_rest) = &self.staged.constraints.at_rest else { return momentum.to_vec() };
        let n = self.dimension();
        let at_rest = words.append(at_rest, |source| match source.array {
            Array::Advected => next[source.at],
            _ => Value::Input(source),
        });
        let inertia = Matrix { rows: n, columns: n, entries: at_rest[..n * n].to_vec() };
        let whole = Pattern::whole(n);
        let factorisation = whole.factorise(words, &inertia);
        let solve = |words: &mut Words, right: &[Value]| {
            whole.solve(words, &factorisation.factors, factorisation.determinants[0][0], right)
        };
        let moving = words.subtracted(momentum, &at_rest[n * n..n * n + n]);
        let (mut velocity, mut projected) = (solve(words, &moving), momentum.to_vec());
        // The covectors are made conjugate with respect to the inverse inertia, so that each impulse leaves the others.
        let mut conjugate: Vec<[Vec<Value>; 2]> = Vec::new();
        for Normal { own, .. } in self.normals(words, &|at| next[at]) {
            let (mut covector, mut along) = (own.clone(), solve(words, &own));
            for [before, of_before] in &conjugate {
                let (shared, size) = (words.dot(&covector, of_before), words.dot(before, of_before));
                let ratio = words.divide(shared, size);
                let ratio = words.negate(ratio);
                covector = plus(words, &covector, ratio, before);
                along = plus(words, &along, ratio, of_before);
            }
            let (rate, size) = (words.dot(&covector, &velocity), words.dot(&covector, &along));
            let impulse = words.divide(rate, size);
            let impulse = words.negate(impulse);
            projected = plus(words, &projected, impulse, &covector);
            velocity = plus(words, &velocity, impulse, &along);
            conjugate.push([covector, along]);
        }
        projected
    }

    /// The covectors `A(w)` of the reactions one after the other, of advected parameters and constants; then the squares of
    /// their parts across those before.
    pub(super) fn reactions(&self) -> Option<Program> {
        let mut words = Words::default();
        let normals = self.normals(&mut words, &|at| Value::Input(Source::new(Array::Advected, at)));
        let squares: Vec<Value> = normals.iter().map(|normal| normal.square).collect();
        let all: Vec<Value> = normals.into_iter().flat_map(|normal| normal.own).chain(squares).collect();
        self.is_constrained().then(|| words.program(&all))
    }
}

/// `v + factor direction`.
fn plus(words: &mut Words, v: &[Value], factor: Value, direction: &[Value]) -> Vec<Value> {
    v.iter()
        .zip(direction)
        .map(|(&v, &direction)| {
            let product = words.multiply(factor, direction);
            words.add(v, product)
        })
        .collect()
}
