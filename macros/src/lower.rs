//! From the tree to a symbolic expression.

use std::collections::BTreeMap;
use std::rc::Rc;

use syn::ext::IdentExt as _;

use crate::ast::{Declaration, FieldKind, Kind, Name, Role, Shape, Tree};
use crate::derive::{Declared, Displacements};
use crate::errors::Errors;
use crate::symbolic::{Expression, Factor, Rational, Stage, Structure, SymbolId, Symbols};

/// Products of more terms than this take too long; a Lagrangian that a person writes has a tenth of it.
const MOST_TERMS: usize = 2_000;
/// The factors of all terms, and of one product of matrices; both multiply when they are differentiated twice.
const MOST_FACTORS: usize = 800;
const LONGEST_PRODUCT: usize = 24;

/// The declared Lagrangian in symbols; the names say which symbol stands for what.
pub(crate) struct Lowered {
    pub(crate) declared: Declared,
    pub(crate) names: BTreeMap<Name, SymbolId>,
    /// Those of a force's virtual work.
    pub(crate) displacements: Option<Displacements>,
}

/// Lowers the tree; `None` where it is too large, which has been reported.
pub(crate) fn lower(declaration: &Declaration, tree: &Rc<Tree>, errors: &mut Errors) -> Option<Lowered> {
    let mut symbols = Symbols::default();
    let mut names = BTreeMap::new();
    let size = declaration.structure.size;
    let structure = if declaration.structure.orthogonal { Structure::Orthogonal } else { Structure::General };
    let step = symbols.add("h", (1, 1), Structure::General, Stage::Construction);
    let increment = symbols.add("F", (size, size), structure, Stage::Iteration);
    names.insert(Name::Step, step);
    names.insert(Name::Increment, increment);
    for (index, field) in declaration.fields.iter().enumerate() {
        let (shape, structure) = match field.kind {
            FieldKind::Scalar => ((1, 1), Structure::General),
            FieldKind::Vector(_) | FieldKind::Advected(..) => (ambient(field.kind.shape()), Structure::General),
            FieldKind::Matrix(rows) => ((rows, rows), Structure::General),
            FieldKind::SymmetricInertia => ((3, 3), Structure::Symmetric),
            FieldKind::DiagonalInertia => ((3, 3), Structure::Diagonal),
        };
        let name = field.name.unraw().to_string();
        names.insert(Name::Field(index), symbols.add(name, shape, structure, Stage::Construction));
    }
    let mut advected = Vec::new();
    for (index, w) in declaration.advected.iter().enumerate() {
        let kind = declaration.advected_kind(index);
        let shape = ambient(kind.shape());
        let id = symbols.add(w.name.unraw().to_string(), shape, Structure::General, Stage::Step);
        names.insert(Name::Advected(index), id);
        advected.push((id, kind.variance()));
    }
    let displacements = (declaration.role == Role::Force).then(|| {
        let mut displacement = |name: &str, place| {
            let id = symbols.add(name, (declaration.structure.dimension(), 1), Structure::General, Stage::Step);
            names.insert(place, id);
            id
        };
        let before = displacement("η", Name::DisplacementBefore);
        Displacements { before, after: displacement("η⁺", Name::DisplacementAfter) }
    });
    let mut lowering = Lowering { symbols: &symbols, names: &names, known: BTreeMap::new() };
    match lowering.expression(tree) {
        Ok(l_d) if l_d.has_overflow() => {
            errors
                .push(tree.span, "the coefficients leave the range of exact arithmetic: make the large numbers fields");
            None
        }
        Ok(l_d) => Some(Lowered {
            declared: Declared { group: declaration.structure.clone(), symbols, l_d, increment, step, advected },
            names,
            displacements,
        }),
        Err(TooLarge(span)) => {
            errors.push(
                span,
                format!(
                    "multiplied out, this has more than {MOST_FACTORS} factors or a product of more than \
                     {LONGEST_PRODUCT} matrices: the expression is too large"
                ),
            );
            None
        }
    }
}

struct TooLarge(proc_macro2::Span);

struct Lowering<'a> {
    symbols: &'a Symbols,
    names: &'a BTreeMap<Name, SymbolId>,
    /// What a `let` has bound is lowered once, however often it is used.
    known: BTreeMap<*const Tree, Expression>,
}

impl Lowering<'_> {
    fn expression(&mut self, tree: &Rc<Tree>) -> Result<Expression, TooLarge> {
        if let Some(known) = self.known.get(&Rc::as_ptr(tree)) {
            return Ok(known.clone());
        }
        let result = self.operation(tree)?;
        if result.len() > MOST_TERMS || result.size() > MOST_FACTORS || result.longest_word() > LONGEST_PRODUCT {
            return Err(TooLarge(tree.span));
        }
        if Rc::strong_count(tree) > 1 {
            self.known.insert(Rc::as_ptr(tree), result.clone());
        }
        Ok(result)
    }

    fn operation(&mut self, tree: &Rc<Tree>) -> Result<Expression, TooLarge> {
        let symbols = self.symbols;
        let result = match &tree.kind {
            Kind::Number(value) => Expression::rational(*value),
            Kind::Identity => Expression::identity(ambient(tree.shape).0),
            Kind::Name(name) => match self.names.get(name) {
                Some(&id) => Expression::symbol(id, self.symbols),
                None => Expression::zero(ambient(tree.shape)),
            },
            Kind::Negate(a) => self.expression(a)?.scaled(-Rational::ONE),
            Kind::Add(a, b) => self.expression(a)?.plus(self.expression(b)?),
            Kind::Subtract(a, b) => self.expression(a)?.minus(self.expression(b)?),
            Kind::Multiply(a, b) => product(tree, &self.expression(a)?, &self.expression(b)?, symbols)?,
            Kind::Divide(a, b) => {
                product(tree, &self.expression(a)?, &self.expression(b)?.power(-1, symbols), symbols)?
            }
            Kind::Transpose(a) => self.expression(a)?.transpose(self.symbols),
            Kind::Trace(a) => self.expression(a)?.trace(self.symbols),
            Kind::Dot(a, b) => product(tree, &self.expression(a)?.transpose(symbols), &self.expression(b)?, symbols)?,
            Kind::Cross(a, b) => product(tree, &self.expression(a)?.hat(symbols), &self.expression(b)?, symbols)?,
            Kind::CrossMatrix(a) => self.expression(a)?.hat(self.symbols),
            Kind::ComponentMultiply(a, b) => {
                product(tree, &self.expression(a)?.diagonal(symbols), &self.expression(b)?, symbols)?
            }
            Kind::Power(a, exponent) => {
                let base = self.expression(a)?;
                if base.len().checked_pow(exponent.unsigned_abs().min(4)).is_none_or(|terms| terms > MOST_TERMS) {
                    return Err(TooLarge(tree.span));
                }
                base.power(*exponent, self.symbols)
            }
            Kind::Apply(function, a) => Expression::function(*function, self.expression(a)?),
            Kind::Vee(a) => self.expression(a)?.vee(self.symbols),
            Kind::Entry(a, row, column) => {
                let operand = self.expression(a)?;
                let (rows, columns) = operand.shape();
                let left = self.unit(*row, rows, true).times(&operand, self.symbols);
                if columns == 1 { left } else { left.times(&self.unit(*column, columns, false), self.symbols) }
            }
        };
        Ok(result)
    }

    fn unit(&self, index: usize, size: usize, transposed: bool) -> Expression {
        let shape = if transposed { (1, size) } else { (size, 1) };
        Expression::from_word(vec![Factor::Unit { index, size, transposed }], shape, self.symbols)
    }
}

fn product(tree: &Tree, left: &Expression, right: &Expression, symbols: &Symbols) -> Result<Expression, TooLarge> {
    if left.len().saturating_mul(right.len()) > MOST_TERMS {
        return Err(TooLarge(tree.span));
    }
    Ok(left.times(right, symbols))
}

fn ambient(shape: Shape) -> (usize, usize) {
    match shape {
        Shape::Scalar => (1, 1),
        Shape::Matrix(rows, columns) => (rows, columns),
    }
}
