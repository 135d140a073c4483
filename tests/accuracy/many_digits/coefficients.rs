//! The coefficients of a composition beyond the digits of a double.

use liestep::methods::CompositionScheme;
use nalgebra::{DMatrix, DVector};

use super::DoubleDouble;
use crate::conditions::deviations;

/// The solution of the order conditions nearest to a scheme's coefficients, all stages in order.
///
/// If there are fewer conditions than coefficients, the further digits differ from the published solution's, but the
/// scheme's coefficients are a rounding of both: they may differ by roundings of the coefficients only.
pub(crate) fn refined(scheme: &CompositionScheme) -> Vec<DoubleDouble> {
    let stages: Vec<_> = scheme.stages().collect();
    let count = stages.len().div_ceil(2);
    let all = |half: &[DoubleDouble]| -> Vec<DoubleDouble> {
        half.iter().chain(half.iter().rev().skip(1)).copied().collect()
    };
    let missed = |half: &[DoubleDouble]| -> Vec<DoubleDouble> {
        deviations(&all(half), scheme.base(), scheme.order()).into_values().collect()
    };
    let mut half: Vec<DoubleDouble> = stages[..count].iter().map(|gamma| (*gamma).into()).collect();
    // The error of central differences slows the iteration, and doesn't change its limit.
    let columns: Vec<_> = (0..count)
        .map(|k| {
            let [plus, minus] = [1e-6, -1e-6].map(|change: f64| {
                let mut moved = half.clone();
                moved[k] += change.into();
                missed(&moved)
            });
            DVector::from_iterator(plus.len(), plus.iter().zip(&minus).map(|(a, b)| (*a - *b).rounded() / 2e-6))
        })
        .collect();
    // The words' conditions are dependent: singular values below those of the conditions, 1e-7 and more, are rounding.
    let inverse = DMatrix::from_columns(&columns).pseudo_inverse(1e-9).expect("a Jacobian");
    for _ in 0..20 {
        let residual = missed(&half);
        let worst = residual.iter().map(|missed| missed.rounded().abs()).fold(0.0, f64::max);
        if worst < 1e-30 {
            for (refined, published) in half.iter().zip(&stages) {
                let change = (*refined - (*published).into()).rounded();
                assert!(change.abs() < 4e-16, "{}: {published} is off by {change:e}", scheme.name());
            }
            return all(&half);
        }
        let residual = DVector::from_iterator(residual.len(), residual.iter().map(|missed| missed.rounded()));
        for (gamma, change) in half.iter_mut().zip((&inverse * residual).iter()) {
            *gamma -= (*change).into();
        }
    }
    panic!("{}: no solution of the order conditions is near", scheme.name());
}
