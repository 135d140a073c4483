//! Reductions: statistics of all members, accumulated while they run.
//!
//! Chunks accumulate in the order of their members, and are merged in their own order, so that the bits of a sum don't
//! depend on who computed which.

use core::ops::Range;
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// The kind of a reduction.
#[derive(Clone, Debug, PartialEq)]
pub enum Reduction {
    /// Count, mean, variance and range.
    Moments,
    /// Counts in equal parts of a range.
    Histogram {
        /// The ends of the range.
        range: Range<f64>,
        /// The number of parts.
        bins: usize,
    },
    /// Counts by size, of any range, from which medians and other [quantiles](Quantiles::at) are read.
    Quantiles,
}

/// The result of a reduction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Summary {
    /// The result of [`Reduction::Moments`].
    Moments(Moments),
    /// The result of [`Reduction::Histogram`].
    Histogram(Histogram),
    /// The result of [`Reduction::Quantiles`].
    Quantiles(Quantiles),
}

/// Counts of values by sign, power of two, and the 128 equal parts between two powers: whole numbers, whose sums don't
/// depend on the order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Quantiles {
    /// Counts by the leading bits of values, in their order.
    counts: BTreeMap<i64, u64>,
    /// The count of NaNs.
    pub not_a_number: u64,
}

impl Quantiles {
    /// Low bits that are dropped: the size is left to one part in 128.
    const LEFT_OUT: u32 = 45;

    fn add(&mut self, value: f64) {
        if value.is_nan() {
            self.not_a_number += 1;
            return;
        }
        #[allow(clippy::cast_possible_wrap)] // without its sign
        let size = (value.abs().to_bits() >> Self::LEFT_OUT) as i64;
        *self.counts.entry(if value < 0.0 { -1 - size } else { size }).or_insert(0) += 1;
    }

    fn merge(&mut self, other: &Self) {
        self.not_a_number += other.not_a_number;
        for (size, count) in &other.counts {
            *self.counts.entry(*size).or_insert(0) += count;
        }
    }

    /// The quantile at this share of all values, from 0 to 1, with an error of at most a 256th of it; NaN without
    /// values.
    #[must_use]
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a share of members
    pub fn at(&self, share: f64) -> f64 {
        let all: u64 = self.counts.values().sum();
        let mut left = (share * all.saturating_sub(1) as f64) as u64;
        for (size, count) in &self.counts {
            if left < *count {
                let bits = (if *size < 0 { -1 - size } else { *size }) as u64;
                let [low, high] = [bits, bits + 1].map(|bits| f64::from_bits(bits << Self::LEFT_OUT));
                let middle = if high.is_finite() { 0.5 * (low + high) } else { low };
                return if *size < 0 { -middle } else { middle };
            }
            left -= count;
        }
        f64::NAN
    }
}

/// Count, mean, variance and range of values; values that aren't finite are counted apart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moments {
    /// The number of finite values.
    pub count: u64,
    /// The number of values that aren't finite.
    pub not_finite: u64,
    /// The mean of the finite values; zero without any.
    pub mean: f64,
    /// The sum of squares about the mean.
    pub squares: f64,
    /// The least value, or infinity.
    pub least: f64,
    /// The largest value, or minus infinity.
    pub largest: f64,
}

impl Moments {
    pub(crate) const NONE: Self =
        Self { count: 0, not_finite: 0, mean: 0.0, squares: 0.0, least: f64::INFINITY, largest: f64::NEG_INFINITY };

    /// The unbiased estimate of the variance; NaN for fewer than two values.
    #[must_use]
    #[allow(clippy::cast_precision_loss)] // members
    pub fn variance(&self) -> f64 {
        if self.count < 2 { f64::NAN } else { self.squares / (self.count - 1) as f64 }
    }

    /// Merges moments by T. F. Chan, G. H. Golub, R. J. `LeVeque`, *Updating formulae and a pairwise algorithm for
    /// computing sample variances*, 1979.
    #[allow(clippy::cast_precision_loss)] // members
    pub(crate) fn merge(&mut self, other: &Self) {
        self.not_finite += other.not_finite;
        if other.count == 0 {
            return;
        }
        if self.count == 0 {
            // The formula would multiply the infinite square of a large mean by zero.
            *self = Self { not_finite: self.not_finite, ..other.clone() };
            return;
        }
        let count = self.count + other.count;
        let (difference, share) = (other.mean - self.mean, other.count as f64 / count as f64);
        self.squares += other.squares + difference * difference * self.count as f64 * share;
        self.mean += difference * share;
        self.count = count;
        self.least = self.least.min(other.least);
        self.largest = self.largest.max(other.largest);
    }

    pub(crate) fn add(&mut self, value: f64) {
        let mut one = Self::NONE;
        if value.is_finite() {
            one = Self { count: 1, mean: value, least: value, largest: value, ..one };
        } else {
            one.not_finite = 1;
        }
        self.merge(&one);
    }
}

/// Counts of values in equal parts of a range.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Histogram {
    /// The ends of the range.
    pub range: Range<f64>,
    /// The count in each part, its beginning included.
    pub counts: Vec<u64>,
    /// The count of values below the range.
    pub below: u64,
    /// The count of values at the end of the range and above.
    pub above: u64,
    /// The count of NaNs.
    pub not_a_number: u64,
}

impl Histogram {
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the range
    fn add(&mut self, value: f64) {
        let place = (value - self.range.start) / (self.range.end - self.range.start) * self.counts.len() as f64;
        if place.is_nan() {
            self.not_a_number += 1;
        } else if place < 0.0 {
            self.below += 1;
        } else if let Some(count) = self.counts.get_mut(place as usize) {
            *count += 1;
        } else {
            self.above += 1;
        }
    }

    fn merge(&mut self, other: &Self) {
        self.counts.iter_mut().zip(&other.counts).for_each(|(count, other)| *count += other);
        self.below += other.below;
        self.above += other.above;
        self.not_a_number += other.not_a_number;
    }
}

impl Reduction {
    /// The mistake in a reduction's parameters, if there is one.
    pub(crate) fn mistake(&self) -> Option<String> {
        let Self::Histogram { range, bins } = self else { return None };
        if *bins == 0 {
            return Some("a histogram has at least one bin".to_owned());
        }
        let width = range.end - range.start;
        let is_range = width.is_finite() && width > 0.0;
        (!is_range).then(|| format!("the range of a histogram goes from a number to a larger one, not {range:?}"))
    }

    /// The summary of no values.
    pub(crate) fn begin(&self) -> Summary {
        match self {
            Self::Moments => Summary::Moments(Moments::NONE),
            Self::Histogram { range, bins } => Summary::Histogram(Histogram {
                range: range.clone(),
                counts: vec![0; *bins],
                below: 0,
                above: 0,
                not_a_number: 0,
            }),
            Self::Quantiles => Summary::Quantiles(Quantiles::default()),
        }
    }
}

impl Summary {
    pub(crate) fn add(&mut self, value: f64) {
        match self {
            Self::Moments(moments) => moments.add(value),
            Self::Histogram(histogram) => histogram.add(value),
            Self::Quantiles(quantiles) => quantiles.add(value),
        }
    }

    /// Adds another summary of the same reduction.
    pub(crate) fn merge(&mut self, other: &Self) {
        match (self, other) {
            (Self::Moments(own), Self::Moments(other)) => own.merge(other),
            (Self::Histogram(own), Self::Histogram(other)) => own.merge(other),
            (Self::Quantiles(own), Self::Quantiles(other)) => own.merge(other),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Histogram, Reduction, Summary};

    /// A summary after it was written and read.
    fn read(summary: &Summary) -> Summary {
        toml::from_str(&toml::to_string(summary).unwrap()).unwrap()
    }

    #[test]
    fn moments_are_those_of_the_values() {
        let mut all = Reduction::Moments.begin();
        for value in [1.0, 2.0, f64::NAN, 6.0] {
            all.add(value);
        }
        let mut more = Reduction::Moments.begin();
        for value in [-1.0, 7.0] {
            more.add(value);
        }
        all.merge(&Reduction::Moments.begin());
        let mut turned = more.clone();
        turned.merge(&all);
        all.merge(&more);
        let Summary::Moments(turned) = &turned else { panic!("they are moments") };
        assert_eq!((turned.count, turned.least, turned.largest), (5, -1.0, 7.0));
        let Summary::Moments(moments) = &all else { panic!("they are moments") };
        assert_eq!((moments.count, moments.not_finite, moments.least, moments.largest), (5, 1, -1.0, 7.0));
        // The mean of 1, 2, 6, −1 and 7 is 3, the squares 4 + 1 + 9 + 16 + 16.
        assert!((moments.mean - 3.0).abs() < 1e-15 && (moments.variance() - 46.0 / 4.0).abs() < 1e-14);
        assert_eq!(read(&all), all);
    }

    /// The squares of these values overflow.
    #[test]
    fn moments_of_large_values_are_numbers() {
        let mut all = Reduction::Moments.begin();
        all.add(f64::NAN);
        all.add(1e200);
        let Summary::Moments(moments) = &all else { panic!("they are moments") };
        assert_eq!((moments.count, moments.not_finite), (1, 1));
        assert_eq!([moments.mean, moments.squares].map(f64::to_bits), [1e200, 0.0].map(f64::to_bits));
        let mut merged = Reduction::Moments.begin();
        merged.merge(&all);
        assert_eq!(merged, all);
    }

    /// Quantiles are compared with the sorted values; parts merged in another order agree to the bit.
    #[test]
    fn quantiles_are_those_of_the_sorted_values() {
        let mut values: Vec<f64> = (0..999).map(|k| (f64::from(k) * 0.7).sin() * f64::from(k % 50).exp()).collect();
        let mut parts = [(); 3].map(|()| Reduction::Quantiles.begin());
        values.iter().enumerate().for_each(|(k, value)| parts[k % 3].add(*value));
        parts[1].add(f64::NAN);
        let [first, second, third] = &parts;
        let merged = [[first, second, third], [third, first, second]].map(|parts| {
            let mut all = Reduction::Quantiles.begin();
            for part in parts {
                all.merge(part);
            }
            all
        });
        assert_eq!(merged[0], merged[1]);
        assert_eq!(read(&merged[0]), merged[0]);
        let Summary::Quantiles(quantiles) = &merged[0] else { panic!("they are quantiles") };
        values.sort_by(f64::total_cmp);
        for place in [0_u16, 1, 100, 499, 500, 700, 998] {
            let (found, expected) = (quantiles.at(f64::from(place) / 998.0 + 1e-12), values[usize::from(place)]);
            assert!((found - expected).abs() <= expected.abs() / 256.0, "{place}: {found} {expected}");
        }
        assert_eq!(quantiles.not_a_number, 1);
        let mut few = Reduction::Quantiles.begin();
        for value in [f64::NEG_INFINITY, 0.0, f64::INFINITY] {
            few.add(value);
        }
        let Summary::Quantiles(few) = few else { panic!("they are quantiles") };
        assert!(few.at(0.0) < f64::MIN && few.at(1.0) > f64::MAX);
        assert!(few.at(0.5).abs() < 1e-300);
    }

    #[test]
    fn a_histogram_counts_from_the_beginning_of_each_part() {
        let mut histogram = Reduction::Histogram { range: -1.0..1.0, bins: 4 }.begin();
        for value in [-1.0, -0.6, -0.5, 0.99, 1.0, -1.5, f64::NAN, f64::INFINITY] {
            histogram.add(value);
        }
        let expected = |times: u64| {
            let counts = [2, 1, 0, 1].map(|count| count * times).to_vec();
            Summary::Histogram(Histogram {
                range: -1.0..1.0,
                counts,
                below: times,
                above: 2 * times,
                not_a_number: times,
            })
        };
        assert_eq!(histogram, expected(1));
        assert_eq!(read(&histogram), histogram);
        histogram.merge(&histogram.clone());
        assert_eq!(histogram, expected(2));
    }
}
