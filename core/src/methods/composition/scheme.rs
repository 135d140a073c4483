//! The published coefficients of symmetric compositions.

#![allow(clippy::excessive_precision, clippy::unreadable_literal)] // the digits are those of the papers

use alloc::vec::Vec;

/// The coefficients `γ_1, …, γ_s` of a symmetric composition, `γ_{s+1−i} = γ_i` and `Σ γ_i = 1`.
///
/// # Examples
///
/// ```
/// use liestep::methods::CompositionScheme;
/// let scheme = CompositionScheme::KAHAN_LI_8;
/// assert_eq!((scheme.order(), scheme.stages().count()), (8, 17));
/// assert!((scheme.stages().sum::<f64>() - 1.0).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompositionScheme {
    name: &'static str,
    base: u32,
    order: u32,
    half: &'static [f64],
}

impl CompositionScheme {
    schemes! {
        /// Order 4 in five stages. \[Su90\]
        SUZUKI_4 = Self::new("Suzuki 4", 2, 4, &[0.41449077179437573714, 0.41449077179437573714,
            -0.65796308717750294857]);

        /// Order 6 in nine stages. \[KL97\]
        KAHAN_LI_6 = Self::new("Kahan-Li 6", 2, 6, &[0.39216144400731413927925056, 0.33259913678935943859974864,
            -0.70624617255763935980996482, 0.08221359629355080023149045, 0.79854399093482996339895035]);

        /// Order 8 in seventeen stages. \[KL97\]
        KAHAN_LI_8 = Self::new("Kahan-Li 8", 2, 8, &[0.13020248308889008087881763, 0.56116298177510838456196441,
            -0.38947496264484728640807860, 0.15884190655515560089621075, -0.39590389413323757733623154,
            0.18453964097831570709183254, 0.25837438768632204729397911, 0.29501172360931029887096624,
            -0.60550853383003451169892108]);

        /// Order 10 in thirty-five stages. \[SS05\]
        SOFRONIOU_SPALETTA_10 = Self::new("Sofroniou-Spaletta 10", 2, 10, &[0.078795722521686419263907679337684,
            0.31309610341510852776481247192647, 0.027918383235078066109520273275299,
            -0.22959284159390709415121339679655, 0.13096206107716486317465685927961,
            -0.26973340565451071434460973222411, 0.074973343155891435666137105641410,
            0.11199342399981020488957508073640, 0.36613344954622675119314812353150,
            -0.39910563013603589787862981058340, 0.10308739852747107731580277001372,
            0.41143087395589023782070411897608, -0.0048663605831352617621956593099771,
            -0.39203335370863990644808193642610, 0.051942502962449647037182904015976,
            0.050665090759924496335874344156866, 0.049674370639729879054568800279461,
            0.049317735759594537917680008339338]);

        /// Order 6 in five stages of a method of order 4; of a step of order 2 it is of order 2. \[Su90\]
        SUZUKI_6 = Self::new("Suzuki 4 to 6", 4, 6, &[0.37306582773327282478, 0.37306582773327282478,
            -0.49226331093309129910]);

        /// Order 8 in five stages of a method of order 6; of a step of order 2 it is of order 2. \[Su90\]
        SUZUKI_8 = Self::new("Suzuki 6 to 8", 6, 8, &[0.35958464934999225261, 0.35958464934999225261,
            -0.43833859739996901045]);
    }

    /// Coefficients of the user's: `half` lists the first half and the middle one; the composition has the order
    /// `order` if the composed method has the even order `base`.
    ///
    /// # Panics
    ///
    /// An empty list panics; in a constant, at compile time.
    #[must_use]
    pub const fn new(name: &'static str, base: u32, order: u32, half: &'static [f64]) -> Self {
        assert!(!half.is_empty(), "a composition has at least one stage");
        Self { name, base, order, half }
    }

    pub(crate) const fn half(&self) -> &'static [f64] {
        self.half
    }

    /// The order of the composed method that the coefficients were derived for. If the composed method has a lower
    /// order, so has the composition.
    #[must_use]
    pub fn base(&self) -> u32 {
        self.base
    }

    /// All the coefficients, in order.
    pub fn stages(&self) -> impl Iterator<Item = f64> + use<> {
        let half = self.half;
        half.iter().chain(half.iter().rev().skip(1)).copied()
    }

    /// The distinct coefficients, and for each stage the index of its coefficient among them.
    pub(super) fn distinct(&self) -> (Vec<f64>, Vec<usize>) {
        let mut distinct: Vec<f64> = Vec::new();
        let places = self.stages().map(|gamma| {
            distinct.iter().position(|other| other.to_bits() == gamma.to_bits()).unwrap_or_else(|| {
                distinct.push(gamma);
                distinct.len() - 1
            })
        });
        let places = places.collect();
        (distinct, places)
    }

    /// The largest `|γ_i|`: the limit on the step is that of the composed method divided by this number.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.half.iter().fold(0.0, |largest, gamma| gamma.abs().max(largest))
    }
}
