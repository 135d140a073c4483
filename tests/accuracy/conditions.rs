//! The coefficients satisfy all the order conditions, and not those of the next order.
//!
//! The step of a self-adjoint method is `exp(h A_1 + h³ A_3 + h⁵ A_5 + …)` with operators `A_k` that don't commute. A
//! composition has the order `p` where the product of these at `γ_i h` agrees with `exp(h A_1)` in all words of the
//! letters `A_k` whose indices add up to `p` or less; a method of order `2q` lacks `A_3, …, A_{2q−1}`. So the words'
//! coefficients are multiplied out: that is all the conditions at once, without a list of them.
//!
//! The same with the letters `A` and `B` for the kinetic flow and the kicks gives the conditions of a splitting. One for a
//! small potential, `(8, 6, 4)`, must agree with `exp(A + B)` in words of up to eight letters with one `B`, of up to six
//! with two, of up to four with more. (The Nyström schemes ask for less than agreement, as some words don't matter.)

use std::collections::BTreeMap;

use liestep::{CompositionScheme, Flow, SplittingScheme};

/// Coefficients of words up to a degree.
type Series = BTreeMap<Vec<u32>, f64>;

fn degree(word: &[u32]) -> u32 {
    word.iter().sum()
}

/// Which words are looked at: with a word, all its parts.
type Kept<'a> = &'a dyn Fn(&[u32]) -> bool;

fn product(a: &Series, b: &Series, kept: Kept<'_>) -> Series {
    let mut product = Series::new();
    for (left, x) in a {
        for (right, y) in b {
            let word = [left.as_slice(), right].concat();
            if kept(&word) {
                *product.entry(word).or_insert(0.0) += x * y;
            }
        }
    }
    product
}

/// `exp(Σ x_k A_k)` for letters and their coefficients, to words of so many letters.
fn exponential(exponent: &[(u32, f64)], length: u32, kept: Kept<'_>) -> Series {
    let exponent: Series = exponent.iter().map(|&(letter, coefficient)| (vec![letter], coefficient)).collect();
    let mut power = Series::from([(Vec::new(), 1.0)]);
    let mut sum = power.clone();
    for n in 1..=length {
        power = product(&power, &exponent, kept);
        for coefficient in power.values_mut() {
            *coefficient /= f64::from(n);
        }
        for (word, coefficient) in &power {
            *sum.entry(word.clone()).or_insert(0.0) += coefficient;
        }
    }
    sum
}

/// The largest difference of two series in the words that are looked at.
fn difference(a: &Series, b: &Series, looked_at: Kept<'_>) -> f64 {
    let words = a.keys().chain(b.keys()).filter(|word| looked_at(word));
    let value = |series: &Series, word: &[u32]| series.get(word).copied().unwrap_or(0.0);
    words.map(|word| (value(a, word) - value(b, word)).abs()).fold(0.0, f64::max)
}

/// The largest deviation from `exp(A_1)` in the words of each degree.
fn deviations(scheme: &CompositionScheme, highest: u32) -> Vec<f64> {
    let kept = |word: &[u32]| degree(word) <= highest;
    let letters: Vec<u32> = (1..=highest).filter(|k| *k == 1 || (k % 2 == 1 && *k > scheme.base())).collect();
    let mut composed = Series::from([(Vec::new(), 1.0)]);
    for gamma in scheme.stages() {
        let exponent: Vec<_> =
            letters.iter().map(|&letter| (letter, gamma.powi(i32::try_from(letter).unwrap()))).collect();
        composed = product(&composed, &exponential(&exponent, highest, &kept), &kept);
    }
    let exact = exponential(&[(1, 1.0)], highest, &kept);
    (0..=highest).map(|of| difference(&composed, &exact, &|word| degree(word) == of)).collect()
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

const A: u32 = 0;
const B: u32 = 1;

/// How far a splitting is from `exp(A + B)` in the words of so many letters at most, by their number of `B`.
fn splitting_deviation(scheme: &SplittingScheme, longest: [usize; 3]) -> f64 {
    let kept = |word: &[u32]| match word.iter().filter(|letter| **letter == B).count() {
        0 => word.len() <= longest[0],
        kicks => word.len() <= longest[kicks.min(3) - 1],
    };
    let length = u32::try_from(longest[0]).unwrap();
    let mut composed = Series::from([(Vec::new(), 1.0)]);
    for (flow, part) in scheme.shares() {
        let letter = if flow == Flow::Drift { A } else { B };
        composed = product(&composed, &exponential(&[(letter, part)], length, &kept), &kept);
    }
    difference(&composed, &exponential(&[(A, 1.0), (B, 1.0)], length, &kept), &kept)
}

#[test]
fn near_integrable_splittings_satisfy_their_order_conditions() {
    for (scheme, longest) in [
        (SplittingScheme::STRANG, [2, 2, 2]),
        (SplittingScheme::NEAR_INTEGRABLE_4_2, [4, 2, 2]),
        (SplittingScheme::NEAR_INTEGRABLE_8_6_4, [8, 6, 4]),
        (SplittingScheme::NEAR_INTEGRABLE_10_6_4, [10, 6, 4]),
    ] {
        let within = splitting_deviation(&scheme, longest);
        println!("{}: {within:.1e}", scheme.name());
        assert!(within < 1e-14, "{}: {within:e}", scheme.name());
        // A letter more is too many, of the words with one `B` and with two.
        let [one, two, more] = longest;
        for longer in [[one + 1, two, more], [one.max(two + 1), two + 1, more]] {
            let beyond = splitting_deviation(&scheme, longer);
            assert!(beyond > 1e-12, "{}, {longer:?}: {beyond:e}", scheme.name());
        }
    }
}

/// The conditions that Nyström schemes share with all splittings: those of words with one kick, and of three letters.
#[test]
fn nystrom_splittings_satisfy_the_common_order_conditions() {
    for (scheme, longest) in [
        (SplittingScheme::NYSTROM_6, [4, 4, 3]),
        (SplittingScheme::NYSTROM_11, [6, 3, 3]),
        (SplittingScheme::NYSTROM_14, [6, 3, 3]),
    ] {
        let within = splitting_deviation(&scheme, longest);
        println!("{}: {within:.1e}", scheme.name());
        // Fifteen digits were published.
        assert!(within < 1e-13, "{}: {within:e}", scheme.name());
    }
}
