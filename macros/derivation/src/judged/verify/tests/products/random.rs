//! Declarations on products at random, as text.

use std::fmt::Write as _;

use crate::mathematics::symbolic::tests::random::Random;

/// What a body does.
#[derive(Clone, Copy, PartialEq)]
enum Moves {
    /// `F_1 = SO3`.
    Turns,
    /// `d_1 = R3`.
    Shifts,
    /// `t_1 = R1`.
    Slides,
}

/// At most this many may be advected.
const MOST_ADVECTED: usize = 6;

/// A declaration as it grows: a name is declared once something uses it.
pub(in super::super) struct Text {
    random: Random,
    moves: Vec<Moves>,
    /// Names with their types.
    fields: Vec<(String, &'static str)>,
    /// Names with what they are.
    advected: Vec<(String, String)>,
}

impl Text {
    /// The arguments and the struct of a seed.
    pub(in super::super) fn of(seed: u64) -> (String, String) {
        let mut random = Random::new(seed);
        let mut moves = vec![Moves::Turns];
        for _ in 0..=random.below(2) {
            moves.push([Moves::Turns, Moves::Shifts, Moves::Shifts, Moves::Slides][random.below(4)]);
        }
        let mut text = Self { random, moves, fields: Vec::new(), advected: Vec::new() };
        let l_d = text.lagrangian();
        let bodies = (0..text.moves.len()).map(|body| {
            let group = ["SO3", "R3", "R1"][text.moves[body] as usize];
            format!("{} = {group}", text.increment(body))
        });
        let list = |pairs: &[(String, String)]| {
            let pairs: Vec<String> = pairs.iter().map(|(name, what)| format!("{name} = {what}")).collect();
            pairs.join(", ")
        };
        let advected =
            if text.advected.is_empty() { String::new() } else { format!("advected({}), ", list(&text.advected)) };
        let bodies: Vec<String> = bodies.collect();
        let arguments = format!("group({}), {advected}l_d = {l_d}", bodies.join(", "));
        let fields: Vec<String> = text.fields.iter().map(|(name, ty)| format!("{name}: {ty}")).collect();
        (arguments, format!("struct Bodies {{ {} }}", fields.join(", ")))
    }

    fn increment(&self, body: usize) -> String {
        format!("{}_{}", ["F", "d", "t"][self.moves[body] as usize], body + 1)
    }

    fn of_kind(&mut self, kind: Moves) -> Option<usize> {
        let bodies: Vec<usize> = (0..self.moves.len()).filter(|&body| self.moves[body] == kind).collect();
        if bodies.is_empty() { None } else { Some(bodies[self.random.below(bodies.len())]) }
    }

    fn turning(&mut self) -> usize {
        self.of_kind(Moves::Turns).expect("the first body turns")
    }

    fn field(&mut self, ty: &'static str) -> String {
        let name = format!("p{}", self.fields.len());
        self.fields.push((name.clone(), ty));
        name
    }

    fn constant(&mut self) -> String {
        self.field("Vector3<f64>")
    }

    /// The name of what is advected; nothing where there is no place for it.
    fn advected(&mut self, name: String, what: impl FnOnce(&mut Self) -> String) -> Option<String> {
        if self.advected.iter().all(|(known, _)| *known != name) {
            if self.advected.len() == MOST_ADVECTED {
                return None;
            }
            let what = what(self);
            self.advected.push((name.clone(), what));
        }
        Some(name)
    }

    /// A field that a body sees.
    fn seen_field(&mut self, body: usize) -> Option<String> {
        let increment = self.increment(body);
        self.advected(format!("w_{}", body + 1), |text| format!("{}.seen_from({increment})", text.constant()))
    }

    /// What brings a vector from one body to another.
    fn relative(&mut self, of: usize, from: usize) -> Option<String> {
        let name = |of: usize, from: usize| format!("Q_{}{}", from + 1, of + 1);
        if self.advected.iter().any(|(known, _)| *known == name(from, of)) {
            return Some(format!("{}.transpose()", name(from, of)));
        }
        let what = format!("{}.seen_from({})", self.increment(of), self.increment(from));
        self.advected(name(of, from), |_| what)
    }

    /// The attitude of a body, or its place.
    fn in_space(&mut self, body: usize) -> Option<String> {
        let what = format!("{}.seen_from(space)", self.increment(body));
        let letter = ["R", "x", "y"][self.moves[body] as usize];
        self.advected(format!("{letter}_{}", body + 1), |_| what)
    }

    /// In space, of what is translated: where it is, how far it goes, and where it is from another.
    fn place(&mut self) -> Option<String> {
        let body = self.of_kind(Moves::Shifts)?;
        let other = (0..self.moves.len()).find(|&other| other != body && self.moves[other] == Moves::Shifts);
        match (self.random.below(3), other) {
            (0, _) => Some(self.increment(body)),
            (1, Some(other)) => {
                let what = format!("{}.seen_from({})", self.increment(body), self.increment(other));
                self.advected(format!("r_{}{}", other + 1, body + 1), |_| what)
            }
            _ => self.in_space(body),
        }
    }

    /// A vector that a body sees, or that space does.
    fn vector(&mut self, seen: Option<usize>, depth: usize) -> String {
        let choice = self.random.below(if depth == 0 { 2 } else { 9 });
        let deeper = |text: &mut Self, seen| text.vector(seen, depth - 1);
        let found = match (seen, choice) {
            (Some(body), 0) => self.seen_field(body),
            (None, 0) => self.place(),
            (_, 1) => None,
            (_, 2) => Some(format!("({} - {})", deeper(self, seen), deeper(self, seen))),
            (_, 3) => Some(format!("{}.cross(&{})", deeper(self, seen), deeper(self, seen))),
            (_, 4) => Some(format!("({} * {})", self.field("Matrix3<f64>"), deeper(self, seen))),
            (Some(body), 5 | 6) => {
                let turned = if self.random.below(2) == 0 { "" } else { ".transpose()" };
                Some(format!("({}{turned} * {})", self.increment(body), deeper(self, seen)))
            }
            (Some(body), 7) => {
                let of = self.turning();
                let relative = if of == body { None } else { self.relative(of, body) };
                relative.map(|relative| format!("({relative} * {})", deeper(self, Some(of))))
            }
            (Some(body), _) => {
                self.in_space(body).map(|attitude| format!("({attitude}.transpose() * {})", deeper(self, None)))
            }
            (None, _) => {
                let body = self.turning();
                self.in_space(body).map(|attitude| format!("({attitude} * {})", deeper(self, Some(body))))
            }
        };
        found.unwrap_or_else(|| self.constant())
    }

    fn any_vector(&mut self, depth: usize) -> String {
        let seen = if self.random.below(3) == 0 { None } else { Some(self.turning()) };
        self.vector(seen, depth)
    }

    fn product(&mut self, depth: usize) -> String {
        let seen = if self.random.below(3) == 0 { None } else { Some(self.turning()) };
        format!("{}.dot(&{})", self.vector(seen, depth), self.vector(seen, depth))
    }

    /// A trace of what relates two bodies at either end of a step, or of one.
    fn trace(&mut self) -> String {
        let (a, b) = (self.turning(), self.turning());
        let (first, second, matrix) = (self.increment(a), self.increment(b), self.field("Matrix3<f64>"));
        match (self.random.below(3), if a == b { None } else { self.relative(b, a) }) {
            (0, Some(relative)) => format!("({relative} * {matrix}).trace()"),
            (_, Some(relative)) => format!("({first}.transpose() * {relative} * {second} * {matrix}).trace()"),
            (0, None) => format!("({first} * {matrix}).trace()"),
            (_, None) => match self.in_space(a) {
                Some(attitude) => format!("({attitude} * {first} * {matrix}).trace()"),
                None => format!("(inverse({first}) * {matrix}).trace()"),
            },
        }
    }

    fn scalar(&mut self, depth: usize) -> String {
        match self.random.below(if depth == 0 { 4 } else { 9 }) {
            0 | 1 => self.product(2),
            2 => self.trace(),
            3 => match self.of_kind(Moves::Slides) {
                Some(body) => match self.in_space(body) {
                    Some(place) => format!("({place} + {})", self.increment(body)),
                    None => self.increment(body),
                },
                None => self.product(1),
            },
            4 => format!("({}).powi(2)", self.scalar(depth - 1)),
            5 => format!("({}).{}()", self.scalar(depth - 1), ["sin", "cos"][self.random.below(2)]),
            6 => format!("(1.0 + {}.norm_squared()).sqrt()", self.any_vector(2)),
            7 => format!("(0.1 * {}).exp()", self.scalar(depth - 1)),
            _ => format!("{} * {}", self.scalar(depth - 1), self.scalar(depth - 1)),
        }
    }

    /// Squares of increments, and what couples two of them.
    fn kinetic(&mut self) -> String {
        let mut sum = String::new();
        for body in 0..self.moves.len() {
            let f = self.increment(body);
            let own = match self.moves[body] {
                Moves::Turns => {
                    let inertia = self.field("NonstandardInertia");
                    format!("(({f} - I) * {inertia} * ({f} - I).transpose()).trace()")
                }
                Moves::Shifts => format!("{} * {f}.norm_squared()", self.field("f64")),
                Moves::Slides => format!("{} * {f}.powi(2)", self.field("f64")),
            };
            let _ = write!(sum, "{}{own} / (2.0 * h)", if body == 0 { "" } else { " + " });
        }
        let (a, b) = (self.turning(), self.turning());
        let (first, second) = (self.increment(a), self.increment(b));
        if let Some(relative) = if a == b { None } else { self.relative(b, a) } {
            let coupling = if self.random.below(2) == 0 {
                let (r, s) = (self.constant(), self.constant());
                format!("(({first} - I) * {r}).dot(&({relative} * (({second} - I) * {s})))")
            } else {
                format!("vee({first}).dot(&({relative} * vee({second} - {second}.transpose())))")
            };
            let _ = write!(sum, " + 0.1 * {coupling} / h");
        }
        if let Some(body) = self.of_kind(Moves::Shifts)
            && let Some(attitude) = self.in_space(a)
        {
            let (d, s) = (self.increment(body), self.constant());
            let _ = write!(sum, " - 0.1 * {d}.dot(&({attitude} * (({first} - I) * {s}))) / h");
        }
        if let Some(body) = self.of_kind(Moves::Slides) {
            let (t, s) = (self.increment(body), self.constant());
            let _ = write!(sum, " + 0.1 * {t} * {s}.dot(&vee({first})) / h");
        }
        if self.random.below(2) == 0
            && let Some(w) = self.seen_field(a)
        {
            let s = self.constant();
            let _ = write!(sum, " + 0.1 * {w}.dot(&(({first} - I) * {s})).powi(2) / h");
        }
        sum
    }

    fn lagrangian(&mut self) -> String {
        let mut sum = self.kinetic();
        for _ in 0..=self.random.below(3) {
            let _ = write!(sum, " - h * {} * {}", self.field("f64"), self.scalar(1));
        }
        match self.random.below(3) {
            0 => sum,
            // The same function of both ends of a step.
            1 => {
                let (s, ends) = (self.constant(), [0, 1].map(|_| self.any_vector(2)));
                format!(
                    "{{ let U = |y: Vector3<f64>| {{ let z = y.dot(&{s}); (1.0 + y.norm_squared()).sqrt() * z }}; \
                     {sum} + 0.5 * h * (U({}) + U({})) }}",
                    ends[0], ends[1]
                )
            }
            _ => {
                let body = self.turning();
                let (y, z) = (self.vector(Some(body), 2), self.vector(Some(body), 1));
                format!("{{ let y = {y}; let z = y - {z}; {sum} - h * y.dot(&z).sin() * z.norm_squared() }}")
            }
        }
    }
}
