//! What has become of the members of an ensemble, counted from their files.

use std::collections::BTreeSet;
use std::fmt;

use liestep_ensemble::{MemberFailure, Shard, Status};

/// The most failures that are printed; all are in the files.
const SHOWN: usize = 10;

/// Members by what has become of them, and by what has happened to them.
#[derive(Default)]
pub(crate) struct Tally {
    finished: u64,
    /// Ended by an event.
    left: u64,
    /// Made, but not to their ends.
    pub(crate) stopped: u64,
    /// That couldn't be made, such as bodies with moments of inertia that no body has.
    pub(crate) impossible: u64,
    /// The first of these.
    pub(crate) unmade: Option<MemberFailure>,
    /// Of those that stopped.
    pub(crate) failures: Vec<MemberFailure>,
    pub(crate) events: Vec<Happened>,
}

/// An event in all members that came to an end.
#[derive(Clone, Default)]
pub(crate) struct Happened {
    members: u64,
    times: u64,
    /// The sum, the least and the largest of the first times, s.
    first: (f64, f64, f64),
}

impl Tally {
    pub(crate) fn of(events: usize) -> Self {
        let nothing = Happened { first: (0.0, f64::INFINITY, f64::NEG_INFINITY), ..Happened::default() };
        Self { events: vec![nothing; events], ..Self::default() }
    }

    pub(crate) fn add(&mut self, shard: Shard) {
        let rows = shard.rows;
        let (mut ended, mut unmade) = (BTreeSet::new(), BTreeSet::new());
        for (member, status) in rows.member.iter().zip(&rows.status) {
            match status {
                Status::Going => continue,
                Status::Finished => self.finished += 1,
                Status::Left => self.left += 1,
                Status::Stopped => self.stopped += 1,
                Status::Impossible => _ = unmade.insert(*member),
            }
            if matches!(status, Status::Finished | Status::Left) {
                ended.insert(*member);
            }
        }
        for (event, crossings) in self.events.iter_mut().zip(&rows.crossings) {
            let mut last = None;
            // Of the columns the first is the time.
            for (row, time) in crossings.row.iter().zip(crossings.columns.iter().flatten()) {
                let member = rows.member[*row];
                if !ended.contains(&member) {
                    continue;
                }
                event.times += 1;
                if last.replace(member) != Some(member) {
                    let (sum, least, largest) = event.first;
                    event.members += 1;
                    event.first = (sum + time, least.min(*time), largest.max(*time));
                }
            }
        }
        self.impossible += unmade.len() as u64;
        let (impossible, stopped): (Vec<_>, Vec<_>) =
            shard.failures.into_iter().partition(|failure| unmade.contains(&failure.member));
        self.unmade = self.unmade.take().or_else(|| impossible.into_iter().next());
        self.failures.extend(stopped.into_iter().take(SHOWN - self.failures.len()));
    }

    /// How likely an event is, in a line.
    #[allow(clippy::cast_precision_loss)] // counts
    pub(crate) fn of_event(&self, name: &str, event: &Happened) -> String {
        let all = self.finished + self.left;
        if all == 0 {
            return String::new();
        }
        let (sum, least, largest) = event.first;
        let share = event.members as f64 / all as f64;
        let [from, to] = wilson(event.members as f64, all as f64);
        let Happened { members, times, .. } = event;
        let often = if times > members { format!("{times} times ") } else { String::new() };
        let first = if *members > 0 {
            let digits = |time: f64| format!("{time:.6e}").parse().unwrap_or(time);
            let [mean, least, largest] = [sum / *members as f64, least, largest].map(digits);
            format!("; first at {mean} s in the mean, from {least} to {largest} s")
        } else {
            String::new()
        };
        format!(
            "  {name}: {often}in {members} of {all} members; probability {share:.4}, with 95 % from {from:.4} to {to:.4}{first}\n"
        )
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { finished, left, stopped, impossible, .. } = self;
        let ended = if *left > 0 { format!("{left} ended by an event, ") } else { String::new() };
        write!(f, "{finished} finished, {ended}{stopped} broke down, {impossible} can't exist")
    }
}

/// The interval of a probability, of confidence 95 %, after an event has happened in some of all trials.
///
/// E. B. Wilson, Probable inference, the law of succession, and statistical inference, Journal of the American Statistical
/// Association 22 (1927).
fn wilson(some: f64, all: f64) -> [f64; 2] {
    /// That quantile of the normal distribution.
    const Z: f64 = 1.959_963_984_540_054;
    let (share, z) = (some / all, Z * Z / all);
    let middle = share + 0.5 * z;
    let half = (z * (share * (1.0 - share) + 0.25 * z)).sqrt();
    // At both ends of the range it is exact, but for rounding.
    [(middle - half) / (1.0 + z), (middle + half) / (1.0 + z)].map(|end| end.clamp(0.0, 1.0))
}
