//! The attribute's arguments, read as far as they can be.

use proc_macro2::{TokenStream, TokenTree};
use syn::ext::IdentExt as _;
use syn::parse::ParseStream;
use syn::punctuated::Punctuated;
use syn::{Expr, Ident, Path, Token, parenthesized};

use super::generators::Generators;
use super::group;
use crate::declared::errors::{Errors, suggestion};
use crate::declared::{Coordinates, Discretisation, Quadrature, Role};
use crate::mathematics::group::built_in;

/// The arguments as written.
#[derive(Default)]
pub(super) struct Arguments {
    pub(super) group: Option<group::GroupName>,
    /// The factors of a product: the increment of each, and its group.
    pub(super) factors: Vec<(Ident, group::GroupName)>,
    /// The name of an advected parameter, its source, and whether it is prescribed for each step.
    pub(super) advected: Vec<(Ident, Source, bool)>,
    /// The expression of `l_d`, of the virtual work or of the constraint, with its key.
    pub(super) expression: Option<(Ident, Expr)>,
    /// The expression of `l`, with its key.
    pub(super) continuous: Option<(Ident, Expr)>,
    /// The names of the velocities, with their key.
    pub(super) velocity: Option<(Ident, Vec<Ident>)>,
    /// The discretisation, with its key.
    pub(super) discretisation: Option<(Ident, Discretisation)>,
    /// The pace, with its key.
    pub(super) pace: Option<(Ident, Expr)>,
    pub(super) root: Option<Path>,
    pub(super) generators: Option<Generators>,
    /// The names of a force's displacements, with their key.
    pub(super) displacement: Option<(Ident, Vec<Ident>)>,
    /// The key of the derivatives.
    pub(super) gradients: Option<Ident>,
    /// Whether an argument without a name has been reported.
    has_nameless: bool,
}

/// The value of an advected parameter.
pub(super) enum Source {
    /// A field, as `up`.
    Field(Ident),
    /// A field or a body in the frame of a body, as `up.seen_from(F_1)`, `F_2.seen_from(F_1)`, `F_2.seen_from(space)`.
    View { what: Ident, from: Ident },
}

/// Reads `key = value` pairs; after a syntax error, reading continues behind the next comma.
pub(super) fn arguments_from(role: Role, input: ParseStream, errors: &mut Errors) -> Arguments {
    let mut arguments = Arguments::default();
    while !input.is_empty() {
        if let Err(error) = argument(role, input, &mut arguments, errors) {
            errors.extend(error);
            skip_argument(input);
        }
    }
    if let (Role::Nonholonomic, Some((key, _))) = (role, &arguments.continuous) {
        // A rule that isn't its own adjoint would make steps of the first order.
        let place = [key.span(); 2];
        let usual = Discretisation { quadrature: Quadrature::Trapezoid, coordinates: Coordinates::Cayley, place };
        arguments.discretisation.get_or_insert((key.clone(), usual));
    }
    arguments
}

fn skip_argument(input: ParseStream) {
    while !input.is_empty() && !input.peek(Token![,]) {
        let _ = input.parse::<TokenTree>();
    }
    let _ = input.parse::<Token![,]>();
}

/// The names of arguments.
fn known(role: Role) -> Vec<&'static str> {
    let mut known = match role {
        Role::Constraint => vec!["group", "advected", role.key(), "crate"],
        Role::Nonholonomic => {
            vec!["group", "advected", "given", role.key(), "velocity", "discretise", "generators", "crate"]
        }
        Role::Hamiltonian => vec!["group", "advected", role.key(), "momentum", "generators", "crate"],
        _ => vec!["group", "advected", "given", role.key(), "generators", "gradients", "crate"],
    };
    match role {
        Role::Lagrangian => known.extend(["l", "velocity", "discretise", "pace"]),
        Role::Force => known.push("displacement"),
        Role::Constraint | Role::Nonholonomic | Role::Hamiltonian => {}
    }
    known
}

fn argument(role: Role, input: ParseStream, arguments: &mut Arguments, errors: &mut Errors) -> syn::Result<()> {
    let known = known(role);
    let has_velocity = known.contains(&"velocity") || known.contains(&"momentum");
    one_comma(input)?;
    let Some(key) = key(input, &known) else {
        if !arguments.has_nameless {
            errors.push(input.span(), format!("arguments have names: write `group = SO3`, `{} = …`", role.key()));
        }
        arguments.has_nameless = true;
        skip_argument(input);
        return Ok(());
    };
    let mut once = |taken: bool| {
        if taken {
            errors.push(key.span(), format!("`{key}` is given twice: remove one"));
        }
    };
    match key.to_string().as_str() {
        "group" => group_argument(&key, input, arguments, errors)?,
        "crate" => {
            once(arguments.root.is_some());
            equals(&key, input)?;
            without_quotes(&key, input)?;
            let message = "write where liestep is found: `crate = liestep`, `crate = ::renamed`";
            let path = input.fork().call(Path::parse_mod_style);
            path.map_err(|_| syn::Error::new(input.span(), message))?;
            arguments.root = Some(input.call(Path::parse_mod_style)?);
        }
        name @ ("l" | "pace" | "zero" | "h") if role != Role::Constraint && known.contains(&name) => {
            let place = if name == "pace" { &mut arguments.pace } else { &mut arguments.continuous };
            once(place.is_some());
            equals(&key, input)?;
            *place = Some((key, input.parse()?));
        }
        expression if expression == role.key() => {
            once(arguments.expression.is_some());
            equals(&key, input)?;
            arguments.expression = Some((key, input.parse()?));
        }
        "velocity" | "momentum" if has_velocity => {
            once(arguments.velocity.is_some());
            arguments.velocity = Some((key.clone(), velocities(&key, input)?));
        }
        "displacement" if role == Role::Force => {
            once(arguments.displacement.is_some());
            let names = displacements(&key, input)?;
            arguments.displacement = Some((key, names));
        }
        "discretise" if has_velocity => {
            once(arguments.discretisation.is_some());
            equals(&key, input)?;
            without_quotes(&key, input)?;
            arguments.discretisation = Some((key, discretisation(input)?));
        }
        "gradients" if known.contains(&"gradients") => {
            once(arguments.gradients.is_some());
            if !is_at_end(input) {
                return Err(syn::Error::new(input.span(), "`gradients` stands alone: remove what follows it"));
            }
            arguments.gradients = Some(key);
        }
        "generators" if role != Role::Constraint => {
            once(arguments.generators.is_some());
            arguments.generators = Some(Generators::of(key, input)?);
        }
        pairs @ ("advected" | "given") if role != Role::Constraint || pairs == "advected" => {
            let is_given = pairs == "given";
            let pairs = advected_pairs(&key, is_given, input)?;
            arguments.advected.extend(pairs.into_iter().map(|(name, source)| (name, source, is_given)));
        }
        "velocity" if role == Role::Constraint => {
            let message = "a holonomic constraint is a function of positions, and sees no velocity: remove this";
            return Err(syn::Error::new(key.span(), message));
        }
        _ => return Err(unknown(role, &key, &known)),
    }
    comma(input)
}

fn unknown(role: Role, key: &Ident, known: &[&'static str]) -> syn::Error {
    let near = suggestion(&key.to_string(), known.iter().copied());
    let list = if near.is_empty() { format!("\nknown: {}", known.join(", ")) } else { String::new() };
    let attribute = role.attribute();
    syn::Error::new(key.span(), format!("`{key}` isn't an argument of `{attribute}`{near}{list}"))
}

fn displacements(key: &Ident, input: ParseStream) -> syn::Result<Vec<Ident>> {
    let message = "write `displacement(eta_1, eta_2)`: a name for each factor of the group, in their order";
    if !input.peek(syn::token::Paren) {
        return Err(syn::Error::new(key.span(), message));
    }
    in_parentheses(input, message)
}

/// `group = SO3`, `group(F_1 = SO3, F_2 = SO3)`.
fn group_argument(key: &Ident, input: ParseStream, arguments: &mut Arguments, errors: &mut Errors) -> syn::Result<()> {
    let (is_again, are_several) = (!arguments.factors.is_empty(), input.peek(syn::token::Paren));
    if is_again && are_several {
        let message = "`group` is given twice: all factors stand in one, `group(F_1 = SO3, F_2 = SO3)`";
        errors.push(key.span(), message);
    } else if is_again || arguments.group.is_some() {
        errors.push(key.span(), format!("`{key}` is given twice: remove one"));
    }
    if are_several {
        let content;
        parenthesized!(content in input);
        let factors = factors(&content, errors);
        content.parse::<TokenStream>()?;
        arguments.factors.extend(factors?);
        return Ok(());
    }
    if !input.peek(Token![=]) {
        return Err(syn::Error::new(input.span(), group::ONE_OR_SEVERAL));
    }
    equals(key, input)?;
    without_quotes(key, input)?;
    let named = group::named(input, errors)?;
    // A name here begins the next argument: a comma is missing, not a part of the group.
    if !is_at_end(input) && !input.peek(Ident::peek_any) {
        return Err(syn::Error::new(input.span(), group::ONE_OR_SEVERAL));
    }
    arguments.group = Some(named);
    Ok(())
}

/// Whether an argument ends here.
fn is_at_end(input: ParseStream) -> bool {
    input.is_empty() || input.peek(Token![,])
}

/// Reports a second comma in a row.
fn one_comma(input: ParseStream) -> syn::Result<()> {
    if input.peek(Token![,]) { Err(input.error("there is one comma too many: remove it")) } else { Ok(()) }
}

fn no_semicolon(input: ParseStream) -> syn::Result<()> {
    if input.peek(Token![;]) { Err(input.error("a comma stands between arguments: write `,`")) } else { Ok(()) }
}

fn comma(input: ParseStream) -> syn::Result<()> {
    no_semicolon(input)?;
    if !input.is_empty() {
        let missing = "a comma is missing before this, or within an expression an operator, as in `a * b`";
        input.parse::<Token![,]>().map_err(|_| input.error(missing))?;
    }
    Ok(())
}

/// `F_1 = SO3, F_2 = SO3`.
fn factors(input: ParseStream, errors: &mut Errors) -> syn::Result<Vec<(Ident, group::GroupName)>> {
    let mut factors = vec![factor(input, errors)?];
    while !input.is_empty() {
        no_semicolon(input)?;
        input.parse::<Token![,]>()?;
        if !input.is_empty() {
            one_comma(input)?;
            factors.push(factor(input, errors)?);
        }
    }
    Ok(factors)
}

/// Reads a factor of a product, as `F_1 = SO3`.
fn factor(input: ParseStream, errors: &mut Errors) -> syn::Result<(Ident, group::GroupName)> {
    let span = input.span();
    let message = "write `group(F_1 = SO3, F_2 = SO3)`: the increment of each body, and its group";
    let name: Ident = input.parse().map_err(|_| syn::Error::new(span, message))?;
    if !input.peek(Token![=]) {
        return Err(syn::Error::new(name.span(), message));
    }
    input.parse::<Token![=]>()?;
    let named = group::named(input, errors)?;
    if built_in(&name.to_string()).is_some() && named.may_be_an_increment() {
        let message = format!("the increment stands first, and then its group: write `{} = {name}`", named.name());
        return Err(syn::Error::new(name.span(), message));
    }
    Ok((name, named))
}

/// Reads names behind a key: `= Omega`, `(Omega_1, Omega_2)`.
fn velocities(key: &Ident, input: ParseStream) -> syn::Result<Vec<Ident>> {
    if input.peek(syn::token::Paren) {
        let message = "write `velocity(Omega_1, Omega_2)`: a name for each factor of the group, in their order";
        return in_parentheses(input, message);
    }
    equals(key, input)?;
    if input.peek(syn::token::Paren) {
        let group: proc_macro2::Group = input.parse()?;
        return Err(syn::Error::new(
            group.span(),
            format!("of several velocities leave the `=` away: `velocity{group}`"),
        ));
    }
    without_quotes(key, input)?;
    Ok(vec![input.call(Ident::parse_any)?])
}

/// Reads names in parentheses, as `(Omega_1, Omega_2)`.
fn in_parentheses(input: ParseStream, message: &str) -> syn::Result<Vec<Ident>> {
    let content;
    parenthesized!(content in input);
    let names = Punctuated::<Ident, Token![,]>::parse_terminated(&content);
    names.map(|names| names.into_iter().collect()).map_err(|error| syn::Error::new(error.span(), message))
}

/// The key of an argument: a known name, a misspelt one, or any name followed by a value.
fn key(input: ParseStream, known: &[&str]) -> Option<Ident> {
    let ahead = input.fork();
    let key = ahead.call(Ident::parse_any).ok()?;
    let is_given = ahead.peek(Token![=]) || ahead.peek(syn::token::Paren);
    let is_known = known.iter().any(|name| key == name);
    let is_slip = is_at_end(&ahead) && !suggestion(&key.to_string(), known.iter().copied()).is_empty();
    (is_given || is_known || is_slip).then(|| input.call(Ident::parse_any).ok())?
}

/// `trapezoid`, `trapezoid(Cayley)`, `midpoint(exp)`, `chord`, ….
fn discretisation(input: ParseStream) -> syn::Result<Discretisation> {
    let name: Ident = input.call(Ident::parse_any)?;
    let known = ["trapezoid", "midpoint", "chord"];
    let quadrature = match name.to_string().as_str() {
        "trapezoid" => Quadrature::Trapezoid,
        "midpoint" => Quadrature::Midpoint,
        "chord" => Quadrature::Chord,
        other => {
            let near = suggestion(other, known);
            let message = format!("`{other}` isn't a discretisation{near}\nknown: {}", known.join(", "));
            return Err(syn::Error::new(name.span(), message));
        }
    };
    if !input.peek(syn::token::Paren) {
        let place = [name.span(); 2];
        return Ok(Discretisation { quadrature, coordinates: Coordinates::Ambient, place });
    }
    let content;
    let parentheses = parenthesized!(content in input);
    let message = format!("write a retraction, `{name}(Cayley)` or `{name}(exp)`");
    let retraction = content.call(Ident::parse_any).map_err(|_| syn::Error::new(parentheses.span.join(), message))?;
    let rest: TokenStream = content.parse()?;
    if !rest.is_empty() {
        return Err(syn::Error::new_spanned(rest, format!("write one retraction: `{name}({retraction})`")));
    }
    let coordinates = match retraction.to_string().as_str() {
        "Cayley" => Coordinates::Cayley,
        "exp" => Coordinates::Exponential,
        other => {
            let near = suggestion(other, ["Cayley", "exp"]);
            let message = format!("`{other}` isn't a retraction{near}\nknown: Cayley, exp");
            return Err(syn::Error::new(retraction.span(), message));
        }
    };
    Ok(Discretisation { quadrature, coordinates, place: [name.span(), parentheses.span.close()] })
}

fn equals(key: &Ident, input: ParseStream) -> syn::Result<()> {
    if !input.peek(Token![=]) {
        return Err(syn::Error::new(input.span(), format!("write `{key} = …`")));
    }
    input.parse::<Token![=]>().map(|_| ())
}

/// Reports quotes around a name.
fn without_quotes(key: &Ident, input: ParseStream) -> syn::Result<()> {
    match input.fork().parse::<syn::LitStr>() {
        Ok(text) => {
            let name = text.value();
            Err(syn::Error::new(text.span(), format!("write the name without quotes: `{key} = {name}`")))
        }
        Err(_) => Ok(()),
    }
}

/// `(w = up, …)`.
fn advected_pairs(
    key: &Ident,
    is_given: bool,
    input: ParseStream,
) -> syn::Result<Punctuated<(Ident, Source), Token![,]>> {
    if !input.peek(syn::token::Paren) {
        let example = if is_given { "given(u = torque)" } else { "advected(w = up)" };
        let message = format!("write `{example}`: a name for the expression, then the field");
        return Err(syn::Error::new(key.span(), message));
    }
    let content;
    parenthesized!(content in input);
    let pairs = content.parse_terminated(advected_pair, Token![,]);
    // The tokens behind a mistake would be reported as unexpected.
    content.parse::<TokenStream>()?;
    pairs
}

fn advected_pair(input: ParseStream) -> syn::Result<(Ident, Source)> {
    one_comma(input)?;
    if !input.peek(Ident::peek_any) {
        return Err(input.error("write `w = up`: a name for the expression, then the field"));
    }
    let name: Ident = input.parse()?;
    if !input.peek(Token![=]) {
        let message = if input.peek(Token![.]) {
            format!("write `w = {name}.seen_from(…)`: a name for the expression comes first")
        } else {
            format!("write `{name} = field`, the field that holds its value")
        };
        return Err(syn::Error::new(name.span(), message));
    }
    input.parse::<Token![=]>()?;
    without_quotes(&name, input)?;
    let span = input.span();
    if input.peek(Token![self]) {
        return Err(syn::Error::new(span, "leave the `self.` away: the fields are known by their names alone"));
    }
    let message = format!("write `{name} = field` with the name of a field and nothing else");
    let field: Ident = input.parse().map_err(|_| syn::Error::new(span, &message))?;
    if input.peek(Token![.]) {
        let seen = seen(field, input)?;
        no_semicolon(input)?;
        // A name here begins the next argument: a comma is missing.
        if let (Source::View { what, from }, false) = (&seen, is_at_end(input) || input.peek(Ident::peek_any)) {
            let message = format!(
                "write `{name} = {what}.seen_from({from})` and nothing else: what is made of it stands in the expression"
            );
            return Err(input.error(message));
        }
        return Ok((name, seen));
    }
    no_semicolon(input)?;
    if !is_at_end(input) {
        return Err(input.error(message));
    }
    Ok((name, Source::Field(field)))
}

/// Reads the rest of a source, `.seen_from(F_1)`.
fn seen(what: Ident, input: ParseStream) -> syn::Result<Source> {
    input.parse::<Token![.]>()?;
    let message = format!("write `{what}.seen_from(…)`, with the increment of the body that sees it");
    let method: Ident = input.parse().map_err(|_| input.error(&message))?;
    if method != "seen_from" || !input.peek(syn::token::Paren) {
        return Err(syn::Error::new(method.span(), message));
    }
    let content;
    parenthesized!(content in input);
    let (first, from) = (content.span(), content.parse::<Ident>());
    let place = if from.is_ok() { content.span() } else { first };
    // The tokens behind a mistake would be reported as unexpected.
    let rest: TokenStream = content.parse()?;
    match from {
        Ok(from) if rest.is_empty() => Ok(Source::View { what, from }),
        _ => Err(syn::Error::new(place, message)),
    }
}
