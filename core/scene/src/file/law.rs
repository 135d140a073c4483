//! Laws as texts: expressions of numbers and vectors in the words of declarations, computed at times of a run.

use liestep_derivation::suggestion;
use nalgebra::Vector3;

/// A number or a vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    Vector(Vector3<f64>),
}

/// The kind of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Number,
    Vector,
}

impl Value {
    pub(crate) const fn kind(&self) -> Kind {
        match self {
            Self::Number(_) => Kind::Number,
            Self::Vector(_) => Kind::Vector,
        }
    }

    /// The number; NaN of a vector.
    const fn number(self) -> f64 {
        match self {
            Self::Number(number) => number,
            Self::Vector(_) => f64::NAN,
        }
    }

    /// The vector; three times a number.
    fn vector(self) -> Vector3<f64> {
        match self {
            Self::Number(number) => Vector3::repeat(number),
            Self::Vector(vector) => vector,
        }
    }

    /// A function of each component of some values; numbers among vectors count for each component.
    fn each<const N: usize>(values: [Self; N], function: impl Fn([f64; N]) -> f64) -> Self {
        if values.iter().all(|value| value.kind() == Kind::Number) {
            return Self::Number(function(values.map(Self::number)));
        }
        let vectors = values.map(Self::vector);
        Self::Vector(Vector3::from_fn(|row, _| function(vectors.map(|vector| vector[row]))))
    }
}

/// A number, or the bound beyond which it lies; NaN where one of them is.
///
/// The standard library's `clamp` panics where the bounds are in the wrong order, and its `min` and `max` lose a NaN.
pub(crate) fn within(number: f64, [low, high]: [f64; 2]) -> f64 {
    if number.is_nan() || low.is_nan() || high.is_nan() {
        return f64::NAN;
    }
    number.max(low).min(high)
}

/// A function of a law, by its name, with its kinds.
#[derive(Clone, Copy)]
enum Function {
    /// A function of a number.
    OfNumber(fn(f64) -> f64),
    /// A function of each component.
    OfEach(fn(f64) -> f64),
    OfTwo(fn(f64, f64) -> f64),
    Clamp,
    Dot,
    Cross,
    Norm,
}

impl Function {
    const NAMES: &'static str =
        "`abs`, `sign`, `sqrt`, `sin`, `cos`, `exp`, `min`, `max`, `clamp`, `dot`, `cross`, `norm`";

    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "abs" => Self::OfEach(f64::abs),
            "sign" => Self::OfEach(|x| if x == 0.0 { 0.0 } else { x.signum() }),
            "sqrt" => Self::OfNumber(f64::sqrt),
            "sin" => Self::OfNumber(f64::sin),
            "cos" => Self::OfNumber(f64::cos),
            "exp" => Self::OfNumber(f64::exp),
            "min" => Self::OfTwo(|x, y| within(x, [f64::NEG_INFINITY, y])),
            "max" => Self::OfTwo(|x, y| within(x, [y, f64::INFINITY])),
            "clamp" => Self::Clamp,
            "dot" => Self::Dot,
            "cross" => Self::Cross,
            "norm" => Self::Norm,
            _ => return None,
        })
    }

    const fn arguments(self) -> usize {
        match self {
            Self::OfNumber(_) | Self::OfEach(_) | Self::Norm => 1,
            Self::OfTwo(_) | Self::Dot | Self::Cross => 2,
            Self::Clamp => 3,
        }
    }

    fn kind(self, kinds: &[Kind]) -> Option<Kind> {
        let has_vectors = kinds.iter().all(|kind| *kind == Kind::Vector);
        let is_any = kinds.contains(&Kind::Vector);
        match self {
            Self::OfNumber(_) => (!is_any).then_some(Kind::Number),
            Self::OfEach(_) | Self::OfTwo(_) | Self::Clamp => Some(if is_any { Kind::Vector } else { Kind::Number }),
            Self::Dot | Self::Norm => has_vectors.then_some(Kind::Number),
            Self::Cross => has_vectors.then_some(Kind::Vector),
        }
    }

    fn value(self, values: &[Value]) -> Value {
        match (self, values) {
            (Self::OfNumber(f) | Self::OfEach(f), &[x]) => Value::each([x], |[x]| f(x)),
            (Self::OfTwo(f), &[x, y]) => Value::each([x, y], |[x, y]| f(x, y)),
            (Self::Clamp, &[x, low, high]) => Value::each([x, low, high], |[x, low, high]| within(x, [low, high])),
            (Self::Dot, &[x, y]) => Value::Number(x.vector().dot(&y.vector())),
            (Self::Cross, &[x, y]) => Value::Vector(x.vector().cross(&y.vector())),
            (Self::Norm, &[x]) => Value::Number(x.vector().norm()),
            _ => Value::Number(f64::NAN),
        }
    }
}

/// A part of an expression.
#[derive(Clone)]
enum Node {
    Constant(f64),
    Name(usize),
    List(Vec<Node>),
    Negative(Box<Node>),
    Binary(char, Box<[Node; 2]>),
    Component(Box<Node>, usize),
    Call(Function, Vec<Node>),
}

/// A law, whose names and kinds are checked.
#[derive(Clone)]
pub(crate) struct Law {
    node: Node,
}

impl Law {
    /// The law of a text, in which these names have values of these kinds, and which has this kind itself.
    pub(crate) fn parse(text: &str, names: &[(String, Kind)], kind: Kind) -> Result<Self, String> {
        match (Self::of(text, names)?, kind) {
            ((law, found), expected) if found == expected => Ok(law),
            (_, Kind::Vector) => Err("a torque is a vector, as `-kd * Omega` or `[0, 0, -k * Omega[2]]`".to_owned()),
            (_, Kind::Number) => Err("the torque of a wheel is a number, as `-k * Omega[2]`".to_owned()),
        }
    }

    /// The expression of a text, in which these names have values of these kinds, with its own kind.
    pub(crate) fn of(text: &str, names: &[(String, Kind)]) -> Result<(Self, Kind), String> {
        let mut parser = Parser { tokens: tokens(text)?, place: 0, names, depth: 0 };
        let node = parser.sum()?;
        if let Some(token) = parser.next() {
            return Err(format!("`{}` isn't expected behind an expression", token.written()));
        }
        let kind = kind_of(&node, names)?;
        Ok((Self { node }, kind))
    }

    /// The value with these values of the names.
    pub(crate) fn value(&self, values: &[Value]) -> Value {
        value(&self.node, values)
    }
}

fn value(node: &Node, values: &[Value]) -> Value {
    match node {
        Node::Constant(number) => Value::Number(*number),
        Node::Name(name) => values.get(*name).copied().unwrap_or(Value::Number(f64::NAN)),
        Node::List(list) => Value::Vector(Vector3::from_fn(|row, _| value(&list[row], values).number())),
        Node::Negative(inner) => Value::each([value(inner, values)], |[x]| -x),
        Node::Binary(sign, both) => {
            let [one, other] = [&both[0], &both[1]].map(|node| value(node, values));
            Value::each([one, other], |[x, y]| match sign {
                '+' => x + y,
                '-' => x - y,
                '*' => x * y,
                _ => x / y,
            })
        }
        Node::Component(inner, at) => Value::Number(value(inner, values).vector()[*at]),
        Node::Call(function, arguments) => {
            function.value(&arguments.iter().map(|node| value(node, values)).collect::<Vec<_>>())
        }
    }
}

/// The kind of a part, whose own parts fit together.
fn kind_of(node: &Node, names: &[(String, Kind)]) -> Result<Kind, String> {
    let of = |node: &Node| kind_of(node, names);
    match node {
        Node::Constant(_) => Ok(Kind::Number),
        Node::Name(name) => names.get(*name).map(|(_, kind)| *kind).ok_or_else(String::new),
        Node::Negative(inner) => of(inner),
        Node::List(list) => {
            let kinds = list.iter().map(of).collect::<Result<Vec<_>, _>>()?;
            match kinds[..] {
                [Kind::Number, Kind::Number, Kind::Number] => Ok(Kind::Vector),
                _ => Err("a vector is a list of three numbers".to_owned()),
            }
        }
        Node::Binary(sign, both) => match (of(&both[0])?, of(&both[1])?, sign) {
            (one, other, '+' | '-') if one == other => Ok(one),
            (_, _, '+' | '-') => Err("a vector and a number have no sum".to_owned()),
            (one, Kind::Number, _) => Ok(one),
            (Kind::Number, Kind::Vector, '*') => Ok(Kind::Vector),
            (_, _, '*') => Err("the product of two vectors is `a.dot(b)` or `a.cross(b)`".to_owned()),
            _ => Err("nothing is divided by a vector".to_owned()),
        },
        Node::Component(inner, _) => match of(inner)? {
            Kind::Vector => Ok(Kind::Number),
            Kind::Number => Err("a number has no components".to_owned()),
        },
        Node::Call(function, arguments) => {
            let kinds = arguments.iter().map(of).collect::<Result<Vec<_>, _>>()?;
            let found = (kinds.len() == function.arguments()).then(|| function.kind(&kinds)).flatten();
            found.ok_or_else(|| {
                "`dot`, `cross` and `norm` are of vectors, `sqrt`, `sin`, `cos`, `exp` of a number, `clamp(x, low, high)` of \
                 three"
                    .to_owned()
            })
        }
    }
}

#[derive(Clone, PartialEq)]
enum Token {
    Number(f64),
    Name(String),
    Sign(char),
}

impl Token {
    fn written(&self) -> String {
        match self {
            Self::Number(number) => format!("{number}"),
            Self::Name(name) => name.clone(),
            Self::Sign(sign) => sign.to_string(),
        }
    }
}

/// Most characters of a law.
const LONGEST: usize = 2_000;

fn tokens(text: &str) -> Result<Vec<Token>, String> {
    if text.len() > LONGEST {
        return Err(format!("a law has at most {LONGEST} characters"));
    }
    let letters: Vec<char> = text.chars().collect();
    let (mut all, mut at) = (Vec::new(), 0);
    while let Some(&letter) = letters.get(at) {
        let from = at;
        let run = |start: usize, holds: &dyn Fn(char) -> bool| {
            start + letters[start..].iter().take_while(|letter| holds(**letter)).count()
        };
        if letter.is_whitespace() {
            at += 1;
            continue;
        }
        if letter.is_alphabetic() {
            at = run(at, &|letter| letter.is_alphanumeric() || letter == '_');
            all.push(Token::Name(letters[from..at].iter().collect()));
        } else if letter.is_ascii_digit() {
            let is_digit = |letter: char| letter.is_ascii_digit();
            at = run(at, &is_digit);
            if letters.get(at) == Some(&'.') {
                at = run(at + 1, &is_digit);
            }
            if matches!(letters.get(at), Some('e' | 'E')) {
                let sign = at + 1 + usize::from(matches!(letters.get(at + 1), Some('+' | '-')));
                at = run(sign.min(letters.len()), &is_digit);
            }
            let written: String = letters[from..at].iter().collect();
            let number = written.parse::<f64>().ok().filter(|number| number.is_finite());
            all.push(Token::Number(number.ok_or_else(|| format!("`{written}` is no number"))?));
        } else if "+-*/()[],.".contains(letter) {
            at += 1;
            all.push(Token::Sign(letter));
        } else {
            return Err(format!("`{letter}` has no meaning in a law"));
        }
    }
    Ok(all)
}

struct Parser<'n> {
    tokens: Vec<Token>,
    place: usize,
    names: &'n [(String, Kind)],
    depth: u32,
}

/// Most brackets and signs within each other.
const DEEPEST: u32 = 64;

impl Parser<'_> {
    fn next(&mut self) -> Option<Token> {
        let token = self.tokens.get(self.place).cloned();
        self.place += 1;
        token
    }

    /// Whether this sign comes next; it is taken then.
    fn takes(&mut self, sign: char) -> bool {
        let comes = self.tokens.get(self.place) == Some(&Token::Sign(sign));
        self.place += usize::from(comes);
        comes
    }

    fn takes_one(&mut self, signs: &str) -> Option<char> {
        signs.chars().find(|sign| self.takes(*sign))
    }

    fn expect(&mut self, sign: char) -> Result<(), String> {
        if self.takes(sign) { Ok(()) } else { Err(format!("`{sign}` is missing")) }
    }

    fn sum(&mut self) -> Result<Node, String> {
        let mut sum = self.product()?;
        while let Some(sign) = self.takes_one("+-") {
            sum = Node::Binary(sign, Box::new([sum, self.product()?]));
        }
        Ok(sum)
    }

    fn product(&mut self) -> Result<Node, String> {
        let mut product = self.signed()?;
        while let Some(sign) = self.takes_one("*/") {
            product = Node::Binary(sign, Box::new([product, self.signed()?]));
        }
        Ok(product)
    }

    fn signed(&mut self) -> Result<Node, String> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(format!("a law has at most {DEEPEST} brackets and signs within each other"));
        }
        let node = if self.takes('-') { Node::Negative(Box::new(self.signed()?)) } else { self.called()? };
        self.depth -= 1;
        Ok(node)
    }

    /// An atom with the components and functions behind it.
    fn called(&mut self) -> Result<Node, String> {
        let mut node = self.atom()?;
        loop {
            if self.takes('[') {
                let Some(Token::Number(number)) = self.next() else { return Err(COMPONENT.to_owned()) };
                let at = [0.0_f64, 1.0, 2.0]
                    .iter()
                    .position(|known| known.to_bits() == number.to_bits())
                    .ok_or(COMPONENT)?;
                self.expect(']')?;
                node = Node::Component(Box::new(node), at);
            } else if self.takes('.') {
                let Some(Token::Name(name)) = self.next() else {
                    return Err("a name is missing behind `.`".to_owned());
                };
                self.expect('(')?;
                node = self.call(&name, vec![node])?;
            } else {
                return Ok(node);
            }
        }
    }

    fn atom(&mut self) -> Result<Node, String> {
        match self.next() {
            Some(Token::Number(number)) => Ok(Node::Constant(number)),
            Some(Token::Sign('(')) => {
                let inner = self.sum()?;
                self.expect(')')?;
                Ok(inner)
            }
            Some(Token::Sign('[')) => Ok(Node::List(self.listed(']', Vec::new())?)),
            Some(Token::Name(name)) if self.takes('(') => self.call(&name, Vec::new()),
            Some(Token::Name(name)) => {
                let found = self.names.iter().position(|(own, _)| *own == name);
                found.map(Node::Name).ok_or_else(|| {
                    let known: Vec<_> = self.names.iter().map(|(name, _)| format!("`{name}`")).collect();
                    let near = suggestion(&name, self.names.iter().map(|(name, _)| name.as_str()));
                    format!("unknown name `{name}`: a law has {}, and the keys of its table{near}", known.join(", "))
                })
            }
            Some(Token::Sign(sign)) => Err(format!("`{sign}` isn't expected here")),
            None => Err("an expression is missing at the end".to_owned()),
        }
    }

    /// Expressions with commas up to a bracket, behind those that are there.
    fn listed(&mut self, end: char, mut all: Vec<Node>) -> Result<Vec<Node>, String> {
        while !self.takes(end) {
            all.push(self.sum()?);
            if !self.takes(',') {
                self.expect(end)?;
                break;
            }
        }
        Ok(all)
    }

    fn call(&mut self, name: &str, before: Vec<Node>) -> Result<Node, String> {
        let function = Function::of(name).ok_or_else(|| format!("`{name}` is none of {}", Function::NAMES))?;
        Ok(Node::Call(function, self.listed(')', before)?))
    }
}

const COMPONENT: &str = "the components of a vector are `v[0]`, `v[1]`, `v[2]`";
