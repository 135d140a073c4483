//! How many operations the Lagrangians of higher order come to.

use super::derived;
use crate::scalar::{Given, Graph, NodeId, count, kernel, with_values};
use crate::symbolic::Stage;

pub(crate) const TOP: &str = "struct Top { J: Inertia, weight: f64, rho: Vector3<f64>, up: Vector3<f64> }";

pub(crate) const FOURTH: &str = "group = SO3, advected(w = up), l_d = {
    let xi = log(F);
    let x = 2.0 * vee(F) / (1.0 + F.trace()).sqrt();
    let next = F.transpose() * w;
    let f = (J * x).cross(&x) / h.powi(2) + 0.5 * weight * (w + next).cross(&rho);
    xi.dot(&(J * xi)) / (2.0 * h) - 0.5 * h * weight * (w + next).dot(&rho)
        + (h / 12.0) * weight * (next - w).cross(&x).dot(&rho)
        - (h.powi(3) / 24.0) * f.dot(&(inverse(J) * f))
}";

pub(crate) const SIXTH: &str = "group = SO3, advected(w = up), l_d = {
    let xi = log(F);
    let om = xi / h;
    let middle = exp(-0.5 * xi) * w;
    let momentum = J * om;
    let f = momentum.cross(&om) + weight * middle.cross(&rho);
    let a = inverse(J) * f;
    let b = inverse(J) * (f.cross(&om) + momentum.cross(&a) - J * om.cross(&a)
        + weight * middle.cross(&om).cross(&rho));
    let sigma = 0.3872983346207417 * h;
    let bend = (-h * h / 20.0) * a;
    let twist = (h * h * sigma / 60.0) * b;
    let stretch = (h * h / 30.0) * b;
    let eta1 = bend + twist;
    let eta2 = (-h * h / 8.0) * a;
    let eta3 = bend - twist;
    let rate1 = stretch - sigma * a;
    let rate2 = (-h * h / 24.0) * b;
    let rate3 = stretch + sigma * a;
    let velocity1 = om + rate1 - eta1.cross(&(om + 0.5 * rate1
        - 0.5 * eta1.cross(&(om + rate1 / 3.0 - eta1.cross(&om) / 3.0))));
    let velocity2 = om + rate2 - eta2.cross(&(om + 0.5 * rate2
        - 0.5 * eta2.cross(&(om + rate2 / 3.0 - eta2.cross(&om) / 3.0))));
    let velocity3 = om + rate3 - eta3.cross(&(om + 0.5 * rate3
        - 0.5 * eta3.cross(&(om + rate3 / 3.0 - eta3.cross(&om) / 3.0))));
    let w1 = exp(-0.1127016653792583 * xi) * w;
    let w3 = exp(-0.8872983346207417 * xi) * w;
    let rho1 = rho + eta1.cross(&(rho + 0.5 * eta1.cross(&(rho + eta1.cross(&rho) / 3.0))));
    let rho2 = rho + eta2.cross(&(rho + 0.5 * eta2.cross(&(rho + eta2.cross(&rho) / 3.0))));
    let rho3 = rho + eta3.cross(&(rho + 0.5 * eta3.cross(&(rho + eta3.cross(&rho) / 3.0))));
    let kinetic = (5.0 * velocity1.dot(&(J * velocity1)) + 8.0 * velocity2.dot(&(J * velocity2))
        + 5.0 * velocity3.dot(&(J * velocity3))) / 2.0;
    let potential = weight * (5.0 * w1.dot(&rho1) + 8.0 * middle.dot(&rho2) + 5.0 * w3.dot(&rho3));
    (h / 18.0) * (kinetic - potential)
}";

/// Operations of an iteration, and of the residual alone.
fn operations(arguments: &str) -> (usize, usize) {
    let kernel = kernel(&derived(arguments, TOP));
    let count = |outputs: &[NodeId]| count(&kernel.graph, outputs, Some(Stage::Iteration)).arithmetic;
    (count(&[kernel.residual.as_slice(), &kernel.jacobian].concat()), count(&kernel.residual))
}

#[test]
fn closed_lets_halve_the_operations_of_the_fourth_order_top() {
    let (iteration, residual) = operations(FOURTH);
    assert!(iteration <= 1_550 && residual <= 350, "{iteration} {residual}");
}

/// A value of `l_d` takes 735; its gradient by multipliers is the residual.
#[test]
fn a_gradient_costs_less_than_three_values_of_the_sixth_order_top() {
    let derived = derived(SIXTH, TOP);
    let mut graph = Graph::default();
    let lets = derived.closed.iter().map(|one| (one.symbol, &one.value));
    let values = with_values(&mut graph, &derived.symbols, lets, Given::new());
    let nodes: Vec<NodeId> = values.values().flat_map(|entries| entries.all().to_vec()).collect();
    let value = count(&graph, &nodes, None).arithmetic;
    let (iteration, residual) = operations(SIXTH);
    assert!(residual < 3 * value, "{residual} for the gradient, {value} for the value");
    assert!(iteration <= 13_000, "{iteration}");
}

#[test]
fn the_jacobians_of_the_higher_orders_are_dear() {
    let geodesic = "group = SO3, advected(w = up), l_d = {
        let xi = log(F);
        xi.dot(&(J * xi)) / (2.0 * h) - 0.5 * h * weight * w.dot(&(rho + F * rho))
    }";
    let is_dear = |arguments| kernel(&derived(arguments, TOP)).jacobian_is_dear();
    assert_eq!([geodesic, FOURTH, SIXTH].map(is_dear), [false, true, true]);
}
