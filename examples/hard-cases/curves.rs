//! What the rows leave for the figure.

use plotters::style::RGBColor;

/// A line with its name.
pub struct Curve {
    pub name: &'static str,
    pub colour: RGBColor,
    pub points: Vec<(f64, f64)>,
}

/// The lines of each panel.
#[derive(Default)]
pub struct Curves {
    /// Energy over its initial value against time: a box, the same about its middle axis, and spun fast.
    pub energies: Vec<(&'static str, Vec<Curve>)>,
    /// The step where a solution is sure, the fold, and where there surely is none, s.
    pub limits: [f64; 3],
    /// Angle of the first step in degrees against the step.
    pub angles: Vec<Curve>,
    /// Newton iterations of the first step against the step.
    pub iterations: Vec<Curve>,
    /// Drift of the energy against the logarithm of the tolerance.
    pub tolerance: Vec<Curve>,
    /// Defects against the logarithm of the number of steps.
    pub orthogonality: Vec<Curve>,
    pub casimirs: Vec<Curve>,
    pub composed: Vec<Curve>,
}

impl Curves {
    pub fn is_empty(&self) -> bool {
        self.energies.is_empty()
            && [&self.angles, &self.tolerance, &self.orthogonality, &self.composed].iter().all(|lines| lines.is_empty())
    }
}
