//! Words: products of matrix factors, with the relations that hold between neighbours.

use super::symbols::{Structure, SymbolId, Symbols};

/// One factor of a matrix product.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Factor {
    /// A matrix or a vector (a matrix of one column).
    Symbol { id: SymbolId, transposed: bool },
    /// The inverse of an invertible matrix that isn't orthogonal.
    Inverse { id: SymbolId, transposed: bool },
    /// A column `e_i` of the identity.
    Unit { index: usize, size: usize, transposed: bool },
    /// `û` of a vector word.
    Hat(Vec<Factor>),
    /// `diag(u)` of a vector word.
    Diagonal(Vec<Factor>),
    /// `½ (W − Wᵀ)^∨` of a matrix word.
    Vee { word: Vec<Factor>, transposed: bool },
}

impl Factor {
    pub fn symbol(id: SymbolId) -> Self {
        Self::Symbol { id, transposed: false }
    }

    pub fn shape(&self, symbols: &Symbols) -> (usize, usize) {
        let turned = |transposed: bool, (rows, columns): (usize, usize)| {
            if transposed { (columns, rows) } else { (rows, columns) }
        };
        match self {
            Self::Symbol { id, transposed } | Self::Inverse { id, transposed } => {
                turned(*transposed, symbols.get(*id).shape)
            }
            Self::Unit { size, transposed, .. } => turned(*transposed, (*size, 1)),
            Self::Hat(_) => (3, 3),
            Self::Diagonal(word) => {
                let size = word.first().map_or(1, |factor| factor.shape(symbols).0);
                (size, size)
            }
            Self::Vee { transposed, .. } => turned(*transposed, (3, 1)),
        }
    }

    /// The transpose and its sign: a symmetric matrix is its own transpose, a skew one its negative.
    pub fn transpose(&self, symbols: &Symbols) -> (i8, Self) {
        match self {
            Self::Symbol { id, transposed } => match symbols.get(*id).structure {
                Structure::Symmetric | Structure::Diagonal => (1, self.clone()),
                Structure::Skew => (-1, self.clone()),
                Structure::General | Structure::Point | Structure::Orthogonal | Structure::Rotation => {
                    (1, Self::Symbol { id: *id, transposed: !transposed })
                }
            },
            Self::Inverse { id, .. } if symbols.get(*id).structure.is_symmetric() => (1, self.clone()),
            Self::Inverse { id, transposed } => (1, Self::Inverse { id: *id, transposed: !transposed }),
            Self::Unit { index, size, transposed } => {
                (1, Self::Unit { index: *index, size: *size, transposed: !transposed })
            }
            Self::Hat(_) => (-1, self.clone()),
            Self::Diagonal(_) => (1, self.clone()),
            Self::Vee { word, transposed } => (1, Self::Vee { word: word.clone(), transposed: !transposed }),
        }
    }

    fn is_inverse_of(&self, other: &Self, symbols: &Symbols) -> bool {
        match (self, other) {
            (Self::Symbol { id: a, transposed: s }, Self::Symbol { id: b, transposed: t }) => {
                a == b && s != t && symbols.get(*a).structure.is_orthogonal()
            }
            (Self::Symbol { id: a, transposed: s }, Self::Inverse { id: b, transposed: t })
            | (Self::Inverse { id: a, transposed: s }, Self::Symbol { id: b, transposed: t }) => a == b && s == t,
            _ => false,
        }
    }

    pub fn contains(&self, symbol: SymbolId) -> bool {
        self.degree(symbol) > 0
    }

    /// The number of occurrences of a symbol.
    pub fn degree(&self, symbol: SymbolId) -> usize {
        match self {
            Self::Symbol { id, .. } | Self::Inverse { id, .. } => usize::from(*id == symbol),
            Self::Unit { .. } => 0,
            Self::Hat(word) | Self::Diagonal(word) | Self::Vee { word, .. } => {
                word.iter().map(|factor| factor.degree(symbol)).sum()
            }
        }
    }
}

/// The number of factors, including those inside others.
pub(super) fn size(word: &[Factor]) -> usize {
    let sizes = word.iter().map(|factor| match factor {
        Factor::Symbol { .. } | Factor::Inverse { .. } | Factor::Unit { .. } => 1,
        Factor::Hat(inner) | Factor::Diagonal(inner) | Factor::Vee { word: inner, .. } => 1 + size(inner),
    });
    sizes.sum()
}

/// The transpose of a word and its sign.
pub(super) fn transpose(word: &[Factor], symbols: &Symbols) -> (i8, Vec<Factor>) {
    let mut sign = 1;
    let factors = word.iter().rev().map(|factor| {
        let (s, turned) = factor.transpose(symbols);
        sign *= s;
        turned
    });
    let factors = factors.collect();
    (sign, factors)
}

/// Applies `FᵀF = FFᵀ = I`, and `Fᵀ û F = (Fᵀu)^` if `det F = 1`, between neighbours until nothing changes.
pub(super) fn reduce(word: Vec<Factor>, symbols: &Symbols) -> Vec<Factor> {
    let mut stack: Vec<Factor> = Vec::with_capacity(word.len());
    for factor in word {
        if stack.last().is_some_and(|last| last.is_inverse_of(&factor, symbols)) {
            stack.pop();
            continue;
        }
        if let [.., left, Factor::Hat(inner)] = stack.as_slice()
            && left.is_inverse_of(&factor, symbols)
            && matches!(left, Factor::Symbol { id, .. } if symbols.get(*id).structure == Structure::Rotation)
            && matches!(factor, Factor::Symbol { .. })
        {
            let rotated = reduce([vec![left.clone()], inner.clone()].concat(), symbols);
            stack.truncate(stack.len() - 2);
            stack.push(Factor::Hat(rotated));
            continue;
        }
        stack.push(factor);
    }
    stack
}

/// The canonical form of a closed word `tr(W)` or of a bilinear form `uᵀ W v`, and its sign.
///
/// Equal words have equal canonical forms. The sign is zero where the word equals its own negative transpose.
pub fn canonical_trace(word: Vec<Factor>, symbols: &Symbols) -> (i8, Vec<Factor>) {
    let word = reduce_cyclic(word, symbols);
    let is_form = word.first().is_some_and(|factor| factor.shape(symbols).0 == 1);
    let candidates = |word: &[Factor]| -> Vec<Factor> {
        if is_form {
            return word.to_vec();
        }
        let rotations = (0..word.len().max(1)).map(|start| {
            let (tail, head) = word.split_at(start);
            [head, tail].concat()
        });
        rotations.min().unwrap_or_default()
    };
    let (sign, turned) = transpose(&word, symbols);
    let (direct, turned) = (candidates(&word), candidates(&turned));
    if direct == turned {
        return (i8::from(sign >= 0), direct);
    }
    let (sign, word) = if direct < turned { (1, direct) } else { (sign, turned) };
    if is_form { sort_triple_product(sign, word, symbols) } else { (sign, word) }
}

/// Cancels inverse neighbours, including the two ends of a trace.
fn reduce_cyclic(word: Vec<Factor>, symbols: &Symbols) -> Vec<Factor> {
    let mut word = reduce(word, symbols);
    while let [first, .., last] = word.as_slice()
        && last.is_inverse_of(first, symbols)
    {
        word.pop();
        word.remove(0);
    }
    word
}

/// The sorted triple product `u · (v × w)`, which changes sign with each exchange and is zero if two vectors are equal.
fn sort_triple_product(sign: i8, word: Vec<Factor>, symbols: &Symbols) -> (i8, Vec<Factor>) {
    let hats: Vec<usize> = (0..word.len()).filter(|&i| matches!(word.get(i), Some(Factor::Hat(_)))).collect();
    let &[at] = hats.as_slice() else { return (sign, word) };
    let (row, rest) = word.split_at(at);
    let Some((Factor::Hat(middle), column)) = rest.split_first() else { return (sign, word) };
    let (turn, row) = transpose(row, symbols);
    let mut vectors = [row, middle.clone(), column.to_vec()];
    let mut sign = sign * turn;
    for (i, j) in [(0, 1), (1, 2), (0, 1)] {
        if vectors[i] == vectors[j] {
            return (0, Vec::new());
        }
        if vectors[i] > vectors[j] {
            vectors.swap(i, j);
            sign = -sign;
        }
    }
    let [row, middle, column] = vectors;
    let (turn, row) = transpose(&row, symbols);
    (sign * turn, [row, vec![Factor::Hat(middle)], column].concat())
}
