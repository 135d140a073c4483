//! Derived equations as LaTeX.

use crate::declaration::Declaration;

/// The signs of printed equations, each with its LaTeX command.
#[rustfmt::skip]
const SIGNS: [(char, &str); 41] = [
    ('−', "-"), ('·', r"\cdot "), ('×', r"\times "), ('⋄', r"\diamond "), ('∂', r"\partial "), ('∨', r"\vee"),
    ('⟨', r"\langle "), ('⟩', r"\rangle "), ('δ', r"\delta "), ('η', r"\eta "), ('λ', r"\lambda "),
    ('μ', r"\mu "), ('ξ', r"\xi "), ('ζ', r"\zeta "), ('Ω', r"\Omega "), ('τ', r"\tau "), ('θ', r"\theta "),
    ('½', r"\tfrac{1}{2}"), ('𝕀', r"\mathbb{I}"), ('√', r"\surd "), ('↦', r"\mapsto "), ('→', r"\to "),
    ('≠', r"\neq "), ('\u{302}', r"\hat{}"), ('ᵀ', r"^{\top}"), ('⁺', "^{+}"), ('⁻', "^{-}"), ('¹', "^{1}"),
    ('²', "^{2}"), ('³', "^{3}"), ('⁴', "^{4}"), ('⁰', "^{0}"), ('⁵', "^{5}"), ('⁶', "^{6}"), ('⁷', "^{7}"),
    ('⁸', "^{8}"), ('⁹', "^{9}"), ('₀', "_{0}"), ('₁', "_{1}"), ('₂', "_{2}"), ('∞', r"\infty "),
];

/// The names of letters and functions that LaTeX knows.
#[rustfmt::skip]
const KNOWN: [&str; 40] = [
    "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda", "mu", "nu", "xi",
    "pi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi", "omega", "Gamma", "Delta", "Theta", "Lambda", "Xi", "Pi",
    "Sigma", "Phi", "Psi", "Omega", "Upsilon", "exp", "log", "sin", "cos", "ln", "det",
];

/// The derived equations, each a line of an `align*`.
#[must_use]
pub fn latex(declaration: &Declaration) -> String {
    let equations = declaration.derivation.lines().filter_map(|line| {
        // A line with its source in brackets at the end is an equation.
        let (equation, source) = line.rsplit_once("    [")?;
        let (left, right) = equation.split_once(" = ")?;
        let source = source.trim_end_matches(']');
        Some(format!("  {} &= {} && \\text{{{}}} \\\\\n", math(left), math(right), text(source)))
    });
    format!("\\begin{{align*}}\n{}\\end{{align*}}\n", equations.collect::<String>())
}

/// Words beside an equation, with their signs as mathematics.
fn text(source: &str) -> String {
    let sign = |character: char| match SIGNS.iter().find(|(sign, _)| *sign == character) {
        Some((_, sign)) => format!("$ {sign} $"),
        None if "_^&%#$".contains(character) => format!("\\{character}"),
        None => character.to_string(),
    };
    source.chars().map(sign).collect()
}

fn math(expression: &str) -> String {
    let mut made = String::new();
    let mut rest = expression.trim();
    while let Some(first) = rest.chars().next() {
        let is_word = |character: char| character.is_ascii_alphanumeric() || character == '_';
        let length = if first.is_ascii_alphabetic() {
            rest.find(|character| !is_word(character)).unwrap_or(rest.len())
        } else if first == '(' {
            closed(rest).unwrap_or(1)
        } else {
            first.len_utf8()
        };
        let (token, behind) = rest.split_at(length);
        match first {
            'a'..='z' | 'A'..='Z' => made += &word(token),
            '(' if length > 1 => made += &group(&token[1..length - 1]),
            '^' => made += "^",
            '*' => made += "^{*}",
            ';' => made += ";\\quad ",
            _ => made += SIGNS.iter().find(|(sign, _)| *sign == first).map_or(token, |(_, sign)| sign),
        }
        rest = behind;
    }
    // Two exponents in sequence are joined.
    let joined = [("  ", " "), (" ^", "^"), (" _", "_"), (" }", "}"), ("^{-}^{", "^{-"), ("^{+}^{\\top}", "^{+\\top}")];
    let made = joined.iter().fold(made, |made, (from, to)| made.replace(from, to));
    made.replace(r"^{\top}^{+}", r"^{\top+}").trim_end().to_owned()
}

/// The end of the bracket that begins a text.
fn closed(text: &str) -> Option<usize> {
    let mut depths = text.char_indices().scan(0, |depth, (at, character)| {
        *depth += i32::from(character == '(') - i32::from(character == ')');
        Some((at, *depth))
    });
    depths.find(|&(_, depth)| depth == 0).map(|(at, _)| at + 1)
}

/// The contents of brackets; a quotient without sums is a fraction.
fn group(content: &str) -> String {
    if let Some((above, below)) = content.split_once('/')
        && ![above, below].iter().any(|part| part.contains(['/', '(', '+', '−']))
    {
        return format!("\\frac{{{}}}{{{}}} ", math(above), math(below));
    }
    format!("\\left({}\\right)", math(content))
}

/// A name, with everything after its first underscore as a subscript.
fn word(name: &str) -> String {
    let (head, below) = name.split_once('_').map_or((name, None), |(head, below)| (head, Some(below)));
    let head = match head {
        _ if KNOWN.contains(&head) => format!("\\{head} "),
        "tr" => "\\operatorname{tr}".to_owned(),
        _ if head.chars().count() == 1 => head.to_owned(),
        // The change of a letter, as `dOmega`.
        _ if head.strip_prefix('d').is_some_and(|letter| KNOWN.contains(&letter)) => {
            format!("\\mathrm{{d}}\\{} ", &head[1..])
        }
        _ => format!("\\mathrm{{{head}}}"),
    };
    let below = below.map(|below| format!("_{{{}}}", below.replace('_', "\\_")));
    head.trim_end().to_owned() + &below.unwrap_or_else(|| " ".to_owned())
}
