//! The flow of every self-adjoint declaration converges to the continuous system at second order in the step, and its
//! symmetric compositions at the order of their scheme.

use checks::structure::System;
use declarations::{OrbitingBody, TetheredPlate, UnderwaterBody};
use liestep::Stepper;
use liestep::groups::{LieGroup as _, SL2};
use liestep::laws::samples::MatrixLieGroup;
use liestep::mechanics::Effect;
use liestep::methods::CompositionScheme;
use liestep::motion::Plan;
use nalgebra::{Matrix3, Matrix4, Point3, SMatrix, SVector, Vector3, Vector6};
use workbench::measure::{four_halvings, order, relative, steps_in};
use workbench::runge_kutta;

use checks::continuous::{Body, Phase};
use checks::samples::{self, Start};

/// The plateau is above the error of a thousand steps of the Runge–Kutta method, for systems with rates of a few per
/// second.
pub(crate) const PLATEAU: f64 = 1e-9;
const TIME: f64 = 1.0;
const COARSEST: f64 = 1.0 / 25.0;
/// The outer stages `1/(2 − 2^⅓)`, and the middle one that makes the sum one.
const TRIPLE_JUMP: CompositionScheme =
    CompositionScheme::new("triple jump", 2, 4, &[1.351_207_191_959_657_8, -1.702_414_383_919_315_3]);

/// The ordinary inertia, `∫ (|X|² I − X Xᵀ) dm`, from the nonstandard one.
fn ordinary(nonstandard: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::identity() * nonstandard.trace() - nonstandard
}

fn rotation(g: &Matrix4<f64>) -> Matrix3<f64> {
    g.fixed_view::<3, 3>(0, 0).into_owned()
}

/// The errors of configuration and momentum together over four halvings of a method's step; `shift` is the difference
/// between the flow's momentum and the convergent one.
fn errors_of<L, P, const N: usize, const D: usize>(
    method: impl Fn(f64) -> Stepper<L, P>,
    coarsest: f64,
    body: &Body<N, D>,
    (attitude, velocity): Start<L::Group>,
    shift: impl Fn(&L::Advected, f64) -> SVector<f64, D>,
) -> [(f64, f64); 5]
where
    L: Effect<Scalar = f64, Group: MatrixLieGroup<N, D>>,
    P: Plan<L>,
{
    let momentum = body.inertia * velocity;
    let exact: Phase<N, D> = body.solution::<L::Group>((attitude.matrix(), momentum), TIME, 1000);
    four_halvings(coarsest).map(|h| {
        let stepper = method(h);
        let w = stepper.start(attitude, velocity).unwrap().advected();
        let mut state = stepper.start_with_momentum(attitude, momentum - shift(&w, h)).unwrap();
        for _ in 0..steps_in(TIME, h) {
            stepper.step(&mut state).unwrap();
        }
        let momentum = state.momentum() + shift(&state.advected(), h);
        (h, relative(&state.attitude().matrix(), &exact.0).hypot(relative(&momentum, &exact.1)))
    })
}

/// Checks the order of the declared step.
pub(crate) fn errors<L, const N: usize, const D: usize>(
    system: &L,
    body: &Body<N, D>,
    start: Start<L::Group>,
    shift: impl Fn(&L::Advected, f64) -> SVector<f64, D>,
) -> [(f64, f64); 5]
where
    L: System<Group: MatrixLieGroup<N, D>> + Clone,
{
    errors_of(|h| Stepper::new(system.clone(), h).unwrap(), COARSEST, body, start, shift)
}

pub(crate) fn unshifted<A, const D: usize>(_: &A, _: f64) -> SVector<f64, D> {
    SVector::zeros()
}

fn assert_second_order<L: System<Group: MatrixLieGroup<N, D>> + Clone, const N: usize, const D: usize>(
    system: &L,
    inertia: SMatrix<f64, D, D>,
    start: Start<L::Group>,
    potential: impl Fn(&SMatrix<f64, N, N>) -> f64,
) {
    let body = Body { inertia, potential: &potential };
    let errors = errors(system, &body, start, unshifted);
    let order = order(&errors, PLATEAU);
    println!("order {order:.4}, errors {:.2e} to {:.2e}", errors[0].1, errors[4].1);
    assert!((order - 2.0).abs() < 0.05, "order {order}, errors {errors:?}");
}

/// Checks the orders of the declared step and of two compositions, on other groups than SO(3).
fn assert_orders<L: System<Group: MatrixLieGroup<N, D>> + Clone, const N: usize, const D: usize>(
    system: &L,
    (inertia, potential): (SMatrix<f64, D, D>, impl Fn(&SMatrix<f64, N, N>) -> f64),
    start: Start<L::Group>,
    coarsest: f64,
) {
    assert_second_order(system, inertia, start, &potential);
    for scheme in [CompositionScheme::SUZUKI_4, TRIPLE_JUMP] {
        let composed = |h: f64| Stepper::composed(system.clone(), h, scheme).unwrap();
        let errors = errors_of(composed, coarsest, &Body { inertia, potential: &potential }, start, unshifted);
        let order = order(&errors, PLATEAU);
        println!("{}: order {order:.4}, errors {:.2e} to {:.2e}", scheme.name(), errors[0].1, errors[4].1);
        assert!((order - 4.0).abs() < 0.1, "{}: order {order}, errors {errors:?}", scheme.name());
    }
}

/// Three kinetic terms under the same weight.
#[test]
fn tops() {
    let (top, full, cayley) = (samples::heavy_top(), samples::full_top(), samples::cayley_top());
    let potential = |r: &Matrix3<f64>| top.m * top.g * top.up.dot(&(r * top.rho));
    assert_second_order(&top, ordinary(&top.J_d.to_matrix()), samples::on_so3(), potential);
    assert_second_order(&full, ordinary(full.J_d.as_matrix()), samples::on_so3(), potential);
    assert_second_order(&cayley, *cayley.J.as_matrix(), samples::on_so3(), potential);
}

#[test]
fn free_body() {
    let body = samples::free_body();
    assert_second_order(&body, ordinary(body.J_d.as_matrix()), samples::on_so3(), |_| 0.0);
}

/// The kick before the step is the sum of two halves: between them the momentum is of second order, and at the declared
/// point of first order.
#[test]
fn log_trace_top() {
    let top = samples::log_trace_top();
    let potential = |r: &Matrix3<f64>| top.weight * top.up.dot(&(r * top.rho));
    let body = Body { inertia: Matrix3::identity() * top.I1, potential: &potential };
    let half_kick = |w: &Vector3<f64>, h: f64| w.cross(&top.rho) * (0.5 * h * top.weight);
    let shifted = order(&errors(&top, &body, samples::on_so3(), half_kick), PLATEAU);
    let plain = order(&errors(&top, &body, samples::on_so3(), unshifted), PLATEAU);
    println!("order {shifted:.4} between the kicks, {plain:.4} before them");
    assert!((shifted - 2.0).abs() < 0.05, "{shifted}");
    assert!((plain - 1.0).abs() < 0.05, "{plain}");
}

#[test]
fn satellite() {
    let body = samples::satellite();
    let boom = body.tip * body.tip.transpose() * (2.0 * body.m);
    let inertia = ordinary(&(body.J_d.as_matrix() + boom));
    assert_second_order(&body, inertia, samples::on_so3(), |r| {
        let inverse_distances = 1.0 / (body.centre - r * body.tip).norm() + 1.0 / (body.centre + r * body.tip).norm();
        -body.GM * body.m * inverse_distances
    });
}

#[test]
fn orbiting_body() {
    let body = samples::orbiting_body();
    assert_orders(&body, orbit(&body), samples::in_orbit(), 0.1);
}

/// The inertia for rotation and translation of a body with the first moment `s = ∫ X dm`:
/// `½ Ω·𝕀Ω + Ω·(s × v) + ½ m v²`.
fn orbit(body: &OrbitingBody) -> (SMatrix<f64, 6, 6>, impl Fn(&Matrix4<f64>) -> f64 + use<'_>) {
    let first: Vector3<f64> = body.J.fixed_view::<3, 1>(0, 3).into_owned();
    let mut inertia = SMatrix::<f64, 6, 6>::identity() * body.J[(3, 3)];
    inertia.fixed_view_mut::<3, 3>(0, 0).copy_from(&ordinary(&rotation(&body.J)));
    inertia.fixed_view_mut::<3, 3>(0, 3).copy_from(&first.cross_matrix());
    inertia.fixed_view_mut::<3, 3>(3, 0).copy_from(&-first.cross_matrix());
    (inertia, move |g| {
        let distance = |p: Point3<f64>| (g.transform_point(&p) - body.centre).norm();
        -body.GM * (body.m1 / distance(body.p1) + body.m2 / distance(body.p2))
    })
}

#[test]
fn spring() {
    let body = samples::spring();
    assert_second_order(&body, ordinary(body.J_d.as_matrix()), samples::on_so3(), |r| {
        0.5 * body.k * ((body.anchor - r * body.rho).norm() - body.length).powi(2)
    });
}

/// The reference is the equations of motion with `J(w) = J + m (ρ × w)(ρ × w)ᵀ`, written by hand.
#[test]
fn sliding_top() {
    let top = samples::sliding_top();
    let inertia = ordinary(top.J_d.as_matrix());
    let (attitude, velocity) = samples::on_so3();
    let stack = |p: Vector3<f64>, w: Vector3<f64>| Vector6::from_iterator(p.iter().chain(&w).copied());
    let momentum = |velocity: &Vector3<f64>, w: &Vector3<f64>| {
        let lever = top.rho.cross(w);
        inertia * velocity + lever * (top.m * lever.dot(velocity))
    };
    let rate = |z: Vector6<f64>| {
        let (p, w) = (z.fixed_rows::<3>(0).into_owned(), z.fixed_rows::<3>(3).into_owned());
        let lever = top.rho.cross(&w);
        let omega = (inertia + lever * lever.transpose() * top.m).try_inverse().unwrap() * p;
        let arm = omega.cross(&top.rho);
        let slope = arm * (top.m * w.dot(&arm)) - top.rho * (top.m * top.g);
        stack(p.cross(&omega) + slope.cross(&w), w.cross(&omega))
    };
    let start = attitude.inverse().as_matrix() * top.up;
    let steps = 2000;
    let exact = (0..steps).fold(stack(momentum(&velocity, &start), start), |z, _| {
        z + runge_kutta::change(z, 1.0 / f64::from(steps), rate)
    });
    let errors = [80_u32, 160, 320].map(|steps| {
        let stepper = liestep::Stepper::new(top.clone(), 1.0 / f64::from(steps)).unwrap();
        let mut state = stepper.start(attitude, velocity).unwrap();
        stepper.run(&mut state, u64::from(steps)).unwrap();
        (stack(state.momentum(), state.advected()) - exact).norm()
    });
    println!("{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.02, "{order}");
    }
}

#[test]
fn magnet() {
    let body = samples::magnet();
    assert_second_order(&body, ordinary(body.J_d.as_matrix()), samples::on_so3(), |r| {
        -body.field.dot(&(r * body.m)) - 0.5 * (body.gradient.0 * r * body.Q * r.transpose()).trace()
    });
}

#[test]
fn underwater_body() {
    let body = samples::underwater_body();
    assert_orders(&body, kirchhoff(&body), samples::on_se3(), 0.2);
}

/// The velocity of the centre `c` is `v + Ω × c = v − ĉ Ω`, and `½ Ω·𝕀Ω` and `½ v_c·M v_c` add.
pub(crate) fn kirchhoff(body: &UnderwaterBody) -> (SMatrix<f64, 6, 6>, impl Fn(&Matrix4<f64>) -> f64 + use<>) {
    let centre = body.origin.coords;
    let mut velocity_of_centre = SMatrix::<f64, 3, 6>::zeros();
    velocity_of_centre.fixed_view_mut::<3, 3>(0, 0).copy_from(&-centre.cross_matrix());
    velocity_of_centre.fixed_view_mut::<3, 3>(0, 3).copy_from(&Matrix3::identity());
    let mut inertia = velocity_of_centre.transpose() * rotation(&body.M) * velocity_of_centre;
    let mut turning = inertia.fixed_view_mut::<3, 3>(0, 0);
    turning += ordinary(&rotation(&body.J));
    let (lever, net): (Vector3<f64>, f64) = (body.weight.fixed_rows::<3>(0).into_owned(), body.weight[3]);
    (inertia, move |g| (rotation(g) * lever).z + net * g[(2, 3)])
}

#[test]
fn tethered_plate() {
    let body = samples::tethered_plate();
    assert_orders(&body, tether(&body), samples::on_se2(), 0.1);
}

/// The inertia of a planar body with the first moment `s`: the velocity of `X` is `v + ω (−X_2, X_1)`.
fn tether(body: &TetheredPlate) -> (Matrix3<f64>, impl Fn(&Matrix3<f64>) -> f64 + use<'_>) {
    let (J, m) = (body.J, body.J[(2, 2)]);
    let (first, second) = (J[(0, 2)], J[(1, 2)]);
    let inertia = Matrix3::new(J[(0, 0)] + J[(1, 1)], -second, first, -second, m, 0.0, first, 0.0, m);
    (inertia, move |g| 0.5 * body.k * ((g.transform_point(&body.p) - body.anchor).norm() - body.length).powi(2))
}

#[test]
fn elastic_flow() {
    let system = samples::elastic_flow();
    let hat = |k| SL2::hat(&Vector3::ith(k, 1.0));
    let inertia = Matrix3::from_fn(|k, j| (hat(k) * system.M * hat(j).transpose()).trace());
    assert_second_order(&system, inertia, samples::on_sl2(), |g| 0.5 * system.k * g.norm_squared());
}
