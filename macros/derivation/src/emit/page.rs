//! The documentation of the derived integrator on the user's struct, for readers of its page and for editors.

use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};
use quote::quote_spanned;

use super::docs::{Equation, OF_A_STEP, certified, costs, lets};
use crate::declared::{Declaration, Field, Role};
use crate::judged::{self, Choice, Equations, Findings};
use crate::mathematics::derive::SelfAdjointness;

/// The item with a page of documentation behind its own, and with the lint against its field names allowed.
pub(super) fn documented(item: &TokenStream, page: &str) -> TokenStream {
    let mut tokens = item.clone().into_iter().peekable();
    // An item that came through a `macro_rules!` fragment may stand in an invisible group.
    if let Some(TokenTree::Group(group)) = tokens.peek()
        && group.delimiter() == Delimiter::None
    {
        let mut inner = Group::new(Delimiter::None, documented(&group.stream(), page));
        inner.set_span(group.span());
        return std::iter::once(TokenTree::Group(inner)).chain(tokens.skip(1)).collect();
    }
    let mut attributes = TokenStream::new();
    while matches!(tokens.peek(), Some(TokenTree::Punct(mark)) if mark.as_char() == '#') {
        attributes.extend(tokens.by_ref().take(2));
    }
    let rest: TokenStream = tokens.collect();
    // Lines begin with a space, as `///` writes them.
    let page = page.lines().fold(String::new(), |page, line| page + if line.is_empty() { "\n" } else { "\n " } + line);
    quote_spanned! {Span::mixed_site()=>
        #attributes
        #[doc = #page]
        #[allow(non_snake_case)]
        #rest
    }
}

/// The limit on the length of an equation; longer ones are in the documentation of the methods.
const LONGEST: usize = 1_200;

/// The page: the momentum equation, the order, the limit on the step, and the cost of a step.
pub(super) fn page(
    declaration: &Declaration,
    chosen: &Choice,
    equations: &[Equation],
    continuous: Option<&Equations>,
    findings: &Findings,
) -> String {
    let (derived, is_lagrangian) = (&chosen.derived, declaration.role != Role::Force);
    let has_kinetic = derived.limit.has_kinetic;
    let heading = match is_lagrangian {
        true if has_kinetic => "# Derived integrator\n\nThe momentum equation, solved for `F` in each step:",
        true => "# Derived terms\n\nThe share in the momentum equation of a body that this is added to:",
        false => "# Derived terms\n\nThe share in the momentum equation of a body that this force acts on:",
    };
    let shown = if is_lagrangian {
        ["legendre_minus", "kick_before", "kick_after"]
    } else {
        ["momentum", "kick_before", "kick_after"]
    };
    let lines = shown.iter().filter_map(|method| equations.iter().find(|one| one.method == *method));
    let text = lets(derived) + &lines.map(|equation| equation.line() + "\n").collect::<String>();
    let text = if text.len() <= LONGEST {
        format!("```text\n{text}```")
    } else {
        "it is long, and stands in the documentation of the methods.".to_owned()
    };
    let mut points = Vec::new();
    if is_lagrangian {
        points.push(format!("Order: {}", order(findings.self_adjointness)));
    }
    if has_kinetic {
        points.push(format!("Limit of a step: {}", limit(chosen)));
    }
    if declaration.group.is_product() && is_lagrangian {
        points.push(momenta(declaration));
        points.push(together(declaration, chosen));
    }
    points.push(format!("Certainty: {}.", certified(OF_A_STEP, findings.sureness)));
    points.push(format!("Cost:\n  * {}", costs(&chosen.kernel).replace("\n    ", "\n  * ")));
    let points = points.into_iter().fold(String::new(), |points, point| points + "* " + &point + "\n");
    let continuous = continuous.map(|equations| super::continuous::text::shown(declaration, equations));
    let continuous = continuous.filter(|shown| shown.len() <= LONGEST);
    let continuous = continuous.map(|shown| format!("The continuous equations that it discretises:\n\n{shown}\n\n"));
    let continuous = continuous.unwrap_or_default();
    format!(
        "\n{heading}\n\n{text}\n\n{points}\n{continuous}All equations are in `DERIVATION` and in the documentation of the methods."
    )
}

/// The conserved momenta of several bodies.
fn momenta(declaration: &Declaration) -> String {
    let name = |field: usize| declaration.fields.get(field).map(Field::plain_name).unwrap_or_default();
    let all = judged::conserved(declaration).into_iter().map(|one| {
        let increments = one.bodies.iter().filter_map(|&body| declaration.factors.get(body));
        let increments: Vec<String> = increments.map(|factor| format!("`{}`", factor.name)).collect();
        let is_added = one.bodies.iter().any(|&body| declaration.group.factor(body).is_added);
        let sum = if increments.len() > 1 { "Σ " } else { "" };
        let sum = format!("{sum}{}", if is_added { "p" } else { "R Π" });
        let of = if increments.len() > 1 { "the bodies" } else { "the body" };
        let along = one.along.map(|field| name(field) + "·").unwrap_or_default();
        format!("`{along}{sum}` over {of} of {}", increments.join(", "))
    });
    let all: Vec<String> = all.collect();
    if all.is_empty() {
        return "Conserved: no momentum, as what is seen asks for every direction.".to_owned();
    }
    let of_translations = declaration.group.factors().iter().any(|factor| factor.is_added);
    let names = if of_translations {
        "attitudes `R`, body momenta `Π` and momenta `p` of what is translated"
    } else {
        "attitudes `R` and body momenta `Π`"
    };
    format!("Conserved, however well a step is solved, with {names}: {}.", all.join("; "))
}

/// The groups of bodies that a step solves together.
fn together(declaration: &Declaration, chosen: &Choice) -> String {
    let ends = chosen.kernel.ends(&chosen.derived.group);
    let mut groups: Vec<Vec<&str>> = vec![Vec::new()];
    for (index, factor) in declaration.factors.iter().enumerate() {
        if ends.contains(&index) {
            groups.push(Vec::new());
        }
        groups.last_mut().into_iter().for_each(|group| group.push(&factor.name));
    }
    let shown = groups.iter().map(|group| format!("`{}`", group.join("`, `"))).collect::<Vec<_>>();
    if shown.len() == 1 {
        format!("Solved together: {}, {} unknowns.", shown[0], chosen.derived.group.dimension())
    } else {
        format!("Solved apart: {}.", shown.join("; "))
    }
}

/// The order that follows from self-adjointness.
fn order(found: SelfAdjointness) -> &'static str {
    match found {
        SelfAdjointness::Symbolic | SelfAdjointness::Exact | SelfAdjointness::WithoutBound => {
            "even, as `l_d` is self-adjoint: a step of −h undoes a step of h."
        }
        SelfAdjointness::ForPoints => {
            "even for points, whose last coordinate is 1, as `l_d` is self-adjoint then: a step of −h undoes a step of h."
        }
        SelfAdjointness::No => "1 in general, as `l_d` isn't self-adjoint: a step of −h doesn't undo a step of h.",
    }
}

/// The reason why a large step may have no solution.
fn limit(chosen: &Choice) -> &'static str {
    if chosen.derived.cleared.is_some() {
        "the part of `μ` with `F` is a polynomial in `F`, so it is bounded. Where the body turns too fast for the step, \
         there is no solution, and the error names the largest step that has one."
    } else if chosen.derived.group.is_so3 {
        "no bound is known beforehand. Where no solution continues the identity, the error names the largest step that has \
         one."
    } else {
        "the equation is solved near the identity. Where no solution continues it, the error names the largest step that \
         has one."
    }
}
