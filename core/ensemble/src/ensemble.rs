//! What is to be computed: members, steps, and what is kept of them.

use core::fmt;
use std::sync::OnceLock;

use liestep::motion::{Batchable, Integrator, Moment};
use simba::simd::AutoF64x8;

use crate::draw::Member;
use crate::group::{Grouping, Start, in_lanes, one_by_one};
use crate::outcome::{Outcome, Passages};
use crate::reduce::{Moments, Reduction};
use crate::section::{LANES, Section};
use crate::{Failure, Table};
use liestep::numbers::Digest;

/// A member at one time: what is kept is computed from it.
#[derive(Debug)]
pub struct Run<'a, M: Integrator> {
    /// The member's number.
    pub member: u64,
    /// Its stepper, with its scene.
    pub stepper: &'a M,
    /// Its state.
    pub state: &'a M::State,
}

type Make<M> = dyn Fn(&Member<'_>) -> Result<Start<M>, Failure> + Send + Sync;
type Value<M> = dyn Fn(&Run<'_, M>) -> f64 + Send + Sync;
type Values<M> = dyn Fn(&Run<'_, M>, &mut Vec<f64>) + Send + Sync;

/// Many motions of one kind: who they are, how long they take, and what is kept of them.
///
/// It is a plan, and is run by [`run`](Self::run). What comes out depends on the plan alone: not on how many threads or
/// processes there are, who of them has what, in which order, or how often a run was interrupted. Each member moves, bit
/// for bit, as its stepper [runs](Integrator::run) it alone, in pieces of [`PIECE`](Self::PIECE) steps from one kept
/// time to the next; but for a splitting pieces don't matter.
pub struct Ensemble<M: Integrator> {
    pub(crate) name: String,
    pub(crate) members: u64,
    pub(crate) steps: u64,
    pub(crate) seed: u64,
    pub(crate) table: Option<Table>,
    pub(crate) every: Option<u64>,
    pub(crate) chunk: Option<u64>,
    pub(crate) make: Box<Make<M>>,
    pub(crate) grouped: Grouping<M>,
    takes_turns: bool,
    pub(crate) names: Vec<String>,
    pub(crate) columns: Vec<Box<Values<M>>>,
    pub(crate) reductions: Vec<(String, Reduction, Box<Value<M>>)>,
    pub(crate) sections: Vec<Section<M>>,
    fingerprint: OnceLock<u64>,
    size: OnceLock<u64>,
}

impl<M: Integrator> Ensemble<M> {
    /// How many steps a member makes between two looks whether it can go on. One that can't makes the last piece again,
    /// step by step.
    pub const PIECE: u64 = 64;

    /// An ensemble of a number of members with a number of steps each, eight members at a time in [lanes](liestep::numbers::Real#lanes).
    ///
    /// The name tells one ensemble from another in the files. `make` is a member's stepper and its start, or why there is
    /// none; it has to give the same each time. Who changes `make` takes another name or another folder: of what it
    /// makes the [fingerprint](Self::fingerprint) sees three members only.
    ///
    /// Scenes are generic over their scalar for that, as the library's are: `Top<f64>` here, declared as `Top<T>`. Of methods,
    /// [`Stepper::new`](liestep::Stepper::new), [`composed`](liestep::Stepper::composed), [`split`](liestep::Stepper::split),
    /// [`processed`](liestep::Stepper::processed), and all of them [`compensated`](liestep::Stepper::compensated), have lanes.
    /// Members of any other scene or method go [`one_by_one`](Self::one_by_one): Gauss collocation and
    /// remedies.
    pub fn new(
        name: &str,
        members: u64,
        steps: u64,
        make: impl Fn(&Member<'_>) -> Result<Start<M>, Failure> + Send + Sync + 'static,
    ) -> Self
    where
        M: Batchable<AutoF64x8> + 'static,
    {
        Self::of(name, members, steps, Box::new(make), in_lanes::<M>, false)
    }

    /// As [`new`](Self::new), for any stepper: members take their turns.
    pub fn one_by_one(
        name: &str,
        members: u64,
        steps: u64,
        make: impl Fn(&Member<'_>) -> Result<Start<M>, Failure> + Send + Sync + 'static,
    ) -> Self
    where
        M: Clone + 'static,
    {
        Self::of(name, members, steps, Box::new(make), one_by_one::<M>, true)
    }

    fn of(name: &str, members: u64, steps: u64, make: Box<Make<M>>, grouped: Grouping<M>, takes_turns: bool) -> Self {
        Self {
            name: name.to_owned(),
            members,
            steps,
            seed: 0,
            table: None,
            every: None,
            chunk: None,
            make,
            grouped,
            takes_turns,
            names: Vec::new(),
            columns: Vec::new(),
            reductions: Vec::new(),
            sections: Vec::new(),
            fingerprint: OnceLock::new(),
            size: OnceLock::new(),
        }
    }

    /// Another plan than before.
    fn changed(self) -> Self {
        Self { fingerprint: OnceLock::new(), size: OnceLock::new(), ..self }
    }

    /// What members draw their numbers with; zero if nothing is said.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self.changed()
    }

    /// The table of which member `k` reads row `k`, by [`Member::cell`].
    #[must_use]
    pub fn over(mut self, table: Table) -> Self {
        self.table = Some(table);
        self.changed()
    }

    /// Keeps the columns at the start, after each multiple of a number of steps, and at the end; without it at the end only.
    ///
    /// A chunk is made in memory, all rows of its members: those of one member are bounded by this number only.
    ///
    /// # Panics
    ///
    /// Where the number is zero.
    #[must_use]
    pub fn every(mut self, steps: u64) -> Self {
        assert!(steps > 0, "columns are kept after a number of steps above zero");
        self.every = Some(steps);
        self.changed()
    }

    /// So many members to a chunk, which is what one worker makes at a time and one file holds.
    ///
    /// If nothing is said it is about a second's work of one core by what a step of the method [costs](Integrator::cost), or a
    /// 64th of the members, so that all cores and all shares have some, and a million rows at most where one member hasn't
    /// more. It is the same on every machine, as the plan is.
    ///
    /// # Panics
    ///
    /// Where the number is zero.
    #[must_use]
    pub fn chunks_of(mut self, members: u64) -> Self {
        assert!(members > 0, "a chunk has members");
        self.chunk = Some(members);
        self.changed()
    }

    /// Keeps columns of these names.
    ///
    /// # Panics
    ///
    /// Where there is a column of that name already; `member`, `step` and `status` always are.
    #[must_use]
    pub fn keep<const N: usize>(
        self,
        names: [&str; N],
        values: impl Fn(&Run<'_, M>) -> [f64; N] + Send + Sync + 'static,
    ) -> Self {
        self.keep_named(&names, move |run, row| row.copy_from_slice(&values(run)))
    }

    /// As [`keep`](Self::keep), of names that are known when the program runs: the slice has a place for each, NaN until
    /// it is filled.
    ///
    /// # Panics
    ///
    /// As [`keep`](Self::keep).
    #[must_use]
    pub fn keep_named(
        mut self,
        names: &[&str],
        values: impl Fn(&Run<'_, M>, &mut [f64]) + Send + Sync + 'static,
    ) -> Self {
        for name in names {
            self.assert_new_column(name);
            self.names.push((*name).to_owned());
        }
        let count = names.len();
        self.columns.push(Box::new(move |run, row| {
            let start = row.len();
            row.resize(start + count, f64::NAN);
            values(run, &mut row[start..]);
        }));
        self.changed()
    }

    /// Reduces a value of every member that has come to its end.
    ///
    /// # Panics
    ///
    /// Where a histogram has no bins or no range, or two reductions have one name.
    #[must_use]
    pub fn reduce(
        mut self,
        name: &str,
        reduction: Reduction,
        value: impl Fn(&Run<'_, M>) -> f64 + Send + Sync + 'static,
    ) -> Self {
        self.assert_new_reduction(name, &reduction);
        self.reductions.push((name.to_owned(), reduction, Box::new(value)));
        self.changed()
    }

    pub(crate) fn assert_new_column(&self, name: &str) {
        let mut known = self.names.iter().chain(self.sections.iter().flat_map(|section| &section.names));
        let is_new = !["member", "step", "status"].contains(&name) && known.all(|own| own != name);
        assert!(is_new, "there is a column `{name}` already");
    }

    pub(crate) fn assert_new_reduction(&self, name: &str, reduction: &Reduction) {
        if let Some(mistake) = reduction.mistake() {
            panic!("`{name}`: {mistake}");
        }
        let is_new = self.all_reductions().all(|(own, _)| own != name);
        assert!(is_new, "there is a reduction `{name}` already");
    }

    /// How many chunks there are.
    #[must_use]
    pub fn chunks(&self) -> u64 {
        self.members.div_ceil(self.members_of_chunk())
    }

    pub(crate) fn members_of_chunk(&self) -> u64 {
        self.chunk.unwrap_or_else(|| *self.size.get_or_init(|| self.usual_chunk()))
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)] // an estimate
    fn usual_chunk(&self) -> u64 {
        // What a core makes in a second of the steps of (3.13), in lanes and one by one; and what one of these costs.
        const STEPS: [f64; 2] = [33_554_432.0, 4_194_304.0];
        const OF_A_STEP: f64 = 448.0;
        const ROWS: u64 = 1 << 20;
        const CHUNKS: u64 = 64;
        let cost = self.looked_at().into_iter().find_map(|member| {
            let (stepper, _) = (self.make)(&self.member(member)).ok()?;
            Some(stepper.cost().map_or(OF_A_STEP, |cost| cost.least()))
        });
        let ratio = OF_A_STEP / cost.unwrap_or(OF_A_STEP).max(1.0);
        let second = (STEPS[usize::from(self.takes_turns)] * ratio / self.steps.max(1) as f64) as u64;
        // As many as give 64 workers something to do; in lanes all of these, and a 32nd of a second, beside which a file is
        // cheap.
        let least = if self.takes_turns { 1 } else { (second / 32).max(LANES as u64) };
        let shared = self.members.div_ceil(CHUNKS).max(least).min(second);
        // Of very many, a few thousand files.
        let most = (self.members >> 12).clamp(1 << 16, ROWS);
        let rows = self.every.map_or(1, |every| self.steps / every + 2);
        let members = shared.max(self.members >> 12).min(ROWS / rows.min(ROWS)).clamp(1, most);
        // Full lanes, if there are members for one.
        if self.takes_turns || members < LANES as u64 { members } else { members - members % LANES as u64 }
    }

    pub(crate) fn member(&self, number: u64) -> Member<'_> {
        Member { number, seed: self.seed, table: self.table.as_ref() }
    }

    /// What tells this plan from another: all its numbers and names, its table, and what is kept of its first, its middle
    /// and its last member at the start and after a piece, as a function can't be compared.
    #[must_use]
    pub fn fingerprint(&self) -> u64 {
        *self.fingerprint.get_or_init(|| self.print())
    }

    /// Its first, its middle and its last member.
    fn looked_at(&self) -> Vec<u64> {
        let mut looked_at = vec![0, self.members / 2, self.members.saturating_sub(1)];
        looked_at.dedup();
        looked_at
    }

    fn print(&self) -> u64 {
        let mut digest = Digest::default();
        digest.text(&self.name);
        let table = self.table.as_ref().map_or(0, Table::digest);
        let every = self.every.unwrap_or(0);
        for number in [self.members, self.steps, self.seed, every, self.members_of_chunk(), table] {
            digest.number(number);
        }
        self.names.iter().for_each(|name| digest.text(name));
        for (name, reduction, _) in &self.reductions {
            digest.text(name);
            digest.text(&format!("{reduction:?}"));
        }
        self.sections.iter().for_each(|section| section.describe(&mut digest));
        for member in self.looked_at() {
            self.look_at(member, &mut digest);
        }
        digest.value()
    }

    /// What a member is, by what is kept of it.
    fn look_at(&self, member: u64, digest: &mut Digest) {
        match (self.make)(&self.member(member)) {
            Ok((stepper, mut state)) => {
                for steps in [0, Self::PIECE.min(self.steps)] {
                    if stepper.run(&mut state, steps).is_err() {
                        digest.number(steps);
                    }
                    let run = Run { member, stepper: &stepper, state: &state };
                    let mut row = Vec::new();
                    self.columns.iter().for_each(|values| values(&run, &mut row));
                    row.extend(self.reductions.iter().map(|(_, _, value)| value(&run)));
                    let now = Moment::of_step(&stepper, &state);
                    row.extend(self.sections.iter().flat_map(|section| section.values(&now)));
                    for value in row {
                        digest.number(value.to_bits());
                    }
                }
            }
            Err(failure) => digest.text(&failure.to_string()),
        }
    }
}

impl<M: Integrator> Ensemble<M> {
    /// Keeps columns where members cross a surface.
    ///
    /// Members stay in lanes; each of their steps is looked at, and those that cross are made again alone. As in every run
    /// with [events](liestep::recording::Run::event) a member makes each step by itself. Rows are kept as without, and in each are the
    /// crossings since the one before: how many these are nothing bounds but the motion, and a chunk is made in memory.
    ///
    /// # Panics
    ///
    /// As [`keep`](Self::keep) and [`reduce`](Self::reduce), for its columns and reductions, and for the 256th section.
    #[must_use]
    pub fn section(mut self, section: Section<M>) -> Self {
        for (place, name) in section.names.iter().enumerate() {
            self.assert_new_column(name);
            assert!(!section.names[..place].contains(name), "there is a column `{name}` already");
        }
        for (place, (name, reduction, _)) in section.reductions.iter().enumerate() {
            self.assert_new_reduction(name, reduction);
            let is_new = section.reductions[..place].iter().all(|(own, ..)| own != name);
            assert!(is_new, "there is a reduction `{name}` already");
        }
        self.sections.push(section);
        assert!(self.sections.len() < 256, "an ensemble has less than 256 sections");
        self.changed()
    }

    /// All reductions and their names: of ends, then of sections.
    pub(crate) fn all_reductions(&self) -> impl Iterator<Item = (&String, &Reduction)> {
        let of_ends = self.reductions.iter().map(|(name, reduction, _)| (name, reduction));
        let of_sections = self.sections.iter().flat_map(|section| &section.reductions);
        of_ends.chain(of_sections.map(|(name, reduction, _)| (name, reduction)))
    }

    /// Of no members.
    pub(crate) fn nothing(&self) -> Outcome {
        let passages = vec![Passages { times: 0, first: Moments::NONE }; self.sections.len()];
        let reduced = self.all_reductions().map(|(_, reduction)| reduction.begin()).collect();
        Outcome { passages, reduced, ..Outcome::default() }
    }
}

impl<M: Integrator> fmt::Debug for Ensemble<M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, members, steps, seed, every, names, .. } = self;
        f.debug_struct("Ensemble")
            .field("name", name)
            .field("members", members)
            .field("steps", steps)
            .field("seed", seed)
            .field("every", every)
            .field("columns", names)
            .finish_non_exhaustive()
    }
}
