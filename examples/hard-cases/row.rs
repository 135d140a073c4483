//! A row of the table: a claim, its measurement, and whether the measurement satisfies it.

use std::error::Error;

/// The reason why a row couldn't be measured.
pub type Failure = Box<dyn Error>;

/// The lengths of long rows, and what is computed besides their criteria.
#[derive(Clone, Copy)]
pub struct Effort {
    pub long: bool,
    /// Whether only the criterion is computed, without others and variants.
    pub verdict_only: bool,
}

impl Effort {
    /// This number of steps for measurements without a criterion; zero if only the verdict is computed.
    pub fn beside(self, steps: u64) -> u64 {
        if self.verdict_only { 0 } else { steps }
    }

    /// The number of steps: `default`, or with the option `--long` the number `long`.
    pub fn steps(self, default: u64, long: u64) -> u64 {
        if self.long { long } else { default }
    }
}

/// A claim, its measurement and its verdict.
pub struct Row {
    pub id: &'static str,
    pub case: &'static str,
    pub criterion: &'static str,
    /// The measurements, and for those that missed their bound the bound.
    pub ours: Vec<String>,
    pub others: Vec<String>,
    pub is_met: bool,
}

impl Row {
    pub fn new(id: &'static str, case: &'static str, criterion: &'static str) -> Self {
        Self { id, case, criterion, ours: Vec::new(), others: Vec::new(), is_met: true }
    }

    /// Judges a size that must not exceed a bound. NaN misses it.
    pub fn at_most(self, what: &str, size: f64, bound: f64) -> Self {
        self.judged(&format!("{what} {}", short(size)), size <= bound, &format!("above {}", short(bound)))
    }

    /// Judges a value that must agree with the expected one within `allowed`.
    pub fn near(self, what: &str, value: f64, expected: f64, allowed: f64) -> Self {
        let is_near = (value - expected).abs() <= allowed;
        self.judged(&format!("{what} {value:.6}"), is_near, &format!("not {expected}"))
    }

    /// Judges a statement that must hold.
    pub fn holds(self, what: &str, is_so: bool) -> Self {
        self.judged(what, is_so, "not so")
    }

    /// Adds a measurement without a criterion.
    pub fn shows(mut self, what: impl Into<String>) -> Self {
        self.ours.push(what.into());
        self
    }

    /// Adds a result of another method.
    pub fn other(mut self, what: impl Into<String>) -> Self {
        self.others.push(what.into());
        self
    }

    fn judged(mut self, what: &str, is_met: bool, complaint: &str) -> Self {
        self.is_met &= is_met;
        self.ours.push(if is_met { what.to_owned() } else { format!("{what} ({complaint})") });
        self
    }
}

/// A size with two digits, or three if it needs no power of ten.
pub fn short(size: f64) -> String {
    if size == 0.0 || (0.1..1e4).contains(&size.abs()) {
        workbench::table::short(format!("{size:.2e}").parse().unwrap_or(size))
    } else {
        workbench::table::number(size)
    }
}
