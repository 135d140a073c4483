//! A row of the table: a claim, what was measured for it, and whether that satisfies it.

use std::error::Error;

/// Why a row couldn't be measured at all.
pub type Failure = Box<dyn Error>;

/// How many steps the long rows take.
#[derive(Clone, Copy)]
pub struct Effort {
    pub long: bool,
    /// Nothing beside what the criterion asks for: neither others nor variants.
    pub verdict_only: bool,
}

impl Effort {
    /// So many steps of what is only shown, or none.
    pub fn beside(self, steps: u64) -> u64 {
        if self.verdict_only { 0 } else { steps }
    }

    /// The one number of steps, or with `--long` the other.
    pub fn steps(self, default: u64, long: u64) -> u64 {
        if self.long { long } else { default }
    }
}

/// One claim.
pub struct Row {
    pub id: &'static str,
    pub case: &'static str,
    pub criterion: &'static str,
    /// What was measured, and of what missed its bound also that.
    pub ours: Vec<String>,
    pub others: Vec<String>,
    pub is_met: bool,
}

impl Row {
    pub fn new(id: &'static str, case: &'static str, criterion: &'static str) -> Self {
        Self { id, case, criterion, ours: Vec::new(), others: Vec::new(), is_met: true }
    }

    /// A size that must not exceed a bound. NaN misses it.
    pub fn at_most(self, what: &str, size: f64, bound: f64) -> Self {
        self.judged(&format!("{what} {}", short(size)), size <= bound, &format!("above {}", short(bound)))
    }

    /// A value that must be as near to the expected one as said.
    pub fn near(self, what: &str, value: f64, expected: f64, allowed: f64) -> Self {
        let is_near = (value - expected).abs() <= allowed;
        self.judged(&format!("{what} {value:.6}"), is_near, &format!("not {expected}"))
    }

    /// Something that must be so.
    pub fn holds(self, what: &str, is_so: bool) -> Self {
        self.judged(what, is_so, "not so")
    }

    /// Something that the criterion doesn't speak of.
    pub fn shows(mut self, what: impl Into<String>) -> Self {
        self.ours.push(what.into());
        self
    }

    /// What another method does.
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

/// A size in two digits, or three where it needs no power of ten.
pub fn short(size: f64) -> String {
    if size == 0.0 || (0.1..1e4).contains(&size.abs()) {
        workbench::table::short(format!("{size:.2e}").parse().unwrap_or(size))
    } else {
        workbench::table::number(size)
    }
}
