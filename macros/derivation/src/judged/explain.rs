//! Messages for declarations that can't be derived, at their tokens.

use std::collections::BTreeSet;
use std::rc::Rc;

use proc_macro2::Span;

use super::verify::{self, KineticPart, Objection, Row, TermMistake};
use crate::declared::check;
use crate::declared::errors::Errors;
use crate::declared::{Coordinates, Declaration, Discretisation, FieldKind, Kind, Name, Quadrature, Role, Tree};
use crate::mathematics::chart::Chart;
use crate::mathematics::derive::{ForceError, LimitError, Refusal};
use crate::mathematics::group::Group;

/// Reports the terms that can't be intended; `None` if there are any.
pub fn terms(declaration: &Declaration, tree: &Rc<Tree>, errors: &mut Errors) -> Option<()> {
    let mistakes = verify::term_mistakes(declaration, tree);
    for (place, mistake) in &mistakes {
        errors.push_between([place.span, place.end], term(*mistake, declaration));
    }
    mistakes.is_empty().then_some(())
}

/// Reports the part of a constraint that isn't linear in the velocities; `None` if there is one.
pub fn linear(declaration: &Declaration, tree: &Rc<Tree>, errors: &mut Errors) -> Option<()> {
    let Some(part) = verify::not_linear(declaration, tree) else { return Some(()) };
    let example = declaration.product_with_velocity();
    let message = format!(
        "a constraint on velocities is linear in them, as {example} is: leave out what has no velocity, and powers and \
         functions of one"
    );
    errors.push_between([part.span, part.end], message);
    None
}

/// The message for a term: the mistake and the correction.
fn term(mistake: TermMistake, declaration: &Declaration) -> String {
    let by_a_power = |least: i32| format!("; if it is a correction, write its power as `h.powi({least})` or higher");
    match mistake {
        TermMistake::ZeroDivisor => {
            "this is zero whatever the parameters, so what is divided by it has no value".to_owned()
        }
        TermMistake::FunctionOfZero => {
            "this is the root or the logarithm of zero whatever the parameters, where it has no derivative".to_owned()
        }
        TermMistake::FunctionOfStep => {
            "this is no power of `h` as h → 0: take the `h` out of the root or the logarithm".to_owned()
        }
        TermMistake::NoWork => "this work is zero whatever the parameters: leave the force out".to_owned(),
        TermMistake::Potential(order @ 2..) => format!(
            "this vanishes like {} as h → 0: a potential goes like `h`, as in `0.5 * h * …`{}",
            power_of_step(order),
            by_a_power(2)
        ),
        TermMistake::Potential(order) => {
            format!("this goes like {} as h → 0: a potential goes like `h`, as in `0.5 * h * …`", power_of_step(order))
        }
        TermMistake::Vanishing(order) => format!(
            "this vanishes like {} as h → 0: a kinetic part goes like `h`, that is, a square of `F - I` over `h`, as in \
             `… / (2.0 * h)`{}{}",
            power_of_step(order),
            by_a_power(2),
            // A potential in the displacement of the body, times `h`, vanishes like h^3.
            if order < 3 {
                ""
            } else {
                "; if it is meant as a potential, `F` is what a step adds, and where the body is stands in what is `advected`"
            }
        ),
        TermMistake::TooSingular(power) => too_singular(power),
        TermMistake::Constant => {
            "this is the same for all `F`, so it does nothing: leave it out, or write `F - I` for `F`".to_owned()
        }
        TermMistake::Zero | TermMistake::Cancelling | TermMistake::NoMotion => idle(mistake, declaration),
        TermMistake::Work(order @ 2..) => format!(
            "this vanishes like {} as h → 0: virtual work goes like `h`, and `F - I` and `vee(F)` count as `h`{}",
            power_of_step(order),
            by_a_power(2)
        ),
        TermMistake::Work(order) => format!(
            "this goes like {} as h → 0: virtual work goes like `h`, as in `0.5 * h * …`; `F - I` and `vee(F)` count as \
             `h`",
            power_of_step(order)
        ),
    }
}

/// The message for a term that no equation of motion contains.
fn idle(mistake: TermMistake, declaration: &Declaration) -> String {
    let motion = match declaration.role {
        Role::Force => "displacement",
        _ if declaration.continuous.is_some() => "velocity",
        _ if declaration.group.is_product() => "increment",
        _ => "`F`",
    };
    match mistake {
        TermMistake::Zero => format!(
            "this term is zero for every {motion}, whatever the parameters: leave it out, or check its signs and what is \
             transposed"
        ),
        TermMistake::Cancelling => {
            format!(
                "all terms with {motion} alone add up to a constant, so there is no kinetic part: check their signs"
            )
        }
        _ => format!(
            "this is the same for every {motion} and all that is advected, so nothing follows from it: a kinetic part \
             is a square of a velocity or of `F - I`, and a potential depends on what is advected"
        ),
    }
}

/// `1`, `h`, `h^2`, `1/h`, `1/h^2`.
fn power_of_step(order: i32) -> String {
    match order {
        0 => "1".to_owned(),
        1 => "h".to_owned(),
        -1 => "1/h".to_owned(),
        2.. => format!("h^{order}"),
        _ => format!("1/h^{}", order.unsigned_abs()),
    }
}

/// Reports the reason why nothing can be derived.
pub(super) fn refusal(refusal: Refusal, declaration: &Declaration, tree: &Rc<Tree>, errors: &mut Errors) {
    let error = match refusal {
        Refusal::Limit(error) => error,
        Refusal::Force(error) => return explain_force(error, declaration, errors),
        Refusal::Overflow => {
            let message = "the coefficients leave the range of exact arithmetic: make the large numbers fields";
            return errors.push(tree.span, message);
        }
    };
    let message = match error {
        LimitError::StepInsideFunction => {
            let span = Search::default().enclosed_step(tree, false).unwrap_or(tree.span);
            errors.push(span, "`h` stands under a function that has no value as h → 0: take it out");
            return;
        }
        LimitError::TooSingular(power) => too_singular(power),
        LimitError::TooLarge => {
            "the limit h → 0 has too many terms: declare the terms one by one, and add them, `Body { … } + Pull { … }`"
                .to_owned()
        }
        LimitError::NotALagrangian => {
            "as h → 0 this doesn't become h times a Lagrangian of the velocity: is a term without its `h`?".to_owned()
        }
    };
    errors.push_over(declaration.expression.as_ref().map(check::value), message);
}

fn too_singular(power: i32) -> String {
    format!("a term with `F` goes like h^{power}: the kinetic part of a discrete Lagrangian goes like 1/h")
}

/// Reports virtual work that isn't the work of a force.
fn explain_force(error: ForceError, declaration: &Declaration, errors: &mut Errors) {
    let message = match error {
        ForceError::NotLinear => {
            "virtual work is linear in the displacements: a force times `eta`, and a force times `eta_next`"
        }
    };
    errors.push_over(declaration.expression.as_ref().map(check::value), message);
}

/// Reports a kinetic part that no values of the parameters make regular at the identity.
pub(super) fn kinetic_part(
    found: &KineticPart,
    declaration: &Declaration,
    tree: &Rc<Tree>,
    errors: &mut Errors,
) -> Option<()> {
    let message = match found {
        KineticPart::Regular => return Some(()),
        KineticPart::OtherInertia(field) => return other_inertia(*field, declaration, tree, errors),
        // The inertia of a rotor between two bodies is added to their own, and one of all bodies is checked at the start.
        KineticPart::Singular(_) if is_of_two_bodies(declaration) => return Some(()),
        KineticPart::NotStationary(asymmetric) => not_stationary(asymmetric, declaration),
        KineticPart::NotSmooth => {
            "the kinetic part has no second derivative at `F = I`, where a step is small: write it \
                                   as a square of `F - I`, without a root"
                .to_owned()
        }
        KineticPart::Negative => {
            "the kinetic part is negative: check its sign, and the `.transpose()` in the square of `F - I`".to_owned()
        }
        KineticPart::Singular(idle) => format!(
            "the kinetic part is singular at `F = I` whatever the parameters, so a momentum doesn't determine a \
             velocity{}",
            without_energy(idle, declaration)
        ),
    };
    errors.push_over(declaration.expression.as_ref().map(check::value), message);
    None
}

/// Whether the group is that of one body twice.
fn is_of_two_bodies(declaration: &Declaration) -> bool {
    let factors = declaration.group.factors();
    let (first, second) = factors.split_at(factors.len() / 2);
    let is_same = |(one, other): (&Group, &Group)| one.generators == other.generators && one.is_added == other.is_added;
    first.len() == second.len() && first.iter().zip(second).all(is_same)
}

/// Reports a continuous kinetic part that no values of the parameters make regular at rest.
pub(super) fn continuous_kinetic_part(
    found: &KineticPart,
    declaration: &Declaration,
    tree: &Rc<Tree>,
    errors: &mut Errors,
) -> Option<()> {
    let message = match found {
        KineticPart::OtherInertia(field) => return other_inertia(*field, declaration, tree, errors),
        KineticPart::Regular | KineticPart::NotStationary(_) => return Some(()),
        KineticPart::NotSmooth => {
            let (velocity, first) = (declaration.velocity_or_omega(0), declaration.group.factor(0));
            let square = if first.is_added && first.dimension() == 1 { "powi(2)" } else { "norm_squared()" };
            let of = if declaration.group.is_product() { "each velocity" } else { "the velocity" };
            format!(
                "the kinetic part has no second derivative at rest: write it as a square of {of}, such as \
                 `{velocity}.{square}`, without a root"
            )
        }
        KineticPart::Negative => "the kinetic part is negative: check its sign".to_owned(),
        KineticPart::Singular(idle) => format!(
            "the kinetic part is singular at rest whatever the parameters, so a momentum doesn't determine a velocity{}",
            without_energy(idle, declaration)
        ),
    };
    errors.push_over(declaration.expression.as_ref().map(check::value), message);
    None
}

/// Reports an inertia in the place of the nonstandard one, or the other way round, where the text has it first.
fn other_inertia(index: usize, declaration: &Declaration, tree: &Rc<Tree>, errors: &mut Errors) -> Option<()> {
    let field = declaration.fields.get(index)?;
    let name = field.plain_name();
    let message = if field.kind == FieldKind::StandardInertia {
        format!(
            "the kinetic energy is ½ Ω·(tr({name}) I − {name}) Ω, in which `{name}` is the nonstandard inertia ∫ x xᵀ dm: \
             give it the type `NonstandardInertia`"
        )
    } else {
        format!(
            "the kinetic energy is ½ Ω·{name} Ω, in which `{name}` is the inertia itself, not the nonstandard one ∫ x xᵀ dm: \
             give it the type `Inertia`"
        )
    };
    let mut known = BTreeSet::new();
    let place = first_use(tree, Name::Field(index), &mut known).unwrap_or(field.at);
    errors.push(place, message);
    None
}

/// The first place of a name in a text.
fn first_use(tree: &Rc<Tree>, name: Name, known: &mut BTreeSet<*const Tree>) -> Option<Span> {
    if !known.insert(Rc::as_ptr(tree)) {
        return None;
    }
    match &tree.kind {
        Kind::Name(own) if *own == name => Some(tree.span),
        kind => kind.operands().into_iter().flatten().find_map(|operand| first_use(operand, name, known)),
    }
}

/// The generators without kinetic energy; those of several bodies are numbered from one in each.
fn without_energy(idle: &[usize], declaration: &Declaration) -> String {
    if idle.is_empty() {
        return "; give every direction an inertia".to_owned();
    }
    let name = |k: usize| {
        let (factor, own) = declaration.group.factor_of(k);
        match declaration.factors.get(factor) {
            Some(increment) if declaration.group.is_product() => format!("E_{} of `{}`", own + 1, increment.name),
            _ => format!("E_{}", k + 1),
        }
    };
    let names: Vec<String> = idle.iter().map(|&k| name(k)).collect();
    format!("; give every direction an inertia: there is no kinetic energy along {}", names.join(", "))
}

/// The reason why a declared `l` can't be discretised as requested.
#[derive(Clone, Copy, Debug)]
pub(super) enum Misfit {
    /// The group's logarithm isn't known in closed form.
    NoLogarithm,
    /// The group's matrices are too large for a Cayley transform in closed form.
    NoCayley,
    /// The velocity of this factor is used where a matrix outside the algebra can't be.
    NotInMatrix(usize),
}

/// Reports a discretisation that doesn't fit the group or the Lagrangian.
pub(super) fn misfit(misfit: Misfit, asked: Discretisation, declaration: &Declaration, errors: &mut Errors) {
    let name = match asked.quadrature {
        Quadrature::Trapezoid => "trapezoid",
        Quadrature::Midpoint => "midpoint",
        Quadrature::Chord => "chord",
    };
    let instead = by_cayley(asked.quadrature, declaration);
    let message = match misfit {
        Misfit::NoLogarithm => {
            format!("no closed logarithm is known on this group, which `{name}(exp)` needs: {instead}")
        }
        Misfit::NoCayley => {
            "no closed inverse of the Cayley map is known on this group: declare `l_d` by hand".to_owned()
        }
        Misfit::NotInMatrix(factor) => {
            let velocity = declaration.velocity_or_omega(factor);
            let increment = declaration.factors.get(factor).map_or("F", |factor| &factor.name);
            let which = if declaration.group.is_product() { format!(" `{velocity}`") } else { String::new() };
            let forms = if declaration.group.factor(factor).is_so3 {
                format!("as `hat({velocity})`, in `{velocity}.dot(&(J * {velocity}))` or in `s.dot(&{velocity})`")
            } else {
                format!("as `hat({velocity})`")
            };
            format!(
                "`{name}` puts the matrix `({increment} - I) / h` in the place of the velocity{which}, which may stand \
                 {forms} alone: {instead}"
            )
        }
    };
    let message = if asked.coordinates == Coordinates::Ambient || !matches!(misfit, Misfit::NotInMatrix(_)) {
        message
    } else {
        format!("`{name}` doesn't fit this Lagrangian: {instead}")
    };
    errors.push_between(asked.place, message);
}

/// Reports a generator of a group without coordinates of increments.
pub(super) fn leaves_group(generator: usize, declaration: &Declaration, errors: &mut Errors) {
    let place = declaration.generators.get(generator).copied().unwrap_or_else(Span::call_site);
    errors.push_decisive(
        place,
        "the Cayley map leaves this group, and the cube of this generator isn't a multiple of it: choose generators `E` \
         with `E³ = c E`, as matrices with one entry and `E_ii - E_jj`",
    );
}

/// The advice for a discretisation that doesn't fit: the one by the Cayley map, where the group has coordinates by it.
fn by_cayley(quadrature: Quadrature, declaration: &Declaration) -> String {
    match quadrature {
        _ if declaration.group.chart() != Ok(Chart::Cayley) => "declare `l_d` by hand".to_owned(),
        Quadrature::Trapezoid => "write `trapezoid(Cayley)`".to_owned(),
        Quadrature::Midpoint | Quadrature::Chord => "write `chord(Cayley)`".to_owned(),
    }
}

/// Reports a discretisation that isn't its own adjoint.
pub(super) fn not_self_adjoint(asked: Discretisation, declaration: &Declaration, errors: &mut Errors) {
    let instead = by_cayley(asked.quadrature, declaration);
    let message = format!(
        "with this discretisation `l_d` isn't its own adjoint, so the order is 1 and a step of −h doesn't undo a step of \
         h: {instead}"
    );
    errors.push_between(asked.place, message);
}

/// Reports a term of the continuous equations that the exact check doesn't confirm.
pub(super) fn unconfirmed_term(term: &str, declaration: &Declaration, errors: &mut Errors) {
    let message = format!("the derived {term} disagrees with what is declared: please report this declaration");
    errors.push_over(declaration.expression.as_ref().map(check::value), message);
}

/// Reports a constraint that doesn't depend on the position of one of its bodies.
pub(super) fn not_held(body: usize, declaration: &Declaration, errors: &mut Errors) {
    let names: Vec<String> =
        declaration.factors.iter().skip(2 * body).take(2).map(|factor| format!("`{}`", factor.name)).collect();
    let rest = if body == 0 { ": what holds a body to space is on space as the body above, too" } else { "" };
    let message = format!("this doesn't depend on where the body of {} is{rest}", names.join(" and "));
    errors.push_over(declaration.expression.as_ref().map(check::value), message);
}

/// Reports a function of a constraint that doesn't depend on the position of any body.
pub(super) fn constant(function: &Tree, errors: &mut Errors) {
    errors.push_between(
        [function.span, function.end],
        "this doesn't depend on where the bodies are, so it holds nothing: leave it out, or use what `advected(…)` names",
    );
}

/// Reports the functions in a part of a constraint that depend on those before them.
pub(super) fn follows(part: &Tree, rows: &[Row], errors: &mut Errors) {
    let names = ["first", "second", "third", "fourth", "fifth", "sixth"];
    let following = names.iter().zip(rows).filter(|(_, row)| **row != Row::New);
    let following: Vec<&str> = following.map(|(name, _)| *name).collect();
    let where_and_what = "wherever the bodies are: take components that don't, as in `(v.dot(&n_1), v.dot(&n_2))`";
    let message = match (rows.len(), following.as_slice()) {
        (1, _) => "this follows from the functions before it, wherever the bodies are: leave it out".to_owned(),
        (all, which) if which.len() == all => {
            format!("these {all} functions follow from those before them, wherever the bodies are: leave them out")
        }
        (all, [one]) => {
            format!("of these {all} functions the {one} follows from those before it, {where_and_what}")
        }
        (all, several) => {
            let several = several.join(" and the ");
            format!("of these {all} functions the {several} follow from those before them, {where_and_what}")
        }
    };
    errors.push_between([part.span, part.end], message);
}

/// Reports a derivation that the self-check doesn't confirm.
pub(super) fn unconfirmed(unconfirmed: Objection, declaration: &Declaration, tree: &Rc<Tree>, errors: &mut Errors) {
    match unconfirmed {
        Objection::Disagrees(term) | Objection::Undefined(term) => unconfirmed_term(term, declaration, errors),
        Objection::NoValue => {
            let message = "this has no value at the points where it was tried: what is under a root or a logarithm has to be \
                           positive for parameters of some size and sign";
            match verify::without_value(declaration, tree) {
                Some(part) => errors.push_between([part.span, part.end], message),
                None => errors.push_over(declaration.expression.as_ref().map(check::value), message),
            }
        }
        Objection::NotSmooth => {
            let (message, ends) = not_smooth(verify::not_smooth_at_identity(declaration, tree), tree);
            errors.push_between(ends, message);
        }
    }
}

/// The message for a part without a derivative at the identity, and the place of that part.
fn not_smooth(place: Option<(Rc<Tree>, TermMistake)>, tree: &Tree) -> (String, [Span; 2]) {
    let what = match place {
        Some((_, TermMistake::ZeroDivisor)) => "this divisor is zero at `F = I`",
        Some(_) => "this is the root or the logarithm of what is zero at `F = I`",
        None => "this has no derivative at `F = I`",
    };
    let ends = place.map_or([tree.span, tree.end], |(place, _)| [place.span, place.end]);
    (format!("{what}, where a step is small: write it so that it has two derivatives there"), ends)
}

fn not_stationary(asymmetric: &[usize], declaration: &Declaration) -> String {
    let beginning = "the kinetic part isn't stationary at `F = I`, so at rest the momentum would grow like 1/h";
    let fields = asymmetric.iter().filter_map(|&index| declaration.fields.get(index));
    let names: Vec<String> = fields.map(|field| format!("`{}`", field.plain_name())).collect();
    if names.is_empty() {
        return format!("{beginning}: write it as a square of `F - I`");
    }
    let (names, first) = (names.join(" and "), names.first().map_or("", |name| name.trim_matches('`')));
    let inertias =
        if declaration.group.size == 3 { ", or give it the type `NonstandardInertia` or `Inertia`" } else { "" };
    format!(
        "{beginning}: it would be for a symmetric {names}, which the type of a plain matrix doesn't promise: write \
         `0.5 * ({first} + {first}.transpose())`{inertias}"
    )
}

/// The search for an `h` inside a function or inside a divisor with a sum, where the limit can't be found by powers.
#[derive(Default)]
struct Search {
    /// The subtrees already searched, so that the value of a `let` is searched once.
    known: BTreeSet<(*const Tree, bool)>,
}

impl Search {
    fn enclosed_step(&mut self, tree: &Rc<Tree>, is_enclosed: bool) -> Option<Span> {
        if !self.known.insert((Rc::as_ptr(tree), is_enclosed)) {
            return None;
        }
        match &tree.kind {
            Kind::Name(Name::Step) => is_enclosed.then_some(tree.span),
            Kind::Apply(_, a) => self.enclosed_step(a, true),
            Kind::Divide(a, b) => {
                self.enclosed_step(a, is_enclosed).or_else(|| self.enclosed_step(b, is_enclosed || is_sum(b)))
            }
            Kind::Power(a, exponent) => self.enclosed_step(a, is_enclosed || (*exponent < 0 && is_sum(a))),
            kind => kind.operands().into_iter().flatten().find_map(|operand| self.enclosed_step(operand, is_enclosed)),
        }
    }
}

/// Whether a sum remains once factors are split off.
fn is_sum(tree: &Tree) -> bool {
    match &tree.kind {
        Kind::Add(..) | Kind::Subtract(..) => true,
        Kind::Multiply(a, b) | Kind::Divide(a, b) => is_sum(a) || is_sum(b),
        Kind::Negate(a) | Kind::Power(a, _) | Kind::Bound(_, a) => is_sum(a),
        _ => false,
    }
}
