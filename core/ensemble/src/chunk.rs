//! A chunk: a pure function of the plan and a number.

use core::ops::Range;

use liestep::motion::Integrator;

use crate::ensemble::{Ensemble, Run};
use crate::failure::{Failure, MemberFailure};
use crate::group::{Group, Start};
use crate::outcome::Outcome;
use crate::section::{Crossing, Place, Watch};
use crate::shard::{Crossings, Rows, Shard, Status};

impl<M: Integrator> Ensemble<M> {
    pub(crate) fn range(&self, chunk: u64) -> Range<u64> {
        let end = |chunk: u64| self.sizes().first(chunk).min(self.members);
        end(chunk)..end(chunk.saturating_add(1))
    }

    /// The recorded rows and the outcome of a chunk, a function of the plan and the number. `None` after a request to
    /// stop; `is_stopped` is called between members and after each [piece](Self::PIECE) of their steps, with sections
    /// after each step.
    pub fn chunk(&self, chunk: u64, is_stopped: &dyn Fn() -> bool) -> Option<Shard> {
        let members = self.range(chunk);
        let (sample, count) = (self.sample(chunk), members.end - members.start);
        let mut made = Tally { rows: self.no_rows(), outcome: self.nothing() };
        // Members that can't be constructed are set apart first, so that they leave no lane empty.
        let mut waiting: Vec<(u64, Option<MemberFailure>)> = Vec::new();
        let mut starts: Vec<Start<M>> = Vec::new();
        for member in members {
            if is_stopped() {
                return None;
            }
            let start = (self.make)(&self.member(member));
            let impossible = start.map(|start| starts.push(start)).err();
            waiting
                .push((member, impossible.map(|failure| MemberFailure { member, steps: 0, was_made: false, failure })));
            if starts.len() == crate::section::LANES {
                self.move_on(&mut waiting, &mut starts, &mut made, is_stopped)?;
            }
        }
        self.move_on(&mut waiting, &mut starts, &mut made, is_stopped)?;
        let Tally { rows, outcome } = made;
        Some(Shard {
            plan: self.fingerprint(),
            chunk,
            members: count,
            sample,
            names: self.names.clone(),
            rows,
            outcome,
        })
    }

    /// Runs the waiting members to their ends, in lanes, and adds their rows and outcomes in their order. `None` after
    /// a request to stop.
    fn move_on(
        &self,
        waiting: &mut Vec<(u64, Option<MemberFailure>)>,
        starts: &mut Vec<Start<M>>,
        made: &mut Tally,
        is_stopped: &dyn Fn() -> bool,
    ) -> Option<()> {
        let possible: Vec<u64> =
            waiting.iter().filter(|(_, failed)| failed.is_none()).map(|(member, _)| *member).collect();
        let mut courses: Vec<Course<M>> = starts.iter().map(|start| self.course(start)).collect();
        let mut first = 0;
        for (mut group, count) in (self.grouped)(starts) {
            let here = first..first + count;
            let (members, courses) = (&possible[here.clone()], &mut courses[here.clone()]);
            self.run_group(&mut *group, members, &starts[here], courses, is_stopped)?;
            first += count;
        }
        let mut moved = courses.into_iter();
        let Tally { rows: all, outcome } = made;
        for (member, impossible) in waiting.drain(..) {
            if let Some(failed) = impossible {
                all.push(member, 0, Status::Impossible, core::iter::repeat_n(f64::NAN, self.names.len()));
                outcome.impossible += 1;
                outcome.failures.push(failed);
                continue;
            }
            let Some(Course { rows, reduced, passed, end, .. }) = moved.next() else { continue };
            all.append(rows);
            for (number, value) in reduced {
                outcome.reduced[number].add(value);
            }
            match end {
                Err(failed) => {
                    outcome.stopped += 1;
                    outcome.failures.push(failed);
                    continue;
                }
                Ok(None) => outcome.left += 1,
                Ok(Some(values)) => {
                    outcome.finished += 1;
                    outcome.reduced.iter_mut().zip(values).for_each(|(reduced, value)| reduced.add(value));
                }
            }
            for (passages, (times, first)) in
                outcome.passages.iter_mut().zip(passed).filter(|(_, (times, _))| *times > 0)
            {
                passages.times += times;
                passages.first.add(first);
            }
        }
        starts.clear();
        Some(())
    }

    /// Runs a group of members to their ends. `None` after a request to stop.
    fn run_group(
        &self,
        group: &mut dyn Group<M>,
        members: &[u64],
        starts: &[Start<M>],
        courses: &mut [Course<M>],
        is_stopped: &dyn Fn() -> bool,
    ) -> Option<()> {
        // Sections are checked after each step.
        let longest = if self.sections.is_empty() { Self::PIECE } else { 1 };
        let going = |group: &dyn Group<M>, place: usize, course: &Course<M>| {
            group.error(place).is_none() && course.ended.is_none()
        };
        let mut steps = 0;
        while steps < self.steps && (courses.iter().enumerate()).any(|(place, course)| going(&*group, place, course)) {
            if self.every.is_some_and(|every| steps.is_multiple_of(every)) {
                for (place, course) in courses.iter_mut().enumerate() {
                    if going(&*group, place, course) {
                        let (member, stepper, state) = (members[place], &starts[place].0, &group.state(place));
                        self.keep_row(&Run { member, stepper, state }, steps, Status::Going, &mut course.rows);
                    }
                }
            }
            let due = self.every.map_or(self.steps, |every| ((steps / every + 1) * every).min(self.steps));
            while steps < due {
                if is_stopped() {
                    return None;
                }
                let piece = longest.min(due - steps);
                group.run(piece);
                steps += piece;
                if self.sections.is_empty() {
                    continue;
                }
                let values: Vec<_> = self.sections.iter().map(|section| group.values(section)).collect();
                for (place, course) in courses.iter_mut().enumerate() {
                    if going(&*group, place, course) {
                        let (before, now) = (|| group.before(place), || group.state(place));
                        let value = |section: usize| values[section].map(|values| values[place]);
                        let at = |section: usize| Place { value: value(section), before: &before, now: &now };
                        self.look_at_sections(&starts[place].0, &at, course, false);
                    }
                }
            }
        }
        for (place, course) in courses.iter_mut().enumerate() {
            let (member, (stepper, start)) = (members[place], &starts[place]);
            if course.ended.is_none() {
                // All steps have been checked, but for a zero at the last.
                let now = || group.state(place);
                self.look_at_sections(stepper, &|_| Place { value: None, before: &now, now: &now }, course, true);
            }
            let error = group.error(place).map(Failure::from);
            let has_left = course.ended.as_ref().is_some_and(|(_, why)| why.is_none());
            let (state, failure) = course.ended.take().unwrap_or_else(|| (group.state(place), error));
            let run = Run { member, stepper, state: &state };
            let made = M::steps(&state) - M::steps(start);
            let status = match failure {
                Some(_) => Status::Stopped,
                None if has_left => Status::Left,
                None => Status::Finished,
            };
            self.keep_row(&run, made, status, &mut course.rows);
            let values = || self.reductions.iter().map(|(_, _, value)| value(&run)).collect();
            course.end = match failure {
                None => Ok((!has_left).then(values)),
                Some(failure) => Err(MemberFailure { member, steps: made, was_made: true, failure }),
            };
        }
        Some(())
    }

    fn no_rows(&self) -> Rows {
        let crossings = self.sections.iter().map(|section| Crossings::of_names(&section.names)).collect();
        Rows::of_columns(self.names.len(), crossings)
    }

    fn course(&self, (stepper, start): &Start<M>) -> Course<M> {
        let watches: Result<_, _> = self.sections.iter().map(|section| section.watch(stepper, start)).collect();
        let (watches, ended) = match watches {
            Ok(watches) => (watches, None),
            Err(failure) => (Vec::new(), Some((start.clone(), Some(failure)))),
        };
        let passed = vec![(0, 0.0); self.sections.len()];
        Course { rows: self.no_rows(), watches, reduced: Vec::new(), passed, ended, end: Ok(None) }
    }

    /// Records the crossings of sections up to this time, which belong to the next row. Crossings after a member leaves
    /// are dropped.
    fn look_at_sections<'a>(
        &self,
        stepper: &M,
        at: &dyn Fn(usize) -> Place<'a, M::State>,
        course: &mut Course<M>,
        is_last: bool,
    ) {
        let (mut found, mut left) = (Vec::new(), f64::INFINITY);
        for (number, (section, watch)) in self.sections.iter().zip(&mut course.watches).enumerate() {
            match section.look(watch, stepper, &at(number), is_last) {
                Ok(crossings) => {
                    if section.ends {
                        left = crossings.first().map_or(left, |crossing| left.min(crossing.time.abs()));
                    }
                    found.push(crossings);
                }
                Err(failure) => {
                    course.ended = Some(((at(number).now)(), Some(failure)));
                    break;
                }
            }
        }
        let mut first = self.reductions.len();
        let kept = course.rows.crossings.iter_mut().zip(&mut course.passed);
        for ((section, crossings), (kept, (times, earliest))) in self.sections.iter().zip(found).zip(kept) {
            for Crossing { time, columns, reduced } in crossings.into_iter().filter(|it| it.time.abs() <= left) {
                if *times == 0 {
                    *earliest = time;
                }
                *times += 1;
                kept.push(course.rows.member.len(), &columns);
                course.reduced.extend((first..).zip(reduced));
            }
            first += section.reductions.len();
        }
        if left.is_finite() && course.ended.is_none() {
            course.ended = Some(((at(0).now)(), None));
        }
    }

    /// Adds a row for a member and a step. If its last row is of this step, only the status of that row changes.
    fn keep_row(&self, run: &Run<'_, M>, steps: u64, status: Status, rows: &mut Rows) {
        if rows.step.last() == Some(&steps) {
            rows.status.pop();
            rows.status.push(status);
            // Crossings found after the last row was written are not later than that row.
            let last = rows.member.len() - 1;
            rows.crossings.iter_mut().flat_map(|crossings| &mut crossings.row).for_each(|row| *row = last.min(*row));
            return;
        }
        let mut row = Vec::with_capacity(self.names.len());
        self.columns.iter().for_each(|values| values(run, &mut row));
        rows.push(run.member, steps, status, row.into_iter());
    }
}

/// The result of a chunk so far.
struct Tally {
    rows: Rows,
    outcome: Outcome,
}

/// The result of a member so far.
struct Course<M: Integrator> {
    rows: Rows,
    /// The searches for crossings, one for each section.
    watches: Vec<Watch<M::State>>,
    /// The values that sections reduce, with the number of the reduction.
    reduced: Vec<(usize, f64)>,
    /// The number of crossings of each section, and the time of the first, s.
    passed: Vec<(u64, f64)>,
    /// The state at which a section ended the member: it left, or failed, as the function had no value.
    ended: Option<(M::State, Option<Failure>)>,
    /// The values at the member's end that are reduced; `None` if the member left.
    end: Result<Option<Vec<f64>>, MemberFailure>,
}
