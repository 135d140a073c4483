//! Tables of the cost of an accuracy.

use std::fmt::Write as _;
use std::path::Path;

use liestep_refinement::Refinement;
use workbench::table::aligned;

use crate::methods::{Family, Method};

/// The errors in the tables.
pub const ERRORS: [f64; 6] = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12];

/// A method and its measured runs.
pub struct MethodRuns {
    pub name: String,
    pub family: Family,
    pub runs: Refinement,
}

impl MethodRuns {
    pub fn new(method: &Method, runs: Refinement) -> Self {
        Self { name: method.name.clone(), family: method.family, runs }
    }

    /// The least time to an error, s.
    pub fn cost(&self, error: f64) -> Option<f64> {
        self.runs.seconds_to(error)
    }
}

/// The cheapest of a family for an error, and its cost, s.
fn cheapest(methods: &[MethodRuns], family: Family, error: f64) -> Option<(&str, f64)> {
    let costs = methods.iter().filter(|method| method.family == family);
    costs.filter_map(|method| Some((method.name.as_str(), method.cost(error)?))).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Microseconds, to two digits.
pub(crate) fn microseconds(cost: f64) -> String {
    let value = cost * 1e6;
    if value < 9.95 { format!("{value:.1}") } else { format!("{value:.0}") }
}

/// Microseconds to each error, a method a row.
pub fn costs(methods: &[MethodRuns]) -> String {
    let heading = core::iter::once("µs to an error of".to_owned()).chain(ERRORS.map(|error| format!("{error:.0e}")));
    let mut rows = vec![heading.collect::<Vec<_>>()];
    for method in methods {
        let costs = ERRORS.map(|error| method.cost(error).map_or_else(|| "–".to_owned(), microseconds));
        rows.push(core::iter::once(method.name.clone()).chain(costs).collect());
    }
    aligned(&rows)
}

/// The cheapest of our methods for each error, beside the cheapest rival.
pub fn best(methods: &[MethodRuns]) -> String {
    let mut rows = vec![["error", "Poisson", "µs", "best rival", "µs", "ratio"].map(str::to_owned).to_vec()];
    for error in ERRORS {
        let (ours, rival) = (cheapest(methods, Family::Poisson, error), cheapest(methods, Family::Rival, error));
        let cell = |found: Option<(&str, f64)>| {
            found.map_or_else(|| ["–".to_owned(), "–".to_owned()], |(name, cost)| [name.to_owned(), microseconds(cost)])
        };
        let ratio = ours.zip(rival).map_or_else(|| "–".to_owned(), |(ours, rival)| format!("{:.2}", ours.1 / rival.1));
        let [name, cost] = cell(ours);
        let [rival, rival_cost] = cell(rival);
        rows.push(vec![format!("{error:.0e}"), name, cost, rival, rival_cost, ratio]);
    }
    aligned(&rows)
}

/// The table of the examples' page: our cheapest Poisson method's time as a multiple of the fastest rival's, a scene a row.
pub fn ratios(results: &[(String, Vec<MethodRuns>)]) -> String {
    let errors = ERRORS.map(|error| format!("{error:.0e}")).join(" | ");
    let mut text = format!("| error of attitude and velocity | {errors} |\n|---|---|---|---|---|---|---|\n");
    for (title, methods) in results {
        let ratios = ERRORS.map(|error| {
            let cost = |family| cheapest(methods, family, error).map(|(_, cost)| cost);
            let ratio = cost(Family::Poisson).zip(cost(Family::Rival)).map(|(ours, rival)| ours / rival);
            ratio.map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.2}"))
        });
        // Writing to a string can't fail.
        let _ = writeln!(text, "| {title} | {} |", ratios.join(" | "));
    }
    text
}

/// Replaces the table of ratios in the examples' page, and README's figure; in a build for registers of 256 bits the second
/// table alone.
///
/// # Errors
///
/// A page without such a table, or one that can't be read or written.
pub fn put_into_readme(table: &str, figure: &str) -> Result<(), std::io::Error> {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let place = examples.join("README.md");
    let page = std::fs::read_to_string(&place)?;
    let heading = table.lines().next().unwrap_or_default();
    let is_second = cfg!(liestep_256_bits);
    let (at, _) = page
        .match_indices(heading)
        .nth(usize::from(is_second))
        .ok_or_else(|| std::io::Error::other("the page has no such table of ratios"))?;
    let after = page[at..].lines().skip_while(|line| line.starts_with('|'));
    let lines: Vec<&str> = table.lines().chain(after).collect();
    std::fs::write(place, page[..at].to_owned() + &lines.join("\n") + "\n")?;
    if is_second { Ok(()) } else { std::fs::write(examples.join("figures/accuracy-cost.svg"), figure) }
}

/// All runs of all methods in a machine-readable form.
#[derive(Default)]
pub struct Data(String);

impl Data {
    /// Adds the runs of a scene over a time, s.
    pub fn add(&mut self, scene: &str, t: f64, methods: &[MethodRuns]) {
        for MethodRuns { name, runs, .. } in methods {
            let name = name.replace(',', " +");
            for line in runs.to_csv().lines().skip(1) {
                // Writing to a string can't fail.
                let _ = writeln!(self.0, "{scene},{t},{name},{line}");
            }
        }
    }

    /// One line for each run.
    pub fn to_csv(&self) -> String {
        let columns = Refinement::default().to_csv();
        format!("scene,time,method,{columns}{}", self.0)
    }
}
