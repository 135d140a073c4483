//! Discretisations that take long to expand.

use crate::common::bodies::{CART, LINKS, OF_CART, OF_LINKS};
use crate::common::{expanded, is_refused, is_self_adjoint};

/// Discretisations on every group, whatever the form of its Cayley transform, are self-adjoint or refused.
#[test]
fn on_every_group() {
    let groups = [
        ("SO2", 2, 1),
        ("SE2", 3, 3),
        ("SO3", 3, 3),
        ("SE3", 4, 6),
        ("SU2", 4, 3),
        ("SL2", 2, 3),
        ("Heisenberg", 3, 3),
        ("R1", 2, 1),
        ("R2", 3, 2),
        ("R3", 4, 3),
    ];
    for (group, size, dimension) in groups {
        let inertia: Vec<String> = (0..dimension).map(|k| format!("0.5 * j{k} * xi[{k}] * xi[{k}]")).collect();
        let fields: Vec<String> = (0..dimension).map(|k| format!("j{k}: f64")).collect();
        let kinetic = inertia.join(" + ");
        let item = format!("struct Body {{ {}, r: Vector{size}<f64>, up: Vector{size}<f64> }}", fields.join(", "));
        // Expansions on the larger groups take long in a build that isn't optimised.
        let rules: &[&str] =
            if dimension > 3 { &["trapezoid(Cayley)"] } else { &["trapezoid(Cayley)", "chord(Cayley)"] };
        for rule in rules {
            let arguments = format!(
                "group = {group}, velocity = xi, advected(w = up), l = {kinetic} - w.dot(&r), discretise = {rule}"
            );
            assert!(!is_refused(&expanded(&arguments, &item)), "{group}, {rule}");
        }
        let closed = ["SO3", "Heisenberg", "R1", "R2", "R3"].contains(&group);
        let arguments = format!(
            "group = {group}, velocity = xi, advected(w = up), l = {kinetic} - w.dot(&r), discretise = midpoint(exp)"
        );
        assert_eq!(is_refused(&expanded(&arguments, &item)), !closed, "{group}, midpoint(exp)");
    }
    let own = "group = Affine, generators = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [0.0, 0.0]]], velocity = xi,
        advected(w = up), l = 0.5 * j * xi.norm_squared() - w.dot(&r), discretise = trapezoid(Cayley)";
    assert!(!is_refused(&expanded(own, "struct Body { j: f64, r: Vector2<f64>, up: Vector2<f64> }")));
}

/// Each rule of discretisation is its own adjoint for several bodies too, and its limit is `l`.
#[test]
fn discretisations_of_several_bodies() {
    for (arguments, item) in [(LINKS, OF_LINKS), (CART, OF_CART)] {
        for rule in ["trapezoid(Cayley)", "trapezoid(exp)", "midpoint(exp)", "chord(Cayley)"] {
            let expansion = expanded(&format!("{arguments}, discretise = {rule}"), item);
            assert!(!is_refused(&expansion), "{rule}: {expansion}");
            assert!(is_self_adjoint(&expansion), "{rule}");
        }
    }
}
