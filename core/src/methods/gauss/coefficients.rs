//! Coefficients of Gauss collocation, by pairs of stages that mirror each other.

roots!();

/// One number per stage: first the stages of the first half of the step, then their mirror images.
pub(super) type OfStages<const PAIRS: usize> = [[f64; PAIRS]; 2];

/// A square matrix over the stages, stored by columns.
pub(super) type Columns<const PAIRS: usize> = [[OfStages<PAIRS>; PAIRS]; 2];

/// Coefficients of a collocation with `2 PAIRS` stages on the unit interval.
///
/// Stage `k` of the first half has the node `c_k < 1/2`, its mirror image `k̄` the node `1 − c_k`. With
/// `L_j = h b_j f(Y_j)` a step is
///
/// ```text
/// Y_i = y + Σ_j (1/2 + σ_ij) L_j      y⁺ = y + Σ_j L_j
/// ```
///
/// Here `σ` is antisymmetric, and changes sign if both stages are mirrored. In this form the method is symplectic and
/// symmetric for every such `σ`, hence for a rounded one, if `1/2 + σ_ij` and `1/2 − σ_ij` are rounded together: the
/// conditions `b_i a_ij + b_j a_ji = b_i b_j` and `a_ij + a_īj̄ = b_j` hold exactly.
///
/// # Source
///
/// \[HW96\], theorem IV.5.6: `σ_ij = Σ ξ_k (P̃_k(c_i) P̃_{k−1}(c_j) − P̃_{k−1}(c_i) P̃_k(c_j))` with the normalised shifted
/// Legendre polynomials; in Legendre's own, `ξ_k` and the norms multiply to `1/2`. The form in `L` is that of
/// \[AMM17\].
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients<const PAIRS: usize> {
    /// The weight `b_k` of both stages of a pair.
    pub weights: [f64; PAIRS],
    /// The matrix `1/2 + σ`.
    pub places: Columns<PAIRS>,
    /// The extrapolation matrix: from the `L` of a step to the values of their interpolating polynomial at the next
    /// step's nodes.
    pub continuation: Columns<PAIRS>,
}

impl<const PAIRS: usize> Coefficients<PAIRS> {
    /// The coefficients of Gauss' nodes.
    #[must_use]
    pub fn gauss() -> Self {
        let stages = 2 * PAIRS;
        let nodes: [f64; PAIRS] = core::array::from_fn(|k| root(stages, k));
        let weights = nodes.map(|x| {
            let (value, before) = legendre_pair(stages, x);
            // b = 1/((1 − x²) P_s'(x)²), with (1 − x²) P_s' = s (P_{s−1} − x P_s).
            let slope = index(stages) * (before - x * value);
            (1.0 - x * x) / (slope * slope)
        });
        // β pairs an odd polynomial at one node with an even one at the other; σ_ij = ±β_ij ∓ β_ji by the sides of the
        // stages.
        let beta = |i: usize, k: usize| -> f64 {
            let terms = (1..stages).map(|m| {
                let (odd, even) = if m % 2 == 1 { (m, m - 1) } else { (m - 1, m) };
                let product = legendre(odd, nodes[i]) * legendre(even, nodes[k]);
                if m % 2 == 1 { product } else { -product }
            });
            0.5 * terms.sum::<f64>()
        };
        let place = |(side_i, i): (f64, usize), (side_j, j): (f64, usize)| {
            let sigma = side_i * beta(i, j) - side_j * beta(j, i);
            // The larger number is between 1/2 and 2, so its difference from one is exact.
            let larger = 0.5 + sigma.abs();
            if sigma < 0.0 { 1.0 - larger } else { larger }
        };
        let extrapolated = |(side_i, i): (f64, usize), (side_j, j): (f64, usize)| -> f64 {
            let (from, to) = (side_j * nodes[j], side_i * nodes[i] + 2.0);
            let terms = (0..stages).map(|m| index(2 * m + 1) * legendre(m, to) * legendre(m, from));
            weights[i] * terms.sum::<f64>()
        };
        Self { weights, places: columns(place), continuation: columns(extrapolated) }
    }
}

/// A matrix by columns from a function of its row and column; each index is the side (±1) and the number of a stage.
fn columns<const PAIRS: usize>(entry: impl Fn((f64, usize), (f64, usize)) -> f64) -> Columns<PAIRS> {
    let stages = |of: &dyn Fn((f64, usize)) -> f64| [1.0, -1.0].map(|side| core::array::from_fn(|k| of((side, k))));
    [1.0, -1.0].map(|side| core::array::from_fn(|k| stages(&|row| entry(row, (side, k)))))
}

#[allow(clippy::cast_precision_loss)] // a few dozen at most
fn index(n: usize) -> f64 {
    n as f64
}

/// `P_n(x)`.
fn legendre(n: usize, x: f64) -> f64 {
    legendre_pair(n, x).0
}

/// `P_n(x)` and `P_{n−1}(x)`, by Bonnet's recurrence, which starts with `P_{−1} = 0`.
fn legendre_pair(n: usize, x: f64) -> (f64, f64) {
    (0..n).fold((1.0, 0.0), |(value, before), m| {
        ((index(2 * m + 1) * x * value - index(m) * before) / index(m + 1), value)
    })
}

/// The `k`th root of `P_n` from the left, in `(−1, 0)`, by Newton's iteration from Tricomi's estimate.
fn root(n: usize, k: usize) -> f64 {
    let mut x = -(core::f64::consts::PI * (index(k) + 0.75) / (index(n) + 0.5)).cos();
    // The estimate has three correct digits, so the fourth iteration is a reserve.
    for _ in 0..4 {
        let (value, before) = legendre_pair(n, x);
        x -= value * (1.0 - x * x) / (index(n) * (before - x * value));
    }
    x
}

#[cfg(test)]
mod tests {
    use super::Coefficients;
    use alloc::vec::Vec;

    /// Butcher's simplifying assumptions `B(2s)` and `C(s)`, which imply order `2s` for a symplectic method. They are
    /// tested for powers of `x = 2c − 1` on `[−1, 1]`, which are well conditioned.
    fn assert_order_conditions<const PAIRS: usize>() {
        let coefficients = Coefficients::<PAIRS>::gauss();
        let stages = 2 * PAIRS;
        let nodes: [f64; PAIRS] = core::array::from_fn(|k| super::root(stages, k));
        let (all_nodes, all_weights): (Vec<_>, Vec<_>) = [-1.0, 1.0]
            .iter()
            .flat_map(|side| (0..PAIRS).map(move |k| (-side * nodes[k], 2.0 * coefficients.weights[k])))
            .unzip();
        let integral = |power: usize, to: f64| {
            let power = i32::try_from(power).unwrap() + 1;
            (to.powi(power) - (-1.0_f64).powi(power)) / f64::from(power)
        };
        for power in 0..2 * stages {
            let sum: f64 = all_nodes
                .iter()
                .zip(&all_weights)
                .map(|(x, b): (&f64, &f64)| b * x.powi(power.try_into().unwrap()))
                .sum();
            assert!((sum - integral(power, 1.0)).abs() < 1e-15, "{PAIRS} pairs, B, x^{power}: {sum}");
        }
        let place = |i: usize, j: usize| coefficients.places.as_flattened()[j].as_flattened()[i];
        for (i, j) in (0..stages).flat_map(|i| (0..stages).map(move |j| (i, j))) {
            let mirrored = |stage: usize| (stage + PAIRS) % stages;
            let is_one = |sum: f64| sum.to_bits() == 1.0_f64.to_bits();
            assert!(is_one(place(i, j) + place(j, i)), "symplectic");
            assert!(is_one(place(i, j) + place(mirrored(i), mirrored(j))), "symmetric");
        }
        for (i, x) in all_nodes.iter().enumerate() {
            for power in 0..stages {
                let terms =
                    (0..stages).map(|j| all_weights[j] * place(i, j) * all_nodes[j].powi(power.try_into().unwrap()));
                let error = terms.sum::<f64>() - integral(power, *x);
                assert!(error.abs() < 1e-15, "{PAIRS} pairs, C, stage {i}, x^{power}: {error:e}");
            }
        }
    }

    #[test]
    fn they_are_gauss_s() {
        assert_order_conditions::<1>();
        assert_order_conditions::<2>();
        assert_order_conditions::<3>();
        assert_order_conditions::<4>();
        assert_order_conditions::<8>();
    }

    /// A polynomial of degree three is determined by four stages, so it is continued exactly.
    #[test]
    fn stages_are_continued_by_their_polynomial() {
        let coefficients = Coefficients::<2>::gauss();
        let nodes: [f64; 2] = core::array::from_fn(|k| super::root(4, k));
        let cubic = |x: f64| 1.0 + x * (0.5 - x * (2.0 + x));
        let values = |shift: f64| {
            [1.0, -1.0].map(|side| core::array::from_fn(|k| coefficients.weights[k] * cubic(shift + side * nodes[k])))
        };
        let (from, expected): ([[f64; 2]; 2], [[f64; 2]; 2]) = (values(0.0), values(2.0));
        for (to, expected) in expected.iter().enumerate() {
            for (i, expected) in expected.iter().enumerate() {
                let terms = (0..2).flat_map(|side| (0..2).map(move |k| (side, k)));
                let found: f64 = terms.map(|(side, k)| coefficients.continuation[side][k][to][i] * from[side][k]).sum();
                assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            }
        }
    }
}
