//! Gauss collocation on the cotangent bundle of all matrices, for continuous Lagrangians of one body on any matrix group.

use alloc::vec::Vec;

use nalgebra::{SMatrix, SVector};

use super::coefficients::Coefficients;
use super::settling::{Changes, MOST_ITERATIONS, Next};
use crate::error::{SetupError, StepError};
use crate::groups::{Advected as _, LieGroup};
use crate::mechanics::{ContinuousLagrangian, Legendre, Matrix, Term, Vector, check_inertia, check_velocity};
use crate::motion::{ElapsedTime, Factor, Integrator, Motion, State, StepReport, write_row};
use crate::numbers::{Coordinates, carried_sum};

roots!();

/// A step of order `4 PAIRS`, by Gauss collocation with `2 PAIRS` stages in attitude and conjugate momentum, for any
/// smooth `l(ξ, w)` on a group of `N` × `N` matrices.
///
/// The Hamiltonian `h(μ, w)` is a function on `T*GL(N)`, with `μ_k = tr(pᵀ g E_k)` and `w = g⁻¹·a_0`. Its canonical
/// equations are
///
/// ```text
/// ġ = g ξ̂        ṗ = −p ξ̂ᵀ + g⁻ᵀ Γ        ξ = ∂h/∂μ,    Γ_ij = −⟨∂l/∂w, e_ij·w⟩
/// ```
///
/// # Invariants
///
/// Gauss collocation preserves linear and quadratic invariants. So attitudes stay in groups that are defined by such
/// relations: rotations (`g gᵀ = I`), rigid motions, unit quaternions, `SL(2)`, the Heisenberg group, translations.
/// Momenta `p` that differ only in directions normal to the group have the same `μ`. Functions of `g` commute, so the
/// step, which is symplectic and maps the group to itself, maps each leaf of such momenta to a leaf. The induced map of
/// `(g, μ)` is therefore well defined, and symplectic on `T*G`. The step commutes with multiplications from the left,
/// so it is a Poisson map of `(μ, w)`. Momentum maps are quadratic, hence conserved to rounding, and a run sums with
/// compensation. A step of `−h` undoes one of `h`. The energy error is of the order of the method, and doesn't drift.
///
/// # Cost
///
/// The stages are solved to rounding by fixed-point iteration, each of `2 PAIRS` right-hand sides. For a body on SO(3)
/// under a potential [`Stepper::collocated`](crate::Stepper::collocated) is several times cheaper: it integrates eight
/// numbers, in SIMD lanes.
///
/// # Examples
///
/// ```
/// use liestep::effects::{Gravity, RigidBody};
/// use liestep::methods::CotangentGauss;
/// use liestep::{NonstandardInertia, SO3};
/// use nalgebra::Vector3;
///
/// let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 1.5, 1.0))? };
/// let top = body + Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.1, 0.0, 1.0), up: Vector3::z() };
/// let gauss = CotangentGauss::<_, 4, 3>::new(top, 0.1)?;
/// let (mut attitude, mut momentum) = (SO3::identity(), Vector3::new(1.0, 4.0, 9.0));
/// let energy = gauss.energy(&attitude, &momentum)?;
/// for _ in 0..100 {
///     (attitude, momentum) = gauss.step(&attitude, &momentum)?;
/// }
/// assert!((gauss.energy(&attitude, &momentum)? - energy).abs() < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Source
///
/// \[HLW06\], theorems IV.2.2 and VI.4.2; see [`conventions`](crate::conventions).
#[derive(Clone, Debug)]
pub struct CotangentGauss<L: Term, const PAIRS: usize, const N: usize> {
    lagrangian: L,
    spatial: L::Advected,
    h: f64,
    coefficients: Coefficients<PAIRS>,
}

/// Rounding errors of the sums of attitude and momentum, which the next step adds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct CotangentCarry<const N: usize, const D: usize> {
    attitude: SMatrix<f64, N, N>,
    momentum: SVector<f64, D>,
}

impl<const N: usize, const D: usize> CotangentCarry<N, D> {
    fn nothing() -> Self {
        Self { attitude: SMatrix::zeros(), momentum: SVector::zeros() }
    }
}

/// The increments of attitude and momentum over a step, and the iterations that they took.
struct Change<const N: usize, const D: usize> {
    attitude: SMatrix<f64, N, N>,
    momentum: SVector<f64, D>,
    iterations: u32,
}

impl<const N: usize, const D: usize> Change<N, D> {
    /// The sums, and their rounding errors.
    fn added<G>(
        &self,
        attitude: &G,
        momentum: &SVector<f64, D>,
        carry: &CotangentCarry<N, D>,
    ) -> Result<((G, SVector<f64, D>), CotangentCarry<N, D>), StepError>
    where
        G: LieGroup<Scalar = f64, Vector = SVector<f64, D>, Matrix = SMatrix<f64, N, N>>,
    {
        let (attitude, of_attitude) = carried_sum(&attitude.matrix(), &self.attitude, &carry.attitude);
        let (momentum, of_momentum) = carried_sum(momentum, &self.momentum, &carry.momentum);
        if !Coordinates::is_finite(&momentum) {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        let carry = CotangentCarry { attitude: of_attitude, momentum: of_momentum };
        Ok(((G::from_matrix_unchecked(attitude), momentum), carry))
    }
}

/// A phase-space point `(g, p)`, or an increment of it.
type Phase<const N: usize> = [SMatrix<f64, N, N>; 2];

/// The increments `L_j = h b_j f(Y_j)` at the stages of the first half and at their mirror images.
type Stages<const PAIRS: usize, const N: usize> = [[Phase<N>; PAIRS]; 2];

/// Matrices of a single group, of size `N`; products of groups have tuples of matrices instead.
#[diagnostic::on_unimplemented(
    message = "`CotangentGauss` integrates on one group, of {N} × {N} matrices",
    label = "this Lagrangian is of several bodies, or of matrices of another size",
    note = "several bodies have no collocation: step them by `Stepper`; of one group `N` is the size of its matrices"
)]
pub trait MatrixOfOneGroup<const N: usize> {}

impl<const N: usize> MatrixOfOneGroup<N> for SMatrix<f64, N, N> {}

// This bound stands in a separate block, so that a Lagrangian without a continuous limit gets one error message and not
// a second one about its matrices.
impl<L: ContinuousLagrangian<Scalar = f64>, const PAIRS: usize, const N: usize> CotangentGauss<L, PAIRS, N> {
    /// A collocation with checked parameters and step.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] for an invalid parameter, [`SetupError::NonFinite`] for an advected parameter that
    /// isn't finite, [`SetupError::SingularKinetic`] or [`SetupError::NegativeKinetic`] if a momentum doesn't determine
    /// a velocity at rest, [`SetupError::InvalidStep`] for a step that isn't finite.
    pub fn new(lagrangian: L, h: f64) -> Result<Self, SetupError>
    where
        Matrix<L>: MatrixOfOneGroup<N>,
    {
        const {
            assert!(
                PAIRS > 0 && PAIRS <= 8,
                "collocation needs a pair of stages, and doubles have no use for more than 8"
            );
        }
        lagrangian.validate()?;
        let spatial = lagrangian.advected();
        if !spatial.is_finite() {
            return Err(SetupError::NonFinite { what: "advected parameter" });
        }
        if !h.is_finite() {
            return Err(SetupError::InvalidStep { step: h });
        }
        check_inertia::<L::Group>(&lagrangian.velocity_hessian(&Vector::<L>::zero(), &spatial))?;
        Ok(Self { lagrangian, spatial, h, coefficients: Coefficients::gauss() })
    }
}

impl<L, const PAIRS: usize, const N: usize, const D: usize> CotangentGauss<L, PAIRS, N>
where
    L: ContinuousLagrangian<Scalar = f64>,
    L::Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>, Matrix = SMatrix<f64, N, N>>,
{
    /// The Lagrangian.
    pub const fn lagrangian(&self) -> &L {
        &self.lagrangian
    }

    /// The step, s.
    pub const fn step_size(&self) -> f64 {
        self.h
    }

    /// The advected parameters in the body frame, at this attitude.
    pub fn advected(&self, attitude: &L::Group) -> L::Advected {
        self.spatial.seen_from(attitude)
    }

    /// The energy `h(μ, w)`, (1.16), in J.
    ///
    /// # Errors
    ///
    /// The errors of [`ContinuousLagrangian::velocity`].
    pub fn energy(&self, attitude: &L::Group, momentum: &SVector<f64, D>) -> Result<f64, StepError> {
        self.lagrangian.hamiltonian(momentum, &self.advected(attitude))
    }

    /// Attitude and body momentum after a step. A [motion](Self::start) of many steps has less rounding error, because
    /// it compensates its sums.
    ///
    /// # Errors
    ///
    /// [`StepError::NotConverged`] if the step is too long for the iteration, [`StepError::NonFinite`] if the result
    /// isn't finite, and the errors of [`ContinuousLagrangian::velocity`].
    pub fn step(
        &self,
        attitude: &L::Group,
        momentum: &SVector<f64, D>,
    ) -> Result<(L::Group, SVector<f64, D>), StepError> {
        let change = self.change(self.h, attitude, momentum)?;
        Ok(change.added(attitude, momentum, &CotangentCarry::nothing())?.0)
    }

    /// A motion from an attitude (body to space) and a body velocity, to be [observed](CotangentGauss::observed).
    ///
    /// # Errors
    ///
    /// [`SetupError`] if the attitude isn't in the group or the velocity isn't finite, and
    /// [`SetupError::AmbiguousVelocity`] if the inverse Legendre transform of its momentum is another velocity.
    pub fn start(
        &self,
        attitude: impl Into<L::Group>,
        velocity: SVector<f64, D>,
    ) -> Result<State<L::Group, L::Advected, CotangentCarry<N, D>>, SetupError> {
        let attitude = attitude.into();
        let defect = attitude.defect();
        // The tolerance is that of `Stepper::start_with_momentum`.
        let is_in_group = defect <= f64::EPSILON * 1e4;
        if !is_in_group {
            return Err(SetupError::NotInGroup { defect });
        }
        if !Coordinates::is_finite(&velocity) {
            return Err(SetupError::NonFinite { what: "velocity" });
        }
        let advected = self.advected(&attitude);
        let momentum = self.lagrangian.momentum(&velocity, &advected);
        if L::LEGENDRE == Legendre::Nonlinear {
            let found = self.lagrangian.velocity(&momentum, &advected);
            let found = found.unwrap_or_else(|_| SVector::from_element(f64::NAN));
            let inertia = self.lagrangian.velocity_hessian(&SVector::zeros(), &advected);
            check_velocity::<f64, _>(&velocity, &found, &momentum, &inertia)?;
        }
        if !Coordinates::is_finite(&momentum) {
            return Err(SetupError::NonFinite { what: "momentum" });
        }
        let motion = Motion { attitude, momentum, advected, steps: 0 };
        Ok(State { motion, kept: CotangentCarry::nothing(), elapsed: ElapsedTime::nothing() })
    }

    /// The increments of a step of any length.
    fn change(&self, h: f64, attitude: &L::Group, momentum: &SVector<f64, D>) -> Result<Change<N, D>, StepError> {
        let start = [attitude.matrix(), lifted::<L::Group, N, D>(attitude, momentum)];
        let rate = self.rate(&start)?;
        let weights = self.coefficients.weights.map(|weight| h * weight);
        let mut stages: Stages<PAIRS, N> = [weights.map(|weight| rate.map(|part| part * weight)); 2];
        let (mut changes, mut last, mut is_settled) = (Changes::none(), false, false);
        let (mut residual, mut iterations) = (f64::INFINITY, 0);
        while !is_settled {
            if iterations == MOST_ITERATIONS {
                return Err(StepError::NotConverged { iterations, residual });
            }
            iterations += 1;
            let next = self.iterated(&start, &stages, &weights)?;
            let [of_attitude, of_momentum] = relative_changes(&start, &stages, &next);
            let change = of_attitude + of_momentum;
            residual = change.sqrt();
            if !change.is_finite() {
                return Err(StepError::NotConverged { iterations, residual });
            }
            stages = next;
            let judged = changes.judge(change, of_attitude);
            is_settled = last || judged == Next::Nothing;
            last = judged == Next::Once;
        }
        let zero = [SMatrix::zeros(); 2];
        let [attitude, conjugate] = combined(&zero, stages.as_flattened().iter().map(|stage| (1.0, stage)));
        // Differences stay small without cancellation: (g + Δg)ᵀ(p + Δp) − gᵀp = (g + Δg)ᵀΔp + Δgᵀp.
        let [g, p] = start;
        let momentum =
            momentum_of::<L::Group, N, D>(&[g + attitude, conjugate]) + momentum_of::<L::Group, N, D>(&[attitude, p]);
        Ok(Change { attitude, momentum, iterations })
    }

    /// The next iterate of the stages.
    fn iterated(
        &self,
        start: &Phase<N>,
        stages: &Stages<PAIRS, N>,
        weights: &[f64; PAIRS],
    ) -> Result<Stages<PAIRS, N>, StepError> {
        let mut next = *stages;
        let places = self.coefficients.places.as_flattened();
        for (i, next) in next.as_flattened_mut().iter_mut().enumerate() {
            let terms =
                places.iter().zip(stages.as_flattened()).map(|(column, stage)| (column.as_flattened()[i], stage));
            let change = combined(&[SMatrix::zeros(); 2], terms);
            let place = [0, 1].map(|part| start[part] + change[part]);
            *next = self.rate(&place)?.map(|part| part * weights[i % PAIRS]);
        }
        Ok(next)
    }

    /// The rates `ġ` and `ṗ`.
    fn rate(&self, place: &Phase<N>) -> Result<Phase<N>, StepError> {
        let [g, p] = place;
        let inverse = g.try_inverse().ok_or(StepError::Singular)?;
        let w = self.spatial.seen_through(g, &inverse);
        let velocity = self.lagrangian.velocity(&momentum_of::<L::Group, N, D>(place), &w)?;
        let hat = L::Group::hat(&velocity);
        let force = inverse.transpose() * self.lagrangian.diamond_matrix(&velocity, &w);
        Ok([g * hat, force - p * hat.transpose()])
    }
}

/// The sums of a run are compensated, and a run that fails leaves the state unchanged.
impl<L, const PAIRS: usize, const N: usize, const D: usize> Integrator for CotangentGauss<L, PAIRS, N>
where
    L: ContinuousLagrangian<Scalar = f64>,
    L::Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>, Matrix = SMatrix<f64, N, N>>,
{
    type Scalar = f64;
    type Motion = Motion<L::Group, L::Advected>;
    type Velocity = SVector<f64, D>;
    type Inertia = ();
    type State = State<L::Group, L::Advected, CotangentCarry<N, D>>;

    fn step(&self, state: &mut Self::State) -> Result<StepReport, StepError> {
        let change = self.change(self.h, &state.attitude, &state.momentum)?;
        let ((attitude, momentum), kept) = change.added(&state.attitude, &state.momentum, &state.kept)?;
        let motion = Motion { attitude, momentum, advected: self.advected(&attitude), steps: state.steps + 1 };
        *state = State { motion, kept, elapsed: state.elapsed };
        Ok(StepReport::of(change.iterations))
    }

    fn run(&self, state: &mut Self::State, steps: u64) -> Result<u64, StepError> {
        let (mut next, mut iterations) = (*state, 0);
        for _ in 0..steps {
            iterations += u64::from(Integrator::step(self, &mut next)?.iterations);
        }
        *state = next;
        Ok(iterations)
    }

    fn part(&self, state: &Self::State, fraction: f64) -> Result<Motion<L::Group, L::Advected>, StepError> {
        let change = self.change(self.h * fraction, &state.attitude, &state.momentum)?;
        let (attitude, momentum) = change.added(&state.attitude, &state.momentum, &state.kept)?.0;
        Ok(Motion { attitude, momentum, advected: self.advected(&attitude), steps: state.steps })
    }

    fn adopt(&self, motion: &Motion<L::Group, L::Advected>) -> Self::State {
        State {
            motion: Motion { advected: self.advected(&motion.attitude), steps: 0, ..*motion },
            kept: CotangentCarry::nothing(),
            elapsed: ElapsedTime::nothing(),
        }
    }

    fn steps(motion: &Self::Motion) -> u64 {
        motion.steps
    }

    fn factors(&self) -> Vec<Factor> {
        L::Group::factors()
    }

    fn inertia(&self) {}

    fn write(&self, motion: &Self::Motion, (): &(), attitude: &mut [f64], row: &mut [f64]) {
        let read = (Integrator::velocity(self, motion), Integrator::energy(self, motion));
        write_row(motion, read, attitude, row);
    }

    fn step_size(&self) -> f64 {
        self.h
    }

    fn velocity(&self, motion: &Motion<L::Group, L::Advected>) -> SVector<f64, D> {
        let velocity = self.lagrangian.velocity(&motion.momentum, &motion.advected);
        velocity.unwrap_or_else(|_| SVector::from_element(f64::NAN))
    }

    fn energy(&self, motion: &Motion<L::Group, L::Advected>) -> f64 {
        self.lagrangian.hamiltonian(&motion.momentum, &motion.advected).unwrap_or(f64::NAN)
    }
}

/// The body momentum `μ_k = tr(pᵀ g E_k)`.
fn momentum_of<G, const N: usize, const D: usize>([g, p]: &Phase<N>) -> SVector<f64, D>
where
    G: LieGroup<Scalar = f64, Vector = SVector<f64, D>, Matrix = SMatrix<f64, N, N>>,
{
    let paired = g.transpose() * p;
    SVector::from_fn(|k, _| paired.dot(&G::hat(&Coordinates::axis(k))))
}

/// The conjugate momentum of least norm with these components; the basis is orthogonal.
fn lifted<G, const N: usize, const D: usize>(attitude: &G, momentum: &SVector<f64, D>) -> SMatrix<f64, N, N>
where
    G: LieGroup<Scalar = f64, Vector = SVector<f64, D>, Matrix = SMatrix<f64, N, N>>,
{
    let scaled = SVector::from_fn(|k, _| momentum[k] / G::hat(&Coordinates::axis(k)).norm_squared());
    attitude.inverse().matrix().transpose() * G::hat(&scaled)
}

/// The linear combination `y + Σ c L`.
fn combined<'a, const N: usize>(y: &Phase<N>, terms: impl Iterator<Item = (f64, &'a Phase<N>)>) -> Phase<N> {
    terms.fold(*y, |sum, (factor, term)| [0, 1].map(|part| sum[part] + term[part] * factor))
}

/// Squared changes between two iterates of attitude and of momentum, relative to the phase-space point.
fn relative_changes<const PAIRS: usize, const N: usize>(
    place: &Phase<N>,
    before: &Stages<PAIRS, N>,
    after: &Stages<PAIRS, N>,
) -> [f64; 2] {
    let pairs = || before.as_flattened().iter().zip(after.as_flattened());
    let of = |part: usize| {
        let change: f64 = pairs().map(|(a, b)| (a[part] - b[part]).norm_squared()).sum();
        let size = place[part].norm_squared() + pairs().map(|(_, b)| b[part].norm_squared()).sum::<f64>();
        if change == 0.0 { 0.0 } else { change / size }
    };
    [of(0), of(1)]
}
