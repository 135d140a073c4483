//! Which momenta of several bodies are conserved.
//!
//! Let `η = (η_1, …, η_n)` be constant in space, and `η·a_0 = 0` for the spatial value of all that is advected. The
//! transport form changes `Σ ⟨Ad*_{g_a⁻¹} μ_a, η_a⟩` by the diamond along `g⁻¹·η`, which is `−⟨δl_d/δw, g⁻¹·(η·a_0)⟩ = 0`:
//! it is constant at any tolerance of the solve. One body as another sees it is the identity at first, which asks for
//! the same `η` for both; a vector that is seen asks for turns about it; a body as it is in space for none.

use crate::declared::{Declaration, FieldKind};
use crate::mathematics::derive::View;
use crate::mathematics::symbolic::Variance;

/// The sum of the spatial momenta of some bodies, or its component along a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Invariant {
    pub bodies: Vec<usize>,
    pub along: Option<usize>,
}

/// Those of bodies that turn; each group of bodies that see each other has one, or none.
pub fn conserved(declaration: &Declaration) -> Vec<Invariant> {
    // For each body the first of those that it is joined with.
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
