//! Smooth functions of one scalar; the rules of variation have their derivatives, which are expressions.

use super::rational::Rational;

/// A function that a Lagrangian may apply to a scalar, or that is a part of `exp` and `log`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)] // their names say it
pub enum Function {
    Sqrt,
    Ln,
    Exp,
    Sin,
    Cos,
    /// `c_k(q) = Σ (−q)ⁱ/(2i + k)!`: with `q = |v|²`, `exp(v̂) = I + c₁ v̂ + c₂ v̂²`.
    Stumpff(u8),
    /// Derivatives of `G(n) = θ/sin θ`, `n = sin²(θ/2)`: with `n = (3 − tr F)/4`, `log F = G vee(F)`.
    LogRatio(u8),
}

/// The limit on terms of a series: one that needs more is at the edge of its radius of convergence, and useless for
/// checks.
const MOST_TERMS: u32 = 400;

impl Function {
    /// The functions that are methods of a scalar.
    pub const METHODS: [Self; 5] = [Self::Sqrt, Self::Ln, Self::Exp, Self::Sin, Self::Cos];

    /// A number that identifies the function.
    pub fn number(self) -> usize {
        match self {
            Self::Sqrt => 0,
            Self::Ln => 1,
            Self::Exp => 2,
            Self::Sin => 3,
            Self::Cos => 4,
            Self::Stumpff(k) => 16 + usize::from(k),
            Self::LogRatio(k) => 512 + usize::from(k),
        }
    }

    /// The method of a Rust float, and the name in equations.
    pub fn name(self) -> String {
        match self {
            Self::Sqrt => "sqrt".to_owned(),
            Self::Ln => "ln".to_owned(),
            Self::Exp => "exp".to_owned(),
            Self::Sin => "sin".to_owned(),
            Self::Cos => "cos".to_owned(),
            Self::Stumpff(k) => format!("c{}", subscript(k)),
            Self::LogRatio(k) => format!("G{}", "′".repeat(k.into())),
        }
    }

    /// The value, for the self-check and for tests; simple and not fast.
    pub fn apply(self, argument: f64) -> f64 {
        match self {
            Self::Sqrt => argument.sqrt(),
            Self::Ln => argument.ln(),
            Self::Exp => argument.exp(),
            Self::Sin => argument.sin(),
            Self::Cos => argument.cos(),
            Self::Stumpff(k) => {
                let first = (1..=k).fold(1.0, |product, i| product / f64::from(i));
                let k = f64::from(k);
                series(argument, first, |m| -1.0 / ((2.0 * m + k + 1.0) * (2.0 * m + k + 2.0)))
            }
            Self::LogRatio(k) => {
                let (first, k) = (leading(k), f64::from(k));
                series(argument, first, |m| (m + k + 1.0) * (m + k + 1.0) / ((m + k + 1.5) * (m + 1.0)))
            }
        }
    }

    /// The exact value at zero, if it is rational.
    pub fn at_zero(self) -> Option<Rational> {
        let product = |factors: &mut dyn Iterator<Item = i128>| factors.product::<i128>();
        Some(match self {
            Self::Sqrt | Self::Sin => Rational::ZERO,
            Self::Ln => return None,
            Self::Exp | Self::Cos => Rational::ONE,
            Self::Stumpff(k) => Rational::new(1, product(&mut (1..=k.into()))),
            // k! k!/(3/2)_k = 2ᵏ k! k!/(3 · 5 · … · (2k + 1)).
            Self::LogRatio(k) => {
                let k = i128::from(k);
                Rational::new(product(&mut (1..=k).map(|i| 2 * i * i)), product(&mut (1..=k).map(|i| 2 * i + 1)))
            }
        })
    }
}

/// `Σ a_m xᵐ`, where `ratio(m)` is `a_{m+1}/a_m`.
fn series(x: f64, first: f64, ratio: impl Fn(f64) -> f64) -> f64 {
    let (mut sum, mut term) = (0.0, first);
    for m in 0..MOST_TERMS {
        sum += term;
        term *= x * ratio(f64::from(m));
        if term.abs() <= f64::EPSILON * sum.abs() * 0.01 {
            return sum;
        }
    }
    f64::NAN
}

/// The leading coefficient `G⁽ᵏ⁾(0)`.
fn leading(k: u8) -> f64 {
    Function::LogRatio(k).at_zero().map_or(f64::NAN, Rational::to_f64)
}

fn subscript(k: u8) -> String {
    let digits = ['₀', '₁', '₂', '₃', '₄', '₅', '₆', '₇', '₈', '₉'];
    k.to_string().chars().filter_map(|c| digits.get(usize::try_from(c.to_digit(10)?).ok()?).copied()).collect()
}
