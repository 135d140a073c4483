//! From the tree to a symbolic expression.

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::declared::errors::Errors;
use crate::declared::{Declaration, FieldKind, Kind, Name, Role, Shape, Tree, parts};
use crate::mathematics::derive::{
    AdvectedSymbol, Body, ContinuousLagrangian, DeclaredConstraint, DeclaredFunction, Displacements, Element, Let,
    View, hat, linear_forms, unit,
};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Expression, Rational, Stage, Structure, SymbolId, Symbols, stage_of, substitute};

/// The limit on terms: larger products take too long, and a Lagrangian that a person writes has a tenth of it.
const MOST_TERMS: usize = 2_000;
/// The limits on the factors of all terms, and of one product of matrices; both multiply when differentiated twice.
const MOST_FACTORS: usize = 800;
const LONGEST_PRODUCT: usize = 24;
/// The limit on closed `let`s, including those of sums.
const MOST_LETS: usize = 150;
/// The limit on numerators and denominators: the eighth power of a smaller number is in range.
const MANY_DIGITS: u128 = 10_000;

/// The declared Lagrangian in symbols, and the symbol of each name.
pub struct Reading {
    pub declared: DeclaredFunction,
    pub names: BTreeMap<Name, SymbolId>,
}

/// The readings of the tree: one multiplied out, one with its `let`s closed, and with a pace one that has its `let`s
/// closed and its matrices multiplied out. `None` if all are too large, which has been reported.
pub fn readings(declaration: &Declaration, tree: &Rc<Tree>, errors: &mut Errors) -> Option<Vec<Reading>> {
    readings_without(declaration, tree, &|_, structure| structure, errors)
}

/// The readings of the tree, with fewer known properties of some symbols.
pub fn readings_without(
    declaration: &Declaration,
    tree: &Rc<Tree>,
    weaker: &dyn Fn(Name, Structure) -> Structure,
    errors: &mut Errors,
) -> Option<Vec<Reading>> {
    let mut symbols = Symbols::default();
    let mut names = BTreeMap::new();
    let step = symbols.add("h", (1, 1), Structure::General, Stage::Construction);
    names.insert(Name::Step, step);
    let mut increments = Vec::new();
    for (index, (factor, group)) in declaration.factors.iter().zip(declaration.group.factors()).enumerate() {
        let structure = if group.orthogonal && !group.is_added {
            weaker(Name::Increment(index), Structure::Rotation)
        } else {
            Structure::General
        };
        let increment = symbols.add(factor.name.clone(), group.shape(), structure, Stage::Iteration);
        names.insert(Name::Increment(index), increment);
        increments.push(increment);
    }
    let advected = parameters(declaration, weaker, &mut symbols, &mut names);
    let displacements = (declaration.role == Role::Force).then(|| {
        let factors = declaration.group.factors().iter().enumerate();
        let each = factors.map(|(factor, own)| {
            let places = [Name::DisplacementBefore(factor), Name::DisplacementAfter(factor)];
            let ids = ["η", "η⁺"].map(|name| symbols.add(name, (own.dimension(), 1), Structure::General, Stage::Step));
            names.extend(places.into_iter().zip(ids));
            ids
        });
        Displacements(each.collect())
    });
    let displaced: Vec<SymbolId> = displacements.iter().flat_map(|all| all.0.iter().flatten().copied()).collect();
    let attempt = |lets, opens_matrices| {
        let lowering = Lowering::new(symbols.clone(), &names, lets);
        Lowering { opens_matrices, displaced: displaced.clone(), ..lowering }.whole(tree)
    };
    let lowered = |(symbols, expression, lets): (Symbols, Expression, Vec<Let>)| {
        let (group, increments) = (declaration.group.clone(), increments.clone());
        let (advected, names) = (advected.clone(), names.clone());
        let has_derivatives = declaration.gradients.is_some();
        let discretised = None;
        let declared = DeclaredFunction {
            group,
            symbols,
            lets,
            expression,
            increments,
            step,
            advected,
            displacements: displacements.clone(),
            has_derivatives,
            discretised,
        };
        Reading { declared, names }
    };
    let multiplied_out = attempt(None, false);
    // The work of a force is linear in the displacements, and mostly short enough to be multiplied out.
    let may_close = multiplied_out.is_err() || displacements.is_none() && has_let(tree);
    let closed = may_close.then(|| attempt(Some(Vec::new()), false));
    // All but `F` cancels in `tr((F − I) J_d (F − I)ᵀ)`, while the pace is best left closed.
    let opened = declaration.energy.map(|_| attempt(Some(Vec::new()), true));
    let all = [Some(multiplied_out), closed, opened].into_iter().flatten();
    let (found, failures): (Vec<_>, Vec<_>) = all.partition(Result::is_ok);
    if found.is_empty() {
        failures.into_iter().filter_map(Result::err).take(1).for_each(|failure| report(failure, tree, errors));
        return None;
    }
    Some(found.into_iter().flatten().map(lowered).collect())
}

/// A continuous Lagrangian in symbols.
pub struct ContinuousReading {
    pub declared: ContinuousLagrangian,
    pub names: BTreeMap<Name, SymbolId>,
}

/// The reading of a declared `l`, multiplied out; `None` if it is too large, which has been reported.
pub fn continuous(declaration: &Declaration, tree: &Rc<Tree>, errors: &mut Errors) -> Option<ContinuousReading> {
    let (mut symbols, mut names) = (Symbols::default(), BTreeMap::new());
    let advected = parameters(declaration, &|_, structure| structure, &mut symbols, &mut names);
    let group = declaration.group.clone();
    let mut velocities = Vec::new();
    for (factor, own) in group.factors().iter().enumerate() {
        let velocity = Element::new(own, &declaration.name_of_velocity(factor), &mut symbols);
        names.insert(Name::Velocity(factor), velocity.components);
        velocities.push(velocity);
    }
    // Velocities of several bodies have no matrix.
    let velocity_matrix = velocities.first().and_then(|velocity| velocity.matrix);
    let lowering = Lowering { velocity_matrix, ..Lowering::new(symbols, &names, None) };
    match lowering.whole(tree) {
        Ok((symbols, expression, _)) => {
            let declared = ContinuousLagrangian { group, symbols, expression, velocities, advected };
            Some(ContinuousReading { declared, names })
        }
        Err(failure) => {
            report(failure, tree, errors);
            None
        }
    }
}

/// A constraint in symbols.
pub struct ConstraintReading {
    pub declared: DeclaredConstraint,
    pub names: BTreeMap<Name, SymbolId>,
}

/// The reading of a constraint, multiplied out, in the positions of both bodies; `None` if it is too large, which has
/// been reported.
pub fn constraint(declaration: &Declaration, functions: &[Rc<Tree>], errors: &mut Errors) -> Option<ConstraintReading> {
    let (mut symbols, mut names) = (Symbols::default(), BTreeMap::new());
    let carried = parameters(declaration, &|_, structure| structure, &mut symbols, &mut names);
    let bodies = ["a", "b"].map(|body| Body::new(body, &mut symbols));
    let mut lowering = Lowering::new(symbols, &names, None);
    let seen: Option<Vec<Expression>> = carried
        .iter()
        .enumerate()
        .map(|(index, w)| {
            let field = declaration.advected.get(index).and_then(|w| w.field);
            let field = field.and_then(|field| names.get(&Name::Field(field)));
            w.seen.at(&bodies, field.copied(), &lowering.symbols)
        })
        .collect();
    let map = carried.iter().map(|w| w.symbol).zip(seen?).collect();
    let lowered: Option<Vec<Expression>> = functions
        .iter()
        .map(|tree| lowering.expression(tree).map_err(|failure| report(failure, tree, errors)).ok())
        .collect();
    let symbols = lowering.symbols;
    let functions = lowered?.iter().map(|function| substitute(function, &map, &symbols)).collect();
    Some(ConstraintReading { declared: DeclaredConstraint { symbols, functions, bodies }, names })
}

/// The symbols of the fields and of the advected parameters, and the action of the group on the latter.
fn parameters(
    declaration: &Declaration,
    weaker: &dyn Fn(Name, Structure) -> Structure,
    symbols: &mut Symbols,
    names: &mut BTreeMap<Name, SymbolId>,
) -> Vec<AdvectedSymbol> {
    for (index, field) in declaration.fields.iter().enumerate() {
        let (shape, structure) = match field.kind {
            FieldKind::Scalar => ((1, 1), Structure::General),
            FieldKind::Vector(_) | FieldKind::Advected(..) | FieldKind::Given(_) | FieldKind::Place(_) => {
                (ambient(field.kind.shape()), Structure::General)
            }
            FieldKind::Point(rows) => ((rows, 1), Structure::Point),
            FieldKind::Matrix(rows) | FieldKind::Configuration(rows) => ((rows, rows), Structure::General),
            FieldKind::SymmetricInertia | FieldKind::StandardInertia => ((3, 3), Structure::Symmetric),
            FieldKind::DiagonalInertia => ((3, 3), Structure::Diagonal),
        };
        let structure = weaker(Name::Field(index), structure);
        let name = field.plain_name();
        names.insert(Name::Field(index), symbols.add(name, shape, structure, Stage::Construction));
    }
    let mut advected = Vec::new();
    for (index, w) in declaration.advected.iter().enumerate() {
        let kind = declaration.advected_kind(index);
        let shape = ambient(kind.shape());
        let structure = match kind {
            FieldKind::Point(_) => Structure::Point,
            FieldKind::Configuration(_) if is_orthogonal(&declaration.group, w.seen) => Structure::Rotation,
            _ => Structure::General,
        };
        let structure = weaker(Name::Advected(index), structure);
        let symbol = symbols.add(w.plain_name(), shape, structure, Stage::Step);
        names.insert(Name::Advected(index), symbol);
        advected.push(AdvectedSymbol { symbol, variance: kind.variance(), seen: w.seen });
    }
    advected
}

/// Whether the configurations of these factors are orthogonal matrices.
pub fn is_orthogonal(group: &Group, seen: View) -> bool {
    let turns = |factor: usize| group.factor(factor).orthogonal && !group.factor(factor).is_added;
    match seen {
        View::Relative { of, from } => turns(of) && turns(from),
        View::Configuration(of) => turns(of),
        View::From(_) => false,
    }
}

/// Whether a `let` names more than another name or a number.
fn has_let(tree: &Rc<Tree>) -> bool {
    let is_let = |part: &&Rc<Tree>| matches!(&part.kind, Kind::Bound(_, inner) if !matches!(inner.kind, Kind::Name(_) | Kind::Number(_)));
    parts(tree).iter().any(is_let)
}

/// Why an expression can't be lowered.
#[derive(Clone, Copy, Debug)]
enum Failure {
    TooLarge(proc_macro2::Span),
    Overflow,
}

fn report(failure: Failure, tree: &Tree, errors: &mut Errors) {
    match failure {
        Failure::TooLarge(span) => errors.push(
            span,
            format!(
                "multiplied out, this has more than {MOST_FACTORS} factors or a product of more than {LONGEST_PRODUCT} \
                 matrices: declare parts as terms of their own, and add them, `a + b`"
            ),
        ),
        Failure::Overflow => errors
            .push(tree.span, "the coefficients leave the range of exact arithmetic: make the large numbers fields"),
    }
}

struct Lowering<'a> {
    symbols: Symbols,
    names: &'a BTreeMap<Name, SymbolId>,
    /// The expressions of `let`s already lowered, so that each is lowered once.
    known: BTreeMap<*const Tree, Expression>,
    /// The `let`s so far, if they stay closed.
    lets: Option<Vec<Let>>,
    /// Whether sums of matrices are multiplied out even then.
    opens_matrices: bool,
    /// The symbol of the velocity's matrix in a continuous Lagrangian.
    velocity_matrix: Option<SymbolId>,
    /// The displacements of virtual work, which stay out of closed `let`s: the force is what they are multiplied with.
    displaced: Vec<SymbolId>,
}

impl<'a> Lowering<'a> {
    fn new(symbols: Symbols, names: &'a BTreeMap<Name, SymbolId>, lets: Option<Vec<Let>>) -> Self {
        let known = BTreeMap::new();
        Self { symbols, names, known, lets, opens_matrices: false, velocity_matrix: None, displaced: Vec::new() }
    }

    fn whole(mut self, tree: &Rc<Tree>) -> Result<(Symbols, Expression, Vec<Let>), Failure> {
        let expression = self.expression(tree)?;
        let lets = self.lets.unwrap_or_default();
        if lets.iter().map(|one| &one.value).chain([&expression]).any(Expression::has_overflow) {
            return Err(Failure::Overflow);
        }
        if lets.len() > MOST_LETS || lets.iter().map(|one| one.value.size()).sum::<usize>() > MOST_FACTORS {
            return Err(Failure::TooLarge(tree.span));
        }
        Ok((self.symbols, expression, lets))
    }

    /// The expression of a `let`, or the symbol that stands for it.
    fn bound(&mut self, name: &str, value: Expression) -> Expression {
        let is_small = value.len() <= 1 && value.size() <= 2;
        let stays_open = is_small || self.displaced.iter().any(|displacement| value.contains(*displacement));
        let Some(lets) = self.lets.as_mut().filter(|_| !stays_open) else { return value };
        // Equal and opposite values share one symbol, and so one multiplier.
        let opposite = value.clone().scaled(-Rational::ONE);
        if let Some(known) = lets.iter().find(|one| one.value == value || one.value == opposite) {
            let sign = if known.value == value { Rational::ONE } else { -Rational::ONE };
            return Expression::symbol(known.symbol, &self.symbols).scaled(sign);
        }
        let structure = match value.shape() {
            (rows, columns) if rows == columns && rows > 1 && value.transpose(&self.symbols) == value => {
                Structure::Symmetric
            }
            _ => Structure::General,
        };
        let stage = stage_of(&value, &self.symbols);
        let symbol = self.symbols.add(name, value.shape(), structure, stage);
        lets.push(Let { symbol, value });
        Expression::symbol(symbol, &self.symbols)
    }

    /// A number. If it has many digits it stays closed: its powers would leave the range of exact arithmetic.
    fn number(&mut self, value: Rational) -> Expression {
        let expression = Expression::rational(value);
        let (numerator, denominator) = value.parts();
        if numerator.unsigned_abs().max(denominator.unsigned_abs()) < MANY_DIGITS {
            return expression;
        }
        let Some(lets) = self.lets.as_mut() else { return expression };
        if let Some(same) = lets.iter().find(|one| one.value == expression) {
            return Expression::symbol(same.symbol, &self.symbols);
        }
        let name = value.to_f64().to_string();
        let symbol = self.symbols.add(name, (1, 1), Structure::General, Stage::Construction);
        lets.push(Let { symbol, value: expression });
        Expression::symbol(symbol, &self.symbols)
    }

    /// Two factors of a product. The action of a sum of matrices on a vector is cheaper term by term.
    fn factors(&mut self, a: &Rc<Tree>, b: &Rc<Tree>) -> Result<(Expression, Expression), Failure> {
        let left = if acts(a, b) { self.expression(a)? } else { self.factor(a)? };
        Ok((left, self.factor(b)?))
    }

    /// A factor of a product. If `let`s stay closed, a sum isn't multiplied out either.
    fn factor(&mut self, tree: &Rc<Tree>) -> Result<Expression, Failure> {
        let value = self.expression(tree)?;
        let is_open = value.len() < 2 || self.opens_matrices && value.shape().0.min(value.shape().1) > 1;
        Ok(if is_open { value } else { self.closed(tree, value) })
    }

    /// A closed value, which derivatives pass through as one.
    fn closed(&mut self, tree: &Rc<Tree>, value: Expression) -> Expression {
        let closed = self.unnamed(value);
        self.known.insert(Rc::as_ptr(tree), closed.clone());
        closed
    }

    /// The symbol of a value without a name, if `let`s stay closed.
    fn unnamed(&mut self, value: Expression) -> Expression {
        let number = self.lets.as_ref().map_or(0, |lets| lets.len() + 1);
        self.bound(&format!("t{number}"), value)
    }

    /// The image of a vector under a sum of matrices, such as `exp(v)`: applied factor by factor, with each image
    /// closed.
    ///
    /// Multiplied out first, a product of two matrices would give two products in the derivative for each of its terms.
    fn image(&mut self, matrix: &Rc<Tree>, vector: &Expression) -> Result<Expression, Failure> {
        Ok(match &matrix.kind {
            Kind::Identity => vector.clone(),
            Kind::Add(a, b) => self.image(a, vector)?.plus(self.image(b, vector)?),
            Kind::Subtract(a, b) => self.image(a, vector)?.minus(self.image(b, vector)?),
            Kind::Multiply(a, b) if a.shape == Shape::Scalar => {
                let factor = self.factor(a)?;
                let image = self.image(b, vector)?;
                self.product(matrix, &factor, &image)?
            }
            Kind::Multiply(a, b) => {
                let inner = self.image(b, vector)?;
                self.image(a, &inner)?
            }
            _ => {
                let factor = self.expression(matrix)?;
                let image = self.product(matrix, &factor, vector)?;
                self.unnamed(image)
            }
        })
    }

    fn expression(&mut self, tree: &Rc<Tree>) -> Result<Expression, Failure> {
        if let Some(known) = self.known.get(&Rc::as_ptr(tree)) {
            return Ok(known.clone());
        }
        let result = self.operation(tree)?;
        if result.len() > MOST_TERMS || result.size() > MOST_FACTORS || result.longest_word() > LONGEST_PRODUCT {
            return Err(Failure::TooLarge(tree.span));
        }
        if Rc::strong_count(tree) > 1 {
            self.known.insert(Rc::as_ptr(tree), result.clone());
        }
        Ok(result)
    }

    fn operation(&mut self, tree: &Rc<Tree>) -> Result<Expression, Failure> {
        let result = match &tree.kind {
            Kind::Number(value) => self.number(*value),
            Kind::Identity => Expression::identity(ambient(tree.shape).0),
            Kind::Name(name) => match self.names.get(name) {
                Some(&id) => Expression::symbol(id, &self.symbols),
                None => Expression::zero(ambient(tree.shape)),
            },
            Kind::Bound(name, a) => {
                let value = self.expression(a)?;
                self.bound(name, value)
            }
            Kind::Negate(a) => self.expression(a)?.scaled(-Rational::ONE),
            Kind::Add(a, b) => self.expression(a)?.plus(self.expression(b)?),
            Kind::Subtract(a, b) => self.expression(a)?.minus(self.expression(b)?),
            Kind::Multiply(a, b) if self.lets.is_some() && acts(a, b) && matches!(a.kind, Kind::Add(..)) => {
                let vector = self.factor(b)?;
                self.image(a, &vector)?
            }
            Kind::Multiply(a, b) => {
                let (left, right) = self.factors(a, b)?;
                self.product(tree, &left, &right)?
            }
            Kind::Divide(a, b) => {
                let (left, right) = self.factors(a, b)?;
                self.product(tree, &left, &right.power(-1, &self.symbols))?
            }
            Kind::Transpose(a) => self.expression(a)?.transpose(&self.symbols),
            Kind::Trace(a) => self.expression(a)?.trace(&self.symbols),
            Kind::Dot(a, b) => {
                let (left, right) = self.factors(a, b)?;
                self.product(tree, &left.transpose(&self.symbols), &right)?
            }
            Kind::Cross(a, b) => {
                let (left, right) = self.factors(a, b)?;
                self.product(tree, &left.hat(&self.symbols), &right)?
            }
            Kind::CrossMatrix(a) => self.expression(a)?.hat(&self.symbols),
            Kind::ComponentMultiply(a, b) => {
                let (left, right) = self.factors(a, b)?;
                self.product(tree, &left.diagonal(&self.symbols), &right)?
            }
            Kind::Power(a, exponent) => self.power(tree, a, *exponent)?,
            Kind::Apply(function, a) => {
                // The argument is closed however small it is, as the derivative is a function of it too.
                let argument = self.expression(a)?;
                let argument = self.closed(a, argument);
                let value = Expression::function(*function, argument);
                self.closed(tree, value)
            }
            Kind::Vee(a) => self.expression(a)?.vee(&self.symbols),
            Kind::Hat(a, generators) => {
                let is_velocity = matches!(a.kind, Kind::Name(Name::Velocity(_)));
                if let Some(id) = self.velocity_matrix.filter(|_| is_velocity) {
                    Expression::symbol(id, &self.symbols)
                } else {
                    let components = self.expression(a)?;
                    hat(generators, tree.shape.rows(), &components, &self.symbols)
                }
            }
            Kind::Components(a, forms) => {
                let element = self.expression(a)?;
                linear_forms(forms, (element.shape().0, tree.shape.rows()), &element, &self.symbols)
            }
            Kind::Inverse(a) => match &a.kind {
                Kind::Name(name) => match self.names.get(name) {
                    Some(&id) => Expression::inverse(id, &self.symbols),
                    None => Expression::zero(ambient(tree.shape)),
                },
                _ => Expression::zero(ambient(tree.shape)),
            },
            Kind::Entry(a, row, column) => {
                let operand = self.expression(a)?;
                self.entry(&operand, *row, *column)
            }
        };
        Ok(result)
    }

    fn power(&mut self, tree: &Tree, base: &Rc<Tree>, exponent: i32) -> Result<Expression, Failure> {
        let base = self.factor(base)?;
        if base.len().checked_pow(exponent.unsigned_abs().min(4)).is_none_or(|terms| terms > MOST_TERMS) {
            return Err(Failure::TooLarge(tree.span));
        }
        Ok(base.power(exponent, &self.symbols))
    }

    fn entry(&self, operand: &Expression, row: usize, column: usize) -> Expression {
        let (rows, columns) = operand.shape();
        let left = unit(row, rows, true, &self.symbols).times(operand, &self.symbols);
        if columns == 1 { left } else { left.times(&unit(column, columns, false, &self.symbols), &self.symbols) }
    }

    fn product(&self, tree: &Tree, left: &Expression, right: &Expression) -> Result<Expression, Failure> {
        if left.len().saturating_mul(right.len()) > MOST_TERMS {
            return Err(Failure::TooLarge(tree.span));
        }
        Ok(left.times(right, &self.symbols))
    }
}

/// Whether a product is a matrix times a vector.
fn acts(a: &Tree, b: &Tree) -> bool {
    matches!((a.shape, b.shape), (Shape::Matrix(_, 2..), Shape::Matrix(_, 1)))
}

fn ambient(shape: Shape) -> (usize, usize) {
    match shape {
        Shape::Scalar => (1, 1),
        Shape::Matrix(rows, columns) => (rows, columns),
    }
}
