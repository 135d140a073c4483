//! The body in whose axes a vector is given: the one mistake among several bodies that shapes can't find.
//!
//! Increments, velocities and displacements are in the axes of their own body, and so are fields `seen_from` a body. A
//! relative configuration maps vectors from the axes of one body to those of another. Other fields may belong to any
//! body, and so may vectors in the axes of space: the attitude of a body may be given relative to another body instead.
//! Only two different known bodies are a mistake.
//!
//! Rotations have an axis and an angle of their own, so they may be compared without a common frame: the rotations of
//! two bodies, each in its own axes, as in `vee(F_1) - vee(F_2)`, or a relative configuration with its transpose. For
//! the same reason a relative configuration may be repeated, `Q * Q`.

use std::rc::Rc;

use syn::{Expr, ExprReference};

use super::Checker;
use crate::declared::{AdvectedParameter, Declaration, Frames, Kind, Name, Role, Shape, Tree};
use crate::mathematics::derive::View;

/// Space, which counts as a body in a constraint; elsewhere the attitude of a body may be relative to another.
const SPACE: usize = usize::MAX;

/// The frames that the value of a name is given in.
pub(super) fn of(declaration: &Declaration, name: Name) -> Frames {
    let space = (declaration.role == Role::Constraint).then_some(SPACE);
    let turns = |factor: usize| declaration.group.is_product() && !declaration.group.factor(factor).is_added;
    match name {
        Name::Increment(factor) if turns(factor) => [Some(factor); 2],
        Name::Velocity(factor) | Name::DisplacementBefore(factor) | Name::DisplacementAfter(factor)
            if turns(factor) =>
        {
            [Some(factor), None]
        }
        Name::Advected(index) => match declaration.advected.get(index).filter(|w| !w.is_given).map(|w| w.seen) {
            Some(View::From(factor)) if turns(factor) => {
                let is_tensor = declaration.advected_kind(index).variance().is_tensor();
                [Some(factor), is_tensor.then_some(factor)]
            }
            Some(View::Relative { of, from }) if turns(of) => [Some(from), Some(of)],
            Some(View::Configuration(of)) if turns(of) => [space, Some(of)],
            Some(View::Configuration(_) | View::Relative { .. }) => [space, None],
            _ => [None; 2],
        },
        _ => [None; 2],
    }
}

/// Whether a name is a rotation: an increment, or a relative configuration.
pub(super) fn is_turn(declaration: &Declaration, name: Name) -> bool {
    match name {
        Name::Increment(_) => true,
        Name::Advected(index) => {
            declaration.advected.get(index).is_some_and(|w| matches!(w.seen, View::Relative { .. }) && !w.is_given)
        }
        _ => false,
    }
}

/// Whether a multiple of a displacement or a velocity belongs to a rotation; `None` for any other expression.
fn is_of_turn(declaration: &Declaration, tree: &Tree) -> Option<bool> {
    match &tree.kind {
        Kind::Name(Name::Velocity(factor) | Name::DisplacementBefore(factor) | Name::DisplacementAfter(factor)) => {
            declaration.group.is_product().then(|| !declaration.group.factor(*factor).is_added)
        }
        Kind::Negate(a) | Kind::Bound(_, a) | Kind::Divide(a, _) => is_of_turn(declaration, a),
        Kind::Multiply(a, b) if a.shape == Shape::Scalar => is_of_turn(declaration, b),
        Kind::Multiply(a, b) if b.shape == Shape::Scalar => is_of_turn(declaration, a),
        _ => None,
    }
}

/// Whether both are rotations between the same two bodies, in either direction.
fn are_relative_alike(a: &Tree, b: &Tree) -> bool {
    let [first, second] = [a, b].map(|tree| match tree.frames {
        [Some(to), Some(from)] if to != from => Some((to.min(from), to.max(from))),
        _ => None,
    });
    first.is_some() && first == second
}

/// A multiple of an attitude, or of a vector's image under its transpose.
struct OfAttitude<'a> {
    /// The body that the attitude is seen from; `None` for space.
    from: Option<usize>,
    is_transposed: bool,
    vector: Option<&'a Tree>,
}

impl<'a> OfAttitude<'a> {
    fn read(declaration: &Declaration, tree: &'a Tree) -> Option<Self> {
        match &tree.kind {
            Kind::Bound(_, a) | Kind::Negate(a) | Kind::Divide(a, _) => Self::read(declaration, a),
            Kind::Multiply(a, b) if a.shape == Shape::Scalar => Self::read(declaration, b),
            Kind::Multiply(a, b) if b.shape == Shape::Scalar => Self::read(declaration, a),
            Kind::Multiply(a, b) => Self::read(declaration, a)
                .filter(|attitude| attitude.vector.is_none())
                .map(|attitude| Self { vector: Some(b), ..attitude }),
            Kind::Transpose(a) => Self::read(declaration, a)
                .filter(|attitude| attitude.vector.is_none())
                .map(|attitude| Self { is_transposed: !attitude.is_transposed, ..attitude }),
            Kind::Name(Name::Advected(index)) => {
                let from = match declaration.advected.get(*index).filter(|w| !w.is_given)?.seen {
                    View::Configuration(of) if !declaration.group.factor(of).is_added => None,
                    View::Relative { of, from } if !declaration.group.factor(of).is_added => Some(from),
                    _ => return None,
                };
                Some(Self { from, is_transposed: false, vector: None })
            }
            _ => None,
        }
    }
}

/// Whether both are attitudes that one body sees, or images of one vector under their transposes: a vector may be taken in
/// the axes in the middle of two bodies, as in the strain of a rod, `((R_1 + R_2).transpose() * r) / 2.0`.
fn are_attitudes_alike(declaration: &Declaration, a: &Tree, b: &Tree) -> bool {
    let (Some(a), Some(b)) = (OfAttitude::read(declaration, a), OfAttitude::read(declaration, b)) else { return false };
    let is_one = match (a.vector, b.vector) {
        (None, None) => true,
        (Some(a), Some(b)) => are_same(a, b),
        _ => false,
    };
    is_one && a.from == b.from && a.is_transposed == b.is_transposed
}

/// The depth to which expressions are compared.
const DEEPEST: usize = 6;

/// Whether two short expressions are the same operations on the same names.
fn are_same(a: &Tree, b: &Tree) -> bool {
    let is_same = match (&a.kind, &b.kind) {
        (Kind::Number(a), Kind::Number(b)) => a == b,
        (Kind::Name(a), Kind::Name(b)) => a == b,
        (Kind::Bound(_, a), _) => return are_same(a, b),
        (_, Kind::Bound(_, b)) => return are_same(a, b),
        (Kind::Power(_, a), Kind::Power(_, b)) => a == b,
        (Kind::Apply(a, _), Kind::Apply(b, _)) => a == b,
        (Kind::Entry(_, a, c), Kind::Entry(_, b, d)) => (a, c) == (b, d),
        (a, b) => std::mem::discriminant(a) == std::mem::discriminant(b),
    };
    let operands = || a.kind.operands().into_iter().zip(b.kind.operands());
    is_same
        && a.shape == b.shape
        && a.depth.max(b.depth) <= DEEPEST
        && operands().all(|pair| match pair {
            (Some(a), Some(b)) => are_same(a, b),
            (a, b) => a.is_none() && b.is_none(),
        })
}

impl Checker<'_> {
    /// Whether the columns of the left factor of a product have the frame of the rows of the right one.
    pub(super) fn meet(&mut self, whole: &Expr, (left, right): (&Expr, &Expr), trees: (&Tree, &Tree)) -> bool {
        let (Some(from), Some(of)) = (trees.0.frames[1], trees.1.frames[0]) else { return true };
        if from == of || are_relative_alike(trees.0, trees.1) {
            return true;
        }
        for (operand, tree, fits) in [(right, trees.1, 0), (left, trees.0, 1)] {
            // The transpose would fit.
            let turned = [tree.frames[1], tree.frames[0]];
            if tree.frames[0] != tree.frames[1] && turned[fits] == Some([from, of][fits]) && spelled(operand) != "…" {
                let name = spelled(operand);
                let message = match name.strip_suffix(".transpose()") {
                    Some(plain) => format!("`{name}` brings vectors the other way: write `{plain}`"),
                    None => format!("`{name}` brings vectors the other way: write `{name}.transpose()`"),
                };
                self.errors.push_over(operand, message);
                return false;
            }
        }
        let (relative, declared) = self.relative(from, of);
        let advice = if trees.1.shape.is_vector() {
            format!("{} * ({relative} * {})", spelled(left), spelled(right))
        } else {
            let left = if is_increment(left) { format!("{}.transpose()", spelled(left)) } else { spelled(left) };
            format!("{left} * {relative} * {}", spelled(right))
        };
        let message = format!(
            "{} and {} are seen from different bodies: between them stands a relative configuration, as in \
             `{advice}`{declared}",
            self.named(left, from),
            self.named(right, of)
        );
        self.errors.push_over(whole, message);
        false
    }

    /// Whether the two operands of a sum or of a method are in the axes of one body.
    pub(super) fn are_seen_alike(
        &mut self,
        how: How,
        whole: &Expr,
        (left, right): (&Expr, &Expr),
        (a, b): (&Rc<Tree>, &Rc<Tree>),
    ) -> bool {
        // Two matrices, each in the axes of its own body, may be summed inside a trace.
        let stays =
            |tree: &Tree| !tree.shape.is_vector() && tree.frames[0].is_some() && tree.frames[0] == tree.frames[1];
        if let [Some(first), Some(second)] = [a, b].map(|tree| is_of_turn(self.declaration, tree))
            && first != second
        {
            let message = "a turn can't be added to a shift: take each with its own, as in `a.dot(&e) + b.dot(&s)`";
            self.errors.push_over(whole, message);
            return false;
        }
        let is_sum = matches!(how, How::Sum(_));
        if (a.is_of_turns && b.is_of_turns)
            || is_sum && (stays(a) && stays(b) || are_attitudes_alike(self.declaration, a, b))
        {
            return true;
        }
        for side in [0, 1] {
            let (Some(first), Some(second)) = (a.frames[side], b.frames[side]) else { continue };
            if first == second {
                continue;
            }
            let (relative, declared) = self.relative(first, second);
            let (a, b) = (spelled(left), spelled(without_reference(right)));
            let brought = match how {
                How::Sum(operator) if side == 0 => format!("{a} {operator} {relative} * {b}"),
                How::Sum(operator) => format!("{a} * {relative} {operator} {b}"),
                How::Method(name) => format!("{a}.{name}(&({relative} * {b}))"),
            };
            let message = format!(
                "`{a}` is seen from `{}`, `{b}` from `{}`: bring one over, `{brought}`{declared}",
                self.seer(first),
                self.seer(second)
            );
            self.errors.push_over(whole, message);
            return false;
        }
        true
    }

    /// The matrix that maps vectors from the axes of the body `of` to those of `from`, and its declaration if it is
    /// missing.
    fn relative(&self, from: usize, of: usize) -> (String, String) {
        let declared = |of: usize, from: usize| {
            let mut advected = self.declaration.advected.iter();
            let seen = if from == SPACE { View::Configuration(of) } else { View::Relative { of, from } };
            advected.find(|w| w.seen == seen).map(AdvectedParameter::plain_name)
        };
        if let Some(name) = declared(of, from) {
            return (name, String::new());
        }
        if let Some(name) = declared(from, of) {
            return (format!("{name}.transpose()"), String::new());
        }
        if of == SPACE {
            let (attitude, declared) = self.relative(of, from);
            return (format!("{attitude}.transpose()"), declared);
        }
        let free = self.free_name(if from == SPACE { "R" } else { "Q" });
        let declare = format!(" (declare `{free} = {}.seen_from({})`)", self.seer(of), self.seer(from));
        (free, declare)
    }

    /// The name of a body, or space.
    fn seer(&self, factor: usize) -> String {
        self.declaration.factors.get(factor).map_or_else(|| "space".to_owned(), |factor| factor.name.clone())
    }

    /// The text of a plain name; for any other expression, the body that it is seen from.
    fn named(&self, expression: &Expr, factor: usize) -> String {
        let body = self.seer(factor);
        match spelled(expression).as_str() {
            "…" => format!("what is seen from `{body}`"),
            name => format!("`{name}`"),
        }
    }
}

/// The operation that combines two operands.
#[derive(Clone, Copy)]
pub(super) enum How<'a> {
    Sum(char),
    Method(&'a str),
}

/// The text of a plain name, or of the transpose of one; dots for any other expression.
fn spelled(expression: &Expr) -> String {
    match expression {
        Expr::Path(path) => path.path.get_ident().map_or_else(|| "…".to_owned(), ToString::to_string),
        Expr::Paren(inner) => spelled(&inner.expr),
        Expr::Group(inner) => spelled(&inner.expr),
        Expr::MethodCall(call) if call.method == "transpose" && spelled(&call.receiver) != "…" => {
            format!("{}.transpose()", spelled(&call.receiver))
        }
        _ => "…".to_owned(),
    }
}

fn is_increment(expression: &Expr) -> bool {
    matches!(expression, Expr::Path(_))
}

fn without_reference(expression: &Expr) -> &Expr {
    match expression {
        Expr::Reference(ExprReference { expr, .. }) => without_reference(expr),
        other => other,
    }
}
