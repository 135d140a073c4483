//! The derived equations as documentation of the generated methods, and as one text.

use crate::derive::{Declared, Derived, SelfAdjointness};
use crate::scalar::{Graph, Kernel, NodeId, count};
use crate::symbolic::{Stage, covector_text, text};

/// A method with its equation.
pub(super) struct Equation {
    pub(super) method: &'static str,
    left: &'static str,
    right: String,
    source: &'static str,
}

/// The equations of a declaration, in the order of the thesis.
pub(super) fn equations(derived: &Derived, declared: &Declared, kernel: &Kernel) -> Vec<Equation> {
    let symbols = &derived.symbols;
    let covector = |expression| covector_text(expression, derived.directions.first, symbols);
    let scalar = |expression| text(expression, symbols);
    let equation = |method, left, right, source| Equation { method, left, right, source };
    let candidates = kernel.candidates.iter().map(|candidate| format!("{}: {}", candidate.name, candidate.operations));
    vec![
        equation("l_d", "l_d", scalar(&declared.l_d), "as declared, with FᵀF = I used"),
        equation("right_momentum", "(R_F)* δl_d/δF", covector(&derived.right_momentum), "section 3.2.1, item 2"),
        equation("left_momentum", "(L_F)* δl_d/δF", covector(&derived.left_momentum), "section 3.2.1, item 1; (2.6)"),
        equation("diamond", "δl_d/δw ⋄ w", covector(&derived.diamond), "(2.1)"),
        equation("legendre_minus", "μ", covector(&derived.momentum), "(2.7)"),
        equation("momentum_jacobian", "∂μ_k along exp(tE_j)F", scalar(&derived.jacobian), "exact, right-trivialised"),
        equation("discrete_energy", "−∂l_d/∂h", scalar(&derived.energy), ""),
        equation("inertia", "η·Jξ for η̂ = E_k, ξ̂ = E_j", scalar(&derived.limit.inertia), "continuous limit"),
        equation("momentum_bias", "s", covector(&derived.limit.bias), "continuous limit"),
        equation("potential", "V", scalar(&derived.limit.potential), "continuous limit"),
        equation("kick_before", "k₀", covector(&derived.kick_before), "a = μ + k₀"),
        equation("kick_after", "k₁⁺", covector(&derived.kick_after), "μ⁺ = Ad*_F a + k₁⁺"),
        equation(
            "newton_system",
            "candidates, cheapest first",
            candidates.collect::<Vec<_>>().join("; "),
            "an iteration",
        ),
    ]
}

/// The documentation of one method, with the operations of its code.
pub(super) fn of(equations: &[Equation], method: &str, graph: &Graph, outputs: &[NodeId]) -> String {
    let operations = count(graph, outputs, None);
    let found = equations.iter().find(|equation| equation.method == method);
    let (left, right, source) = found.map_or(("", "", ""), |e| (e.left, e.right.as_str(), e.source));
    let source = if source.is_empty() { String::new() } else { format!("    [{source}]") };
    format!("```text\n{left} = {right}{source}\n```\n\n{operations}.")
}

/// The documentation of a stage.
pub(super) fn stage(graph: &Graph, outputs: &[NodeId], stage: Stage, when: &str) -> String {
    format!("{} at {when}.", count(graph, outputs, Some(stage)))
}

/// All equations as one text.
pub(super) fn derivation(equations: &[Equation], self_adjointness: SelfAdjointness) -> String {
    let line = |equation: &Equation| {
        let source = if equation.source.is_empty() { String::new() } else { format!("    [{}]", equation.source) };
        format!("{}\n    {} = {}{source}\n", equation.method, equation.left, equation.right)
    };
    equations.iter().map(line).chain([adjoint(self_adjointness)]).collect()
}

/// Whether the Lagrangian is self-adjoint, how that was found, and what follows.
fn adjoint(found: SelfAdjointness) -> String {
    let (sign, how, consequence) = match found {
        SelfAdjointness::Symbolic => ("=", "by the normal forms", "even order; a step of −h undoes a step of h"),
        SelfAdjointness::Numeric => {
            ("=", "at random points, to rounding", "even order; a step of −h undoes a step of h")
        }
        SelfAdjointness::No => ("≠", "at random points", "order 1 in general; a step of −h doesn't undo a step of h"),
        SelfAdjointness::Unknown => ("≟", "no value at the random points", "not known to be its own adjoint"),
    };
    format!("self-adjoint\n    l_d(F, w, h) {sign} −l_d(F⁻¹, F⁻¹·w, −h)    [{how}: {consequence}]\n")
}
