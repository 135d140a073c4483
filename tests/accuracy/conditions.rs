//! The coefficients of methods satisfy all order conditions of their order, and not those of the next.
//!
//! The step of a self-adjoint method is `exp(h A_1 + h³ A_3 + h⁵ A_5 + …)` with operators `A_k` that don't commute. A
//! composition has the order `p` if the product of these at `γ_i h` agrees with `exp(h A_1)` in all words of the
//! letters `A_k` whose indices add up to `p` or less; a method of order `2q` lacks `A_3, …, A_{2q−1}`. So the test
//! multiplies out the coefficients of words, which covers all conditions at once, without a list of them.
//!
//! The letters `A` and `B` for the kinetic flow and the kicks give the conditions of a splitting. One for a small
//! potential, `(8, 6, 4)`, must agree with `exp(A + B)` in words of up to eight letters with one `B`, of up to six with
//! two, of up to four with more. (Nyström schemes satisfy fewer conditions, as some words don't matter.) A share `g` of
//! the force gradient is a term `½ g [B, [A, B]]` in the exponent of the kick.

use core::ops::{Add, Div, Mul, Sub};
use std::collections::BTreeMap;

use liestep::methods::{CompositionScheme, Flow, ProcessedScheme, SplittingScheme};
use nalgebra::{DMatrix, DVector};

/// The scalars of coefficients and of series.
pub(crate) trait Number:
    Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
}

impl<T> Number for T where T: Copy + From<f64> + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Div<Output = T> {}

/// The coefficients of words; the words of a series include all subwords of each.
type Series<T> = BTreeMap<Vec<u32>, T>;

fn degree(word: &[u32]) -> u32 {
    word.iter().sum()
}

/// The series `1` on the selected words of these letters.
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

/// The deviation of a composition of a method of the order `base` from `exp(A_1)`, for each word up to a degree.
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
        // The bound is for sums of tens of products of numbers below one; the error at the next order is far larger.
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

/// A flow, its share and that of the force gradient.
type Part = (Flow, f64, f64);

fn shares(scheme: &SplittingScheme) -> impl Iterator<Item = Part> {
    scheme.shares().zip(scheme.gradients()).map(|((flow, share), gradient)| (flow, share, gradient))
}

/// The series times the exponentials of these parts.
fn times_shares(series: &Series<f64>, shares: impl Iterator<Item = Part>) -> Series<f64> {
    shares.fold(series.clone(), |composed, (flow, part, gradient)| {
        let of_flow = if flow == Flow::Drift { A } else { B };
        if gradient == 0.0 {
            return times_exponential(&composed, |letter| if letter == of_flow { part } else { 0.0 });
        }
        // ½ [B, [A, B]] = B A B − ½ (A B B + B B A).
        let half = -0.5 * gradient;
        let words = [(vec![B], part), (vec![B, A, B], gradient), (vec![A, B, B], half), (vec![B, B, A], half)];
        times_exponential_of(&composed, &words)
    })
}

/// The largest difference of a splitting's coefficients of words in `A` and `B` from those of `exp(A + B)`; `longest` has
/// the most letters of a word with one, two and more `B`.
fn splitting_deviation(scheme: &SplittingScheme, longest: [usize; 3]) -> f64 {
    let one: Series<f64> = one(&[A, B], |word| match word.iter().filter(|letter| **letter == B).count() {
        0 => word.len() <= longest[0],
        kicks => word.len() <= longest[kicks.min(3) - 1],
    });
    let composed = times_shares(&one, shares(scheme));
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
        // One more letter is too many, for the words with one `B` and for those with two.
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
        // The published coefficients have fifteen digits.
        assert!(within < 1e-13, "{}: {within:e}", scheme.name());
    }
}

/// The product of two series, in the words of the first.
fn product(a: &Series<f64>, b: &Series<f64>) -> Series<f64> {
    let of = |series: &Series<f64>, word: &[u32]| series.get(word).copied().unwrap_or(0.0);
    let coefficient = |word: &Vec<u32>| (0..=word.len()).map(|cut| of(a, &word[..cut]) * of(b, &word[cut..])).sum();
    a.keys().map(|word| (word.clone(), coefficient(word))).collect()
}

/// The logarithm of a series whose coefficient of the empty word is one.
fn logarithm(series: &Series<f64>) -> Series<f64> {
    let rest: Series<f64> =
        series.iter().map(|(word, x)| (word.clone(), if word.is_empty() { 0.0 } else { *x })).collect();
    let longest = series.keys().map(Vec::len).max().unwrap_or(0);
    let (mut sum, mut last) = (rest.clone(), rest.clone());
    for n in (2_u32..).take(longest) {
        last = product(&last, &rest);
        let sign = if n % 2 == 0 { -1.0 } else { 1.0 };
        for (word, x) in &mut sum {
            *x += sign * last[word] / f64::from(n);
        }
    }
    sum
}

/// The words of this length that vanish because the kinetic energy is quadratic in the momentum: `[B, [B, [B, A]]]` and
/// all its commutators, one column each.
fn vanishing(length: usize) -> DMatrix<f64> {
    let commutator = |letter: u32, series: &Series<f64>| {
        let mut sum = Series::new();
        for (word, x) in series {
            *sum.entry([&[letter], word.as_slice()].concat()).or_insert(0.0) += x;
            *sum.entry([word.as_slice(), &[letter]].concat()).or_insert(0.0) -= x;
        }
        sum
    };
    let mut elements = vec![[B, B, B].iter().fold(Series::from([(vec![A], 1.0)]), |of, b| commutator(*b, &of))];
    for _ in 4..length {
        elements = elements.iter().flat_map(|element| [A, B].map(|letter| commutator(letter, element))).collect();
    }
    let column = |element: &Series<f64>| {
        DVector::from_iterator(1 << length, words(length).map(|word| element.get(&word).copied().unwrap_or(0.0)))
    };
    DMatrix::from_columns(&elements.iter().map(column).collect::<Vec<_>>())
}

/// All words of this length.
fn words(length: usize) -> impl Iterator<Item = Vec<u32>> {
    (0_u32..1 << length).map(move |bits| (0..length).map(|place| (bits >> place) & 1).collect())
}

/// The distance of the logarithm of a product of flows from `A + B`, in the words of each length from 1 on, up to
/// vanishing words.
fn by_length(parts: &[Part], longest: usize) -> Vec<f64> {
    let one: Series<f64> = one(&[A, B], |word| word.len() <= longest);
    let logarithm = logarithm(&times_shares(&one, parts.iter().copied()));
    let of_length = |length: usize| {
        let wanted = if length == 1 { 1.0 } else { 0.0 };
        let missed = DVector::from_iterator(1 << length, words(length).map(|word| logarithm[&word] - wanted));
        if length < 4 {
            return missed.amax();
        }
        let vanishing = vanishing(length);
        let inverse = vanishing.clone().pseudo_inverse(1e-9).expect("a matrix");
        (&missed - &vanishing * (inverse * &missed)).amax()
    };
    (1..=longest).map(of_length).collect()
}

/// The inverse processor, the kernel, and the processor.
fn processed(scheme: &ProcessedScheme) -> Vec<Part> {
    let out: Vec<Part> = scheme.processor().collect();
    let back = out.iter().rev().map(|&(flow, share, gradient)| (flow, -share, -gradient));
    back.chain(shares(&scheme.kernel())).chain(out.iter().copied()).collect()
}

/// The whole satisfies the conditions of its order and the kernel alone those of order 2; the next order's conditions
/// fail.
#[test]
fn processed_splittings_satisfy_their_order_conditions() {
    for scheme in ProcessedScheme::ALL {
        let order = usize::try_from(scheme.order()).unwrap();
        let missed = by_length(&processed(&scheme), order + 1);
        let (beyond, within) = missed.split_last().unwrap();
        let worst = within.iter().copied().fold(0.0, f64::max);
        let alone = by_length(&shares(&scheme.kernel()).collect::<Vec<_>>(), 3);
        println!("{}: {worst:.1e}, then {beyond:.1e}; the kernel alone {:.1e}", scheme.name(), alone[2]);
        assert!(worst < 1e-14, "{}: {worst:e}", scheme.name());
        assert!(*beyond > 1e-6, "{}: {beyond:e}", scheme.name());
        assert!(alone[0].max(alone[1]) < 1e-14 && alone[2] > 1e-4, "{}: {alone:?}", scheme.name());
    }
}

/// A fourth drift reduces the error at order 7 to less than a tenth.
#[test]
fn a_fourth_drift_is_worth_its_cost() {
    let [three, four] =
        [ProcessedScheme::SIX_A, ProcessedScheme::SIX_C].map(|scheme| by_length(&processed(&scheme), 7)[6]);
    assert!(four < 0.1 * three, "{three:e}, {four:e}");
}

#[test]
fn a_wrong_digit_of_a_processor_is_found() {
    let mut parts = processed(&ProcessedScheme::SIX_A);
    parts[3].1 += 1e-9;
    assert!(by_length(&parts, 6).into_iter().fold(0.0, f64::max) > 1e-10);
}

/// All conditions of the schemes that rely on a quadratic kinetic energy.
#[test]
fn nystrom_splittings_satisfy_all_their_order_conditions() {
    use SplittingScheme as Scheme;
    for scheme in [Scheme::NYSTROM_6, Scheme::NYSTROM_11, Scheme::NYSTROM_14, Scheme::FORCE_GRADIENT_5] {
        let order = usize::try_from(scheme.order()).unwrap();
        let missed = by_length(&shares(&scheme).collect::<Vec<_>>(), order + 1);
        let (beyond, within) = missed.split_last().unwrap();
        let worst = within.iter().copied().fold(0.0, f64::max);
        println!("{}: {worst:.1e}, then {beyond:.1e}", scheme.name());
        // The published coefficients have fifteen digits.
        assert!(worst < 1e-13 && *beyond > 1e-8, "{}: {worst:e}, {beyond:e}", scheme.name());
    }
}
