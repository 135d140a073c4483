//! The conserved momenta of several bodies.
//!
//! Let `η = (η_1, …, η_n)` be constant in space, with `η·a_0 = 0` for the spatial values of all advected parameters.
//! The transport form changes `Σ ⟨Ad*_{g_a⁻¹} μ_a, η_a⟩` by the diamond along `g⁻¹·η`, which is
//! `−⟨δl_d/δw, g⁻¹·(η·a_0)⟩ = 0`: the sum is constant at any tolerance of the solve. A relative attitude has the
//! identity for its spatial value, so both bodies have the same `η`; a vector in the axes of a body restricts `η` to
//! rotations about it; the attitude of a body in space allows no `η` for that body.

use crate::declared::{Declaration, FieldKind};
use crate::mathematics::derive::View;
use crate::mathematics::symbolic::Variance;

/// The sum of the spatial momenta of some bodies, or its component along a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Invariant {
    pub bodies: Vec<usize>,
    pub along: Option<usize>,
}

/// The conserved momenta of rotating bodies; each group of coupled bodies has one, or none.
pub fn conserved(declaration: &Declaration) -> Vec<Invariant> {
    // The first of the bodies that each body is coupled with.
    let mut first: Vec<usize> = (0..declaration.factors.len()).collect();
    for w in &declaration.advected {
        if let View::Relative { of, from } = w.seen {
            let (a, b) = (first[of], first[from]);
            first.iter_mut().filter(|body| **body == a || **body == b).for_each(|body| *body = a.min(b));
        }
    }
    let group = |root: usize| {
        let bodies: Vec<usize> = (0..first.len()).filter(|&body| first[body] == root).collect();
        let mut along = None;
        for (index, w) in declaration.advected.iter().enumerate().filter(|(_, w)| !w.is_given) {
            match w.seen {
                View::Configuration(of) if bodies.contains(&of) => return None,
                View::From(body) if bodies.contains(&body) => {
                    let is_vector = match declaration.advected_kind(index) {
                        FieldKind::Vector(_) => true,
                        FieldKind::Advected(variance, _) => {
                            matches!(variance, Variance::Vector | Variance::Covector)
                        }
                        _ => false,
                    };
                    let is_new = along.is_some_and(|known| Some(known) != w.field);
                    if !is_vector || is_new {
                        return None;
                    }
                    along = w.field;
                }
                _ => {}
            }
        }
        Some(Invariant { bodies, along })
    };
    (0..first.len()).filter(|&root| first[root] == root).filter_map(group).collect()
}
