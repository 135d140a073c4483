//! Names in an expression: those of the macro, of fields, and of advected parameters.

use std::rc::Rc;

use proc_macro2::Span;
use syn::ext::IdentExt as _;

use super::{Checker, frames};
use crate::declared::{Declaration, Kind, Name, OF_ANY_SIZE, Shape, Spelling, Tree, named_velocities};

impl Checker<'_> {
    pub(super) fn name(&mut self, ident: &syn::Ident) -> Option<Rc<Tree>> {
        let (spelling, span) = (Spelling::of(ident), ident.span());
        let name = spelling.letters.clone();
        for scope in self.scopes.iter_mut().rev() {
            if let Some(binding) = scope.get_mut(&spelling) {
                binding.used = true;
                if let Some(closure) = &binding.closure {
                    let message = format!("`{name}` is a function: call it, `{name}({})`", closure.names());
                    self.errors.push(span, message);
                }
                return binding.tree.clone();
            }
        }
        let advected = |declaration: &Declaration| declaration.advected.iter().position(|w| w.plain_name() == name);
        let field = |declaration: &Declaration| declaration.fields.iter().position(|field| field.plain_name() == name);
        let square = self.declaration.group.rows_of_identity().map_or(OF_ANY_SIZE, |rows| Shape::Matrix(rows, rows));
        let increment = self.declaration.factors.iter().position(|factor| factor.name == name);
        let velocity = self.declaration.velocities().iter().position(|velocity| velocity.unraw() == name);
        let displacement = self.displacement(&name);
        let of_increment = |factor: usize| match self.declaration.group.factor(factor).shape() {
            (1, 1) if self.declaration.group.factor(factor).is_added => Shape::Scalar,
            (rows, columns) => Shape::Matrix(rows, columns),
        };
        let (shape, found) = if let Some(factor) = increment {
            if self.declaration.continuous.is_some() || self.is_constraint() {
                return self.of_a_step(&name, Some(factor), span);
            }
            (of_increment(factor), Name::Increment(factor))
        } else if let Some(factor) = velocity {
            let own = self.declaration.group.factor(factor);
            let is_scalar = own.is_added && own.dimension() == 1;
            let shape = if is_scalar { Shape::Scalar } else { Shape::Matrix(own.dimension(), 1) };
            (shape, Name::Velocity(factor))
        } else {
            match name.as_str() {
                "I" => return Some(Tree::new(span, square, Kind::Identity)),
                "h" if self.declaration.continuous.is_some() || self.is_constraint() && !self.is_parameter("h") => {
                    return self.of_a_step(&name, None, span);
                }
                "h" if !self.is_constraint() => (Shape::Scalar, Name::Step),
                _ if displacement.is_some() => displacement?,
                _ => {
                    if let Some(index) = advected(self.declaration) {
                        (self.declaration.advected_kind(index).shape(), Name::Advected(index))
                    } else if let Some(index) = field(self.declaration) {
                        if let Some(w) = self.declaration.advected.iter().find(|w| w.field == Some(index)) {
                            let (plain, is_given) = (w.plain_name(), w.is_given);
                            let message = if is_given {
                                format!("`{name}` is the value of `{plain}` until another is given: write `{plain}`")
                            } else {
                                format!(
                                    "`{name}` is the spatial value of `{plain}`: write `{plain}`, which is what the body sees"
                                )
                            };
                            self.errors.push(span, message);
                            return None;
                        }
                        (self.declaration.fields[index].kind.shape(), Name::Field(index))
                    } else {
                        // An unknown name is reported once, however often it is used.
                        if !self.declaration.unreadable.contains(&name) && self.unknown.insert(name.clone()) {
                            let advice = self.advice_on_name(&name);
                            self.errors.push(span, format!("`{name}` isn't known here{advice}"));
                        }
                        return None;
                    }
                }
            }
        };
        self.used.push(found);
        let seen = (frames::of(self.declaration, found), frames::is_turn(self.declaration, found));
        Some(Tree::seen(span, shape, found, seen))
    }

    /// Reports an increment or `h` in a continuous Lagrangian or a constraint, where there is no step.
    fn of_a_step(&mut self, name: &str, increment: Option<usize>, span: Span) -> Option<Rc<Tree>> {
        if !self.unknown.insert(name.to_owned()) {
            return None;
        }
        let message = match increment {
            Some(factor) if self.is_constraint() => {
                let place = if self.declaration.group.factor(factor).is_added { "x" } else { "R" };
                format!(
                    "a holonomic constraint is a function of positions: no increment may stand in it; name where the body \
                     is, `advected({place} = {name}.seen_from(space))`"
                )
            }
            None if self.is_constraint() => {
                "a holonomic constraint is a function of positions: no step may stand in it".to_owned()
            }
            Some(factor) => {
                let velocity = match self.declaration.velocity(factor) {
                    Some(velocity) => format!("the velocity `{}`", velocity.unraw()),
                    None if self.declaration.group.is_product() => {
                        format!("its velocity, named by `{}`", named_velocities(&self.declaration.factors))
                    }
                    None => "the velocity `Omega`, named by `velocity = Omega`".to_owned(),
                };
                format!(
                    "`{name}` is the increment of a step, and `l` has no steps: write it in {velocity}, or declare \
                     `l_d = …`"
                )
            }
            None => {
                "`h` is the length of a step, and `l` has no steps: leave it out; `discretise = …` makes `l_d`, or \
                     declare `l_d = …`"
                    .to_owned()
            }
        };
        self.errors.push(span, message);
        None
    }

    /// The displacement of that name: a vector with a component for each generator of its factor, on a line a scalar.
    fn displacement(&self, name: &str) -> Option<(Shape, Name)> {
        let group = &self.declaration.group;
        (0..group.factors().len()).find_map(|factor| {
            let [before, after] = self.declaration.displacement(factor)?;
            let own = group.factor(factor);
            let is_scalar = own.is_added && own.dimension() == 1;
            let shape = if is_scalar { Shape::Scalar } else { Shape::Matrix(own.dimension(), 1) };
            match name {
                _ if name == before => Some((shape, Name::DisplacementBefore(factor))),
                _ if name == after => Some((shape, Name::DisplacementAfter(factor))),
                _ => None,
            }
        })
    }
}
