//! The continuous equations of motion as numbers, for any ODE solver.

use alloc::vec::Vec;

use crate::error::{SetupError, StepError};
use crate::groups::{Advected as _, LieGroup};
use crate::mechanics::{ContinuousLagrangian, Legendre, Term, check_inertia, left_symmetries, right_symmetries};
use crate::numbers::{Coordinates, Entries as _, real};

type Velocity<L> = <<L as Term>::Group as LieGroup>::Vector;
type Matrix<L> = <<L as Term>::Group as LieGroup>::Matrix;
type Square<L> = <Velocity<L> as Coordinates<<L as Term>::Scalar>>::Square;

/// The right-hand side of `ġ = g ξ̂`, `μ̇ = ad*_ξ μ + ∂l/∂w ⋄ w` with `w = g⁻¹·a_0`, \[RDAE, (1.5), (1.12) and (2.2)\],
/// with parameters checked and the inertia factorised once.
///
/// A state as numbers is the attitude's matrix row by row, then the body momentum. An explicit method conserves neither
/// the relation of the group nor a momentum: it is for references, and for comparison.
///
/// # Examples
///
/// ```
/// use liestep::effects::{Gravity, RigidBody};
/// use liestep::motion::RightHandSide;
/// use liestep::{NonstandardInertia, SO3};
/// use nalgebra::Vector3;
///
/// let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
/// let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
/// let top = RightHandSide::new(RigidBody { J_d } + gravity)?;
///
/// let state = top.state(&SO3::identity(), &Vector3::new(1.5, 6.0, 48.0));
/// let mut rate = vec![0.0_f64; state.len()];
/// top.rate(&state, &mut rate)?; // what a solver calls
/// assert!((rate[1] + 12.0).abs() < 1e-14 && (rate[2] - 2.0).abs() < 1e-14); // the first row of ξ̂, as g = I
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct RightHandSide<L: Term> {
    lagrangian: L,
    spatial: L::Advected,
    /// The factors of `M` and its determinant, if it is the same for all `ξ` and `w`.
    inertia: Option<(Square<L>, L::Scalar)>,
}

impl<L: ContinuousLagrangian> RightHandSide<L> {
    /// Checks the parameters, and factorises a constant inertia.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] for an invalid parameter, [`SetupError::NonFinite`] for an advected parameter that
    /// isn't finite, [`SetupError::SingularKinetic`] or [`SetupError::NegativeKinetic`] if a momentum doesn't determine
    /// a velocity at rest.
    ///
    /// Declared generators that differ from those of the group are an error at compile time:
    ///
    /// ```compile_fail,E0080
    /// use liestep::groups::R1;
    /// use liestep::lagrangian;
    /// use liestep::motion::RightHandSide;
    ///
    /// type Line<T = f64> = R1<T>;
    ///
    /// #[lagrangian(
    ///     group = Line,
    ///     generators = [[[0.0, 2.0], [0.0, 0.0]]], // of R1 the entry is 1
    ///     l_d = m * (F - I).norm_squared() / (2.0 * h),
    /// )]
    /// struct Particle {
    ///     m: f64,
    /// }
    ///
    /// let _ = RightHandSide::new(Particle { m: 1.0 });
    /// ```
    pub fn new(lagrangian: L) -> Result<Self, SetupError> {
        lagrangian.validate()?;
        let spatial = lagrangian.advected();
        if !spatial.is_finite() {
            return Err(SetupError::NonFinite { what: "advected parameter" });
        }
        let inertia = lagrangian.velocity_hessian(&Velocity::<L>::zero(), &spatial);
        check_inertia::<L::Group>(&inertia)?;
        let inertia = (L::LEGENDRE == Legendre::Constant).then(|| Velocity::<L>::factorise(&inertia));
        Ok(Self { lagrangian, spatial, inertia })
    }

    /// The Lagrangian.
    pub const fn lagrangian(&self) -> &L {
        &self.lagrangian
    }

    /// The body velocity at a body momentum, the solution of \[RDAE, (1.14)\].
    ///
    /// # Errors
    ///
    /// The errors of [`ContinuousLagrangian::velocity`].
    #[inline]
    pub fn velocity(&self, momentum: &Velocity<L>, w: &L::Advected) -> Result<Velocity<L>, StepError> {
        let Some((factors, determinant)) = &self.inertia else { return self.lagrangian.velocity(momentum, w) };
        let bias = self.lagrangian.momentum(&Velocity::<L>::zero(), w);
        Ok(Velocity::<L>::solve_again(factors, *determinant, &(*momentum - bias)))
    }

    /// The rates `ġ = g ξ̂`, a matrix in 1/s, and `μ̇` in the body frame, on SO(3) in N m, \[RDAE, (1.5), (1.12) and
    /// (2.2)\].
    ///
    /// For several bodies, a tuple of matrices, and the rates of all momenta, one after the other. A translation has
    /// its velocity in the last column of its matrix, in m/s, and its rate in N; both are in the axes of space.
    ///
    /// # Errors
    ///
    /// The errors of [`ContinuousLagrangian::velocity`].
    #[inline]
    pub fn rates(&self, attitude: &L::Group, momentum: &Velocity<L>) -> Result<(Matrix<L>, Velocity<L>), StepError> {
        let w = self.spatial.seen_from(attitude);
        let velocity = self.velocity(momentum, &w)?;
        let rate = L::Group::lie_bracket_transpose(&velocity, momentum) + self.lagrangian.diamond_rate(&velocity, &w);
        Ok((attitude.change(&L::Group::hat(&velocity)), rate))
    }

    /// The energy `h(μ, w)`, (1.16), in J.
    ///
    /// # Errors
    ///
    /// The errors of [`ContinuousLagrangian::velocity`].
    pub fn energy(&self, attitude: &L::Group, momentum: &Velocity<L>) -> Result<L::Scalar, StepError> {
        self.lagrangian.hamiltonian(momentum, &self.spatial.seen_from(attitude))
    }

    /// A basis of the symmetries in space, the directions `η` with `η·a_0 = 0`.
    pub fn left_symmetries(&self) -> Vec<Velocity<L>> {
        left_symmetries(&self.lagrangian)
    }

    /// A basis of the symmetries in the body, found at sample points to rounding: for a symmetric top its axis. The
    /// symmetries for all values of the parameters are listed in
    /// [`CONTINUOUS_DERIVATION`](ContinuousLagrangian::CONTINUOUS_DERIVATION).
    pub fn right_symmetries(&self) -> Vec<Velocity<L>> {
        right_symmetries(&self.lagrangian)
    }

    /// The conserved momenta: `⟨Ad*_{g⁻¹} μ, η⟩` in space for each [left symmetry](Self::left_symmetries), then
    /// `⟨μ, ζ⟩` in the body for each [right one](Self::right_symmetries). The [energy](Self::energy) is conserved, too.
    pub fn conserved(&self, attitude: &L::Group, momentum: &Velocity<L>) -> Vec<L::Scalar> {
        let spatial = attitude.inverse().adjoint_transpose(momentum);
        let left = self.left_symmetries().into_iter().map(|eta| spatial.dot(&eta));
        let right = self.right_symmetries().into_iter().map(|zeta| momentum.dot(&zeta));
        left.chain(right).collect()
    }

    /// A state as numbers: the attitude's matrix row by row, then the momentum. For several bodies all matrices come
    /// first, then the momenta. For a translation, the last column of the matrix is the position in space, m, and the
    /// momentum is in the axes of space, kg m/s.
    pub fn state(&self, attitude: &L::Group, momentum: &Velocity<L>) -> Vec<L::Scalar> {
        let mut numbers = Vec::new();
        attitude.matrix().each(&mut |entry| numbers.push(entry));
        momentum.each(&mut |entry| numbers.push(entry));
        numbers
    }

    /// The attitude and the momentum of a [`state`](Self::state), with an unchecked matrix; missing numbers are NaN.
    pub fn parts(&self, state: &[L::Scalar]) -> (L::Group, Velocity<L>) {
        let mut numbers = state.iter().copied();
        let mut next = || numbers.next().unwrap_or_else(|| real(f64::NAN));
        let matrix = Matrix::<L>::from_entries(&mut next);
        (L::Group::from_matrix_unchecked(matrix), Velocity::<L>::from_entries(&mut next))
    }

    /// Writes the rate of a [`state`](Self::state), in the same order, into a slice. A shorter slice is filled; in a
    /// longer one the rest stays unchanged.
    ///
    /// # Errors
    ///
    /// The errors of [`ContinuousLagrangian::velocity`].
    pub fn rate(&self, state: &[L::Scalar], rate: &mut [L::Scalar]) -> Result<(), StepError> {
        let (attitude, momentum) = self.parts(state);
        let (of_attitude, of_momentum) = self.rates(&attitude, &momentum)?;
        let mut places = rate.iter_mut();
        let mut write = |entry: L::Scalar| {
            if let Some(place) = places.next() {
                *place = entry;
            }
        };
        of_attitude.each(&mut write);
        of_momentum.each(&mut write);
        Ok(())
    }
}
