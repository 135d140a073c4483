//! Functions that a `let` names: `let U = |y: Vector3<f64>| …;`. A call is replaced by the body with its arguments.

use std::collections::BTreeMap;
use std::rc::Rc;

use proc_macro2::Span;
use quote::ToTokens as _;
use syn::ext::IdentExt as _;
use syn::{Expr, ExprCall, ExprClosure, Ident, Pat, ReturnType, Type};

use super::{Binding, Checker};
use crate::declared::parse::{field_kind, scalar_of};
use crate::declared::{FieldKind, Kind, Scalar, Shape, Spelling, Tree};
use crate::mathematics::symbolic::Rational;

/// The limit on calls. Each is checked separately, so a chain of functions that each call the previous one twice
/// doubles the calls at every step. Arguments may be `let`s of their own, of which the derivation allows fewer.
const MOST_CALLS: usize = 200;

/// A function that a `let` declares.
pub(super) struct Closure {
    parameters: Vec<(Ident, Shape)>,
    body: Expr,
    /// The names in scope of the function's body beside the parameters.
    scopes: Vec<BTreeMap<Spelling, Binding>>,
}

/// The function of a call.
pub(super) enum Callee {
    /// A function declared by a `let`.
    Closure(Ident, Rc<Closure>),
    /// The name of a `let` with a mistake: its calls can't be checked.
    Mistaken,
    Other,
}

impl Closure {
    /// The names of the parameters.
    pub(super) fn names(&self) -> String {
        self.parameters.iter().map(|(name, _)| name.unraw().to_string()).collect::<Vec<_>>().join(", ")
    }
}

impl Checker<'_> {
    /// A function at its declaration; `None` after a mistake in it.
    pub(super) fn closure(&mut self, closure: &ExprClosure) -> Option<Closure> {
        let before = self.errors.iter().count();
        let words = [
            closure.capture.map(|word| word.span),
            closure.asyncness.map(|word| word.span),
            closure.constness.map(|word| word.span),
        ];
        for word in words.into_iter().flatten() {
            self.errors.push(word, "leave this word away: a function is `|x: f64| …`");
        }
        let parameters: Vec<_> = closure.inputs.iter().map(|parameter| self.parameter(parameter)).collect();
        if let ReturnType::Type(_, ty) = &closure.output {
            self.errors.push_over(ty, "leave the type away: it follows from the expression");
        }
        if parameters.is_empty() {
            let message = "a function of nothing is a value: write `let U = …;`";
            self.errors.push(closure.inputs_begin.span, message);
        }
        let parameters = parameters.into_iter().collect::<Option<Vec<_>>>()?;
        // The body is checked once here: a mistake is reported once, and the names in it count as used even without a
        // call.
        let stand_in = |span: Span, shape| Some(Tree::new(span, shape, Kind::Number(Rational::ZERO)));
        let bound = parameters.iter().map(|(name, shape)| (name, stand_in(name.span(), *shape), Some(0)));
        let scope = bound.map(|(name, tree, references)| {
            let binding = Binding { tree, closure: None, span: name.span(), references, used: false };
            (Spelling::of(name), binding)
        });
        let scope: BTreeMap<_, _> = scope.collect();
        if scope.len() < parameters.len() {
            let again = |at: &usize| parameters[..*at].iter().any(|(other, _)| *other == parameters[*at].0);
            let place =
                (0..parameters.len()).find(again).map_or(closure.inputs_begin.span, |at| parameters[at].0.span());
            self.errors.push(place, "two parameters have one name: rename one");
            return None;
        }
        self.scopes.push(scope);
        let derived = self.derived.clone();
        let body = self.expression(&closure.body);
        self.derived = derived;
        let scope = self.scopes.pop().unwrap_or_default();
        body?;
        for binding in scope.values().filter(|binding| !binding.used) {
            self.errors.push(binding.span, "this parameter isn't used: remove it");
        }
        let body = (*closure.body).clone();
        (self.errors.iter().count() == before).then(|| Closure { parameters, body, scopes: self.scopes.clone() })
    }

    fn parameter(&mut self, parameter: &Pat) -> Option<(Ident, Shape)> {
        let advice = "write the name and the type of what it is called with: `|x: f64|`, `|y: Vector3<f64>|`, \
                      `|Q: Matrix3<f64>|`";
        let Pat::Type(typed) = parameter else {
            self.errors.push_over(parameter, advice);
            return None;
        };
        if let Type::Reference(reference) = &*typed.ty {
            let (mark, ty) = (reference.and_token.span, reference.elem.to_token_stream().to_string().replace(' ', ""));
            self.errors.push(mark, format!("leave the `&` away, as values are passed: write `{ty}`"));
            return None;
        }
        let name = match &*typed.pat {
            Pat::Ident(name) if name.by_ref.is_none() && name.mutability.is_none() && name.subpat.is_none() => {
                name.ident.clone()
            }
            other => {
                self.errors.push_over(other, advice);
                return None;
            }
        };
        if !self.is_free(&name) {
            return None;
        }
        let kind = field_kind(&typed.ty, &self.declaration.item);
        if let Some(kind @ (FieldKind::Scalar | FieldKind::Vector(_) | FieldKind::Matrix(_))) = kind {
            let (Scalar::Primitive(common) | Scalar::Parameter(common)) = &self.declaration.scalar;
            let parameters = || self.declaration.item.generics.type_params();
            let is_scalar =
                |name: &Ident| name == "f64" || name == "f32" || parameters().any(|parameter| parameter.ident == *name);
            if let Some(found) = scalar_of(&typed.ty).filter(|found| found != common && is_scalar(found)) {
                self.errors.push(found.span(), format!("the scalar of this struct is `{common}`: write it here too"));
                return None;
            }
            return Some((name, kind.shape()));
        }
        let message = "a function is called with numbers: write f64, Vector3<f64> or Matrix3<f64>, or the same with the \
                       struct's type parameter";
        self.errors.push_over(&typed.ty, message);
        None
    }

    /// The function that a call names.
    pub(super) fn callee(&mut self, call: &ExprCall) -> Callee {
        let Expr::Path(path) = &*call.func else { return Callee::Other };
        let Some(name) = path.path.get_ident() else { return Callee::Other };
        let spelling = Spelling::of(name);
        let bound = self.scopes.iter_mut().rev().find_map(|scope| scope.get_mut(&spelling));
        let Some(binding) = bound else { return Callee::Other };
        match binding.closure.clone() {
            Some(closure) => {
                binding.used = true;
                Callee::Closure(name.clone(), closure)
            }
            None if binding.tree.is_none() => Callee::Mistaken,
            None => Callee::Other,
        }
    }

    /// The body of a function with the arguments of a call.
    pub(super) fn called(&mut self, name: &Ident, closure: &Closure, call: &ExprCall) -> Option<Rc<Tree>> {
        let arguments: Vec<_> = call.args.iter().map(|argument| (argument, self.expression(argument))).collect();
        if arguments.len() != closure.parameters.len() {
            let (wanted, found) = (closure.parameters.len(), arguments.len());
            let message =
                format!("`{name}` is called with {wanted}, `{name}({})`, and here with {found}", closure.names());
            self.errors.push(name.span(), message);
            return None;
        }
        let mut scope = BTreeMap::new();
        let mut fits = true;
        for ((parameter, shape), (passed, argument)) in closure.parameters.iter().zip(arguments) {
            let Some(argument) = argument else {
                fits = false;
                continue;
            };
            if argument.shape != *shape {
                let (wanted, found) = (shape.describe(), argument.shape.describe());
                self.errors.push_over(passed, format!("`{parameter}` of `{name}` is {wanted}, and this is {found}"));
                fits = false;
                continue;
            }
            fits &= self.is_passed_right(&name.to_string(), passed, false);
            let (span, end) = (argument.span, argument.end);
            let bound = Tree::new(span, *shape, Kind::Bound(self.in_derivation(parameter), argument));
            let tree = Some(Tree::until(bound, end));
            let binding = Binding { tree, closure: None, span: parameter.span(), references: Some(0), used: true };
            scope.insert(Spelling::of(parameter), binding);
        }
        self.calls += 1;
        if self.calls > MOST_CALLS {
            if self.calls == MOST_CALLS + 1 {
                let message =
                    format!("functions are called more than {MOST_CALLS} times: declare parts as terms of their own");
                self.errors.push(name.span(), message);
            }
            return None;
        }
        if !fits {
            return None;
        }
        let outer = std::mem::replace(&mut self.scopes, closure.scopes.clone());
        self.scopes.push(scope);
        let value = self.expression(&closure.body);
        self.scopes = outer;
        value
    }
}
