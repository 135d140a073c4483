//! Advice for unknown names, methods and functions, chosen by their usual meaning.
//!
//! Similar letters alone would mislead: a tangent isn't `ln`, and a constant `PI` isn't `I`.

use quote::ToTokens as _;
use syn::Expr;
use syn::ext::IdentExt as _;

use super::Checker;
use super::functions::FUNCTIONS;
use super::methods::METHODS;
use crate::declared::errors::suggestion;
use crate::declared::{AdvectedParameter, Field, Shape, named_velocities};
use crate::mathematics::group::Group;

impl Checker<'_> {
    /// The second half of the message `… isn't known here`, for a name.
    pub(super) fn advice_on_name(&self, name: &str) -> String {
        let known = self.known_names();
        let near = suggestion(name, known.iter().map(String::as_str));
        if !near.is_empty() {
            return near;
        }
        let noun = self.declaration.role.noun();
        let mut constants = self.declaration.item.generics.const_params();
        let is_product = self.declaration.group.is_product();
        // Names of several bodies end in numbers.
        let is_numeral = |letter: char| is_product && (letter == '_' || letter.is_ascii_digit());
        let stem = name.trim_end_matches(is_numeral);
        match (stem, self.turning(name)) {
            ("w", Some(body)) => {
                return format!(
                    "; declare it with `advected({name} = field.seen_from({body}))`, where the field holds its spatial value"
                );
            }
            ("R" | "rotation" | "attitude" | "orientation", Some(body)) => {
                return format!("; declare it with `advected({name} = {body}.seen_from(space))`");
            }
            _ => {}
        }
        match stem {
            "F" if self.declaration.continuous.is_none() && !self.is_constraint() => {
                let names: Vec<String> = self.increments().iter().map(|name| format!("`{name}`")).collect();
                let (the, are) = if is_product { ("increments", "are") } else { ("increment", "is") };
                format!("; the {the} {are} called {}", names.join(", "))
            }
            "w" if !is_product => {
                "; declare it with `advected(w = field)`, where the field holds its spatial value".to_owned()
            }
            "t" | "time" => format!(
                "; {noun} has no time: declare what changes with it by `given(u = field)`, and go on by `step_with`"
            ),
            "omega" | "Omega" | "Ω" | "ω" | "xi" | "velocity" => self.advice_on_velocity(name),
            "angle" | "theta" | "phi" | "psi" | "θ" | "φ" | "ψ" if self.turns() => format!(
                "; {noun} has no angles: the cosine of the angle between two directions is `w.dot(&e)`, of a field `e` in the body and \
                 one in space that `advected(w = up)` turns into the body's axes"
            ),
            "R" | "rotation" | "attitude" | "orientation" if !is_product => format!(
                "; {noun} is reduced, and sees no `{name}`: what is fixed in space is declared with `advected(w = field)`"
            ),
            "Id" | "id" | "identity" | "Identity" | "eye" => "; the identity is `I`".to_owned(),
            "dt" | "step" | "time_step" | "timestep" | "delta_t" => "; the step is `h`".to_owned(),
            "self" => "; the fields are known by their names alone".to_owned(),
            _ if FUNCTIONS.contains(&name) => format!("; it is a function: write `{name}(…)`"),
            _ if METHODS.contains(&name) => format!("; it is a method: write `x{}`", called(name)),
            _ if constants.any(|constant| constant.ident == name) => {
                "; it is no real number: make it a field".to_owned()
            }
            _ => {
                let value = number_of(name).map_or_else(|| "its value".to_owned(), |number| format!("`{number}`"));
                let place = self.place_of_translated(name);
                format!(": make it a field of the struct, or write {value}{place}\nknown: {}", known.join(", "))
            }
        }
    }

    /// The advice for a name that may mean the position of a translated body: an increment is its displacement in a
    /// step.
    fn place_of_translated(&self, name: &str) -> String {
        let own = self.declaration.group.factors().iter().zip(&self.declaration.factors).find(|(own, _)| own.is_added);
        let place = |factor: &str| {
            format!("; if it is where `{factor}` has come to, `advected({name} = {factor}.seen_from(space))`")
        };
        own.filter(|_| !self.is_constraint()).map(|(_, factor)| place(&factor.name)).unwrap_or_default()
    }

    /// Whether the group turns bodies in space.
    fn turns(&self) -> bool {
        self.declaration.group.factors().iter().any(|factor| factor.is_so3)
    }

    /// The advice for a name that usually means a velocity.
    fn advice_on_velocity(&self, name: &str) -> String {
        let is_product = self.declaration.group.is_product();
        if self.declaration.continuous.is_some() {
            return match self.declaration.velocities() {
                [] if is_product => {
                    format!("; name the velocities by `{}`", named_velocities(&self.declaration.factors))
                }
                [] => format!("; name the velocity by `velocity = {name}`"),
                [one] => format!("; the velocity is called `{one}`"),
                several => {
                    let names: Vec<String> = several.iter().map(|name| format!("`{name}`")).collect();
                    format!("; the velocities are called {}", names.join(", "))
                }
            };
        }
        if self.is_constraint() {
            return "; a holonomic constraint is a function of positions, and sees no velocity".to_owned();
        }
        let (increment, group) = self.body(name);
        let velocity = if group.is_added {
            format!("`{increment} / h`")
        } else if group.is_so3 {
            format!("`log({increment}) / h`")
        } else {
            format!("`({increment} - I) / h`")
        };
        let continuous = match (self.is_force(), is_product) {
            (true, _) => String::new(),
            (_, true) => format!(", or declare `l = …` with `{}`", named_velocities(&self.declaration.factors)),
            _ => format!(", or declare `l = …` with `velocity = {name}`"),
        };
        format!("; the velocity of a step is in `{increment}`: write {velocity}{continuous}")
    }

    /// The names of the increments.
    fn increments(&self) -> Vec<String> {
        self.declaration.factors.iter().map(|factor| factor.name.clone()).collect()
    }

    /// The increments with their groups. Those with the number of this name come first, as `F_2` for `Omega_2`, and
    /// rotations come before translations.
    fn bodies(&self, name: &str) -> Vec<(&str, &Group)> {
        let number = |name: &str| name.chars().filter(char::is_ascii_digit).collect::<String>();
        let factors = self.declaration.factors.iter().enumerate();
        let bodies = factors.map(|(at, factor)| (factor.name.as_str(), self.declaration.group.factor(at)));
        let mut bodies: Vec<_> = bodies.collect();
        bodies.sort_by_key(|(increment, group)| (number(increment) != number(name), group.is_added));
        bodies
    }

    /// The body that the name most likely belongs to.
    fn body(&self, name: &str) -> (&str, &Group) {
        self.bodies(name).first().copied().unwrap_or(("F", &self.declaration.group))
    }

    /// The first of several bodies that has a rotation: a translation moves no vector, and has no attitude.
    fn turning(&self, name: &str) -> Option<&str> {
        let turns = self.bodies(name).into_iter().find(|(_, group)| !group.is_added);
        turns.map(|(increment, _)| increment).filter(|_| self.declaration.group.is_product())
    }

    /// All names in scope.
    fn known_names(&self) -> Vec<String> {
        let fields = self.declaration.fields.iter().map(Field::plain_name);
        let advected = self.declaration.advected.iter().map(AdvectedParameter::plain_name);
        let bound = self.scopes.iter().flat_map(|scope| scope.keys().map(|bound| bound.letters.clone()));
        let factors = 0..self.declaration.factors.len();
        let displacements = factors.filter_map(|factor| self.declaration.displacement(factor)).flatten();
        let has_steps = self.declaration.continuous.is_none() && !self.is_constraint();
        let (increments, step) = if has_steps { (self.increments(), Some("h")) } else { (Vec::new(), None) };
        let constants = ["I"].into_iter().chain(step).map(ToOwned::to_owned);
        let builtin = increments.into_iter().chain(constants).chain(displacements);
        let velocity = self.declaration.velocities().iter().map(|velocity| velocity.unraw().to_string());
        builtin.chain(velocity).chain(advected).chain(fields).chain(bound).collect()
    }

    /// The message for a method that isn't known.
    pub(super) fn advice_on_method(&self, name: &str, receiver: &Expr, shape: Option<Shape>) -> String {
        let of = spelled(receiver);
        match name {
            "log" if shape == Some(Shape::Scalar) => self.isnt_known(name, &format!(": write `{of}.ln()`")),
            "inverse" | "try_inverse" if shape == Some(Shape::Scalar) => {
                self.isnt_known(name, &format!(": write `1.0 / {of}`"))
            }
            "try_inverse" => self.isnt_known(name, &format!(": write `inverse({of})`")),
            _ if FUNCTIONS.contains(&name) => format!("`{name}` is a function: write `{name}({of})`"),
            _ => self.advice_on(name, &METHODS),
        }
    }

    /// The message for a function that isn't known.
    pub(super) fn advice_on_function(&self, function: &Expr) -> String {
        let Expr::Path(path) = function else { return NO_FUNCTION.to_owned() };
        let last = path.path.segments.last().map(|last| last.ident.unraw().to_string()).unwrap_or_default();
        if last == "identity" {
            "write `I` for the identity".to_owned()
        } else if path.path.segments.len() > 1 {
            "what this makes would be a constant: make it a field of the struct".to_owned()
        } else if self.known_names().contains(&last) {
            NO_FUNCTION.to_owned()
        } else if METHODS.contains(&last.as_str()) {
            format!("`{last}` is a method: write `x{}`", called(&last))
        } else {
            self.advice_on(&last, &FUNCTIONS)
        }
    }

    fn advice_on(&self, name: &str, known: &[&str]) -> String {
        if NOT_SMOOTH.contains(&name) {
            return format!(
                "`{name}` isn't smooth, and its derivative is needed: use a smooth function such as `.powi(2)`"
            );
        }
        if let Some(advice) = instead_of(name) {
            return self.isnt_known(name, &format!(": {advice}"));
        }
        let near = if is_of_others(name) { String::new() } else { suggestion(name, known.iter().copied()) };
        if !near.is_empty() {
            return self.isnt_known(name, &near);
        }
        let methods = METHODS.iter().filter(|method| **method != "clone");
        let methods: Vec<String> = methods.map(|method| format!(".{method}")).collect();
        self.isnt_known(name, &format!("\nknown: {}, {}", FUNCTIONS.join(", "), methods.join(", ")))
    }

    fn isnt_known(&self, name: &str, advice: &str) -> String {
        format!("`{name}` isn't known in {}{advice}", self.declaration.role.noun())
    }
}

/// A method call with placeholder arguments: `.trace()`, `.dot(&v)`.
pub(super) fn called(method: &str) -> String {
    let arguments = match method {
        "dot" | "cross" | "component_mul" => "&v",
        "powi" => "2",
        _ => "",
    };
    format!(".{method}({arguments})")
}

/// The text of a plain name or a number; dots for any other expression.
pub(super) fn spelled(expression: &Expr) -> String {
    match expression {
        Expr::Lit(literal) => literal.to_token_stream().to_string(),
        Expr::Path(path) => path.path.get_ident().map_or_else(|| "…".to_owned(), ToString::to_string),
        Expr::Paren(inner) => spelled(&inner.expr),
        Expr::Group(inner) => spelled(&inner.expr),
        _ => "…".to_owned(),
    }
}

/// Mathematical constants by their usual names.
pub(super) fn number_of(name: &str) -> Option<f64> {
    match name {
        "PI" | "pi" => Some(std::f64::consts::PI),
        "TAU" => Some(std::f64::consts::TAU),
        "FRAC_PI_2" => Some(std::f64::consts::FRAC_PI_2),
        "SQRT_2" => Some(std::f64::consts::SQRT_2),
        _ => None,
    }
}

const NO_FUNCTION: &str = "this is a value and no function: a product is written with `*`";

const NOT_SMOOTH: [&str; 8] = ["abs", "max", "min", "signum", "floor", "ceil", "round", "clamp"];

/// The replacement for a function of other libraries, with the arguments `x`, `v` and `A`.
fn instead_of(function: &str) -> Option<&'static str> {
    Some(match function {
        "tan" => "write the sine over the cosine, `x.sin() / x.cos()`",
        "sin_cos" => "write `x.sin()` and `x.cos()`",
        "sinh" => "write `0.5 * (x.exp() - (-x).exp())`",
        "cosh" => "write `0.5 * (x.exp() + (-x).exp())`",
        "tanh" => "write `1.0 - 2.0 / ((2.0 * x).exp() + 1.0)`",
        "log10" | "log2" => "write `x.ln()`, over that of the base",
        "exp_m1" => "write `x.exp() - 1.0`",
        "ln_1p" => "write `(1.0 + x).ln()`",
        "pow" | "powf" | "square" | "squared" => "write `x.powi(2)`, with a whole number, or `x.sqrt()`",
        "recip" => "write `1.0 / x`",
        "mul_add" => "write `a * b + c`",
        "magnitude" => "write `v.norm()`",
        "magnitude_squared" => "write `v.norm_squared()`",
        "normalize" | "normalized" => "write `v / v.norm()`",
        "skew" | "skew_symmetric" | "wedge" => "write `v.cross_matrix()`",
        "tr" => "write `A.trace()`",
        "tr_mul" | "tr_dot" => "write `.transpose()` and `*`",
        "adjoint" | "t" | "T" => "write `A.transpose()`",
        "outer" | "outer_product" => "write `a * b.transpose()`",
        "row" | "column" => "write entries by their indices: `v[0]`, `A[(0, 1)]`",
        _ => return None,
    })
}

/// Whether the name is that of another function, and not a misspelling.
fn is_of_others(name: &str) -> bool {
    let arc = name.strip_prefix('a').map(|name| name.strip_prefix("rc").unwrap_or(name));
    let arc = arc.map(|name| name.strip_suffix('h').unwrap_or(name));
    matches!(arc, Some("sin" | "cos" | "tan" | "tan2")) || matches!(name, "len" | "cbrt" | "log" | "ln1p" | "expm1")
}
