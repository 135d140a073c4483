//! A chunk: a pure function of the plan and a number.

use core::ops::Range;

use liestep::motion::Integrator;

use crate::ensemble::{Ensemble, Run};
use crate::failure::Failed;
use crate::group::Start;
use crate::reduce::Reduced;
use crate::shard::{Rows, Shard, Status};

impl<M: Integrator> Ensemble<M> {
    /// The members of a chunk.
    pub(crate) fn range(&self, chunk: u64) -> Range<u64> {
        let size = self.members_of_chunk();
        chunk * size..((chunk + 1) * size).min(self.members)
    }

    /// What is kept of the members of a chunk: the same for the same plan and number, whoever computes it. `None` if it is
    /// told to stop on the way, which is asked between members and after each [piece](Self::PIECE) of their steps.
    pub fn chunk(&self, chunk: u64, is_stopped: &dyn Fn() -> bool) -> Option<Shard> {
        self.shard(self.fingerprint(), chunk, is_stopped)
    }

    pub(crate) fn shard(&self, plan: u64, chunk: u64, is_stopped: &dyn Fn() -> bool) -> Option<Shard> {
        let members = self.range(chunk);
        let mut made = Made {
            rows: Rows::of_columns(self.names.len()),
            finished: 0,
            failures: Vec::new(),
            reduced: self.reductions.iter().map(|(_, reduction, _)| reduction.begin()).collect(),
        };
        // Those that can't be made are taken out first, so that they leave no lane empty.
        let mut waiting: Vec<(u64, Option<Failed>)> = Vec::new();
        let mut starts: Vec<Start<M>> = Vec::new();
        for member in members {
            if is_stopped() {
                return None;
            }
            let start = (self.make)(&self.member(member));
            let impossible = start.map(|start| starts.push(start)).err();
            waiting.push((member, impossible.map(|failure| Failed { member, steps: 0, failure })));
            if starts.len() == crate::group::LANES {
                self.move_on(&mut waiting, &mut starts, &mut made, is_stopped)?;
            }
        }
        self.move_on(&mut waiting, &mut starts, &mut made, is_stopped)?;
        let Made { rows, finished, failures, reduced } = made;
        Some(Shard { plan, chunk, names: self.names.clone(), rows, finished, failures, reduced })
    }

    /// Runs those that are waiting to their ends, in lanes, and writes down what is kept of them in their order. `None` if
    /// it is told to stop.
    fn move_on(
        &self,
        waiting: &mut Vec<(u64, Option<Failed>)>,
        starts: &mut Vec<Start<M>>,
        made: &mut Made,
        is_stopped: &dyn Fn() -> bool,
    ) -> Option<()> {
        let possible: Vec<u64> =
            waiting.iter().filter(|(_, failed)| failed.is_none()).map(|(member, _)| *member).collect();
        let mut kept: Vec<Rows> = possible.iter().map(|_| Rows::of_columns(self.names.len())).collect();
        let mut ends: Vec<Result<Vec<f64>, Failed>> = Vec::with_capacity(possible.len());
        let mut first = 0;
        for (mut group, count) in (self.grouped)(starts) {
            let here = first..first + count;
            let mut keep = |group: &dyn crate::group::Group<M>, steps: u64| {
                for place in here.clone().filter(|place| group.error(place - here.start).is_none()) {
                    let state = group.state(place - here.start);
                    let run = Run { member: possible[place], stepper: &starts[place].0, state: &state };
                    self.keep_row(&run, steps, Status::Going, &mut kept[place]);
                }
            };
            let mut steps = 0;
            if self.every.is_some() {
                keep(&*group, 0);
            }
            while steps < self.steps {
                let due = self.every.map_or(self.steps, |every| ((steps / every + 1) * every).min(self.steps));
                while steps < due {
                    if is_stopped() {
                        return None;
                    }
                    let piece = Self::PIECE.min(due - steps);
                    group.run(piece);
                    steps += piece;
                }
                if steps < self.steps {
                    keep(&*group, steps);
                }
            }
            for place in here.clone() {
                let (member, stepper, state) = (possible[place], &starts[place].0, group.state(place - here.start));
                let run = Run { member, stepper, state: &state };
                let made = state.steps() - starts[place].1.steps();
                match group.error(place - here.start) {
                    None => {
                        self.keep_row(&run, made, Status::Finished, &mut kept[place]);
                        ends.push(Ok(self.reductions.iter().map(|(_, _, value)| value(&run)).collect()));
                    }
                    Some(error) => {
                        self.keep_row(&run, made, Status::Stopped, &mut kept[place]);
                        ends.push(Err(Failed { member, steps: made, failure: error.into() }));
                    }
                }
            }
            first += count;
        }
        let mut moved = kept.into_iter().zip(ends);
        for (member, impossible) in waiting.drain(..) {
            if let Some(failed) = impossible {
                made.rows.push(member, 0, Status::Impossible, core::iter::repeat_n(f64::NAN, self.names.len()));
                made.failures.push(failed);
                continue;
            }
            let Some((rows, end)) = moved.next() else { continue };
            made.rows.append(rows);
            match end {
                Ok(values) => {
                    made.finished += 1;
                    made.reduced.iter_mut().zip(values).for_each(|(reduced, value)| reduced.add(value));
                }
                Err(failed) => made.failures.push(failed),
            }
        }
        starts.clear();
        Some(())
    }

    /// One row for a member and a step: one that ends where it was last kept has a last row already.
    fn keep_row(&self, run: &Run<'_, M>, steps: u64, status: Status, rows: &mut Rows) {
        if rows.step.last() == Some(&steps) {
            rows.status.pop();
            rows.status.push(status);
            return;
        }
        let mut row = Vec::with_capacity(self.names.len());
        self.columns.iter().for_each(|values| values(run, &mut row));
        rows.push(run.member, steps, status, row.into_iter());
    }
}

/// What there is of a chunk so far.
struct Made {
    rows: Rows,
    finished: u64,
    failures: Vec<Failed>,
    reduced: Vec<Reduced>,
}
