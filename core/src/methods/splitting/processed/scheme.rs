//! The coefficients of processed splittings.
//!
//! All were found for this library: kernels and processors by Levenberg and Marquardt's method on the order conditions
//! in the Lie algebra with `[B, [B, [B, A]]] = 0`, from random starts, with small errors at the next order, and
//! polished to 30 digits. `tests/accuracy/conditions.rs` has the conditions.

// Coefficients have all digits that were found, although a double has fewer.
#![allow(clippy::excessive_precision, clippy::unreadable_literal)]

use super::super::scheme::{Flow, SplittingScheme};

/// The coefficients of a processed splitting: a kernel for the steps, and a processor that is applied only at both ends
/// of a run.
///
/// A run of `n` steps with the kernel `K_h` and the processor `χ_h` is `χ_h ∘ K_hⁿ ∘ χ_h⁻¹`. It has the order of the
/// scheme although the kernel alone has order 2: most of the kernel's error is a change of coordinates, which the
/// processor removes. So a kernel has fewer conditions to satisfy, 3 in place of 6 for order 6, and with as many drifts
/// and kicks its error is smaller. Both consist of drifts and kicks, some with [force gradients](SplittingScheme), so
/// the whole is a Poisson map and conserves the momentum maps.
///
/// # Examples
///
/// ```
/// use liestep::methods::ProcessedScheme;
/// let scheme = ProcessedScheme::SIX_A;
/// assert_eq!((scheme.order(), scheme.kernel().drifts(), scheme.kernel().gradient_kicks()), (6, 3, 1));
/// ```
///
/// # Source
///
/// \[BCR99\], \[BCM06\] for processing, \[Ch97\] for the force gradient; see [`conventions`](crate::conventions). The
/// coefficients were found for this library.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProcessedScheme {
    name: &'static str,
    order: u32,
    kernel: SplittingScheme,
    /// The drift, kick and force gradient of each stage.
    processor: &'static [[f64; 3]],
    /// The last drift.
    last: f64,
}

impl ProcessedScheme {
    schemes! {
        /// Order 6 with three drifts and one force gradient a step.
        ///
        /// Its error is a sum of two terms of opposite signs. If they are of one size, halving the step reduces the
        /// error 17 to 56 times and not 64: the order measured between two steps is 4.1 to 5.8 then, down to the level
        /// of rounding. The error is less than one term alone would be: its size at a step counts, not its slope.
        SIX_A = Self::new("processed 3-6 a", 6, THREE_DRIFTS, &[
            [-0.0703026373535961342390651631159, 0.20665604926098297350745841313, 0.0286456827611767065874012365132],
            [-0.111704528879860710158274407152, -0.034640489261471661869693869713, -0.0118430410009511916400804816644],
            [0.554008729214240650588112644763, 0.190187950956113773204912119634, 0.0185118699025337784886053945875],
            [-0.456202211436371128197410636322, 0.000116279800890681322342555109914, 0.00520723290185722637308192844025],
            [0.321382297940377449531439929904, 0.092738754781874447784048152174, -0.0328529951970588503886503665355],
        ], 0.217876896053600086424265002259);

        /// Order 6 with the kernel of `SIX_A` and another processor.
        SIX_B = Self::new("processed 3-6 b", 6, THREE_DRIFTS, &[
            [0.0, -0.0753837272678498780127182547603, -0.024616012733644205316884684561],
            [-0.480437027036673811053472743691, -0.280916135925670772797257748164, 0.137598234836117268532228451324],
            [-0.0141783879163624734235258095302, 0.248576404673639870927110522567, -0.127792499363947432350360452806],
            [0.34237870613551988388933899794, 0.188911554438579190948875386659, 0.0421709043461003411446997962927],
            [-0.0964081844136876834211755873155, -0.00309426120493107782719806408365, -0.0267192366951326938516235246487],
        ], 0.326738727944971417247646984815);

        /// Order 6 with four drifts and two force gradients a step, for high accuracy.
        ///
        /// The terms of its error at order 7 are less than a tenth of those of `SIX_A`, so that a step is longer by more
        /// than the fourth drift costs. Its processor also removes what is a change of coordinates in the error at order 7:
        /// such a part changes the energy at the start, and with it the phase of a long run.
        SIX_C = Self::new("processed 4-6", 6, FOUR_DRIFTS, &[
            [-0.101264702457425487620399288992, 0.0441887687686495178898038943353, -0.0100710436766783696269498189896],
            [0.268895558282576827102468223465, -0.285867547466254908566692072404, 0.0828811902327909935818893464099],
            [-0.00891094361941925715472553689083, -0.422422381670053986246012854311, -0.069526939519528541578767432409],
            [0.0344564899441436554876352508904, 0.721226472604577792907454353951, 0.0298144728508830611655733895544],
            [0.045904196302490046022978617753, -0.15491091761405809984297066735, -0.0234677965010070326216692775401],
            [-0.489412870203560765946301411889, -0.0028338332629697542065384168351, 0.00289637746774981066489579745726],
        ], 0.149712833111085544043388383049);

        /// Order 4 with two drifts and two force gradients a step, for low accuracy.
        FOUR_A = Self::new("processed 2-4 a", 4, TWO_DRIFTS, &[
            [0.0, 0.1037567817473591791555719186, -0.00119642846777136052003310969941],
            [-0.277154059845793467558282630705, 0.00202243534277590415038351679294, 0.00539013931637204767996689030059],
            [0.32760645783074108212932442421, -0.210221055067421363064861438076, -0.00482158382246573022003310969941],
        ], -0.154894235962233894329947796187);

        /// Order 4, as `FOUR_A`, with another kernel.
        FOUR_B = Self::new("processed 2-4 b", 4, OTHER_TWO_DRIFTS, &[
            [0.108747341864335639838158465321, -0.212769547452841184020360402899, 0.00271191666087527843437997569787],
            [0.160853475914733953407698986988, 0.14153890479160099979925851758, 0.0182482077750180722343799756979],
            [-0.264705925479093689235625081075, 0.357012349828013705227340805194, 0.000139103223083609794379975697874],
        ], 0.280886814866797616996006548641);

        /// Order 4 with the shortest processor, for the lowest accuracy. Effective order 4 asks of a kernel of one
        /// drift and one kick only a twelfth of the force gradient in its kick; this kernel is two such steps.
        FOUR_C = Self::new("processed 2-4 c", 4, TWICE_ONE_DRIFT, &[
            [0.054864149511049415639146885511, 0.094931451225437736688605888439, -0.000053717973010598082549787894],
            [-0.109728299022098367694014751199, -0.094931451225439340968587073141, -0.000935151310587703304089004259],
        ], 0.054864149511047347774886680987);
    }

    /// Coefficients of the user's: the order is that of the whole method; `processor` is `χ` at the end of a run, by
    /// drift, kick and force gradient of each stage, and `last` its last drift.
    #[must_use]
    pub const fn new(
        name: &'static str,
        order: u32,
        kernel: SplittingScheme,
        processor: &'static [[f64; 3]],
        last: f64,
    ) -> Self {
        Self { name, order, kernel, processor, last }
    }

    /// The splitting whose steps are processed.
    #[must_use]
    pub fn kernel(&self) -> SplittingScheme {
        self.kernel
    }

    /// The shares of the processor `χ` at the end of a run, each with its share of the force gradient.
    pub fn processor(&self) -> impl Iterator<Item = (Flow, f64, f64)> + use<> {
        let stage = |&[drift, kick, gradient]: &[f64; 3]| [(Flow::Drift, drift, 0.0), (Flow::Kick, kick, gradient)];
        self.processor.iter().flat_map(stage).chain([(Flow::Drift, self.last, 0.0)])
    }
}

/// The kernel with three drifts and the gradient in one kick, for the three conditions of effective order 6.
const THREE_DRIFTS: SplittingScheme = SplittingScheme::new(
    "kernel 3-6",
    2,
    Flow::Kick,
    &[
        0.23788706474829719456562710991,
        0.56826103839186301271453174471,
        0.26211293525170280543437289009,
        -0.13652207678372602542906348942,
    ],
)
.with_gradients(&[0.0164011128160783278247123891002, 0.0, 0.0, 0.0]);

/// The kernel with four drifts and the gradient in two kicks. Its error at order 7 is least with terms of more kicks
/// weighted less.
const FOUR_DRIFTS: SplittingScheme = SplittingScheme::new(
    "kernel 4-6",
    2,
    Flow::Drift,
    &[
        -0.052316433218430974276221769166,
        0.180007275468998064813878919347,
        0.391635863746805837944065008588,
        0.319992724531001935186121080653,
        0.321361138943250272664313521155,
    ],
)
.with_gradients(&[0.0, 0.0, 0.0, 0.00686273698574202308472813275799]);

/// The kernel for the one condition of effective order 4, with the least error at order 5.
const TWO_DRIFTS: SplittingScheme = SplittingScheme::new(
    "kernel 2-4",
    2,
    Flow::Kick,
    &[0.233149591711226471352693488039, 0.5, 0.533700816577547057294613023921],
)
.with_gradients(&[0.0107620534858024267078342724616, 0.0, -0.00040683737877315244433145508716]);

/// Another kernel for the condition of [`TWO_DRIFTS`].
const OTHER_TWO_DRIFTS: SplittingScheme = SplittingScheme::new(
    "kernel 2-4",
    2,
    Flow::Kick,
    &[0.262935359903518271907729598992, 0.5, 0.474129280192963456184540802016],
)
.with_gradients(&[-0.00195607940665287845748730058811, 0.0, 0.0249128156824726384850253966564]);

/// The kernel with one kick in the middle of each half, for the one condition of effective order 4.
const TWICE_ONE_DRIFT: SplittingScheme =
    SplittingScheme::new("kernel 2-4", 2, Flow::Drift, &[0.25, 0.5, 0.5]).with_gradients(&[0.0, 1.0 / 96.0, 0.0]);
