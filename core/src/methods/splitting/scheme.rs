//! The published coefficients of kinetic-potential splittings.

// Coefficients have the digits of the papers, although a double has fewer.
#![allow(clippy::excessive_precision, clippy::unreadable_literal)]

use crate::methods::composition::CompositionScheme;

/// The first and, by symmetry, last flow of a splitting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// The kinetic flow: free motion of the body.
    Drift,
    /// The potential's flow: the momentum changes, the attitude doesn't.
    Kick,
}

/// The coefficients of a symmetric splitting: the shares of the step for alternating drifts and kicks.
///
/// The Nyström schemes rely on a kinetic energy that is quadratic in the momentum: some commutators of kicks then
/// vanish. The near-integrable schemes are for a potential that is small beside the kinetic energy. The error of
/// `(8, 6, 4)` is a sum of terms of the orders `ε h⁸`, `ε² h⁶`, `ε³ h⁴` with the ratio `ε` of the two energies. So the
/// order in `h` alone is the last of the numbers, while at usual steps the first is observed.
///
/// Kicks may include the *force gradient*: besides `b_i h τ` the kick of `g_i h³ U`, where `U = −½ τ·J⁻¹τ` is the
/// potential's commutator with the kinetic energy. Like the potential it is a function of the attitude, so the kick
/// stays explicit and symplectic. It costs one [derivative](crate::mechanics::Effect::kick_derivative) of the torque,
/// and removes an error that otherwise takes more kinetic flows, some of them negative.
///
/// # Examples
///
/// ```
/// use liestep::methods::SplittingScheme;
/// let scheme = SplittingScheme::NYSTROM_11;
/// assert_eq!((scheme.order(), scheme.drifts(), scheme.kicks()), (6, 11, 11));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplittingScheme {
    name: &'static str,
    order: u32,
    first: Flow,
    half: &'static [f64],
    /// The force gradients of the shares of `half`; zero for drifts, and for all shares after the last entry.
    gradients: &'static [f64],
}

impl SplittingScheme {
    schemes! {
        /// Order 2: half a kick, the kinetic flow, half a kick. With the kinetic term of (3.13) this is (3.13).
        STRANG = Self::new("Strang", 2, Flow::Kick, &[0.5, 1.0]);

        /// `(4, 2)` in two stages, for a small potential. \[ML95\]
        NEAR_INTEGRABLE_4_2 = Self::new("near-integrable (4, 2)", 2, Flow::Drift,
            &[0.2113248654051871177454256097490212721762, 0.5, 0.5773502691896257645091487805019574556476]);

        /// `(8, 6, 4)` in seven stages, for a small potential. \[BCF13\]
        NEAR_INTEGRABLE_8_6_4 = Self::new("near-integrable (8, 6, 4)", 4, Flow::Drift,
            &[0.0711334264982231177779387300061549964174, 0.183083687472197221961703757166430291072,
            0.241153427956640098736487795326289649618, 0.310782859898574869507522291054262796375,
            0.521411761772814789212136078067994229991, -0.0265646185119588006972121379164987592663,
            -0.333698616227678005726562603400438876027, 0.0653961422823734184559721793911134363710]);

        /// `(10, 6, 4)` in eight stages, for a small potential. \[BCF13\]
        NEAR_INTEGRABLE_10_6_4 = Self::new("near-integrable (10, 6, 4)", 4, Flow::Drift,
            &[0.03809449742241219545697532230863756534060, 0.09585888083707521061077150377145884776921,
            0.1452987161169137492940200726606637497442, 0.2044461531429987806805077839164344779763,
            0.2076276957255412507162056113249882065158, 0.2170703479789911017143385924306336714532,
            0.4359097036515261592231548624010651844006, -0.01737538195906509300561788011852699719871,
            -0.6538612258327867093807117373907094120024]);

        /// Order 4 in six stages. \[BM02\], `SRKN6b`
        NYSTROM_6 = Self::new("Nyström 6-4", 4, Flow::Kick, &[0.0829844064174052, 0.245298957184271,
            0.396309801498368, 0.604872665711080, -0.0390563049223486, -0.350171622895351, 0.1195241940131508]);

        /// Order 6 in eleven stages. \[BM02\], `SRKN11b`
        NYSTROM_11 = Self::new("Nyström 11-6", 6, Flow::Kick, &[0.0414649985182624, 0.123229775946271,
            0.198128671918067, 0.290553797799558, -0.0400061921041533, -0.127049212625417, 0.0752539843015807,
            -0.246331761062075, -0.0115113874206879, 0.357208872795928, 0.2366699247869311, 0.20477705429147]);

        /// Order 6 in fourteen stages. \[BM02\], `SRKN14a`
        NYSTROM_14 = Self::new("Nyström 14-6", 6, Flow::Drift, &[0.0378593198406116, 0.09171915262446165,
            0.102635633102435, 0.183983170005006, -0.0258678882665587, -0.05653436583288827, 0.314241403071447,
            0.004914688774712854, -0.130144459517415, 0.143761127168358, 0.106417700369543, 0.328567693746804,
            -0.00879424312851058, -0.196411466486454234, 0.20730506905689536]);

        /// Order 8 in seventeen stages: Strang's splitting composed. \[KL97\]
        KAHAN_LI_8 = Self::new("Kahan-Li 8", 8, Flow::Kick,
            &composed_strang::<18>(CompositionScheme::KAHAN_LI_8.half()));

        /// Order 10 in thirty-five stages: Strang's splitting composed. \[SS05\]
        SOFRONIOU_SPALETTA_10 = Self::new("Sofroniou-Spaletta 10", 10, Flow::Kick,
            &composed_strang::<36>(CompositionScheme::SOFRONIOU_SPALETTA_10.half()));

        /// Order 4 in two stages, with force gradients: Gauss's nodes and weights. \[Ch97\], algorithm B
        FORCE_GRADIENT_2 = Self::new("force gradient 2-4", 4, Flow::Drift,
            &[0.2113248654051871177454256097490212721762, 0.5,
            0.5773502691896257645091487805019574556476]).with_gradients(&[0.0,
            0.0111645496846301127696897357705886513774]);

        /// Order 4 in four stages, `(8, 4)` for a small potential: Gauss's nodes and weights, \[LR01\], with force
        /// gradients in the inner two kicks that cancel the commutator.
        FORCE_GRADIENT_4 = Self::new("force gradient 4-4", 4, Flow::Drift,
            &[0.0694318442029737123880267555535952474521, 0.1739274225687269286865319746109997036177,
            0.2605776340045981552106403648947824089476, 0.3260725774312730713134680253890002963823,
            0.3399810435848562648026657591032446872006]).with_gradients(&[0.0, 0.0, 0.0,
            0.0033967750482086013315321577834921437970]);

        /// Order 6 in five stages, with force gradients. \[OMF02\]
        FORCE_GRADIENT_5 = Self::new("force gradient 5-6", 6, Flow::Drift, &[0.1097059723948682, 0.2693315848935301,
            0.4140632267310831, 1.1319803486515564, -0.0237691991259513, -1.8026238670901730]).with_gradients(&[0.0,
            0.0017284322679412332, 0.0, 0.0, 0.0, -0.02649277286832104]);
    }

    /// Coefficients of the user's: those of alternating drifts and kicks, from the first to the middle one.
    ///
    /// # Panics
    ///
    /// Fewer than two coefficients panic; in a constant, at compile time.
    #[must_use]
    pub const fn new(name: &'static str, order: u32, first: Flow, half: &'static [f64]) -> Self {
        assert!(half.len() >= 2, "a splitting has a drift and a kick at least");
        Self { name, order, first, half, gradients: &[] }
    }

    /// Adds shares `g_i` of the force gradient: one for each drift and kick, from the first on; missing ones are zero,
    /// and those of drifts are ignored.
    #[must_use]
    pub const fn with_gradients(self, gradients: &'static [f64]) -> Self {
        Self { gradients, ..self }
    }

    /// All shares of the step, in order.
    pub fn shares(&self) -> impl Iterator<Item = (Flow, f64)> + use<> {
        let (half, first) = (self.half, self.first);
        let shares = half.iter().chain(half.iter().rev().skip(1)).copied();
        let other = if first == Flow::Drift { Flow::Kick } else { Flow::Drift };
        [first, other].into_iter().cycle().zip(shares)
    }

    /// The shares of the force gradient in each of [`shares`](Self::shares), zero in drifts.
    pub fn gradients(&self) -> impl Iterator<Item = f64> + use<> {
        let (count, gradients) = (self.half.len(), self.gradients);
        let drift = usize::from(self.first == Flow::Kick);
        (0..2 * count - 1).map(move |index| {
            let from_ends = index.min(2 * (count - 1) - index);
            if index % 2 == drift { 0.0 } else { gradients.get(from_ends).copied().unwrap_or(0.0) }
        })
    }

    /// Whether any kick has a share of the force gradient.
    #[must_use]
    pub fn has_gradients(&self) -> bool {
        self.gradients().any(|share| share != 0.0)
    }

    /// The number of kicks with a force gradient per step of a long run.
    #[must_use]
    pub fn gradient_kicks(&self) -> usize {
        let joined = self.gradients().next().is_some_and(|share| share != 0.0);
        self.gradients().filter(|share| *share != 0.0).count() - usize::from(joined)
    }

    /// The number of kinetic flows per step of a long run, in which the last of a step and the first of the next are
    /// merged.
    #[must_use]
    pub fn drifts(&self) -> usize {
        self.in_a_step_of_many(Flow::Drift)
    }

    /// The number of kicks per step of a long run.
    #[must_use]
    pub fn kicks(&self) -> usize {
        self.in_a_step_of_many(Flow::Kick)
    }

    fn in_a_step_of_many(&self, flow: Flow) -> usize {
        self.shares().filter(|share| share.0 == flow).count() - usize::from(self.first == flow)
    }
}

/// The shares of half a kick, the kinetic flow and half a kick for each `γ`, with neighbouring kicks merged: `N` of
/// them from the first to the middle one, twice as many as there are `γ`.
const fn composed_strang<const N: usize>(gammas: &[f64]) -> [f64; N] {
    let (mut shares, mut stage, mut before) = ([0.0; N], 0, 0.0);
    while 2 * stage < N {
        shares[2 * stage] = 0.5 * (before + gammas[stage]);
        shares[2 * stage + 1] = gammas[stage];
        before = gammas[stage];
        stage += 1;
    }
    shares
}
