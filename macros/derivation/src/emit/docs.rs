//! The derived equations as documentation of the generated methods, and as one text.

use crate::declared::{AdvectedParameter, Declaration, Factor, Role};
use crate::judged::{Choice, Equations, Findings, Sureness};
use crate::mathematics::derive::{Continuous, DeclaredFunction, Derivation, Inverse, SelfAdjointness, View};
use crate::mathematics::symbolic::{Space, Stage, covector_text, matrix_text, text, vector_text};
use crate::program::{Candidate, Graph, Kernel, NodeId, count};

/// A method with its equation.
pub(super) struct Equation {
    pub(super) method: &'static str,
    left: String,
    right: String,
    source: String,
}

impl Equation {
    pub(super) fn new(method: &'static str, left: &str, right: String, source: &str) -> Self {
        Self { method, left: left.to_owned(), right, source: source.to_owned() }
    }

    /// `left = right    [source]`.
    pub(super) fn line(&self) -> String {
        let source = if self.source.is_empty() { String::new() } else { format!("    [{}]", self.source) };
        format!("{} = {}{source}", self.left, self.right)
    }
}

/// The closed `let`s and their multipliers, which occur in the equations; those of a force have none.
pub(super) fn lets(derived: &Derivation) -> String {
    let symbols = &derived.symbols;
    let name = |id| &symbols.get(id).name;
    if derived.closed.is_empty() {
        return String::new();
    }
    // A constant with many digits has its digits as its name.
    let named = || derived.closed.iter().filter(|one| name(one.symbol).parse::<f64>().is_err());
    let values = named().map(|one| format!("\n    {} = {}", name(one.symbol), text(&one.value, symbols)));
    let has_multipliers = derived.closed.iter().any(|one| !one.pairing.is_zero());
    let pairings = named().rev().filter(|_| has_multipliers).map(|one| {
        let (multiplier, direction) = (name(one.multiplier), name(one.direction));
        format!("\n    ⟨{multiplier}, {direction}⟩ = {}", text(&one.pairing, symbols))
    });
    let (values, pairings) = (values.collect::<String>(), pairings.collect::<String>());
    let multipliers = if has_multipliers { "\nmultipliers, λ_v = ∂l_d/∂v" } else { "" };
    format!("lets, kept closed{values}{multipliers}{pairings}\n")
}

/// The equations of a declaration, in the order of the thesis.
pub(super) fn equations(
    derived: &Derivation,
    declared: &DeclaredFunction,
    continuous: Option<&Equations>,
) -> Vec<Equation> {
    let symbols = &derived.symbols;
    let covector = |expression| covectors(derived, expression);
    let scalar = |expression| text(expression, symbols);
    let equation = Equation::new;
    let w: Vec<&str> = declared.advected.iter().map(|w| symbols.get(w.symbol).name.as_str()).collect();
    let at = at(&w);
    let mut equations = vec![
        equation("l_d", "l_d", scalar(&declared.expression), "as declared, in normal form"),
        equation("right_momentum", "(R_F)* δl_d/δF", covector(&derived.right_momentum), "section 3.2.1, item 2"),
        equation("left_momentum", "(L_F)* δl_d/δF", covector(&derived.left_momentum), "section 3.2.1, item 1; (2.6)"),
        equation("diamond", &moved_by("δl_d/δw ⋄ w", &w), covector(&derived.diamond), "(2.1)"),
        equation("legendre_minus", "μ", covector(&derived.momentum), "(2.7)"),
        equation("momentum_jacobian", "∂μ_k along exp(tE_j)F", scalar(&derived.jacobian), "exact, right-trivialised"),
        equation("discrete_energy", "−∂l_d/∂h", scalar(&derived.energy), ""),
        inertia(derived, continuous),
        equation("momentum_bias", &format!("s{at}"), covector(&derived.limit.bias), of_limit(continuous)),
        equation("potential", &format!("V{at}"), scalar(&derived.limit.potential), of_limit(continuous)),
        equation("kick_before", "k₀", covector(&derived.kick_before), "a step solves U(F) = μ + k₀"),
        equation("kick_after", "k₁⁺", covector(&derived.shown_kick_after), "μ⁺ = Ad*_F (μ + k₀) + k₁⁺"),
    ];
    let shares = declared.advected.iter().zip(&derived.shares).map(|(w, share)| {
        let name = &symbols.get(w.symbol).name;
        equation("diamond", &format!("δl_d/δ{name} ⋄ {name}"), covector(share), &format!("of {name} alone"))
    });
    let behind = equations.iter().position(|one| one.method == "diamond").map_or(0, |at| at + 1);
    equations.splice(behind..behind, shares);
    if let Some([next, before]) = &derived.flow {
        let (next, before) = (covector(next), covector(before));
        if next.len() + before.len() <= LONGEST {
            equations.push(equation("increments", &next, before, "F ↦ F⁺, the flow (2.5); of the heavy top (3.16)"));
        }
    }
    if let Some(change) = &derived.kick_derivative {
        let left = moved_by("∂k₀ along exp(−tE_j)·w", &w);
        equations.push(equation("kick_derivative", &left, covector(change), "the force gradient's"));
    }
    equations
}

/// The names of the advected parameters.
pub(super) fn names(declaration: &Declaration) -> Vec<String> {
    declaration.advected.iter().map(AdvectedParameter::plain_name).collect()
}

/// `(w, v)`, the arguments of a function of the advected parameters.
pub(super) fn at(w: &[impl AsRef<str>]) -> String {
    let names = w.iter().map(AsRef::as_ref).collect::<Vec<_>>().join(", ");
    if names.is_empty() { names } else { format!("({names})") }
}

/// A formula in `w` with the names of the advected parameters, in parentheses if there are several.
pub(super) fn moved_by(formula: &str, w: &[impl AsRef<str>]) -> String {
    match w {
        [] => formula.to_owned(),
        [one] => formula.replace('w', one.as_ref()),
        several => formula.replace('w', &at(several)),
    }
}

/// A covector, or those of several bodies.
fn covectors(derived: &Derivation, expression: &crate::mathematics::symbolic::Expression) -> String {
    let (symbols, factors) = (&derived.symbols, &derived.directions.factors);
    let of_factor = |first| {
        let own = expression.filtered(|monomial| crate::mathematics::symbolic::monomial_contains(monomial, first));
        // The direction of a translation is a vector.
        let vector = if symbols.get(first).shape.1 == 1 { vector_text(&own, first, symbols) } else { None };
        vector.unwrap_or_else(|| covector_text(&own, first, symbols))
    };
    match factors.as_slice() {
        [one] => covector_text(expression, one.first, symbols),
        factors => factors.iter().map(|one| of_factor(one.first)).collect::<Vec<_>>().join(";  "),
    }
}

/// The limit on the length of the inertia matrix and of the flow on increments, which have other forms if longer.
const LONGEST: usize = 1_500;

/// The source of `J`, `s` and `V`.
fn of_limit(continuous: Option<&Equations>) -> &'static str {
    match continuous.map(|equations| equations.derived.inverse) {
        Some(Inverse::Nonlinear) => "continuous limit at rest",
        _ => "continuous limit",
    }
}

/// `J` as a matrix, if it has that form.
fn inertia(derived: &Derivation, continuous: Option<&Equations>) -> Equation {
    let quadratic = continuous.filter(|equations| equations.derived.inverse != Inverse::Nonlinear);
    let as_matrix = quadratic.and_then(|equations| inertia_matrix(&equations.derived));
    match as_matrix {
        Some(text) if text.len() <= LONGEST => Equation::new("inertia", "𝕀", text, "continuous limit"),
        _ => {
            let text = text(&derived.limit.inertia, &derived.symbols);
            Equation::new("inertia", "η·𝕀ξ for η̂ = E_k, ξ̂ = E_j", text, of_limit(continuous))
        }
    }
}

/// The equations of a force.
pub(super) fn equations_of_force(derived: &Derivation, declared: &DeclaredFunction) -> Vec<Equation> {
    let symbols = &derived.symbols;
    let covector = |expression| covectors(derived, expression);
    let equation = Equation::new;
    let (work, jacobian) = (text(&declared.expression, symbols), text(&derived.jacobian, symbols));
    vec![
        equation("virtual_work", "f⁻·η + f⁺·η⁺", work, "as declared, with FᵀF = I used"),
        equation("momentum", "−f⁻", covector(&derived.momentum), "the share in (2.7)"),
        equation("momentum_jacobian", "−∂f⁻_k along exp(tE_j)F", jacobian, "exact, right-trivialised"),
        equation("kick_before", "k₀", covector(&derived.kick_before), "a step solves U(F) = μ + k₀"),
        equation("kick_after", "k₁⁺", covector(&derived.shown_kick_after), "μ⁺ = Ad*_F (μ + k₀) + k₁⁺"),
    ]
}

/// The documentation of a method: its equations, and the operations of its code.
pub(super) fn of(equations: &[Equation], methods: &[&str], graph: &Graph, outputs: &[NodeId]) -> String {
    let operations = count(graph, outputs, None);
    let found = equations.iter().filter(|equation| methods.contains(&equation.method));
    let lines: Vec<String> = found.map(Equation::line).collect();
    if lines.is_empty() {
        return format!("{operations}.");
    }
    format!("```text\n{}\n```\n\n{operations}.", lines.join("\n"))
}

/// The documentation of a stage.
pub(super) fn stage(graph: &Graph, outputs: &[NodeId], stage: Stage, when: &str) -> String {
    format!("{} at {when}.", count(graph, outputs, Some(stage)))
}

/// The equations, their hypotheses and their cost, as one text.
pub(super) fn derivation(
    declaration: &Declaration,
    chosen: &Choice,
    equations: &[Equation],
    continuous: Option<String>,
    findings: &Findings,
) -> String {
    // Several equations of one method stand below one heading.
    let line = |(at, equation): (usize, &Equation)| {
        let is_next = at > 0 && equations[at - 1].method == equation.method;
        let head = if is_next { String::new() } else { format!("{}\n", equation.method) };
        format!("{head}    {}\n", equation.line())
    };
    let hypotheses = match findings.hypotheses.as_slice() {
        [] => "none".to_owned(),
        used => used.join(", "),
    };
    let sections = [
        ("hypotheses used", hypotheses),
        ("self-adjoint", adjoint(findings, declaration)),
        ("certainty", certified(OF_A_STEP, findings.sureness)),
        ("Newton system", candidates(&chosen.kernel)),
        ("operations", costs(&chosen.kernel)),
    ];
    let sections = sections.map(|(title, text)| format!("{title}\n    {text}\n"));
    let beginning = [setting(declaration, true), lets(&chosen.derived)];
    beginning.into_iter().chain(equations.iter().enumerate().map(line)).chain(continuous).chain(sections).collect()
}

/// The operations of each stage, one a line.
pub(super) fn costs(kernel: &Kernel) -> String {
    let before = [kernel.kick_before.as_slice(), &kernel.residual, &kernel.jacobian].concat();
    // The sum a = μ + k₀ takes an addition for each component.
    let mut before_the_solve = count(&kernel.graph, &before, Some(Stage::Step));
    before_the_solve.arithmetic += kernel.residual.len();
    format!(
        "construction: {}\n    step, before the solve: {}\n    Newton iteration: {}\n    step, after the solve: {}",
        count(&kernel.graph, &[before.as_slice(), &kernel.kick_after].concat(), Some(Stage::Construction)),
        before_the_solve,
        count(&kernel.graph, &before, Some(Stage::Iteration)),
        count(&kernel.graph, &kernel.kick_after, Some(Stage::Step))
            + count(&kernel.graph, &kernel.kick_after, Some(Stage::Iteration)),
    )
}

/// `∂²l/∂ξ²` as a matrix, if it has that form.
pub(super) fn inertia_matrix(derived: &Continuous) -> Option<String> {
    let [directions] = derived.directions.as_slice() else { return None };
    matrix_text(&derived.hessian, directions.map(|direction| direction.components), &derived.symbols)
}

/// The group and its action on the advected parameters.
pub(super) fn setting(declaration: &Declaration, is_discrete: bool) -> String {
    let names = declaration.factors.iter().map(Factor::group_name);
    let group = names.collect::<Vec<_>>().join(" × ");
    let is_product = declaration.group.is_product();
    let increment = |factor: usize| declaration.factors.get(factor).map_or("F", |factor| factor.name.as_str());
    // The continuous setting has no increments, and their names stand for the bodies.
    let element = |factor: usize| if is_product { format!("g_{}", factor + 1) } else { "g".to_owned() };
    let advected = declaration.advected.iter().enumerate().map(|(index, w)| {
        let name = w.plain_name();
        let f = match w.seen {
            View::From(factor) => increment(factor),
            View::Relative { of, from } => {
                let (one, other) = (increment(of), increment(from));
                let (g, from) = (element(of), element(from));
                return match (declaration.group.factor(of).is_added, is_discrete) {
                    (true, true) => {
                        format!("    {name}⁺ = {name} + {one} − {other}: the place of {one} as {other} sees it\n")
                    }
                    (true, false) => format!("    {name} = {g} − {from}: the place of {one} as {other} sees it\n"),
                    (false, true) => {
                        format!("    {name}⁺ = {other}⁻¹ {name} {one}: the body of {one} as that of {other} sees it\n")
                    }
                    (false, false) => {
                        format!("    {name} = {from}⁻¹ {g}: the body of {one} as that of {other} sees it\n")
                    }
                };
            }
            View::Configuration(of) => {
                let (one, g) = (increment(of), element(of));
                return match (declaration.group.factor(of).is_added, is_discrete) {
                    (true, true) => format!("    {name}⁺ = {name} + {one}: the place of {one} in space\n"),
                    (true, false) => format!("    {name} = {g}: the place of {one} in space\n"),
                    (false, true) => format!("    {name}⁺ = {name} {one}: the body of {one} as it is in space\n"),
                    (false, false) => format!("    {name} = {g}: the body of {one} as it is in space\n"),
                };
            }
        };
        let variance = declaration.advected_kind(index).variance();
        let spaces = variance.spaces().into_iter().flatten().map(|space| if space == Space::Own { "V" } else { "V*" });
        let space = spaces.collect::<Vec<_>>().join(" ⊗ ");
        let [left, right] = variance.sides([&"F⁻¹", &"F"], |&matrix| if matrix == "F" { "Fᵀ" } else { "F⁻ᵀ" });
        let Some(left) = left else { return format!("    {} is given for each step\n", w.plain_name()) };
        let moved = &right.map_or_else(|| format!("{left} w"), |right| format!("{left} w {right}"));
        if is_discrete {
            let moved = with_names(moved, f, &name);
            format!("    {name}⁺ = {f}⁻¹·{name} = {moved} for {name} in {space}\n")
        } else if is_product {
            let of = if let View::From(factor) = w.seen { element(factor) } else { String::new() };
            format!("    {name} = {of}⁻¹·a₀ in {space}, seen from {f}\n")
        } else {
            format!("    {name} = g⁻¹·a₀ in {space}\n")
        }
    });
    let advected: String = advected.collect();
    let increments = declaration.factors.iter().map(|factor| factor.name.as_str()).collect::<Vec<_>>().join(", ");
    let whole = match (is_discrete, is_product) {
        (true, true) => format!("F = ({increments}) = g⁻¹ g⁺"),
        (true, false) if increments != "F" => format!("F = {increments} = g⁻¹ g⁺"),
        (true, false) => "F = g⁻¹ g⁺".to_owned(),
        (false, true) => {
            let elements: Vec<String> = (0..declaration.factors.len()).map(element).collect();
            format!("g = ({})", elements.join(", "))
        }
        (false, false) => "g".to_owned(),
    };
    let bodies = if is_product && !is_discrete { format!(", of {increments}") } else { String::new() };
    let basis = match (is_discrete, is_product) {
        (false, _) => "",
        (true, false) => "    E_k, E_j: of the basis of the algebra, μ_k = ⟨μ, E_k⟩\n",
        (true, true) => "    E_k_1, E_j_1: of the basis of the first factor's algebra, and so on\n",
    };
    format!("group\n    {whole} in {group}{bodies}\n{advected}{basis}")
}

/// `F⁻¹ w` with the names of an increment and of a parameter, either of which may contain the other's letter.
fn with_names(formula: &str, increment: &str, moved: &str) -> String {
    let mut text = String::new();
    for letter in formula.chars() {
        match letter {
            'F' => text.push_str(increment),
            'w' => text.push_str(moved),
            other => text.push(other),
        }
    }
    text
}

/// The unknown of the Newton system, its form, and the other candidates for it.
pub(super) fn candidates(kernel: &Kernel) -> String {
    let unknown = if kernel.in_increment {
        "U(F) = μ + k₀ along F ↦ exp(tE_j)F, right-trivialised"
    } else {
        "U(F) = μ + k₀ in the Cayley vector y of F, tan(θ/2) along the axis"
    };
    let line = |(index, candidate): (usize, &Candidate)| {
        let verdict = if index == 0 { "taken" } else { "rejected" };
        format!("\n    {verdict}: {}, {} an iteration", candidate.name, candidate.operations)
    };
    kernel.candidates.iter().enumerate().map(line).fold(unknown.to_owned(), |text, line| text + &line)
}

/// The bound on the probability of a wrong derivation, as text.
pub(super) fn certified(what: &str, sureness: Sureness) -> String {
    match sureness {
        Sureness::Certified(exponent) => format!("{what} are identities; {}", wrong(exponent)),
        Sureness::TooHigh => {
            format!("{what} are not certified: degrees are too high for a bound; they agree at random points, exactly")
        }
        Sureness::Multiple => format!(
            "{what} are not certified: a constant is a multiple of 2⁶¹ − 1, modulo which they agree wherever both have values"
        ),
        Sureness::Series => format!(
            "{what} are not certified: a generator's cube isn't a multiple of it; they agree in power series, exactly"
        ),
    }
}

fn wrong(exponent: u32) -> String {
    let exponent: String = exponent.to_string().chars().filter_map(superscript).collect();
    format!("a wrong one would pass with a probability below 2⁻{exponent}")
}

/// The parts of a step that are compared.
pub(super) const OF_A_STEP: &str = "the terms and the stages of a step";

fn superscript(digit: char) -> Option<char> {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    digits.get(usize::try_from(digit.to_digit(10)?).ok()?).copied()
}

/// The self-adjointness of the Lagrangian or of the force, its proof, and its consequence.
fn adjoint(findings: &Findings, declaration: &Declaration) -> String {
    let even = "even order; a step of −h undoes a step of h";
    let how_sure = match (findings.sureness, findings.self_adjointness) {
        (Sureness::Certified(exponent), SelfAdjointness::Exact) => wrong(exponent),
        (Sureness::Multiple, _) => "modulo 2⁶¹ − 1, without a bound".to_owned(),
        _ => "exactly, without a bound".to_owned(),
    };
    let at_points = format!("at random points, {how_sure}");
    let (sign, how, consequence) = match findings.self_adjointness {
        SelfAdjointness::Symbolic => ("=", "by the normal forms", even),
        SelfAdjointness::Exact | SelfAdjointness::WithoutBound => ("=", at_points.as_str(), even),
        SelfAdjointness::ForPoints => (
            "≠",
            "equal, at random points, if all vectors have 1 for their last coordinate, as the types of points promise",
            "with such vectors even order, and a step of −h undoes a step of h",
        ),
        SelfAdjointness::No => ("≠", "at random points", "order 1 in general; a step of −h doesn't undo a step of h"),
    };
    let w = names(declaration);
    let [here, there] = ["", "F⁻¹·"].map(|turned| w.iter().fold(String::new(), |all, w| all + turned + w + ", "));
    let (function, ends) =
        if declaration.role == Role::Force { ("δW", [", η, η⁺", ", η⁺, η"]) } else { ("l_d", [""; 2]) };
    format!("{function}(F, {here}h{}) {sign} −{function}(F⁻¹, {there}−h{})    [{how}: {consequence}]", ends[0], ends[1])
}
