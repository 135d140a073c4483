//! The derivatives of a holonomic constraint by the positions of two bodies, in the axes of space.
//!
//! ```text
//! G_R η = d/ds g(…, exp(sη̂) R, …)          G_x ξ = d/ds g(…, x + sξ, …)
//! ```

use super::View;
use crate::mathematics::symbolic::{Expression, Stage, Structure, SymbolId, Symbols, Variations, variation};

/// The symbols of a body's position.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// The rotation from the body's axes to those of space.
    pub attitude: SymbolId,
    pub position: SymbolId,
    /// The variations `η` of the attitude and `ξ` of the position.
    pub directions: [SymbolId; 2],
}

impl Body {
    pub fn new(name: &str, symbols: &mut Symbols) -> Self {
        let mut vector = |letter, stage| symbols.add(format!("{letter}_{name}"), (3, 1), Structure::General, stage);
        let (position, directions) = (vector("x", Stage::Step), ["η", "ξ"].map(|d| vector(d, Stage::Construction)));
        let attitude = symbols.add(format!("R_{name}"), (3, 3), Structure::Rotation, Stage::Step);
        Self { attitude, position, directions }
    }
}

impl View {
    /// The value of a parameter at the positions of two bodies, each of which rotates by its first factor and is
    /// translated by its second; `field` is the symbol of its spatial value. `None` if the field is missing.
    pub fn at(self, bodies: &[Body; 2], field: Option<SymbolId>, symbols: &Symbols) -> Option<Expression> {
        let is_shift = |factor: usize| factor % 2 == 1;
        let place = |factor: usize| {
            let body = &bodies[factor / 2 % 2];
            Expression::symbol(if is_shift(factor) { body.position } else { body.attitude }, symbols)
        };
        Some(match self {
            Self::From(factor) => place(factor).transpose(symbols).times(&Expression::symbol(field?, symbols), symbols),
            Self::Relative { of, from } if is_shift(of) => place(of).minus(place(from)),
            Self::Relative { of, from } => place(from).transpose(symbols).times(&place(of), symbols),
            Self::Configuration(of) => place(of),
        })
    }
}

/// A constraint and its symbols.
#[derive(Clone, Debug)]
pub struct DeclaredConstraint {
    pub symbols: Symbols,
    /// The functions `g`, scalars and columns.
    pub functions: Vec<Expression>,
    /// The body above, and the body below.
    pub bodies: [Body; 2],
}

impl DeclaredConstraint {
    /// `G_R η` and `G_x ξ` of both bodies, for each of the functions.
    pub fn slopes(&self) -> [[Vec<Expression>; 2]; 2] {
        let symbols = &self.symbols;
        self.bodies.map(|body| {
            let [turn, shift] = body.directions.map(|direction| Expression::symbol(direction, symbols));
            let turn = turn.hat(symbols).times(&Expression::symbol(body.attitude, symbols), symbols);
            [(body.attitude, turn), (body.position, shift)].map(|along| {
                let along = Variations::from([along]);
                let varied = |function| variation(function, &along, symbols).with_hats_resolved(symbols);
                self.functions.iter().map(varied).collect()
            })
        })
    }
}
