//! The derived equations as documentation of the generated methods, and as one text.

use crate::derive::{Declared, Derived};
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

/// The equations of a force.
pub(super) fn equations_of_force(derived: &Derived, declared: &Declared, kernel: &Kernel) -> Vec<Equation> {
    let symbols = &derived.symbols;
    let covector = |expression| covector_text(expression, derived.directions.first, symbols);
    let equation = |method, left, right, source| Equation { method, left, right, source };
    let (work, jacobian) = (text(&declared.l_d, symbols), text(&derived.jacobian, symbols));
    let candidates = kernel.candidates.iter().map(|candidate| format!("{}: {}", candidate.name, candidate.operations));
    vec![
        equation("virtual_work", "f⁻·η + f⁺·η⁺", work, "as declared, with FᵀF = I used"),
        equation("momentum", "−f⁻", covector(&derived.momentum), "the share in (2.7)"),
        equation("momentum_jacobian", "−∂f⁻_k along exp(tE_j)F", jacobian, "exact, right-trivialised"),
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
pub(super) fn derivation(equations: &[Equation]) -> String {
    let line = |equation: &Equation| {
        let source = if equation.source.is_empty() { String::new() } else { format!("    [{}]", equation.source) };
        format!("{}\n    {} = {}{source}\n", equation.method, equation.left, equation.right)
    };
    equations.iter().map(line).collect()
}
