//! The attribute macros of liestep; use them through the crate `liestep`.
//!
//! This half runs when the user's crate is compiled. The derivation is the crate `liestep-derivation`, an ordinary library.

use liestep_derivation as derivation;
use liestep_derivation::Role;

/// The attribute implements `Effect`, `DiscreteLagrangian`, `ContinuousLagrangian` and `Add` for the annotated struct.
///
/// | argument | meaning |
/// |---|---|
/// | `group = SO3` | the group that `F` belongs to; `Name!` is one that `matrix_group!` declares |
/// | `generators = […]` | the generators, by rows, of a group of your own |
/// | `group(F = SO3, d = R3, …)` | the increments of two to four factors; of a group of your own `Q = Name!`, or with `generators(Name = […], …)` |
/// | `advected(w = up, …)` | `w` is the field `up`, moved by the group: `w_i = g_i⁻¹ · up`; may be left out |
/// | `given(u = torque, …)` | `u` is the field `torque` unless a step has another value; may be left out |
/// | `l_d = …` | the discrete Lagrangian, an expression or a block with `let` bindings |
/// | `velocity = Omega, l = …` | instead of `l_d`: the continuous one, in the components of the velocity; for several bodies `velocity(Omega_1, Omega_2)` |
/// | `discretise = trapezoid(Cayley)` | the discretisation of `l`; without it there are the continuous equations alone |
/// | `pace = …` | `s(w)` of a time `τ` in which steps are equal, `dt = s dτ`, with `given(E_0 = energy)`; for `Stepper::paced`; may be left out |
/// | `gradients` | also the derivatives of a step, for `Stepper::linearised`; may be left out |
/// | `crate = path` | the path of liestep, if not `::liestep` |
///
/// The expression may use `F` (the increment `g_i⁻¹ g_{i+1}`, a matrix), `I`, `h` (the step), the advected names and
/// the fields. It is ordinary Rust over nalgebra, and becomes the method `l_d` unchanged: `+ - * /`, unary minus,
/// `let`, `.transpose() .trace() .dot(&v) .norm_squared() .norm() .cross(&v) .cross_matrix() .component_mul(&v)
/// .powi(n) .sqrt() .ln() .exp() .sin() .cos()`, indexing, decimal literals, and five functions: `hat(v)`, the matrix
/// `Σ v_k E_k` of the Lie algebra; `vee(A)`, the vector of `½ (A − Aᵀ)`; `log(F)`, the rotation vector of a rotation;
/// `exp(v)`, the rotation by a vector; and `inverse(J)` of a field or of `F`. A `let` may name a function,
/// `let U = |y: Vector3<f64>| …;`, such as a potential that is taken at both ends of a step. A large Lagrangian is best
/// written with `let`s: they are differentiated by multipliers, unless multiplying out is cheaper.
///
/// # Several bodies
///
/// With `group(F_1 = SO3, F_2 = SO3)` the expression is in the increments of both. Each parameter names its frame:
///
/// | `advected(…)` | | `f⁻¹ · w` |
/// |---|---|---|
/// | `w = up.seen_from(F_1)` | the field `up` in the axes of the body of `F_1` | `F_1ᵀ w` |
/// | `Q = F_2.seen_from(F_1)` | `g_1⁻¹ g_2`: `Q` maps from the axes of the second body to the first's | `F_1⁻¹ Q F_2` |
/// | `R = F_2.seen_from(space)` | `g_2` itself | `R F_2` |
/// | `r = d_2.seen_from(d_1)`, of `R3` | the second position relative to the first | `r + d_2 − d_1` |
/// | `x = d_1.seen_from(space)`, of `R3` | the position | `x + d_1` |
///
/// Vectors of two bodies are combined by `Q`, as in `x.dot(&(Q * y))`. The states are tuples:
/// `stepper.start((R_1, R_2), …)`, with the components of both velocities one after the other. The second body has the
/// momentum `state.momentum_of::<1>()`, the attitude `state.attitude().1`, and the velocity
/// `<(SO3, SO3) as Factor<1>>::components(&stepper.velocity(&state))`. The struct's documentation says which momenta
/// the bodies conserve together, and whether a step solves them together. An example is
/// `examples/declarations/double_pendulum.rs`.
///
/// A factor is any group, as in `group(F = SE3, Q = SO3)`. Matrices of several sizes have an `I` of the size of
/// the matrix that it stands beside. Translations have `R1`, `R2` or `R3`: their increment is a scalar or a vector in the axes
/// of space, which is added. The rotation of a wheel about its axis is in `R1`, as in
/// `examples/declarations/gyrostat.rs`.
///
/// Two to four factors are declared together, by `l_d` or by `l`; a `#[force]` acts on them by their displacements. The
/// library's effects are for one body, its splittings have no kinetic flow for several, and `CotangentGauss` is for one
/// group. Compositions, substeps and the derivatives of a step work for several bodies.
///
/// # Continuous Lagrangians
///
/// In `l = …` the velocity `ξ = g⁻¹ġ` has the name in `velocity`. It is a vector with a component for each generator,
/// with the matrix `hat(Omega)`; `F` and `h` aren't in scope. `l` may be any smooth function of the velocity and of the
/// advected parameters. It becomes `impl ContinuousLagrangian`: the momentum, the diamond, the equations of motion, the
/// Hamiltonian. They are compared with the declared `l` in exact arithmetic, as is the limit `h → 0` of its
/// discretisation:
///
/// | `discretise =` | `l_d` | |
/// |---|---|---|
/// | `trapezoid` | `(h/2) (l(ξ̂, w) + l(ξ̂, F⁻¹·w))` | the matrix `ξ̂ = (F − I)/h`, as in (3.13) |
/// | `trapezoid(Cayley)`, `trapezoid(exp)` | `(h/2) (l(ξ, w) + l(ξ, F⁻¹·w))` | `hξ = cay⁻¹(F)`, or `log F` |
/// | `midpoint(exp)` | `h l(ξ, exp(−hξ/2)·w)` | `hξ = log F` |
/// | `chord`, `chord(Cayley)`, `chord(exp)` | `h l(ξ, (w + F⁻¹·w)/2)` | as for the trapezoid |
///
/// All are self-adjoint, of order two; a discretisation that isn't for this `l` on this group is refused. If `l` isn't
/// quadratic in the velocity, a stepper finds the velocity of a momentum by Newton's iteration, and a method that
/// contains the motion of a free body, like a splitting, is refused when it is set up. With the matrix `(F − I)/h` the
/// velocity may be used as `hat(Omega)`, on SO(3) also in `Omega.dot(&(J * Omega))` and `s.dot(&Omega)`. Terms much
/// larger than `l_d` cancel in a power of the first of these: those of `k (Ω·JΩ)²` are as large as `4 k tr(J_d)²/h³`,
/// and each is rounded, so that a short step loses digits which `trapezoid(Cayley)` keeps. The logarithm is known on
/// SO(3), and if all generators are strictly triangular. A declared `l_d` has the continuous equations of its limit,
/// too, which may be of any degree in the velocity.
///
/// Several bodies have the velocities `velocity(Omega_1, v)`, one for each factor of `group(F_1 = SO3, d = R3)`, in
/// their order: those of rotations are in the body's own axes, those of translations in the axes of space. Methods take
/// and return the components of all, one after the other. If the kinetic energy depends on a relative configuration,
/// the discretisations `trapezoid` and `chord` with the matrices `(F - I) / h` aren't self-adjoint, and are refused;
/// `trapezoid(Cayley)` and `chord(Cayley)` are.
///
/// # The parameters
///
/// The fields are `f64`, `Vector3<f64>`, `Point3<f64>`, `Matrix3<f64>` (or of another size), `NonstandardInertia`,
/// `DiagonalNonstandardInertia` and `Inertia`, or all of them over `f32` or over a type parameter `T: Real` of the
/// struct; with more than six rows they are `SVector<f64, 8>` and `SMatrix<f64, 8, 8>`. The derivation uses what their
/// types guarantee: an inertia is symmetric, a diagonal one has six zeros. (3.13) with an `Inertia` is
/// an error, and so is `½ Ω·JΩ` with a `NonstandardInertia` in a continuous Lagrangian. A point, if the group moves points, has the
/// homogeneous coordinates `(x, y, z, 1)`, as on SE(3). An advected vector is a covector, moved by `ρ(f)ᵀ`; a point is
/// moved by `ρ(f)⁻¹`; `ContravariantVector`, `ContravariantTensor`, `CovariantTensor` and `MixedTensor` are the other
/// kinds. At most six parameters are advected or given, and none is called `F`, `I`, `h`, `hat`, `vee`, `log`, `exp` or
/// `inverse`.
///
/// Values that change with time are given: `Stepper::step_with` takes a step with other values of the advected
/// parameters and of those in `given(…)`, scalars, vectors or matrices that the group doesn't move.
///
/// As `h → 0`, with `F = exp(hξ̂)`, a Lagrangian is of the first order in `h`: a kinetic part is a square of `F - I`
/// over `h`, and a potential has a factor `h`. A term of another order is an error, as is one that isn't smooth at
/// `F = I`. A term without `F` and advected parameters, such as an energy at rest, changes no equation. An inertia may
/// depend on advected parameters. A correction of higher order is marked by `h.powi(n)`:
/// `h.powi(3) * w.dot(&rho).powi(2)`.
///
/// A Lagrangian without a kinetic part, like a potential, has no motion of its own, but adds to one that has:
/// `body + potential`.
///
/// In a `macro_rules!` macro, fragments keep their precedence, and a `let` of the macro hides no name of its caller.
///
/// Every mistake is reported at its token. See `DiscreteLagrangian` for the derived terms.
#[proc_macro_attribute]
pub fn lagrangian(arguments: proc_macro::TokenStream, item: proc_macro::TokenStream) -> proc_macro::TokenStream {
    derivation::expand(Role::Lagrangian, arguments.into(), &item.into()).into()
}

/// Derives the stages of a force from its virtual work in a step: `impl Effect` and `impl Add` for the annotated
/// struct.
///
/// ```text
/// #[force(
///     group = SO3,                    the group that F belongs to; with `generators`, a group of your own
///     advected(w = up, …),            as for a Lagrangian
///     given(u = torque, …),           as for a Lagrangian
///     work = …,                       the virtual work f⁻·eta + f⁺·eta_next, linear in the displacements
///     displacement(eta_1, s),         the names of displacements of several bodies
///     gradients,                      as for a Lagrangian
///     crate = path,                   the path of liestep, if not `::liestep`
/// )]
/// struct Name { … }                   the parameters
/// ```
///
/// The expression may also use `eta` and `eta_next`, the virtual displacements of the body at the beginning and at the
/// end of the step, each in the body's axes at that time: the discrete Lagrange–d'Alembert principle. They have a
/// component for each generator of the group; on SO(3) they are small rotations (rad), on SE(3) these and three small
/// translations (m), and `hat(eta) * p` is the displacement of the body's point `p`. A torque `τ(F, w)` with half its
/// impulse at either end has the work `0.5 * h * tau.dot(&(eta + eta_next))`. Work is of the first order in `h`, and
/// `F - I` and `vee(F)` count as `h`: drag is `-c * vee(F).dot(&eta)`. Work of higher order is marked by `h.powi(n)`.
/// The factor of `eta` enters the momentum equation, and its derivative the Newton Jacobian.
///
/// A force on several bodies has their group, `group(F_1 = SO3, d = R3)`, and names their displacements in that order,
/// `displacement(eta_1, s)`; at the end of the step they are `eta_1_next` and `s_next`. Those of rotations are in the
/// body's axes at that time, those of translations in the axes of space. The torque `u` of a motor between a body and
/// its wheel, with the wheel's angle `t` about the axis `a`, has the work `0.5 * h * u * (s + s_next)`, as that angle
/// is relative to the body. The force adds to Lagrangians of the same group.
#[proc_macro_attribute]
pub fn force(arguments: proc_macro::TokenStream, item: proc_macro::TokenStream) -> proc_macro::TokenStream {
    derivation::expand(Role::Force, arguments.into(), &item.into()).into()
}

/// Derives a constraint that is linear in the velocity, such as rolling without sliding: `impl Nonholonomic`, `impl Effect`
/// and `impl Add` for the annotated struct.
///
/// ```text
/// #[nonholonomic(
///     group = SO3,                    as for a Lagrangian; also `group(F = SO3, d = R3)`
///     advected(w = up, …),            as for a Lagrangian
///     given(u = drift, …),            as for a Lagrangian
///     velocity = Omega, zero = …,     linear in the velocity, a scalar; on a product `velocity(Omega, v)`
///     discretise = trapezoid(Cayley), the rule by which an increment satisfies it, as for a Lagrangian: this one if none is
///                                     named
///     crate = path,                   the path of liestep, if not `::liestep`
/// )]
/// struct Name { … }                   the parameters
/// ```
///
/// The struct adds to Lagrangians and forces of the same group. A step of the sum is that of the discrete
/// Lagrange–d'Alembert principle, of order two: the reactions do no work on displacements that satisfy the constraints, and
/// each increment satisfies them to rounding, as does the velocity after each step. What a constraint has is scalar: several
/// are several structs that are added, and each has a multiplier.
///
/// The scene is no Lagrangian any more. A step isn't symplectic, and methods that need a Lagrangian are refused. The initial
/// velocity has to satisfy the constraints. `Nonholonomic` has the derived terms, and the chapter "Rolling" of the guide
/// examples with their closed solutions.
#[proc_macro_attribute]
pub fn nonholonomic(arguments: proc_macro::TokenStream, item: proc_macro::TokenStream) -> proc_macro::TokenStream {
    derivation::expand(Role::Nonholonomic, arguments.into(), &item.into()).into()
}

/// Derives the slopes of a holonomic constraint on two bodies: `impl Constraint` for the annotated struct, which
/// `Multibody::join` takes like the library's joints.
///
/// ```text
/// #[constraint(
///     group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),    the body above, which may be space, and the body below
///     advected(R_1 = F_1.seen_from(space), …),            as for a Lagrangian of several bodies
///     zero = …,                                           functions of the positions of the bodies
///     crate = path,                                       the path of liestep, if not `::liestep`
/// )]
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Name { … }                                       the parameters, over `f64`
/// ```
///
/// The constraint `zero` is a scalar, a vector or several of them, `(a, b)`: one to six functions, each in a unit of
/// its own. They depend on the names in `advected(…)`: attitudes and positions in space, those of one body relative to
/// the other, and fields in the axes of a body. Increments, velocities and the step have no meaning here. The functions
/// become `gap` unchanged, and their derivatives along rotations and translations of either body `slope`.
///
/// A function whose derivatives vanish at its zeros constrains nothing: for a distance take `|y|² − l²` and not the
/// square of `|y| − l`, and for a line two functions across it, not a cross product, one component of which depends on
/// the others.
#[proc_macro_attribute]
pub fn constraint(arguments: proc_macro::TokenStream, item: proc_macro::TokenStream) -> proc_macro::TokenStream {
    derivation::expand(Role::Constraint, arguments.into(), &item.into()).into()
}

/// Declares a matrix group: a type alias for it, and its generators, written once.
///
/// ```text
/// matrix_group! {
///     /// The affine maps `x ↦ a x + b` of the line, `a > 0`.
///     pub type Affine = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [0.0, 0.0]]];
///
///     fn relation<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> T {
///         m[(1, 0)].abs() + (m[(1, 1)] - T::one()).abs()
///     }
/// }
///
/// #[lagrangian(group = Affine!, …)]
/// ```
///
/// The matrices are the basis `E_k` of the group's Lie algebra, each by rows. The functions are those of the trait
/// `Generators`, which the marker `AffineGenerators` implements; `relation` is required. `crate = path;` in front is
/// the path of liestep, if not `::liestep`.
///
/// `group = Affine!` calls a macro of the group's name, which has the generators. The macro is in scope where the type
/// is, within the crate; from another crate, write `group = Affine` with `generators = […]`, which the compiler
/// compares with those of the group.
#[proc_macro]
pub fn matrix_group(tokens: proc_macro::TokenStream) -> proc_macro::TokenStream {
    derivation::matrix_group(tokens.into()).into()
}

/// Marks the functions of a step: inlined into every caller, except in builds with debug assertions, which compile
/// faster.
///
/// On an `impl` or a `trait` it marks all functions but those with `#[inline]`, `#[inline(never)]` or `#[cold]`, and
/// those that a macro generates there. For liestep's sources alone. Closures have the attribute written out, as
/// attribute macros can't be applied to them.
#[doc(hidden)]
#[proc_macro_attribute]
pub fn hot(_: proc_macro::TokenStream, item: proc_macro::TokenStream) -> proc_macro::TokenStream {
    derivation::hot(item.into()).into()
}

/// `Lanes` of a struct, field by field: fields marked `#[shared]` are the same in all lanes.
///
/// For the sources of liestep alone, as [`hot`](macro@hot).
#[doc(hidden)]
#[proc_macro_derive(Lanes, attributes(shared))]
pub fn lanes(item: proc_macro::TokenStream) -> proc_macro::TokenStream {
    derivation::lanes(item.into(), false).into()
}

/// `InLanes` of a struct that has `Lanes`.
#[doc(hidden)]
#[proc_macro_derive(InLanes, attributes(shared))]
pub fn in_lanes(item: proc_macro::TokenStream) -> proc_macro::TokenStream {
    derivation::lanes(item.into(), true).into()
}
