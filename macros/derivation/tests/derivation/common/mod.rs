//! Helpers of the derivation's tests: declarations, their expansions and numbers.

pub(crate) mod bodies;
pub(crate) mod numeric;
pub(crate) mod random;

use std::rc::Rc;

use liestep_derivation::Role;
use liestep_derivation::declared::errors::Errors;
use liestep_derivation::declared::{Declaration, Tree, check, lower, parse};
use liestep_derivation::judged::cheapest;
use liestep_derivation::judged::verify::number::Number;
use liestep_derivation::mathematics::derive::{Derivation, derive};
use liestep_derivation::program::{Graph, Input, Node, NodeId};
use proc_macro2::TokenStream;

/// The heavy top, (3.13).
pub(crate) const HEAVY_TOP: &str = "group = SO3, advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * m * g * w.dot(&(rho + F * rho))";

/// The struct of the heavy top (3.13), with an inertia of this type.
pub(crate) fn top(inertia: &str) -> String {
    format!("struct Top {{ J_d: {inertia}, m: f64, g: f64, rho: Vector3<f64>, up: Vector3<f64> }}")
}

/// A struct with those of the fields that occur in a declaration's arguments.
pub(crate) fn struct_of(fields: &[&str], arguments: &str) -> String {
    let names: Vec<&str> = arguments.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    let is_used = |field: &&&str| field.split(':').next().is_some_and(|name| names.contains(&name));
    let fields: Vec<&str> = fields.iter().filter(is_used).copied().collect();
    format!("struct Body {{ {} }}", fields.join(", "))
}

pub(crate) fn tokens(text: &str) -> TokenStream {
    text.parse().expect("tokens")
}

pub(crate) fn expand(arguments: TokenStream, item: &TokenStream) -> TokenStream {
    liestep_derivation::expand(Role::Lagrangian, arguments, item)
}

pub(crate) fn expanded(arguments: &str, item: &str) -> TokenStream {
    expand(tokens(arguments), &tokens(item))
}

/// The derivation of a declaration, through all phases.
pub(crate) fn derived(arguments: &str, item: &str) -> Derivation {
    let mut errors = Errors::default();
    let declaration = parse::declaration(Role::Lagrangian, &tokens(arguments), &tokens(item), &mut errors);
    let declaration = declaration.expect("a declaration");
    let tree = check::check(&declaration, &mut errors).expect("a Lagrangian");
    let readings = lower::readings(&declaration, &tree, &mut errors).expect("small");
    cheapest(readings, derive, &declaration, &tree, &mut errors).expect("something to derive").derived
}

/// Whether an expansion is an error for the compiler to report; asserts that it is items otherwise.
pub(crate) fn is_refused(expansion: &TokenStream) -> bool {
    let text = expansion.to_string();
    if text.contains("compile_error") {
        return true;
    }
    if let Err(error) = syn::parse2::<syn::File>(expansion.clone()) {
        panic!("neither an error nor items: {error}\n{text}");
    }
    false
}

/// A declaration, and the trees of its functions.
pub(crate) fn checked_as(role: Role, arguments: &str, item: &str) -> (Declaration, Vec<Rc<Tree>>) {
    let mut errors = Errors::default();
    let declaration = parse::declaration(role, &tokens(arguments), &tokens(item), &mut errors).expect("a declaration");
    let trees = check::functions(&declaration, &mut errors).expect("something declared");
    (declaration, trees)
}

/// The arguments of the attribute and the struct in a declaration's file.
pub(crate) fn arguments_and_struct(file: &str) -> (&str, &str) {
    let (_, rest) = file.split_once("#[lagrangian(").expect("an attribute");
    let (arguments, rest) = rest.split_once("\n)]").expect("its end");
    let at = rest.find("pub struct").expect("a struct");
    (arguments, &rest[at..])
}

/// The values of a graph's outputs for given inputs.
pub(crate) fn evaluated<T: Number>(graph: &Graph, outputs: &[NodeId], input: &dyn Fn(Input) -> T) -> Vec<T> {
    let mut values = vec![T::UNDEFINED; graph.nodes().count()];
    for id in graph.reachable(outputs) {
        let at = |operand: NodeId| values[operand.0];
        values[id.0] = match graph.node(id) {
            Node::Constant(value) => T::of(value),
            Node::Input(entry) => input(entry),
            Node::Negate(a) => -at(a),
            Node::Add(a, b) => at(a) + at(b),
            Node::Subtract(a, b) => at(a) - at(b),
            Node::Multiply(a, b) => at(a) * at(b),
            Node::Divide(a, b) => at(a) / at(b),
            Node::Apply(function, a) => at(a).apply(function),
        };
    }
    outputs.iter().map(|output| values[output.0]).collect()
}

/// Whether an expansion says that a step of `−h` undoes one of `h`.
pub(crate) fn is_self_adjoint(expansion: &TokenStream) -> bool {
    expansion.to_string().contains("is_self_adjoint : true")
}

/// The message of a declaration that is refused.
pub(crate) fn message(arguments: &str, item: &str) -> Option<String> {
    let expansion = expanded(arguments, item);
    let text = expansion.to_string();
    is_refused(&expansion).then(|| text.split("compile_error").nth(1).unwrap_or_default().chars().take(200).collect())
}
