//! The certificate of a step, as JSON.

use std::fmt::Write as _;

use liestep_derivation::whole::{Chart, WholeStep};
use liestep_derivation::{Action, Carried, Function, Operation, ParameterKind, Program};
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};

use crate::declaration::Declaration;
use crate::emitted::{emitted, name};
use crate::error::LateError;
use crate::written::{Sums, c};

/// The claims: a name, the program of the left side, and the equation.
const CLAIMS: [(&str, &str, &str); 19] = [
    ("work", "", "work(η, η⁺) = Σ η_k work(E_k, 0) + Σ η⁺_k work(0, E_k)"),
    ("target", "target", "a = μ + k(w), then a·a"),
    (
        "residual",
        "newton",
        "r = S (1 + y·y)^power (μ_F + k(w) − a), (μ_F)_k = d/ds l_d(exp(s E_k) F, exp(s E_k)·w) − work(E_k, 0), with S ≠ 0 \
         of h and parameters alone",
    ),
    ("jacobian", "newton", "J = ∂r/∂y"),
    ("update", "newton", "J u = r"),
    ("determinants", "newton", "leading principal minors of J, and products of its diagonal"),
    ("iterate", "iterate", "y − u, u·u and (y − u)·(y − u), then the determinants"),
    ("again", "again", "J(y) (y′ − y⁺) = r(y′), then the squares of y′ − y⁺ and y⁺"),
    ("attitude", "finish", "g⁺ = g F"),
    ("momentum", "finish", "μ⁺_k = d/ds l_d(F exp(s E_k), w) + work(0, E_k) where a = μ_F + k(w)"),
    ("transport", "finish", "μ⁺(a′) − μ⁺(a) = Ad*_F (a′ − a)"),
    ("advected", "finish", "w⁺ = F⁻¹·w"),
    ("guess", "finish", "y, y − y₁ and y + 2 (y − y₁) − (y₁ − y₂)"),
    ("checks", "finish", "the sum of μ⁺ and w⁺, and how far F is from the identity"),
    ("seen", "seen", "w = g⁻¹·w₀"),
    ("restored", "restored", "‖gᵀg − I‖ and g + g (I − gᵀg)/2"),
    ("defect", "defect", "zero in the group; for rotations ‖gᵀg − I‖, and 1 − det g where det g < 0"),
    ("rest", "rest", "tr J and the determinants at y = 0 and a = 0"),
    ("safe", "safe", "the determinants of lim h/2 ∂(μ_F)/∂y at y = 0 as h → 0"),
];

#[doc = include_str!("certificate.md")]
///
/// # Errors
///
/// [`LateError::Step`]: there is no step as programs, as of a force alone.
pub fn certificate(declaration: &Declaration) -> Result<String, LateError> {
    let step = WholeStep::of(declaration)?;
    let factors = step.factors.iter().map(|factor| {
        let chart = if factor.chart == Chart::Product { "product" } else { "cayley" };
        json!({"name": factor.name, "rows": factor.size(), "generators": factor.basis.generators, "chart": chart})
    });
    let parameters = declaration.parameters.iter().map(|parameter| {
        let (kind, (rows, columns)) = (kind(parameter.kind), parameter.kind.shape());
        json!({"name": parameter.name, "kind": kind, "rows": rows, "columns": columns})
    });
    let programs = emitted(&step, &[("newton", &step.programs.newton)])
        .programs
        .into_iter()
        .filter_map(|(name, program)| Some((name, as_data(&program?))));
    let has = |name: &str| match name {
        "work" => declaration.has_force,
        "safe" => step.programs.safe.is_some(),
        _ => true,
    };
    let claims = CLAIMS.iter().filter(|claim| has(claim.0));
    let claims = claims.map(|(name, of, equation)| json!({"name": name, "of": of, "equation": equation}));
    let mut digest = "sha256:".to_owned();
    for byte in Sha256::digest(c(declaration, Sums::Rounded)?) {
        let _ = write!(digest, "{byte:02x}");
    }
    let advected: Vec<Value> = declaration.carried.iter().map(carried).collect();
    let entries = [
        ("format", json!("liestep certificate 1")),
        ("name", json!(declaration.name)),
        ("texts", json!(declaration.texts())),
        ("factors", factors.collect()),
        ("parameters", parameters.collect()),
        ("advected", json!(advected)),
        ("power", json!(declaration.denominators)),
        ("ends", json!(ends(declaration, &step))),
        ("claims", claims.collect()),
        ("digests", json!({"c": digest})),
    ];
    let programs: Vec<String> = programs.map(|(name, data)| format!("  {}: {data}", json!(name))).collect();
    let mut lines: Vec<String> = entries.iter().map(|(key, value)| format!("{}: {value}", json!(key))).collect();
    lines.push(format!("\"programs\": {{\n{}\n}}", programs.join(",\n")));
    Ok(format!("{{\n{}\n}}\n", lines.join(",\n")))
}

const fn kind(kind: ParameterKind) -> &'static str {
    match kind {
        ParameterKind::Scalar => "scalar",
        ParameterKind::Vector(_) => "vector",
        ParameterKind::Matrix(_) => "matrix",
        ParameterKind::Inertia => "symmetric",
        ParameterKind::DiagonalInertia => "diagonal",
    }
}

fn carried(one: &Carried) -> Value {
    let (action, factors) = match one.action {
        Action::Moved(variance, k) => (variance.noun(), vec![k]),
        Action::Point(k) => ("point", vec![k]),
        Action::Relative { of, from } => ("relative", vec![of, from]),
        Action::Configuration(of) => ("configuration", vec![of]),
        Action::Given => ("given", Vec::new()),
    };
    json!({"action": action, "factors": factors, "field": one.field, "rows": one.shape.0, "columns": one.shape.1})
}

/// The components at which blocks with a determinant of their own end.
fn ends(declaration: &Declaration, step: &WholeStep) -> Vec<usize> {
    let begins: Vec<usize> = step.factors.iter().map(|factor| factor.component).filter(|&at| at > 0).collect();
    let apart = declaration.blocks.iter().filter(|_| !begins.is_empty()).copied();
    let mut ends: Vec<usize> = apart.filter(|&at| at > 0).chain(begins.iter().copied()).chain([step.sizes.n]).collect();
    ends.sort_unstable();
    ends.dedup();
    ends
}

fn as_data(program: &Program) -> Value {
    let inputs = program.inputs.iter().map(|source| json!([name(source.array), source.at]));
    let operations = program.operations.iter().map(|operation| match *operation {
        Operation::Negate(a) => json!(["-", a]),
        Operation::Add(a, b) => json!(["+", a, b]),
        Operation::Subtract(a, b) => json!(["-", a, b]),
        Operation::Multiply(a, b) => json!(["*", a, b]),
        Operation::Divide(a, b) => json!(["/", a, b]),
        Operation::Apply(function, a) => json!([applied(function), a]),
    });
    let (inputs, operations): (Value, Value) = (inputs.collect(), operations.collect());
    json!({"inputs": inputs, "literals": program.literals, "operations": operations, "outputs": program.outputs})
}

fn applied(function: Function) -> String {
    match function {
        Function::Stumpff(k) => format!("stumpff_{k}"),
        Function::LogRatio(k) => format!("log_ratio_{k}"),
        other => other.name(),
    }
}
