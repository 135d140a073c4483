//! The Lie algebra by its components.

use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Expression, Factor, Rational, Symbols};

/// `Σ v_k E_k`, entry by entry.
pub fn hat(generators: &[Vec<Rational>], size: usize, v: &Expression, symbols: &Symbols) -> Expression {
    let mut sum = Expression::zero((size, size));
    for (k, generator) in generators.iter().enumerate() {
        let component = unit(k, generators.len(), true, symbols).times(v, symbols);
        for (place, &entry) in generator.iter().enumerate().filter(|(_, entry)| !entry.is_zero()) {
            let (row, column) = (unit(place / size, size, false, symbols), unit(place % size, size, true, symbols));
            let there = row.times(&component, symbols).times(&column, symbols);
            sum = sum.plus(there.scaled(entry));
        }
    }
    sum
}

/// The components of an element of the algebra with respect to the generators.
pub(super) fn components(group: &Group, element: &Expression, symbols: &Symbols) -> Expression {
    if group.is_so3 {
        return element.vee(symbols);
    }
    linear_forms(&group.dual(), (group.size, group.dimension()), element, symbols)
}

/// The components by linear forms in the entries, each a sum of terms `(k, row, column, factor)`.
pub fn linear_forms(
    forms: &[(usize, usize, usize, Rational)],
    (size, dimension): (usize, usize),
    element: &Expression,
    symbols: &Symbols,
) -> Expression {
    let terms = forms.iter().map(|&(k, row, column, factor)| {
        let entry = unit(row, size, true, symbols).times(element, symbols);
        let entry = entry.times(&unit(column, size, false, symbols), symbols);
        unit(k, dimension, false, symbols).times(&entry, symbols).scaled(factor)
    });
    terms.fold(Expression::zero((dimension, 1)), Expression::plus)
}

/// A column of the identity, or a row.
pub fn unit(index: usize, size: usize, transposed: bool, symbols: &Symbols) -> Expression {
    let shape = if transposed { (1, size) } else { (size, 1) };
    Expression::from_word(vec![Factor::Unit { index, size, transposed }], shape, symbols)
}
