//! The attribute macros of liestep; use them through the crate `liestep`.
//!
//! This half runs when the user's crate is compiled. The derivation is the crate `liestep-derivation`, an ordinary library.

use liestep_derivation as derivation;
use liestep_derivation::Role;

/// Derives an integrator from a reduced Lagrangian, discrete or continuous: `impl Effect`, `impl DiscreteLagrangian`,
/// `impl ContinuousLagrangian` and `impl Add` for the annotated struct.
///
/// ```text
/// #[lagrangian(
///     group = SO3,                    the group that F belongs to
///     generators = […],               its generators, row by row, if it is a group of your own; of one that
///                                     `matrix_group!` declares, `group = Name!` finds them
///     group(F = SO3, d = R3, …),      or the increments of two to four bodies that turn or are translated
///     advected(w = up, …),            w is the field `up`, carried by the group: w_i = g_i⁻¹ · up; may be left out
///     given(u = torque, …),           u is the field `torque` until a step is given another value; may be left out
///     l_d = …,                        the Lagrangian, an expression or a block with `let` bindings; or
///     velocity = Omega, l = …,        the continuous one, in the velocity's components by that name; of several bodies
///                                     `velocity(Omega_1, Omega_2)`
///     discretise = trapezoid(Cayley), how `l_d` is made of `l`; left out, there are the continuous equations alone
///     pace = …,                       s(w) of a time `τ` in which steps are equal, `dt = s dτ`, with `given(E_0 = energy)`;
///                                     for `Stepper::paced`; may be left out
///     gradients,                      also the derivatives of a step, for `Stepper::linearised`; may be left out
///     crate = path,                   where liestep is found, if not at `::liestep`
/// )]
/// struct Name { … }                   the parameters
/// ```
///
/// In scope in the expression are `F` (the increment `g_i⁻¹ g_{i+1}`, a matrix), `I`, `h` (the step), the advected
/// names and the fields. It is ordinary Rust over nalgebra, so it also becomes the method `l_d` as it stands:
/// `+ - * /`, unary minus, `let`, `.transpose() .trace() .dot(&v) .norm_squared() .norm() .cross(&v) .cross_matrix()
/// .component_mul(&v) .powi(n) .sqrt() .ln() .exp() .sin() .cos()`, indexing, decimal literals, and five functions:
/// `hat(v)`, the matrix `Σ v_k E_k` of the Lie algebra; `vee(A)`, the vector of `½ (A − Aᵀ)`; `log(F)`, the rotation
/// vector of a rotation; `exp(v)`, the rotation by a vector; and `inverse(J)` of a field or of `F`. A `let` may name a
/// function, `let U = |y: Vector3<f64>| …;`, as a potential that both ends of a step have. A large Lagrangian
/// is best written with `let`s: what isn't cheaper multiplied out is differentiated through them, by multipliers.
///
/// # Several bodies
///
/// With `group(F_1 = SO3, F_2 = SO3)` the expression is in the increments of both, and each parameter says who sees it:
///
/// | `advected(…)` | | `f⁻¹ · w` |
/// |---|---|---|
/// | `w = up.seen_from(F_1)` | the field `up`, as the body of `F_1` sees it | `F_1ᵀ w` |
/// | `Q = F_2.seen_from(F_1)` | `g_1⁻¹ g_2`: `Q` brings a vector from the second body to the first | `F_1⁻¹ Q F_2` |
/// | `R = F_2.seen_from(space)` | `g_2` itself | `R F_2` |
/// | `r = d_2.seen_from(d_1)`, of `R3` | the second place as it is from the first | `r + d_2 − d_1` |
/// | `x = d_1.seen_from(space)`, of `R3` | the place | `x + d_1` |
///
/// Vectors of two bodies meet by `Q`, as in `x.dot(&(Q * y))`. The states are tuples: `stepper.start((R_1, R_2), …)`, with
/// the components of both velocities one after the other. Of the second body `state.momentum_of::<1>()` is the momentum,
/// `state.attitude().1` the attitude, and `<(SO3, SO3) as Factor<1>>::components(&stepper.velocity(&state))` the velocity.
/// What they conserve together, and whether a step solves them together, is in the documentation of the struct.
/// `examples/declarations/double_pendulum.rs` is one.
///
/// What turns does so by `SO3`. What is translated by `R1`, `R2` or `R3` has a scalar or a vector for its increment, in the
/// axes of space, which is added. A wheel's turn about its axis is one of `R1`, as in `examples/declarations/gyrostat.rs`.
///
/// Two to four factors are declared together, by `l_d` or by `l`; a `#[force]` acts on them by their displacements. No
/// effect of the library does, as those are of one body; no splitting has their kinetic flow, and `CotangentGauss` is of
/// one group. Compositions, substeps and the derivatives of a step are there for them.
///
/// # Continuous Lagrangians
///
/// In `l = …` the velocity `ξ = g⁻¹ġ` is in scope by the name that `velocity` gives it, a vector with a component for each
/// generator, and its matrix as `hat(Omega)`; `F` and `h` aren't. `l` may be any smooth function of the velocity and of what
/// is advected. It becomes `impl ContinuousLagrangian`: the momentum, the diamond, the equations of motion, the Hamiltonian.
/// They are compared with the declared `l` in exact arithmetic, as is the limit `h → 0` of what is made of it:
///
/// | `discretise =` | `l_d` | |
/// |---|---|---|
/// | `trapezoid` | `(h/2) (l(ξ̂, w) + l(ξ̂, F⁻¹·w))` | the matrix `ξ̂ = (F − I)/h`, as in (3.13) |
/// | `trapezoid(Cayley)`, `trapezoid(exp)` | `(h/2) (l(ξ, w) + l(ξ, F⁻¹·w))` | `hξ = cay⁻¹(F)`, or `log F` |
/// | `midpoint(exp)` | `h l(ξ, exp(−hξ/2)·w)` | `hξ = log F` |
/// | `chord`, `chord(Cayley)`, `chord(exp)` | `h l(ξ, (w + F⁻¹·w)/2)` | as for the trapezoid |
///
/// All are self-adjoint, of order two; one that isn't for this `l` on this group is refused. Where `l` isn't quadratic in
/// the velocity, a stepper finds the velocity of a momentum by Newton's iteration, and what has the motion of one free body
/// in it, like a splitting, is refused when it is set up. For the matrix `(F − I)/h` the velocity stands as
/// `hat(Omega)`, on SO(3) also in `Omega.dot(&(J * Omega))` and `s.dot(&Omega)`. In a power of the first of these, terms
/// cancel that are much larger than `l_d`: those of `k (Ω·JΩ)²` are as large as `4 k tr(J_d)²/h³`, and each is rounded, so
/// that a short step loses digits which `trapezoid(Cayley)` keeps. A logarithm is known on SO(3) and where all generators
/// are strictly triangular. A declared `l_d` has the continuous equations of its limit, which may be of any degree
/// in the velocity, too.
///
/// Of several bodies `velocity(Omega_1, v)` names the velocities, one for each factor of `group(F_1 = SO3, d = R3)`, in their
/// order: of what turns in its own axes, of what is translated in those of space. Methods take and give the components of all,
/// one after the other. Where the kinetic energy depends on a relative configuration, what `trapezoid` and `chord` make
/// with the matrices `(F - I) / h` isn't its own adjoint, and is refused. What `trapezoid(Cayley)` and `chord(Cayley)`
/// make is.
///
/// # The parameters
///
/// The fields are `f64`, `Vector3<f64>`, `Point3<f64>`, `Matrix3<f64>` (or of another size), `NonstandardInertia`,
/// `DiagonalNonstandardInertia` and `Inertia`, or all of them over `f32` or over a type parameter `T: Real` of the
/// struct; of more than six rows `SVector<f64, 8>` and `SMatrix<f64, 8, 8>`. Their types say what may be used: an inertia is symmetric, a diagonal one has six zeros. A point, where the
/// group moves points, stands for its homogeneous coordinates, `(x, y, z, 1)` on SE(3). An advected vector is a
/// covector, moved by `ρ(f)ᵀ`; a point is moved by `ρ(f)⁻¹`; `ContravariantVector`, `ContravariantTensor`,
/// `CovariantTensor` and `MixedTensor` are the other kinds.
/// At most six are advected or given, and no parameter is called `F`, `I`, `h`, `hat`, `vee`, `log` or `exp`.
///
/// What changes with time is given: `Stepper::step_with` makes a step with other values of what is advected and of what
/// `given(…)` names, a scalar, a vector or a matrix that the group doesn't move.
///
/// As `h → 0`, with `F = exp(hξ̂)`, a Lagrangian goes like `h`: a kinetic part is a square of `F - I` over `h`, and a
/// potential has a factor `h`. A term that goes otherwise is an error, as is one that isn't smooth at `F = I`. A term in
/// neither `F` nor what is advected, such as an energy at rest, changes no equation. An inertia may depend on what is advected. A correction that vanishes with a higher
/// power says so by `h.powi(n)`: `h.powi(3) * w.dot(&rho).powi(2)`.
///
/// A Lagrangian without a kinetic part, like a potential, can't move by itself, but adds to one that can:
/// `body + potential`.
///
/// In a `macro_rules!` macro, fragments keep their precedence, and a `let` of the macro hides no name of its caller.
///
/// Every mistake is reported at the token that it is about. See `DiscreteLagrangian` for what is derived.
#[proc_macro_attribute]
pub fn lagrangian(arguments: proc_macro::TokenStream, item: proc_macro::TokenStream) -> proc_macro::TokenStream {
    derivation::expand(Role::Lagrangian, arguments.into(), &item.into()).into()
}

/// Derives the stages of a force from its virtual work in a step: `impl Effect` and `impl Add` for the annotated
/// struct.
///
/// ```text
/// #[force(
///     group = SO3,                    the group that F belongs to; with `generators`, one of your own
///     advected(w = up, …),            as for a Lagrangian
///     given(u = torque, …),           as for a Lagrangian
///     work = …,                       the virtual work f⁻·eta + f⁺·eta_next, linear in the displacements
///     displacement(eta_1, s),         the names of displacements of several bodies
///     gradients,                      as for a Lagrangian
///     crate = path,                   where liestep is found, if not at `::liestep`
/// )]
/// struct Name { … }                   the parameters
/// ```
///
/// In scope are also `eta` and `eta_next`, the virtual displacements of the body at the beginning and at the end of the
/// step, each in the body's axes then: the discrete Lagrange–d'Alembert principle. They have a component for each
/// generator of the group; on SO(3) they are small rotations (rad), on SE(3) these and three small translations (m), and
/// `hat(eta) * p` is how far the body's point `p` goes. A torque `τ(F, w)` that acts half at either end is
/// `0.5 * h * tau.dot(&(eta + eta_next))`. Work goes like `h` as `h → 0`, and `F - I` and `vee(F)` count as `h`: drag is
/// `-c * vee(F).dot(&eta)`; work that vanishes faster says so by `h.powi(n)`. What `eta` is multiplied with enters the
/// momentum equation, and its derivative the Newton Jacobian.
///
/// A force on several bodies has their group, `group(F_1 = SO3, d = R3)`, and names their displacements in that order,
/// `displacement(eta_1, s)`; at the end of the step they are `eta_1_next` and `s_next`. Of what turns they are in the
/// body's axes then, of what is translated in those of space. A motor's torque `u` between a body and its wheel, of turn
/// `t` about the axis `a`, is `0.5 * h * u * (s + s_next)`, as that angle is against the body. It adds to
/// Lagrangians of the same group.
#[proc_macro_attribute]
pub fn force(arguments: proc_macro::TokenStream, item: proc_macro::TokenStream) -> proc_macro::TokenStream {
    derivation::expand(Role::Force, arguments.into(), &item.into()).into()
}

/// Derives the slopes of a holonomic constraint on two bodies: `impl Constraint` for the annotated struct, which
/// `Stepper::jointed` holds as it holds the library's joints. It takes one type of them: joints of several kinds are an enum
/// of your own, see `Constraint`.
///
/// ```text
/// #[constraint(
///     group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),    the body above, which may be space, and that below
///     advected(R_1 = F_1.seen_from(space), …),            as for a Lagrangian of several bodies
///     zero = …,                                           functions of where the bodies are
///     crate = path,                                       where liestep is found, if not at `::liestep`
/// )]
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Name { … }                                       the parameters, over `f64`
/// ```
///
/// What is zero is a scalar, a vector or several of them, `(a, b)`: one to six functions, each in a unit of its own. They
/// are written in what `advected(…)` names: attitudes and places in space, how one body is seen from the other, and fields
/// as a body sees them. Increments, velocities and the step have no meaning here. The functions become `gap` as they stand,
/// and their derivatives along turns and shifts of either body `slope`.
///
/// A function whose derivatives vanish where it is zero holds nothing: of a distance take `|y|² − l²` and not the square of
/// `|y| − l`, and of a line two functions across it, not a cross product, one component of which repeats the others.
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
/// `Generators`, which the marker `AffineGenerators` implements; `relation` is required. `crate = path;` in front says
/// where liestep is found, if not at `::liestep`.
///
/// `group = Affine!` asks a macro of the group's name for the generators. The macro is found where the type is, within
/// the crate; from another crate, write `group = Affine` with `generators = […]`, which the compiler compares with those
/// of the group.
#[proc_macro]
pub fn matrix_group(tokens: proc_macro::TokenStream) -> proc_macro::TokenStream {
    derivation::matrix_group(tokens.into()).into()
}

/// Inlined into every caller, but for builds with debug assertions, which are to be built soon: what a step is made of.
///
/// On an `impl` or a `trait` it marks all functions but those with `#[inline]`, `#[inline(never)]` or `#[cold]`, and those
/// that a macro makes there. For liestep's sources alone. Closures write it out, as attribute macros can't stand on them.
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
