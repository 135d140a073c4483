//! Expressions as text, in the notation of a paper.

use super::expression::{Atom, Expression, Monomial};
use super::rational::Rational;
use super::symbols::{SymbolId, Symbols};
use super::word::{Factor, transpose};

/// The text of a scalar, vector or matrix expression.
pub fn text(expression: &Expression, symbols: &Symbols) -> String {
    let is_matrix = expression.shape() != (1, 1);
    join(expression.terms().map(|(monomial, coefficient)| {
        let (prefix, mut body) = parts(monomial, coefficient, None, symbols);
        let word = word_text(&monomial.word, symbols);
        body.extend((!word.is_empty()).then_some(word));
        if is_matrix && monomial.word.is_empty() {
            body.push("I".to_owned());
        }
        (coefficient, prefix, body.join(" "))
    }))
}

/// An expression that is linear in the algebra direction `E`, as the covector that it pairs with: `tr(E W)` is the `E`
/// component of `−(W − Wᵀ)^∨`. Terms with equal coefficients are collected.
pub fn covector_text(expression: &Expression, direction: SymbolId, symbols: &Symbols) -> String {
    let mut terms: Vec<Term> = Vec::new();
    for (monomial, coefficient) in expression.terms() {
        let term = covector_term(monomial, coefficient, direction, symbols);
        match terms.iter_mut().find(|other| other.shares_coefficient(&term)) {
            Some(other) => other.vees.extend(term.vees),
            None => terms.push(term),
        }
    }
    join(terms.into_iter().map(|term| {
        let mut body = term.body;
        body.extend((!term.vees.is_empty()).then(|| format!("({})^∨", term.vees.join(" + "))));
        (term.coefficient, term.prefix, body.join(" "))
    }))
}

/// A term of a covector: a coefficient, other scalars, and `W − Wᵀ` under the `∨`.
struct Term {
    coefficient: Rational,
    prefix: String,
    body: Vec<String>,
    vees: Vec<String>,
}

impl Term {
    fn shares_coefficient(&self, other: &Self) -> bool {
        let is_vee = !self.vees.is_empty() && !other.vees.is_empty();
        is_vee && self.coefficient == other.coefficient && self.prefix == other.prefix && self.body == other.body
    }
}

fn covector_term(monomial: &Monomial, coefficient: Rational, direction: SymbolId, symbols: &Symbols) -> Term {
    let closed = monomial.scalars.iter().find_map(|(atom, exponent)| match atom {
        Atom::Trace(word) if *exponent == 1 => opened(word, direction, symbols).map(|opened| (atom, opened)),
        _ => None,
    });
    let Some((atom, word)) = closed else {
        let (prefix, body) = parts(monomial, coefficient, None, symbols);
        return Term { coefficient, prefix, body, vees: Vec::new() };
    };
    let (sign, turned) = transpose(&word, symbols);
    let (word, turned) = (word_text(&word, symbols), word_text(&turned, symbols));
    let between = if sign < 0 { "+" } else { "−" };
    let (coefficient, vee) = if coefficient.is_negative() || sign < 0 {
        (-coefficient, format!("{word} {between} {turned}"))
    } else {
        (coefficient, format!("{turned} − {word}"))
    };
    let (prefix, body) = parts(monomial, coefficient, Some(atom), symbols);
    Term { coefficient, prefix, body, vees: vec![vee] }
}

/// `W` with `tr(E W)` or `uᵀ A E B v` equal to the closed word, if `E` is one of its factors.
fn opened(word: &[Factor], direction: SymbolId, symbols: &Symbols) -> Option<Vec<Factor>> {
    let is_direction = |factor: &Factor| matches!(factor, Factor::Symbol { id, .. } if *id == direction);
    let at = word.iter().position(is_direction)?;
    let (before, rest) = word.split_at(at);
    let after = rest.get(1..)?;
    let others = [after, before].concat();
    let once = !others.iter().any(|factor| factor.contains(direction));
    (once
        && !others.is_empty()
        && symbols.get(direction).name.starts_with("E_k")
        && symbols.get(direction).is_rotation())
    .then_some(others)
}

/// The sum of terms with their signs.
fn join(terms: impl Iterator<Item = (Rational, String, String)>) -> String {
    let mut sum = String::new();
    for (coefficient, prefix, body) in terms {
        sum.push_str(match (sum.is_empty(), coefficient.is_negative()) {
            (true, true) => "−",
            (true, false) => "",
            (false, true) => " − ",
            (false, false) => " + ",
        });
        sum.push_str(&prefix);
        if !prefix.is_empty() && !body.is_empty() {
            sum.push(' ');
        }
        sum.push_str(&body);
        if prefix.is_empty() && body.is_empty() {
            sum.push('1');
        }
    }
    if sum.is_empty() { "0".to_owned() } else { sum }
}

/// A monomial in two parts: one fraction of the coefficient's size and of the named scalars, and the traces, forms and
/// functions.
fn parts(
    monomial: &Monomial,
    coefficient: Rational,
    without: Option<&Atom>,
    symbols: &Symbols,
) -> (String, Vec<String>) {
    let (mut over, mut under, mut body) = (Vec::new(), Vec::new(), Vec::new());
    let (numerator, denominator) = coefficient.parts();
    if numerator.unsigned_abs() != 1 {
        over.push(numerator.unsigned_abs().to_string());
    }
    if denominator != 1 {
        under.push(denominator.to_string());
    }
    for (atom, exponent) in monomial.scalars.iter().filter(|(atom, _)| Some(*atom) != without) {
        let power = match exponent.unsigned_abs() {
            1 => String::new(),
            n => superscript(n),
        };
        let side = match atom {
            _ if *exponent < 0 => &mut under,
            Atom::Symbol(_) => &mut over,
            Atom::Trace(_) | Atom::Function(..) | Atom::Sum(_) => &mut body,
        };
        side.push(format!("{}{power}", atom_text(atom, symbols)));
    }
    let (over, parts) = (over.join(" "), under.len());
    let under = under.join(" ");
    let prefix = match (over.is_empty(), parts) {
        (_, 0) => over,
        (true, 1) => format!("(1/{under})"),
        (true, _) => format!("(1/({under}))"),
        (false, 1) => format!("({over}/{under})"),
        (false, _) => format!("({over}/({under}))"),
    };
    (prefix, body)
}

fn superscript(n: u32) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digit = |c: char| c.to_digit(10).and_then(|d| digits.get(usize::try_from(d).ok()?).copied());
    n.to_string().chars().filter_map(digit).collect()
}

fn atom_text(atom: &Atom, symbols: &Symbols) -> String {
    match atom {
        Atom::Symbol(id) => symbols.get(*id).name.clone(),
        Atom::Trace(word) => match word.split_first() {
            Some((first, rest)) if first.shape(symbols).0 == 1 => {
                let (_, column) = first.transpose(symbols);
                format!("⟨{}, {}⟩", factor_text(&column, symbols), word_text(rest, symbols))
            }
            _ => format!("tr({})", word_text(word, symbols)),
        },
        Atom::Function(function, inner) => format!("{}({})", function.name(), text(inner, symbols)),
        Atom::Sum(inner) => format!("({})", text(inner, symbols)),
    }
}

fn word_text(word: &[Factor], symbols: &Symbols) -> String {
    word.iter().map(|factor| factor_text(factor, symbols)).collect::<Vec<_>>().join(" ")
}

fn factor_text(factor: &Factor, symbols: &Symbols) -> String {
    let mark = |transposed: bool| if transposed { "ᵀ" } else { "" };
    match factor {
        Factor::Symbol { id, transposed } => format!("{}{}", symbols.get(*id).name, mark(*transposed)),
        Factor::Inverse { id, transposed } => {
            format!("{}⁻{}", symbols.get(*id).name, if *transposed { "ᵀ" } else { "¹" })
        }
        Factor::Unit { index, transposed, .. } => format!("e{}{}", index + 1, mark(*transposed)),
        Factor::Hat(word) => format!("hat({})", word_text(word, symbols)),
        Factor::Diagonal(word) => format!("diag({})", word_text(word, symbols)),
        Factor::Vee { word, transposed } => format!("vee({}){}", word_text(word, symbols), mark(*transposed)),
    }
}

/// An expression that is linear in the components of a direction, as the vector that it pairs with; on SO(3) products
/// of vectors are cross products. `None` if a term doesn't have that form.
pub fn vector_text(expression: &Expression, direction: SymbolId, symbols: &Symbols) -> Option<String> {
    let term = |(monomial, coefficient): (&Monomial, Rational)| {
        let (atom, sign, word) = opened_form(monomial, direction, symbols)?;
        let mut coefficient = if sign < 0 { -coefficient } else { coefficient };
        let mut text = column_text(&word, symbols);
        // −u × v = v × u.
        if coefficient.is_negative()
            && let [Factor::Hat(inner), rest @ ..] = word.as_slice()
            && !rest.is_empty()
        {
            text = column_text(&[vec![Factor::Hat(rest.to_vec())], inner.clone()].concat(), symbols);
            coefficient = -coefficient;
        }
        let (prefix, mut body) = parts(monomial, coefficient, Some(atom), symbols);
        body.extend((!text.is_empty()).then_some(text));
        Some((coefficient, prefix, body.join(" ")))
    };
    let terms: Option<Vec<_>> = expression.terms().map(term).collect();
    terms.map(|terms| join(terms.into_iter()))
}

/// An expression that is linear in the components of two directions, as the matrix between them. `None` if a term
/// doesn't have that form.
pub fn matrix_text(expression: &Expression, [left, right]: [SymbolId; 2], symbols: &Symbols) -> Option<String> {
    let term = |(monomial, coefficient): (&Monomial, Rational)| {
        let mut rest = monomial.clone();
        let (atom, sign, word) = opened_form(monomial, left, symbols)?;
        rest.scalars.remove(atom);
        let (prefix, mut body, sign) = if word.iter().any(|factor| factor.contains(right)) {
            let (last, matrix) = word.split_last()?;
            let is_direction = matches!(last, Factor::Symbol { id, transposed: false } if *id == right);
            if !is_direction || matrix.iter().any(|factor| factor.contains(right)) {
                return None;
            }
            let (prefix, mut body) = parts(&rest, coefficient, None, symbols);
            body.push(if matrix.is_empty() { "I".to_owned() } else { word_text(matrix, symbols) });
            (prefix, body, sign)
        } else {
            let (other, turn, row) = opened_form(&rest, right, symbols)?;
            let (prefix, body) = parts(&rest, coefficient, Some(other), symbols);
            let row = match row.as_slice() {
                [] => String::new(),
                [single] => format!("{}ᵀ", factor_text(single, symbols)),
                row => format!("({})ᵀ", word_text(row, symbols)),
            };
            let outer = format!("{} {row}", word_text(&word, symbols)).trim().to_owned();
            (prefix, [body, vec![outer]].concat(), sign * turn)
        };
        let coefficient = if sign < 0 { -coefficient } else { coefficient };
        body.retain(|part| !part.is_empty());
        Some((coefficient, prefix, body.join(" ")))
    };
    let terms: Option<Vec<_>> = expression.terms().map(term).collect();
    terms.map(|terms| join(terms.into_iter()))
}

/// The atom `±⟨direction, W⟩` of a monomial, with its sign and the column `W`.
fn opened_form<'a>(
    monomial: &'a Monomial,
    direction: SymbolId,
    symbols: &Symbols,
) -> Option<(&'a Atom, i8, Vec<Factor>)> {
    let mut found = monomial.scalars.iter().filter(|(atom, _)| match atom {
        Atom::Symbol(id) => *id == direction,
        Atom::Trace(word) => word.iter().any(|factor| factor.contains(direction)),
        Atom::Function(_, inner) | Atom::Sum(inner) => inner.contains(direction),
    });
    let (Some((atom, 1)), None) = (found.next(), found.next()) else { return None };
    // Components on a line are scalars.
    let Atom::Trace(word) = atom else { return matches!(atom, Atom::Symbol(_)).then(|| (atom, 1, Vec::new())) };
    let is_direction = |factor: &Factor| matches!(factor, Factor::Symbol { id, .. } if *id == direction);
    let others = |factors: &[Factor]| !factors.iter().any(|factor| factor.contains(direction));
    if word.first()?.shape(symbols).0 != 1 {
        return None;
    }
    match word.as_slice() {
        [first, rest @ ..] if is_direction(first) && others(rest) => Some((atom, 1, rest.to_vec())),
        [rest @ .., last] if is_direction(last) && others(rest) => {
            let (sign, column) = transpose(rest, symbols);
            Some((atom, sign, column))
        }
        // uᵀ η̂ v = η·(v × u).
        _ => {
            let at = word.iter().position(
                |factor| matches!(factor, Factor::Hat(inner) if inner.len() == 1 && is_direction(&inner[0])),
            )?;
            let (row, rest) = word.split_at(at);
            let (_, column) = rest.split_first()?;
            let (sign, u) = transpose(row, symbols);
            (others(row) && others(column)).then(|| (atom, sign, [vec![Factor::Hat(column.to_vec())], u].concat()))
        }
    }
}

/// The text of a column, with `û v` as `u × v`.
fn column_text(word: &[Factor], symbols: &Symbols) -> String {
    let bracketed = |text: String| if text.contains(' ') { format!("({text})") } else { text };
    match word {
        [Factor::Hat(inner), rest @ ..] if !rest.is_empty() => {
            let right = column_text(rest, symbols);
            format!("{} × {}", bracketed(word_text(inner, symbols)), bracketed(right))
        }
        _ => word_text(word, symbols),
    }
}
