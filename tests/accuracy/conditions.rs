//! The coefficients satisfy all the order conditions, and not those of the next order.
//!
//! The step of a self-adjoint method is `exp(h A_1 + h³ A_3 + h⁵ A_5 + …)` with operators `A_k` that don't commute. A
//! composition has the order `p` where the product of these at `γ_i h` agrees with `exp(h A_1)` in all words of the
//! letters `A_k` whose indices add up to `p` or less; a method of order `2q` lacks `A_3, …, A_{2q−1}`. So the words'
//! coefficients are multiplied out: that is all the conditions at once, without a list of them.
//!
//! The same with the letters `A` and `B` for the kinetic flow and the kicks gives the conditions of a splitting. One
//! for a small potential, `(8, 6, 4)`, must agree with `exp(A + B)` in words of up to eight letters with one `B`, of up
//! to six with two, of up to four with more. (The Nyström schemes ask for less than agreement, as some words don't
//! matter.) A share `g` of the force gradient is one of `½ [B, [A, B]]` beside the kick.

use core::ops::{Add, Div, Mul, Sub};
use std::collections::BTreeMap;

use liestep::methods::{CompositionScheme, Flow, SplittingScheme};

/// What coefficients are computed in.
pub(crate) trait Number:
    Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
}

impl<T> Number for T where T: Copy + From<f64> + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Div<Output = T> {}

/// Coefficients of words; with a word there are all its parts.
type Series<T> = BTreeMap<Vec<u32>, T>;

fn degree(word: &[u32]) -> u32 {
    word.iter().sum()
}

/// The words of these letters that are looked at, with their coefficients in one.
fn one<T: Number>(letters: &[u32], is_looked_at: impl Fn(&[u32]) -> bool) -> Series<T> {
    let mut all = Series::from([(Vec::new(), T::from(1.0))]);
    let mut last: Vec<Vec<u32>> = vec![Vec::new()];
    while !last.is_empty() {
        let longer = last.iter().flat_map(|word| letters.iter().map(|letter| [word, [*letter].as_slice()].concat()));
        last = longer.filter(|word| is_looked_at(word)).collect();
        all.extend(last.iter().map(|word| (word.clone(), T::from(0.0))));
    }
    all
}

/// The series times `exp(Σ x_k A_k)`, where a word of `n` letters has the product of its letters' `x_k` over `n!`.
fn times_exponential<T: Number>(series: &Series<T>, x: impl Fn(u32) -> T) -> Series<T> {
    let of_word = |word: &[u32]| {
        word.iter().zip(1..).fold(T::from(1.0), |product, (letter, n)| product * x(*letter) / f64::from(n).into())
    };
    let coefficient = |word: &Vec<u32>| {
        let cuts = (0..=word.len()).map(|cut| series[&word[..cut]] * of_word(&word[cut..]));
        cuts.fold(T::from(0.0), |sum, part| sum + part)
    };
    series.keys().map(|word| (word.clone(), coefficient(word))).collect()
}

/// The series times the exponential of a sum of words with these coefficients.
fn times_exponential_of(series: &Series<f64>, words: &[(Vec<u32>, f64)]) -> Series<f64> {
    let longest = series.keys().map(Vec::len).max().unwrap_or(0);
    let (mut sum, mut last) = (series.clone(), series.clone());
    for n in (1_u32..).take(longest) {
        let mut next: Series<f64> = series.keys().map(|word| (word.clone(), 0.0)).collect();
        for (word, x) in &mut next {
            for (end, factor) in words {
                let before = word.strip_suffix(end.as_slice()).map_or(0.0, |begin| last[begin]);
                *x += before * factor / f64::from(n);
            }
        }
        for (word, x) in &next {
            *sum.entry(word.clone()).or_default() += x;
        }
        last = next;
    }
    sum
}

fn power<T: Number>(x: T, n: u32) -> T {
    (0..n).fold(T::from(1.0), |product, _| product * x)
}

/// How a composition of a method of the order `base` deviates from `exp(A_1)`, word by word up to a degree.
pub(crate) fn deviations<T: Number>(stages: &[T], base: u32, highest: u32) -> Series<T> {
    let letters: Vec<u32> = (1..=highest).filter(|k| *k == 1 || (k % 2 == 1 && *k > base)).collect();
    let one = one(&letters, |word| degree(word) <= highest);
    let stage = |composed: Series<T>, gamma: &T| times_exponential(&composed, |letter| power(*gamma, letter));
    let composed = stages.iter().fold(one.clone(), stage);
    let exact = times_exponential(&one, |letter| T::from(f64::from(u8::from(letter == 1))));
    composed.into_iter().map(|(word, x)| (word.clone(), x - exact[&word])).collect()
}

/// The largest deviation in the words of each degree.
fn by_degree(scheme: &CompositionScheme, highest: u32) -> Vec<f64> {
    let stages: Vec<_> = scheme.stages().collect();
    let deviations = deviations(&stages, scheme.base(), highest);
    let of = |wanted| deviations.iter().filter(move |(word, _)| degree(word) == wanted);
    (0..=highest).map(|wanted| of(wanted).map(|(_, x)| x.abs()).fold(0.0, f64::max)).collect()
}

#[test]
fn compositions_satisfy_their_order_conditions() {
    for scheme in CompositionScheme::ALL {
        let deviations = by_degree(&scheme, scheme.order() + 1);
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
    let worst = by_degree(&wrong, 4).into_iter().fold(0.0, f64::max);
    assert!(worst > 1e-10);
}

const A: u32 = 0;
const B: u32 = 1;

/// How far a splitting is from `exp(A + B)` in the words of so many letters at most, by their number of `B`.
fn splitting_deviation(scheme: &SplittingScheme, longest: [usize; 3]) -> f64 {
    let one: Series<f64> = one(&[A, B], |word| match word.iter().filter(|letter| **letter == B).count() {
        0 => word.len() <= longest[0],
        kicks => word.len() <= longest[kicks.min(3) - 1],
    });
    let composed = scheme.shares().zip(scheme.gradients()).fold(one.clone(), |composed, ((flow, part), gradient)| {
        let of_flow = if flow == Flow::Drift { A } else { B };
        if gradient == 0.0 {
            return times_exponential(&composed, |letter| if letter == of_flow { part } else { 0.0 });
        }
        // ½ [B, [A, B]] = B A B − ½ (A B B + B B A).
        let half = -0.5 * gradient;
        let words = [(vec![B], part), (vec![B, A, B], gradient), (vec![A, B, B], half), (vec![B, B, A], half)];
        times_exponential_of(&composed, &words)
    });
    let exact = times_exponential(&one, |_| 1.0);
    composed.iter().map(|(word, x)| (x - exact[word]).abs()).fold(0.0, f64::max)
}

#[test]
fn near_integrable_splittings_satisfy_their_order_conditions() {
    for (scheme, longest) in [
        (SplittingScheme::STRANG, [2, 2, 2]),
        (SplittingScheme::NEAR_INTEGRABLE_4_2, [4, 2, 2]),
        (SplittingScheme::NEAR_INTEGRABLE_8_6_4, [8, 6, 4]),
        (SplittingScheme::NEAR_INTEGRABLE_10_6_4, [10, 6, 4]),
        (SplittingScheme::FORCE_GRADIENT_2, [4, 4, 4]),
        (SplittingScheme::FORCE_GRADIENT_4, [8, 4, 4]),
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
        (SplittingScheme::FORCE_GRADIENT_5, [6, 4, 4]),
    ] {
        let within = splitting_deviation(&scheme, longest);
        println!("{}: {within:.1e}", scheme.name());
        // Fifteen digits were published.
        assert!(within < 1e-13, "{}: {within:e}", scheme.name());
    }
}
