//! Expressions in print, as a paper would write them.

use super::expression::{Atom, Expression, Monomial};
use super::rational::Rational;
use super::symbols::{SymbolId, Symbols};
use super::word::{Factor, transpose};

/// A scalar, vector or matrix expression.
pub(crate) fn text(expression: &Expression, symbols: &Symbols) -> String {
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

/// An expression that is linear in the algebra direction `E`, as the covector that it pairs with: `tr(E W)` is the
/// `E` component of `−(W − Wᵀ)^∨`. What has one coefficient shares it.
pub(crate) fn covector_text(expression: &Expression, direction: SymbolId, symbols: &Symbols) -> String {
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
    (once && !others.is_empty() && symbols.get(direction).name == "E_k" && symbols.get(direction).is_rotation())
        .then_some(others)
}

/// Terms with their signs.
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
