//! From Rust syntax to a tree with shapes. Nothing is derived before all shapes fit.

mod advice;
mod closures;
mod constraint;
mod frames;
mod functions;
mod methods;
mod names;
mod operators;
mod usage;

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use proc_macro2::{Span, TokenStream};
use quote::ToTokens;
use syn::ext::IdentExt as _;
use syn::spanned::Spanned as _;
use syn::{Block, Expr, Lit, Pat, Stmt, UnOp};

use crate::declared::errors::Errors;
use crate::declared::{Declaration, Kind, Name, OF_ANY_SIZE, Role, Shape, Spelling, Tree, parts};
use crate::mathematics::group::{Group, built_in};
use crate::mathematics::symbolic::Rational;
use closures::Closure;

/// The limit on nesting: deeper expressions, which no person writes, would overflow the compiler's stack.
const DEEPEST: usize = 250;

/// The declared expression as a tree; `None` after a mistake in the expression, the attribute or the struct.
pub fn check(declaration: &Declaration, errors: &mut Errors) -> Option<Rc<Tree>> {
    functions(declaration, errors)?.into_iter().next()
}

/// All functions of a declaration: those of a constraint, or the one expression of a Lagrangian or a force.
pub fn functions(declaration: &Declaration, errors: &mut Errors) -> Option<Vec<Rc<Tree>>> {
    let expression = declaration.expression.as_ref()?;
    let turning = declaration.group.of_hat().map(|factor| declaration.group.factor(factor).clone());
    let matrices = turning.or_else(|| built_in("SO3")).unwrap_or_else(|| declaration.group.clone());
    let mut checker = Checker {
        declaration,
        errors,
        scopes: vec![BTreeMap::new()],
        used: Vec::new(),
        unknown: BTreeSet::new(),
        depth: 0,
        is_too_deep: false,
        matrices,
        calls: 0,
        derived: BTreeSet::new(),
        result: value(expression),
        parts: Vec::new(),
    };
    let tree = checker.expression(expression);
    let (used, parts) = (checker.used, checker.parts);
    let tree = tree?;
    let functions = if parts.is_empty() { vec![tree.clone()] } else { parts };
    sized(&functions, errors)?;
    if declaration.role == Role::Constraint {
        constraint::few(&functions, value(expression), errors)?;
    } else if tree.shape != Shape::Scalar {
        let shape = tree.shape.describe();
        let advice = match declaration.role {
            Role::Force => "take its `.dot(…)` with a displacement",
            Role::Nonholonomic => "declare one constraint for each component, and add them",
            _ => "take a `.trace()` or a `.dot(…)`",
        };
        let noun = declaration.role.noun();
        errors.push_over(value(expression), format!("{noun} is a scalar, but this is {shape}: {advice}"));
        return None;
    }
    // The list `used` may be incomplete after a mistake.
    if errors.is_empty() {
        usage::check(declaration, &used, errors);
    }
    errors.is_empty().then_some(functions)
}

/// Reports an `I` that stands alone where matrices have several sizes.
fn sized(functions: &[Rc<Tree>], errors: &mut Errors) -> Option<()> {
    let mut all = functions.iter().flat_map(parts);
    let alone = all.find(|part| part.kind.is_identity() && part.shape == OF_ANY_SIZE);
    let Some(identity) = alone else { return Some(()) };
    errors.push(identity.span, operators::ALONE);
    None
}

/// The last expression of a block, or the expression itself.
pub fn value(expression: &Expr) -> &Expr {
    match expression {
        Expr::Group(inner) => value(&inner.expr),
        Expr::Paren(inner) => value(&inner.expr),
        Expr::Block(block) => match block.block.stmts.last() {
            Some(Stmt::Expr(last, None)) => value(last),
            _ => expression,
        },
        _ => expression,
    }
}

/// The last token of an expression; the compiler doesn't join spans.
fn end(expression: &Expr) -> Span {
    match expression {
        Expr::Binary(binary) => end(&binary.right),
        Expr::Unary(unary) => end(&unary.expr),
        Expr::Group(inner) => end(&inner.expr),
        Expr::Reference(inner) => end(&inner.expr),
        Expr::Paren(inner) => inner.paren_token.span.close(),
        Expr::MethodCall(call) => call.paren_token.span.close(),
        Expr::Call(call) => call.paren_token.span.close(),
        Expr::Index(index) => index.bracket_token.span.close(),
        Expr::Field(field) => field.member.span(),
        Expr::Block(block) => block.block.brace_token.span.close(),
        other => other.span(),
    }
}

/// A `let`: its tree, which is missing after a mistake, and whether its name has been used.
#[derive(Clone)]
struct Binding {
    tree: Option<Rc<Tree>>,
    /// The function, if the `let` declares one; then there is no tree.
    closure: Option<Rc<Closure>>,
    span: Span,
    /// The number of `&` in front of its value, if known.
    references: Option<usize>,
    used: bool,
}

/// An expression whose first token has no meaning.
struct FirstToken<'a>(&'a Expr);

impl ToTokens for FirstToken<'_> {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        tokens.extend(self.0.to_token_stream().into_iter().take(1));
    }
}

struct Checker<'a> {
    declaration: &'a Declaration,
    errors: &'a mut Errors,
    scopes: Vec<BTreeMap<Spelling, Binding>>,
    used: Vec<Name>,
    unknown: BTreeSet<String>,
    depth: usize,
    /// Whether the nesting has been reported: both operands of an operation may be too deep.
    is_too_deep: bool,
    /// The group that `I` and `hat(v)` belong to: among several bodies that of the first rotation.
    matrices: Group,
    /// The number of calls so far; a function may call others.
    calls: usize,
    /// The names of `let`s and of parameters in the derivation, where a name belongs to one value.
    derived: BTreeSet<String>,
    /// The expression without the block around it.
    result: &'a Expr,
    /// The functions of a constraint of several parts.
    parts: Vec<Rc<Tree>>,
}

impl Checker<'_> {
    /// The tree of an expression; `None` where a mistake has been reported.
    fn expression(&mut self, expression: &Expr) -> Option<Rc<Tree>> {
        if self.depth > DEEPEST {
            if !self.is_too_deep {
                self.errors.push(expression.span(), format!("nested more than {DEEPEST} deep: bind parts with `let`"));
            }
            self.is_too_deep = true;
            return None;
        }
        self.depth += 1;
        let tree = self.expression_inside(expression).map(|tree| Tree::until(tree, end(expression)));
        self.depth -= 1;
        if tree.as_ref().is_some_and(|tree| tree.depth > DEEPEST) {
            self.errors
                .push(expression.span(), format!("nested more than {DEEPEST} deep: the expression is too large"));
            return None;
        }
        tree
    }

    fn expression_inside(&mut self, expression: &Expr) -> Option<Rc<Tree>> {
        let span = expression.span();
        match expression {
            Expr::Paren(inner) => self.expression(&inner.expr),
            Expr::Group(inner) => self.expression(&inner.expr),
            Expr::Reference(inner) if inner.mutability.is_none() => self.expression(&inner.expr),
            Expr::Block(block) if block.label.is_none() => self.block(&block.block),
            Expr::Lit(literal) => self.literal(&literal.lit),
            Expr::Path(path) => match path.path.get_ident() {
                Some(name) if path.qself.is_none() => self.name(name),
                _ => {
                    let last = path.path.segments.last().and_then(|last| advice::number_of(&last.ident.to_string()));
                    let value = last.map_or_else(|| "its value".to_owned(), |number| format!("`{number}`"));
                    let message =
                        format!("a path has no meaning here: make it a field of the struct, or write {value}");
                    self.errors.push_over(path, message);
                    None
                }
            },
            Expr::Unary(unary) => match unary.op {
                UnOp::Neg(_) => {
                    let operand = self.expression(&unary.expr)?;
                    Some(Tree::new(span, operand.shape, Kind::Negate(operand)))
                }
                UnOp::Deref(star) => {
                    self.errors.push(star.span, "leave this `*` away; a power is written `x.powi(2)`");
                    None
                }
                _ => self.unknown(unary.op),
            },
            Expr::Binary(binary) => self.binary(binary),
            Expr::MethodCall(call) => self.method(call),
            Expr::Call(call) => self.call(call),
            Expr::Index(index) => self.index(index),
            Expr::Field(field) => self.component(field),
            Expr::Tuple(tuple) if self.is_constraint() && std::ptr::eq(expression, self.result) => self.stacked(tuple),
            Expr::Array(array) if self.is_constraint() && std::ptr::eq(expression, self.result) => {
                self.errors.push_over(array, "several functions stand in parentheses: write `(a, b)`");
                None
            }
            Expr::Cast(cast) => {
                self.errors.push_over(cast.as_token, "leave the cast away: all numbers are real, of one type");
                None
            }
            Expr::Try(question) => self.unknown(question.question_token),
            Expr::Closure(closure) => {
                let message =
                    "a function has a name: write `let U = |x: f64| …;` before the expression, and call `U(…)`";
                self.errors.push(closure.inputs_begin.span, message);
                None
            }
            Expr::Await(wait) => self.unknown(wait.await_token),
            Expr::Range(range) => self.unknown(range.limits),
            Expr::Assign(assignment) if self.is_constraint() => self.has_to_be_zero(assignment.eq_token),
            Expr::Assign(assignment) => self.unknown(assignment.eq_token),
            Expr::Reference(reference) => self.unknown(reference.mutability),
            _ => self.unknown(FirstToken(expression)),
        }
    }

    /// The number of `&` in front of the value of an expression, if known; parameters and results of operations are
    /// values.
    fn references(&self, expression: &Expr) -> Option<usize> {
        match expression {
            Expr::Reference(inner) => self.references(&inner.expr).map(|references| references + 1),
            Expr::Paren(inner) => self.references(&inner.expr),
            Expr::Group(inner) => self.references(&inner.expr),
            Expr::Block(_) => None,
            Expr::Path(path) => {
                let spelling = Spelling::of(path.path.get_ident()?);
                let binding = self.scopes.iter().rev().find_map(|scope| scope.get(&spelling));
                binding.map_or(Some(0), |binding| binding.references)
            }
            _ => Some(0),
        }
    }

    /// Whether the compiler accepts the argument: a method takes a reference, a function a value. If not, reports the
    /// right form. A reference to a reference is accepted.
    fn is_passed_right(&mut self, function: &str, argument: &Expr, by_reference: bool) -> bool {
        if self.declaration.is_text {
            return true;
        }
        let Some(found) = self.references(argument) else { return true };
        let advice = match (by_reference, found) {
            (true, 1..) | (false, 0) => return true,
            (true, 0) if matches!(argument, Expr::Path(_)) => {
                format!("takes a reference: write `&{}`", argument.to_token_stream())
            }
            (true, 0) => "takes a reference: write `&(…)`".to_owned(),
            (false, _) => "takes the value itself: leave the `&` away".to_owned(),
        };
        self.errors.push_over(argument, format!("`{function}` {advice}"));
        false
    }

    /// Reports a token without a meaning; its surroundings are right.
    fn unknown(&mut self, token: impl ToTokens) -> Option<Rc<Tree>> {
        let noun = self.declaration.role.noun();
        self.errors.push_over(
            token,
            format!(
                "this has no meaning in {noun}: use + - * /, `let`, indexing, `vee(…)` and the methods of vectors and \
                 matrices"
            ),
        );
        None
    }

    fn block(&mut self, block: &Block) -> Option<Rc<Tree>> {
        self.scopes.push(BTreeMap::new());
        let result = self.statements(&block.stmts, block.brace_token.span.join());
        // A statement with a mistake may use any name.
        let is_read = self.errors.is_empty();
        for binding in self.scopes.pop().into_iter().flat_map(BTreeMap::into_values) {
            if is_read && !binding.used {
                self.errors.push(binding.span, "this `let` isn't used: remove it");
            }
        }
        result
    }

    fn statements(&mut self, statements: &[Stmt], span: Span) -> Option<Rc<Tree>> {
        let the = self.declaration.role.definite();
        let Some((last, before)) = statements.split_last() else {
            self.errors.push(span, format!("the block is empty: end it with {the}"));
            return None;
        };
        for statement in before {
            match statement {
                Stmt::Local(local) => self.binding(local),
                other => {
                    // The statement may have been meant to declare a name.
                    self.errors.push_over(other, format!("only `let name = …;` may stand before {the}"));
                    return None;
                }
            }
        }
        match last {
            Stmt::Expr(expression, None) => self.expression(expression),
            Stmt::Expr(_, Some(semicolon)) => {
                self.errors.push(semicolon.span(), format!("the block must end with {the}: remove the semicolon"));
                None
            }
            other => {
                self.errors.push(other.span(), format!("the block must end with {the}, without a semicolon"));
                None
            }
        }
    }

    fn binding(&mut self, local: &syn::Local) {
        let (pattern, ty) = match &local.pat {
            Pat::Type(typed) => (&*typed.pat, Some(&typed.ty)),
            pattern => (pattern, None),
        };
        let name = match pattern {
            Pat::Ident(name) if name.by_ref.is_none() && name.mutability.is_none() && name.subpat.is_none() => {
                &name.ident
            }
            other => {
                self.errors.push_over(other, "bind one plain name: `let name = …;`");
                self.bind_nothing(other);
                return;
            }
        };
        if let Some(ty) = ty {
            self.errors.push_over(ty, "leave the type away: it follows from the expression");
        }
        if !self.is_free(name) {
            self.bind_nothing(pattern);
            return;
        }
        let Some(init) = local.init.as_ref().filter(|init| init.diverge.is_none()) else {
            self.errors.push_over(local, "a binding needs a value: `let name = …;`");
            self.bind_nothing(pattern);
            return;
        };
        if let Expr::Closure(closure) = &*init.expr {
            let closure = self.closure(closure).map(Rc::new);
            let used = closure.is_none();
            let binding = Binding { tree: None, closure, span: name.span(), references: Some(0), used };
            self.scopes.last_mut().map(|scope| scope.insert(Spelling::of(name), binding));
            return;
        }
        let tree = self.expression(&init.expr).map(|tree| {
            let (span, end, shape) = (tree.span, tree.end, tree.shape);
            let derived = self.in_derivation(name);
            Tree::until(Tree::new(span, shape, Kind::Bound(derived, tree)), end)
        });
        let references = self.references(&init.expr);
        let binding = Binding { tree, closure: None, span: name.span(), references, used: false };
        if let Some(scope) = self.scopes.last_mut() {
            scope.insert(Spelling::of(name), binding);
        }
    }

    /// Whether a name has no other meaning, which the compiled code would use in its place, or which it would hide.
    fn is_free(&mut self, name: &syn::Ident) -> bool {
        let (letters, the) = (name.unraw().to_string(), self.declaration.role.definite());
        let is_increment = self.declaration.factors.iter().any(|factor| factor.name == letters);
        if is_increment
            || self.declaration.role.reserved(self.declaration.group.is_product()).contains(&letters.as_str())
        {
            self.errors.push(name.span(), format!("`{letters}` already has a meaning in {the}: choose another name"));
            return false;
        }
        true
    }

    /// The name of a value in the derivation: as written, with a number from the second value of that name on.
    fn in_derivation(&mut self, name: &syn::Ident) -> String {
        let name = name.unraw().to_string();
        let is_taken = |name: &String| self.derived.contains(name) || self.is_parameter(name);
        let numbered = (2..).map(|number| format!("{name}_{number}"));
        let derived = if is_taken(&name) { numbered.into_iter().find(|name| !is_taken(name)) } else { None };
        let derived = derived.unwrap_or(name);
        self.derived.insert(derived.clone());
        derived
    }

    /// Whether a field, an advected parameter or an increment has this name.
    fn is_parameter(&self, name: &str) -> bool {
        self.declaration.fields.iter().any(|field| field.plain_name() == name)
            || self.declaration.advected.iter().any(|w| w.plain_name() == name)
            || self.declaration.factors.iter().any(|factor| factor.name == name)
    }

    /// The name, with a number if another value has it already.
    fn free_name(&self, name: &str) -> String {
        let is_bound = |name: &str| self.scopes.iter().flat_map(BTreeMap::keys).any(|bound| bound.letters == name);
        let is_taken = |name: &str| self.is_parameter(name) || is_bound(name);
        if !is_taken(name) {
            return name.to_owned();
        }
        let mut number = 2;
        while is_taken(&format!("{name}_{number}")) {
            number += 1;
        }
        format!("{name}_{number}")
    }

    /// Declares the names of a `let` with a mistake, without a tree.
    fn bind_nothing(&mut self, pattern: &Pat) {
        match pattern {
            Pat::Ident(name) => {
                let binding = Binding { tree: None, closure: None, span: name.span(), references: None, used: true };
                if let Some(scope) = self.scopes.last_mut() {
                    scope.insert(Spelling::of(&name.ident), binding);
                }
            }
            Pat::Tuple(tuple) => tuple.elems.iter().for_each(|part| self.bind_nothing(part)),
            _ => {}
        }
    }

    fn literal(&mut self, literal: &Lit) -> Option<Rc<Tree>> {
        let (digits, suffix, is_integer) = match literal {
            Lit::Float(float) => (float.base10_digits().to_owned(), float.suffix().to_owned(), false),
            Lit::Int(integer) => (integer.base10_digits().to_owned(), integer.suffix().to_owned(), true),
            Lit::Str(text) => {
                self.errors.push(text.span(), "leave the quotes away: expressions are written as they are");
                return None;
            }
            other => return self.unknown(other),
        };
        if is_integer && !self.declaration.is_text {
            self.errors.push(literal.span(), format!("write `{digits}.0`: scalars are real numbers"));
            return None;
        }
        if !suffix.is_empty() {
            self.errors.push(literal.span(), format!("leave the suffix away: write `{digits}`"));
            return None;
        }
        let value = Rational::from_decimal(&digits);
        if value.is_overflow() {
            self.errors.push(literal.span(), "too many digits for exact arithmetic: make it a field of the struct");
            return None;
        }
        Some(Tree::new(literal.span(), Shape::Scalar, Kind::Number(value)))
    }

    fn is_force(&self) -> bool {
        self.declaration.role == Role::Force
    }
}
