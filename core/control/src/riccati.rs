//! The quadratic programme of one iteration, solved by a Riccati recursion over the steps.
//!
//! ```text
//! minimise  Σ_k ½ (x_k, u_k)·H_k (x_k, u_k) + a_k·x_k + b_k·u_k      under  x_{k+1} = A_k x_k + B_k u_k,   E x_N = −e
//! ```
//!
//! where `x_0` is zero except for its last entries, which are free. The value of the remaining steps is
//! `½ x·P x + (p + Ψ ν)·x`, for multipliers `ν` of the last condition; `Π = [p, Ψ]` is carried backwards in one matrix.
//! The time is linear in the number of steps.

use nalgebra::{DMatrix, DVector};

/// The coefficients of one step in the programme.
#[derive(Clone)]
pub(crate) struct Stage {
    /// The derivatives `∂x⁺/∂x` and `∂x⁺/∂u`.
    pub(crate) by_state: DMatrix<f64>,
    pub(crate) by_input: DMatrix<f64>,
    /// The gradients `a` and `b` of the cost.
    pub(crate) state_gradient: DVector<f64>,
    pub(crate) input_gradient: DVector<f64>,
    /// The second derivatives of the cost by state and input, in this order.
    pub(crate) hessian: DMatrix<f64>,
    /// The inputs that have no room to change.
    pub(crate) fixed: Vec<usize>,
    /// The second derivatives of the step's end by the last component of the state.
    pub(crate) bent: DVector<f64>,
}

/// The condition at the end, `E` and `e`, and the derivatives of the cost by the last state.
#[derive(Clone)]
pub(crate) struct End {
    pub(crate) by_state: DMatrix<f64>,
    pub(crate) miss: DVector<f64>,
    /// The present multipliers, near which new ones stay if inputs don't act on a condition.
    pub(crate) multipliers: DVector<f64>,
    pub(crate) hessian: DMatrix<f64>,
    pub(crate) gradient: DVector<f64>,
}

/// The second derivatives and the gradient of the cost by the state of this number.
pub(crate) fn of_state<'s>(
    stages: &'s mut [Stage],
    end: &'s mut End,
    step: usize,
) -> (&'s mut DMatrix<f64>, &'s mut DVector<f64>) {
    match stages.get_mut(step) {
        Some(stage) => (&mut stage.hessian, &mut stage.state_gradient),
        None => (&mut end.hessian, &mut end.gradient),
    }
}

/// `H ← H + weight v vᵀ`, for its first rows and columns.
pub(crate) fn add_square(hessian: &mut DMatrix<f64>, v: &DVector<f64>, weight: f64) {
    hessian.view_mut((0, 0), (v.len(), v.len())).ger(weight, v, v, 1.0);
}

/// The solution: the changes of the states and of the inputs, and the new multipliers.
pub(crate) struct Solution {
    /// State changes, one more than there are steps.
    pub(crate) states: Vec<DVector<f64>>,
    pub(crate) inputs: Vec<DVector<f64>>,
    pub(crate) multipliers: DVector<f64>,
}

/// The input as a function of the state, `u = K x + κ (1, ν)`.
struct Policy {
    gain: DMatrix<f64>,
    offsets: DMatrix<f64>,
}

/// The least cost of all steps as a function of the first state, `½ x·P x + (p + Ψ ν)·x + …`, and the inputs that
/// attain it.
pub(crate) struct Value {
    /// The matrix `P`.
    pub(crate) square: DMatrix<f64>,
    /// The slopes `Π = [p, Ψ]`.
    pub(crate) slopes: DMatrix<f64>,
    /// Minus the second derivatives by `(1, ν)`, `W`.
    bent: DMatrix<f64>,
    /// Policies from the last step to the first.
    policies: Vec<Policy>,
}

impl Value {
    /// The least cost of a programme; `None` if it isn't convex in the inputs.
    pub(crate) fn new(stages: &[Stage], end: &End) -> Option<Self> {
        let (states, conditions) = (end.by_state.ncols(), end.miss.len());
        let mut slopes = DMatrix::zeros(states, 1 + conditions);
        slopes.set_column(0, &end.gradient);
        slopes.columns_mut(1, conditions).copy_from(&end.by_state.transpose());
        let bent = DMatrix::zeros(1 + conditions, 1 + conditions);
        let mut value = Self { square: end.hessian.clone(), slopes, bent, policies: Vec::with_capacity(stages.len()) };
        for stage in stages.iter().rev() {
            let policy = value.backwards(stage)?;
            value.policies.push(policy);
        }
        Some(value)
    }

    /// The inputs from this state on, and the states that follow.
    pub(crate) fn forwards(&self, stages: &[Stage], start: DVector<f64>, multipliers: DVector<f64>) -> Solution {
        let with_one = multipliers.clone().insert_row(0, 1.0);
        let (mut state, mut states) = (start, Vec::with_capacity(stages.len() + 1));
        let mut inputs = Vec::with_capacity(stages.len());
        for (stage, policy) in stages.iter().zip(self.policies.iter().rev()) {
            let input = &policy.gain * &state + &policy.offsets * &with_one;
            let next = &stage.by_state * &state + &stage.by_input * &input;
            states.push(std::mem::replace(&mut state, next));
            inputs.push(input);
        }
        states.push(state);
        Solution { states, inputs, multipliers }
    }

    /// The value before a step from that after it: with `S = H_uu + Bᵀ P B`, `M = H_ux + Bᵀ P A` and `N = Bᵀ Π + b`,
    ///
    /// ```text
    /// K = −S⁻¹ M    κ = −S⁻¹ N    P ← H_xx + Aᵀ P A + Mᵀ K    Π ← Aᵀ Π + a + Mᵀ κ    W ← W − Nᵀ κ
    /// ```
    fn backwards(&mut self, stage: &Stage) -> Option<Policy> {
        let Self { square: value, slopes, bent, .. } = self;
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
}

/// The solution of a programme; `None` if it isn't convex in the inputs, or its condition can't be met to first order.
pub(crate) fn solve(stages: &[Stage], end: &End, free: usize) -> Option<Solution> {
    let (states, conditions) = (end.by_state.ncols(), end.miss.len());
    let value = Value::new(stages, end)?;
    let Value { square, slopes, bent, .. } = &value;

    // A damping by rounding: the multiplier of a condition that no input acts on stays as it is.
    let proximal =
        1e-13 * bent.diagonal().iter().skip(1).fold(0.0_f64, |most, entry| most.max(*entry)).max(f64::MIN_POSITIVE);
    // The solution is stationary in the free entries and in the multipliers.
    let size = free + conditions;
    let (mut matrix, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
    let first = states - free;
    matrix.view_mut((0, 0), (free, free)).copy_from(&square.view((first, first), (free, free)));
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
    // The system is empty without a condition and with a fixed duration.
    let found = if size == 0 { right } else { matrix.lu().solve(&right)? };
    if found.iter().any(|entry| !entry.is_finite()) {
        return None;
    }

    let mut start = DVector::zeros(states);
    start.rows_mut(first, free).copy_from(&found.rows(0, free));
    Some(value.forwards(stages, start, found.rows(free, conditions).into_owned()))
}
