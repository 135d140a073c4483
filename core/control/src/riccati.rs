//! The quadratic programme of one iteration, solved by a Riccati recursion over the steps.
//!
//! ```text
//! minimise  Σ_k ½ (x_k, u_k)·H_k (x_k, u_k) + a_k·x_k + b_k·u_k      under  x_{k+1} = A_k x_k + B_k u_k,   E x_N = −e
//! ```
//!
//! where `x_0` is zero but for its last entries, which are free. Of the value `½ x·P x + (p + Ψ ν)·x` of the steps that are
//! left, for multipliers `ν` of the last condition, `Π = [p, Ψ]` is carried backwards in one matrix. What it costs is
//! linear in the number of steps.

use nalgebra::{DMatrix, DVector};

/// What an iteration knows about a step.
#[derive(Clone)]
pub(crate) struct Stage {
    /// `∂x⁺/∂x` and `∂x⁺/∂u`.
    pub(crate) by_state: DMatrix<f64>,
    pub(crate) by_input: DMatrix<f64>,
    /// The gradients `a` and `b` of the cost.
    pub(crate) state_gradient: DVector<f64>,
    pub(crate) input_gradient: DVector<f64>,
    /// The second derivatives by state and input, in this order.
    pub(crate) hessian: DMatrix<f64>,
    /// Inputs that have no room to change.
    pub(crate) fixed: Vec<usize>,
    /// The second derivatives of the end by the last component of the state.
    pub(crate) bent: DVector<f64>,
}

/// The condition at the end: `E`, `e`, and the second derivatives by the last state.
#[derive(Clone)]
pub(crate) struct End {
    pub(crate) by_state: DMatrix<f64>,
    pub(crate) miss: DVector<f64>,
    /// The multipliers that new ones are kept beside where inputs don't act on a condition.
    pub(crate) multipliers: DVector<f64>,
    pub(crate) hessian: DMatrix<f64>,
    pub(crate) gradient: DVector<f64>,
}

/// The solution: the changes of the free entries of the first state, of the inputs, and the new multipliers.
pub(crate) struct Solution {
    pub(crate) start: DVector<f64>,
    pub(crate) inputs: Vec<DVector<f64>>,
    pub(crate) multipliers: DVector<f64>,
}

/// `u = K x + κ (1, ν)`
struct Policy {
    gain: DMatrix<f64>,
    offsets: DMatrix<f64>,
}

/// `None` where the programme isn't convex in the inputs, or its condition can't be met to first order.
pub(crate) fn solve(stages: &[Stage], end: &End, free: usize) -> Option<Solution> {
    let (states, conditions) = (end.by_state.ncols(), end.miss.len());
    let mut value = end.hessian.clone();
    let mut slopes = DMatrix::zeros(states, 1 + conditions);
    slopes.set_column(0, &end.gradient);
    slopes.columns_mut(1, conditions).copy_from(&end.by_state.transpose());
    let mut bent = DMatrix::zeros(1 + conditions, 1 + conditions);
    let mut policies = Vec::new();
    for stage in stages.iter().rev() {
        policies.push(backwards(stage, &mut value, &mut slopes, &mut bent)?);
    }

    // What rounding is of the largest: a condition that nothing acts on leaves its multiplier as it is.
    let proximal =
        1e-13 * bent.diagonal().iter().skip(1).fold(0.0_f64, |most, entry| most.max(*entry)).max(f64::MIN_POSITIVE);
    // Stationary in the free entries and in the multipliers.
    let size = free + conditions;
    let (mut matrix, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
    let first = states - free;
    matrix.view_mut((0, 0), (free, free)).copy_from(&value.view((first, first), (free, free)));
    let by_multipliers = slopes.view((first, 1), (free, conditions));
    matrix.view_mut((0, free), (free, conditions)).copy_from(&by_multipliers);
    matrix.view_mut((free, 0), (conditions, free)).copy_from(&by_multipliers.transpose());
    matrix.view_mut((free, free), (conditions, conditions)).copy_from(&-bent.view((1, 1), (conditions, conditions)));
    for condition in 0..conditions {
        matrix[(free + condition, free + condition)] -= proximal;
    }
    right.rows_mut(0, free).copy_from(&-slopes.view((first, 0), (free, 1)));
    right
        .rows_mut(free, conditions)
        .copy_from(&(bent.view((1, 0), (conditions, 1)) - &end.miss - &end.multipliers * proximal));
    // Nothing is free without a condition and with a fixed duration.
    let found = if size == 0 { right } else { matrix.lu().solve(&right)? };
    if found.iter().any(|entry| !entry.is_finite()) {
        return None;
    }

    let multipliers = found.rows(free, conditions).into_owned();
    let start = found.rows(0, free).into_owned();
    let mut state = DVector::zeros(states);
    state.rows_mut(first, free).copy_from(&start);
    let with_one = DVector::from_iterator(1 + conditions, std::iter::once(1.0).chain(multipliers.iter().copied()));
    let mut inputs = Vec::with_capacity(policies.len());
    for (stage, policy) in stages.iter().zip(policies.iter().rev()) {
        let input = &policy.gain * &state + &policy.offsets * &with_one;
        state = &stage.by_state * &state + &stage.by_input * &input;
        inputs.push(input);
    }
    Some(Solution { start, inputs, multipliers })
}

/// The value before a step from that behind it: with `S = H_uu + Bᵀ P B`, `M = H_ux + Bᵀ P A` and `N = Bᵀ Π + b`,
///
/// ```text
/// K = −S⁻¹ M    κ = −S⁻¹ N    P ← H_xx + Aᵀ P A + Mᵀ K    Π ← Aᵀ Π + a + Mᵀ κ    W ← W − Nᵀ κ
/// ```
fn backwards(
    stage: &Stage,
    value: &mut DMatrix<f64>,
    slopes: &mut DMatrix<f64>,
    bent: &mut DMatrix<f64>,
) -> Option<Policy> {
    let (a, b) = (&stage.by_state, &stage.by_input);
    let (states, inputs) = (a.ncols(), b.ncols());
    let (value_a, value_b) = (&*value * a, &*value * b);
    let mut square = stage.hessian.view((states, states), (inputs, inputs)) + b.tr_mul(&value_b);
    let mut mixed = stage.hessian.view((states, 0), (inputs, states)) + b.tr_mul(&value_a);
    let mut offsets = b.tr_mul(slopes);
    offsets.column_mut(0).axpy(1.0, &stage.input_gradient, 1.0);
    for &input in &stage.fixed {
        square.row_mut(input).fill(0.0);
        square.column_mut(input).fill(0.0);
        square[(input, input)] = 1.0;
        mixed.row_mut(input).fill(0.0);
        offsets.row_mut(input).fill(0.0);
    }
    let factor = square.cholesky()?;
    let gain = -factor.solve(&mixed);
    let policy = Policy { offsets: -factor.solve(&offsets), gain };
    *value = stage.hessian.view((0, 0), (states, states)) + a.tr_mul(&value_a) + mixed.tr_mul(&policy.gain);
    *value = (&*value + value.transpose()) * 0.5;
    *bent -= offsets.tr_mul(&policy.offsets);
    *slopes = a.tr_mul(slopes) + mixed.tr_mul(&policy.offsets);
    slopes.column_mut(0).axpy(1.0, &stage.state_gradient, 1.0);
    Some(policy)
}
