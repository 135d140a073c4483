//! The text of the continuous equations.

use crate::declared::{Declaration, FieldKind};
use crate::emit::docs::{Equation, at, certified, inertia_matrix, moved_by, names, setting};
use crate::judged::Equations;
use crate::mathematics::derive::{AdvectedSymbol, Continuous, Element, Inverse, View};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Expression, Rational, Variance, monomial_contains, text, vector_text};

/// The limit on the length of an equation; longer ones are replaced by words.
const LONGEST: usize = 1_500;

/// The name of the velocity; `ξ` stands for those of several bodies together.
fn velocity(derived: &Continuous) -> &str {
    match derived.velocities.as_slice() {
        [one] => &derived.symbols.get(one.components).name,
        _ => "ξ",
    }
}

/// The names of the velocities of all factors.
fn velocities(derived: &Continuous) -> Vec<&str> {
    derived.velocities.iter().map(|velocity| derived.symbols.get(velocity.components).name.as_str()).collect()
}

/// A covector as a vector, if there is one body and the vector is short.
fn covector(derived: &Continuous, expression: &Expression) -> Option<String> {
    let [directions] = derived.directions.as_slice() else { return None };
    vector_text(expression, directions[0].components, &derived.symbols).filter(|text| text.len() <= LONGEST)
}

/// The part of a covector that belongs to a factor of the group.
fn of_factor(derived: &Continuous, factor: usize, expression: &Expression) -> Expression {
    let direction = derived.directions[factor][0];
    expression.filtered(|monomial| {
        let mut symbols = [Some(direction.components), direction.matrix].into_iter().flatten();
        symbols.any(|symbol| monomial_contains(monomial, symbol))
    })
}

/// The equations in the order of the thesis.
pub(super) fn equations(declaration: &Declaration, equations: &Equations) -> Vec<Equation> {
    let derived = &equations.derived;
    let scalar = |expression: &Expression| {
        let text = text(expression, &derived.symbols);
        if text.len() <= LONGEST { text } else { "…, which is long".to_owned() }
    };
    let paired = |method, name: &str, expression: &Expression, source| match covector(derived, expression) {
        Some(text) => Equation::new(method, name, text, source),
        None if derived.directions.len() > 1 => Equation::new(method, name, of_bodies(derived, expression), source),
        None => Equation::new(method, &format!("⟨{name}, η⟩"), scalar(expression), source),
    };
    let w = names(declaration);
    let all: Vec<&str> = velocities(derived).into_iter().chain(w.iter().map(String::as_str)).collect();
    let source = if declaration.continuous.is_some() { "as declared, in normal form" } else { "the limit of l_d/h" };
    let mut list = vec![
        Equation::new("l", &format!("l{}", at(&all)), scalar(&derived.lagrangian), source),
        paired("momentum", "μ", &derived.momentum, "∂l/∂ξ, (1.14)"),
    ];
    list.push(match inertia_matrix(derived) {
        Some(text) if text.len() <= LONGEST => Equation::new("velocity_hessian", "𝕀", text, "∂²l/∂ξ², the inertia"),
        _ => Equation::new("velocity_hessian", "⟨𝕀η, ζ⟩", scalar(&derived.hessian), "∂²l/∂ξ², the inertia"),
    });
    let has_moved = derived.advected.iter().any(is_moved);
    if has_moved {
        list.push(paired("diamond_rate", &moved_by(DIAMOND, &w), &derived.diamond, "(2.1)"));
    }
    if !derived.advection.is_zero() {
        let left = moved_by("(∂²l/∂w∂ξ)(ξ·w)", &w);
        list.push(paired("momentum_advection", &left, &derived.advection, "by which μ of a fixed ξ falls"));
    }
    list.push(momentum_rate(derived, has_moved));
    list.extend(advected_rates(declaration, derived));
    if derived.has_kinetic() && derived.inverse != Inverse::Nonlinear && without_bias(derived) == unwritten(derived) {
        list.push(paired("momentum", &format!("s{}", at(&w)), &derived.bias(), "μ at rest"));
    }
    list.push(inverse(derived));
    list.push(hamiltonian(derived, &hamiltonian_of(&w)));
    list.push(kept(declaration, equations));
    list
}

/// The covectors of several bodies, in their order.
fn of_bodies(derived: &Continuous, expression: &Expression) -> String {
    let of_body = |(factor, directions): (usize, &[Element; 2])| {
        let own = of_factor(derived, factor, expression);
        let found = vector_text(&own, directions[0].components, &derived.symbols);
        let found = found.unwrap_or_else(|| format!("η_{} ↦ {}", factor + 1, text(&own, &derived.symbols)));
        if found.len() <= LONGEST { found } else { "…, which is long".to_owned() }
    };
    derived.directions.iter().enumerate().map(of_body).collect::<Vec<_>>().join(";  ")
}

fn sum(terms: &[String]) -> String {
    let mut sum = String::new();
    for term in terms.iter().filter(|term| *term != "0") {
        let (sign, size) = match (sum.is_empty(), term.strip_prefix('−')) {
            (true, _) => ("", term.as_str()),
            (false, Some(rest)) => (" − ", rest),
            (false, None) => (" + ", term.as_str()),
        };
        sum.push_str(sign);
        sum.push_str(size);
    }
    if sum.is_empty() { "0".to_owned() } else { sum }
}

/// Whether the group moves the parameter.
fn is_moved(w: &AdvectedSymbol) -> bool {
    w.variance != Variance::Fixed || w.seen.is_configuration()
}

/// `μ̇` of each body: on SO(3) with a cross product, for a translation the force alone.
fn momentum_rates(derived: &Continuous) -> String {
    let velocities = velocities(derived);
    let of_body = |(factor, own): (usize, &Group)| {
        let diamond = of_factor(derived, factor, &derived.diamond);
        let force = vector_text(&diamond, derived.directions[factor][0].components, &derived.symbols);
        let force = force.filter(|text| text.len() <= LONGEST);
        let force = force.unwrap_or_else(|| format!("({})_{}", moved_by(DIAMOND, &seen(derived)), factor + 1));
        let turn = format!("μ_{} × {}", factor + 1, velocities[factor]);
        sum(&if own.is_added { vec![force] } else { vec![turn, force] })
    };
    derived.group.factors().iter().enumerate().map(of_body).collect::<Vec<_>>().join(";  ")
}

/// The diamond of (2.1).
const DIAMOND: &str = "∂l/∂w ⋄ w";

/// (1.4) with (2.2), on SO(3) in cross products.
fn momentum_rate(derived: &Continuous, has_moved: bool) -> Equation {
    let force = moved_by(DIAMOND, &seen(derived));
    let source =
        if has_moved { format!("(1.4) and (2.2): ad*_ξ μ + {force}") } else { "(1.4): ad*_ξ μ".to_owned() };
    if derived.group.is_product() {
        return Equation::new("momentum_rate", "dμ/dt", momentum_rates(derived), &(source + ", of each"));
    }
    let xi = velocity(derived);
    let momentum = covector(derived, &derived.momentum);
    let diamond = covector(derived, &derived.diamond);
    let right = match (derived.group.is_so3, momentum, diamond) {
        (true, Some(momentum), Some(diamond)) if derived.has_kinetic() => {
            sum(&[format!("({momentum}) × {xi}"), diamond])
        }
        (_, _, Some(diamond)) if has_moved && derived.group.is_so3 => sum(&[format!("μ × {xi}"), diamond]),
        _ if has_moved => format!("ad*_{xi} μ + {force}"),
        _ => format!("ad*_{xi} μ"),
    };
    let left = if derived.inverse == Inverse::Constant && derived.advection.is_zero() && derived.has_kinetic() {
        "dμ/dt = 𝕀 dξ/dt"
    } else {
        "dμ/dt"
    };
    Equation::new("momentum_rate", &left.replace("ξ", xi), right, &source)
}

/// (2.2), by the kind of each parameter.
fn advected_rates(declaration: &Declaration, derived: &Continuous) -> Vec<Equation> {
    let velocities = velocities(derived);
    let added = |factor: usize| derived.group.factor(factor).is_added;
    let rate = |index: usize, name: String| {
        let w = derived.advected.get(index)?;
        let of = |factor: usize| velocities[factor];
        let (xi, right) = match w.seen {
            View::From(factor) => (of(factor), None),
            View::Relative { of: body, from } if added(body) => ("", Some(format!("{} − {}", of(body), of(from)))),
            View::Configuration(body) if added(body) => ("", Some(of(body).to_owned())),
            View::Relative { of: body, from } => {
                ("", Some(format!("{name} hat({}) − hat({}) {name}", of(body), of(from))))
            }
            View::Configuration(body) => ("", Some(format!("{name} hat({})", of(body)))),
        };
        let hat = format!("hat({xi})");
        let equation = |right| {
            let source = format!("(2.2): −ξ·{name}");
            Some(Equation::new("advected_rate", &format!("d{name}/dt"), right, &source))
        };
        if let Some(right) = right {
            return equation(right);
        }
        let right = match w.variance {
            Variance::Covector if derived.group.rotates() => format!("{name} × {xi}"),
            variance => {
                let by = [("−", hat.clone()), ("+", hat)];
                let transposed = |(sign, matrix): &(&'static str, String)| (*sign, format!("{matrix}ᵀ"));
                let [left, right] = variance.sides([&by[0], &by[1]], transposed);
                let left = left.map(|(sign, matrix)| (sign, format!("{matrix} {name}")));
                let right = right.map(|(sign, matrix)| (sign, format!("{name} {matrix}")));
                let mut terms: Vec<_> = [left, right].into_iter().flatten().collect();
                terms.sort_by_key(|(sign, _)| *sign == "−");
                let (sign, first) = terms.first()?;
                let begin = format!("{}{first}", sign.trim_start_matches('+'));
                terms[1..].iter().fold(begin, |sum, (sign, term)| format!("{sum} {sign} {term}"))
            }
        };
        equation(right)
    };
    names(declaration).into_iter().enumerate().filter_map(|(index, name)| rate(index, name)).collect()
}

/// The names of the advected parameters.
fn seen(derived: &Continuous) -> Vec<&str> {
    derived.advected.iter().map(|w| derived.symbols.get(w.symbol).name.as_str()).collect()
}

/// `μ − s(w)`, if the momentum at rest `s` is written out elsewhere.
fn unwritten(derived: &Continuous) -> String {
    format!("μ − s{}", at(&seen(derived)))
}

/// `μ − s(w)`.
fn without_bias(derived: &Continuous) -> String {
    match covector(derived, &derived.bias()) {
        _ if derived.bias().is_zero() => "μ".to_owned(),
        Some(bias) if !bias.contains(" + ") && !bias.contains('−') => format!("μ − {bias}"),
        Some(bias) => format!("μ − ({bias})"),
        None => unwritten(derived),
    }
}

fn inverse(derived: &Continuous) -> Equation {
    let (xi, difference) = (velocity(derived), without_bias(derived));
    let difference = if difference == "μ" { difference } else { format!("({difference})") };
    let (right, source) = match derived.inverse {
        _ if !derived.has_kinetic() => ("not determined by μ: add a kinetic part".to_owned(), ""),
        Inverse::Constant => (format!("𝕀⁻¹ {difference}"), "(1.14) inverted, 𝕀⁻¹ once for all"),
        Inverse::Varying => (format!("𝕀{}⁻¹ {difference}", at(&seen(derived))), "(1.14) inverted"),
        Inverse::Nonlinear => ("the solution of ∂l/∂ξ = μ".to_owned(), "(1.14) inverted by Newton's iteration"),
    };
    Equation::new("velocity", xi, right, source)
}

fn hamiltonian(derived: &Continuous, name: &str) -> Equation {
    let potential = text(&derived.potential(), &derived.symbols);
    let (difference, at) = (without_bias(derived), at(&seen(derived)));
    let right = match derived.inverse {
        Inverse::Nonlinear => format!("⟨μ, {0}⟩ − l at {0} = ∂h/∂μ", velocity(derived)),
        _ if !derived.has_kinetic() => potential,
        Inverse::Varying if difference == "μ" => sum(&[format!("½ ⟨μ, 𝕀{at}⁻¹ μ⟩"), potential]),
        Inverse::Varying => sum(&[format!("½ ⟨{difference}, 𝕀{at}⁻¹ ({difference})⟩"), potential]),
        Inverse::Constant if difference == "μ" => sum(&["½ ⟨μ, 𝕀⁻¹ μ⟩".to_owned(), potential]),
        Inverse::Constant => sum(&[format!("½ ⟨{difference}, 𝕀⁻¹ ({difference})⟩"), potential]),
    };
    Equation::new("hamiltonian", name, right, "(1.16)")
}

/// `h(μ, w)` with the names of the advected and given parameters.
fn hamiltonian_of(w: &[String]) -> String {
    let arguments: Vec<&str> = ["μ"].into_iter().chain(w.iter().map(String::as_str)).collect();
    format!("h({})", arguments.join(", "))
}

/// The component `μ_k` of the momentum; of several bodies `(μ_a)_k`, or `μ_a` if body `a` has one component.
fn component(group: &Group, k: usize) -> String {
    if !group.is_product() {
        return format!("μ_{}", k + 1);
    }
    let (factor, own) = group.factor_of(k);
    match group.factor(factor).dimension() {
        1 => format!("μ_{}", factor + 1),
        _ => format!("(μ_{})_{}", factor + 1, own + 1),
    }
}

/// The conserved quantities of the motion.
fn kept(declaration: &Declaration, equations: &Equations) -> Equation {
    let derived = &equations.derived;
    let names = names(declaration);
    let given = declaration.advected.iter().filter(|parameter| parameter.is_given);
    let given: Vec<String> = given.map(crate::declared::AdvectedParameter::plain_name).collect();
    let energy = hamiltonian_of(&names);
    let condition = if given.is_empty() { String::new() } else { format!(" while {} stays", given.join(", ")) };
    let mut kept = vec![energy + &condition];
    let carried = |index: &usize| derived.advected.get(*index).is_some_and(is_moved);
    let carried: Vec<usize> = (0..declaration.advected.len()).filter(carried).collect();
    match carried.as_slice() {
        [] => kept.push("Ad*_{g⁻¹} μ".to_owned()),
        [one] if derived.group.is_so3 && matches!(declaration.advected_kind(*one), FieldKind::Vector(_)) => {
            let name = &names[*one];
            kept.push(format!("|{name}|²"));
            kept.push(format!("⟨μ, {name}⟩, the spatial momentum along it"));
        }
        _ => kept.push("⟨Ad*_{g⁻¹} μ, η⟩ for η·a₀ = 0".to_owned()),
    }
    for symmetry in &equations.right_symmetries {
        let terms = symmetry.iter().enumerate().filter(|(_, factor)| !factor.is_zero());
        let term = |(k, factor): (usize, &Rational)| match factor.parts() {
            (1, 1) => component(&derived.group, k),
            (-1, 1) => format!("−{}", component(&derived.group, k)),
            (numerator, 1) => format!("{numerator} {}", component(&derived.group, k)).replace('-', "−"),
            (numerator, denominator) => {
                format!("({numerator}/{denominator}) {}", component(&derived.group, k)).replace('-', "−")
            }
        };
        kept.push(sum(&terms.map(term).collect::<Vec<_>>()));
    }
    Equation::new("kept", "kept", kept.join("; "), "left and right symmetries")
}

/// The equations as one text.
pub(super) fn derivation(declaration: &Declaration, equations: &Equations) -> String {
    setting(declaration, false) + &section(declaration, equations)
}

/// The Hamiltonian, and its derivatives: those of the momentum stand where a Lagrangian has those of the velocity.
pub(in crate::emit) fn of_hamiltonian(declaration: &Declaration, equations: &Equations) -> String {
    let derived = &equations.derived;
    let shown = |expression| text(expression, &derived.symbols);
    let sections = [
        ("hamiltonian", format!("h = {}", shown(&derived.lagrangian))),
        ("velocity", format!("⟨∂h/∂μ, η⟩ = {}", shown(&derived.momentum))),
        ("diamond", format!("⟨∂h/∂w ⋄ w, η⟩ = {}", shown(&derived.diamond))),
        ("equations", "ξ = ∂h/∂μ, μ̇ = ad*_ξ μ − ∂h/∂w ⋄ w, ẇ = −ξ·w, ġ = g ξ̂    [(1.12)]".to_owned()),
        ("certainty", certified("these terms", equations.sureness)),
    ];
    let sections = sections.map(|(title, text)| format!("{title}\n    {text}\n"));
    [setting(declaration, false)].into_iter().chain(sections).collect()
}

/// The equations without the group and its action.
pub(in crate::emit) fn section(declaration: &Declaration, equations: &Equations) -> String {
    let texts = self::equations(declaration, equations);
    let (xi, group) = (velocity(&equations.derived), &equations.derived.group);
    let pairing = if group.is_so3 {
        "μ_k = ⟨μ, E_k⟩, so that μ is the body momentum; the thesis' matrix, paired by tr(AᵀB), is half of hat(μ)"
    } else if group.is_product() {
        "(μ_a)_k = ⟨μ, E_k of factor a⟩: of what turns the momentum in its own axes, of what is translated that in the \
         axes of space"
    } else {
        "μ_k = ⟨μ, E_k⟩, with the generators E_k of the declaration"
    };
    let all = velocities(&equations.derived).join(", ");
    let named = if group.is_product() { format!("{xi} = ({all})") } else { xi.to_owned() };
    let lines: String = texts.iter().fold(String::new(), |lines, equation| lines + "    " + &equation.line() + "\n");
    let limit = if declaration.continuous.is_some() && declaration.discretisation().is_none() {
        String::new()
    } else {
        let w = names(declaration).iter().fold(String::new(), |w, name| w + ", " + name);
        format!("    l_d(exp(h {xi}){w}, h) = h l({xi}{w}) + O(h²)    [at random points, exactly, without a bound]\n")
    };
    let certainty = certified("the equations", equations.sureness);
    format!("continuous\n    {named} = g⁻¹ dg/dt\n{limit}    pairing: {pairing}\n{lines}    certainty: {certainty}\n")
}

/// The section on the continuous equations in the struct's documentation.
pub(in crate::emit) fn page(declaration: &Declaration, equations: &Equations) -> String {
    let shown = shown(declaration, equations);
    format!(
        "\n# Derived equations\n\n{shown}\n\nAll equations are in `CONTINUOUS_DERIVATION` and in the documentation of the \
         methods. An ODE solver integrates what `RightHandSide` makes of them."
    )
}

/// The equations of motion.
pub(in crate::emit) fn shown(declaration: &Declaration, equations: &Equations) -> String {
    let shown = ["l", "momentum", "momentum_rate", "advected_rate", "hamiltonian"];
    let lines = self::equations(declaration, equations);
    let lines = lines.iter().filter(|one| shown.contains(&one.method));
    let text: String = lines.map(|equation| equation.line() + "\n").collect();
    format!("```text\n{text}```")
}
