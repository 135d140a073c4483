//! Controls: kinetic terms that aren't self-adjoint, as counterparts of those in the declarations. The scheme is of
//! first order and a step of `−h` doesn't undo one of `h`.

use checks::structure::reversal;
use liestep::groups::{CovariantTensor, LieGroup as _, SE3, SL2};
use liestep::lagrangian;
use liestep::mechanics::Effect as _;
use nalgebra::{Matrix2, Matrix3, Matrix4, Point3, Vector3, Vector4};
use workbench::measure::order;

use crate::order::{PLATEAU, errors, kirchhoff, unshifted};
use checks::continuous::Body;
use checks::samples;

/// [`UnderwaterBody`](declarations::UnderwaterBody) with its displacement in the frame before the step alone.
#[lagrangian(
    group = SE3,
    advected(w = height),
    l_d = {
        let d = F - I;
        let before = d * origin;
        let kinetic = (d * J * d.transpose()).trace() + before.dot(&(M * before));
        kinetic / (2.0 * h) - 0.5 * h * w.dot(&(weight + F * weight))
    },
)]
#[derive(Clone)]
struct OneSidedUnderwaterBody {
    J: Matrix4<f64>,
    M: Matrix4<f64>,
    origin: Point3<f64>,
    weight: Vector4<f64>,
    height: Vector4<f64>,
}

/// [`ElasticFlow`](declarations::ElasticFlow) with `F − I` in its kinetic term.
#[lagrangian(
    group = SL2,
    advected(C = metric),
    l_d = ((F - I) * M * (F - I).transpose()).trace() / (2.0 * h)
        - 0.25 * h * k * (C + F.transpose() * C * F).trace(),
)]
#[derive(Clone)]
struct OneSidedElasticFlow {
    M: Matrix2<f64>,
    k: f64,
    metric: CovariantTensor<f64, 2>,
}

// A composition takes only self-adjoint declarations, by a constant at compile time: these aren't self-adjoint.
const _: () = assert!(!OneSidedUnderwaterBody::FACTS.is_self_adjoint && !OneSidedElasticFlow::FACTS.is_self_adjoint);

fn assert_first_order(errors: &[(f64, f64)]) {
    let order = order(errors, PLATEAU);
    println!("order {order:.4}");
    assert!((order - 1.0).abs() < 0.1, "order {order}, errors {errors:?}");
}

#[test]
fn underwater_body() {
    let body = samples::underwater_body();
    let (inertia, potential) = kirchhoff(&body);
    let declarations::UnderwaterBody { J, M, origin, weight, height } = body;
    let one_sided = OneSidedUnderwaterBody { J, M, origin, weight, height };
    let continuous = Body { inertia, potential: &potential };
    assert_first_order(&errors(&one_sided, &continuous, samples::on_se3(), unshifted));
    assert!(reversal::error_of_return(&one_sided, 0.1, 46) > 1e-3);
}

#[test]
fn elastic_flow() {
    let system = samples::elastic_flow();
    let one_sided = OneSidedElasticFlow { M: system.M, k: system.k, metric: system.metric };
    let hat = |k| SL2::hat(&Vector3::ith(k, 1.0));
    let inertia = Matrix3::from_fn(|k, j| (hat(k) * system.M * hat(j).transpose()).trace());
    let potential = |g: &Matrix2<f64>| 0.5 * system.k * g.norm_squared();
    assert_first_order(&errors(&one_sided, &Body { inertia, potential: &potential }, samples::on_sl2(), unshifted));
    assert!(reversal::error_of_return(&one_sided, 0.1, 47) > 1e-3);
}
