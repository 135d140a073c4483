//! The evaluation of the declared tree on numbers, without the symbolic form.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::number::Number;
use super::value::Value;
use crate::declared::{Kind, Name, Shape, Tree};

/// An evaluation with the values of names, and of parts already evaluated.
pub struct Evaluation<'a, T = f64> {
    values: &'a BTreeMap<Name, Value<T>>,
    /// The values by address; each entry owns its tree, so that the address stays valid.
    known: BTreeMap<*const Tree, (Rc<Tree>, Value<T>)>,
}

impl<'a, T: Number> Evaluation<'a, T> {
    pub fn new(values: &'a BTreeMap<Name, Value<T>>) -> Self {
        Self { values, known: BTreeMap::new() }
    }

    pub fn of(&mut self, tree: &Rc<Tree>) -> Value<T> {
        if let Some((_, known)) = self.known.get(&Rc::as_ptr(tree)) {
            return known.clone();
        }
        let value = self.operation(tree);
        if Rc::strong_count(tree) > 1 {
            self.known.insert(Rc::as_ptr(tree), (tree.clone(), value.clone()));
        }
        value
    }

    fn operation(&mut self, tree: &Rc<Tree>) -> Value<T> {
        match &tree.kind {
            Kind::Number(value) => Value::scalar(T::of(*value)),
            Kind::Identity => Value::identity(tree.shape.rows()),
            Kind::Name(name) => self.values.get(name).cloned().unwrap_or_else(|| Value::scalar(T::UNDEFINED)),
            Kind::Negate(a) => self.of(a).map(|x| -x),
            Kind::Add(a, b) => self.of(a).zip(&self.of(b), |x, y| x + y),
            Kind::Subtract(a, b) => self.of(a).zip(&self.of(b), |x, y| x - y),
            Kind::Multiply(a, b) => match (a.shape, b.shape) {
                (Shape::Scalar, _) => {
                    let factor = self.of(a).first();
                    self.of(b).map(|x| x * factor)
                }
                (_, Shape::Scalar) => {
                    let factor = self.of(b).first();
                    self.of(a).map(|x| x * factor)
                }
                _ => self.of(a).times(&self.of(b)),
            },
            Kind::Divide(a, b) => {
                let divisor = self.of(b).first();
                self.of(a).map(|x| x / divisor)
            }
            Kind::Transpose(a) => self.of(a).transpose(),
            Kind::Trace(a) => Value::scalar(self.of(a).trace()),
            Kind::Dot(a, b) => self.of(a).transpose().times(&self.of(b)),
            Kind::Cross(a, b) => Value::hat(&self.of(a)).times(&self.of(b)),
            Kind::CrossMatrix(a) => Value::hat(&self.of(a)),
            Kind::ComponentMultiply(a, b) => self.of(a).zip(&self.of(b), |x, y| x * y),
            Kind::Power(a, exponent) => Value::scalar(self.of(a).first().power(*exponent)),
            Kind::Apply(function, a) => Value::scalar(self.of(a).first().apply(*function)),
            Kind::Vee(a) => self.of(a).vee(),
            Kind::Hat(a, generators) => Value::combination(tree.shape.rows(), generators, &self.of(a).entries),
            Kind::Components(a, forms) => {
                let element = self.of(a);
                Value::new(tree.shape.rows(), 1, |row, _| {
                    let own = forms.iter().filter(|(k, ..)| *k == row);
                    own.fold(T::ZERO, |sum, &(_, i, j, factor)| sum + T::of(factor) * element.at(i, j))
                })
            }
            Kind::Inverse(a) => self.of(a).inverse(),
            Kind::Bound(_, a) => self.of(a),
            Kind::Entry(a, row, column) => Value::scalar(self.of(a).at(*row, *column)),
        }
    }
}
