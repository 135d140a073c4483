//! The coefficients satisfy all the order conditions, and not those of the next order.
//!
//! The step of a self-adjoint method is `exp(h A_1 + h³ A_3 + h⁵ A_5 + …)` with operators `A_k` that don't commute. A
//! composition has the order `p` where the product of these at `γ_i h` agrees with `exp(h A_1)` in all words of the
//! letters `A_k` whose indices add up to `p` or less; a method of order `2q` lacks `A_3, …, A_{2q−1}`. So the words'
//! coefficients are multiplied out: that is all the conditions at once, without a list of them.

use std::collections::BTreeMap;

use liestep::CompositionScheme;

/// Coefficients of words up to a degree.
type Series = BTreeMap<Vec<u32>, f64>;

fn degree(word: &[u32]) -> u32 {
    word.iter().sum()
}

fn product(a: &Series, b: &Series, highest: u32) -> Series {
    let mut product = Series::new();
    for (left, x) in a {
        for (right, y) in b {
            let word = [left.as_slice(), right].concat();
            if degree(&word) <= highest {
                *product.entry(word).or_insert(0.0) += x * y;
            }
        }
    }
    product
}

/// `exp(Σ_k γ^k A_k)` over the letters.
fn exponential(gamma: f64, letters: &[u32], highest: u32) -> Series {
    let exponent: Series =
        letters.iter().map(|&letter| (vec![letter], gamma.powi(i32::try_from(letter).unwrap()))).collect();
    let mut power = Series::from([(Vec::new(), 1.0)]);
    let mut sum = power.clone();
    for n in 1..=highest {
        power = product(&power, &exponent, highest);
        power.values_mut().for_each(|coefficient| *coefficient /= f64::from(n));
        for (word, coefficient) in &power {
            *sum.entry(word.clone()).or_insert(0.0) += coefficient;
        }
    }
    sum
}

/// The largest deviation from `exp(A_1)` in the words of each degree.
fn deviations(scheme: &CompositionScheme, highest: u32) -> Vec<f64> {
    let letters: Vec<u32> = (1..=highest).filter(|k| *k == 1 || (k % 2 == 1 && *k > scheme.base())).collect();
    let mut composed = Series::from([(Vec::new(), 1.0)]);
    for gamma in scheme.stages() {
        composed = product(&composed, &exponential(gamma, &letters, highest), highest);
    }
    let exact = exponential(1.0, &[1], highest);
    let mut deviations = vec![0.0_f64; highest as usize + 1];
    for (word, coefficient) in &composed {
        let deviation = (coefficient - exact.get(word).unwrap_or(&0.0)).abs();
        let worst = &mut deviations[degree(word) as usize];
        *worst = worst.max(deviation);
    }
    deviations
}

#[test]
fn compositions_satisfy_their_order_conditions() {
    for scheme in [
        CompositionScheme::SUZUKI_4,
        CompositionScheme::SUZUKI_6,
        CompositionScheme::SUZUKI_8,
        CompositionScheme::KAHAN_LI_6,
        CompositionScheme::KAHAN_LI_8,
        CompositionScheme::SOFRONIOU_SPALETTA_10,
    ] {
        let deviations = deviations(&scheme, scheme.order() + 1);
        let (beyond, within) = deviations.split_last().unwrap();
        let worst = within.iter().fold(0.0_f64, |worst, deviation| worst.max(*deviation));
        println!("{}: {worst:.1e}, then {beyond:.1e}", scheme.name());
        // Sums of tens of products of numbers below one; the next order is missed by far more.
        assert!(worst < 1e-14, "{}: {worst:e}", scheme.name());
        assert!(*beyond > 1e-7, "{}: {beyond:e}", scheme.name());
    }
}

#[test]
fn a_wrong_digit_is_found() {
    let wrong = CompositionScheme::new("wrong", 2, 4, &[0.414_490_772, 0.414_490_771, -0.657_963_087]);
    let worst = deviations(&wrong, 4).into_iter().fold(0.0, f64::max);
    assert!(worst > 1e-10);
}
