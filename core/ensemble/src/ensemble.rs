//! The plan of an ensemble: members, steps, and recorded columns.

use core::fmt;
use std::sync::OnceLock;

use liestep::motion::{AnyStepper, Batchable, Integrator, Moment};
use simba::simd::AutoF64x8;

use crate::draw::Member;
use crate::group::{Grouping, Start, abreast, in_lanes, one_by_one};
use crate::outcome::{Outcome, Passages};
use crate::reduce::{Moments, Reduction};
use crate::section::Section;
use crate::sizes::Sizes;
use crate::{Failure, Table};
use liestep::numbers::Digest;

/// A member at one time, from which recorded values are computed.
#[derive(Debug)]
pub struct Run<'a, M: Integrator> {
    /// The member's number.
    pub member: u64,
    /// The member's stepper, with its scene.
    pub stepper: &'a M,
    /// The member's state.
    pub state: &'a M::State,
}

type Make<M> = dyn Fn(&Member<'_>) -> Result<Start<M>, Failure> + Send + Sync;
type Value<M> = dyn Fn(&Run<'_, M>) -> f64 + Send + Sync;
type Values<M> = dyn Fn(&Run<'_, M>, &mut Vec<f64>) + Send + Sync;

/// A plan for many motions of one kind: the members, the number of steps, and the recorded columns.
///
/// [`run`](Self::run) executes it. Results depend on the plan alone: not on the number of threads or processes, the
/// assignment or the order of chunks, or interruptions. Each member moves, bit for bit, as its stepper
/// [runs](Integrator::run) it alone, in pieces of [`PIECE`](Self::PIECE) steps from one recorded time to the next; the
/// length of pieces matters for splittings only.
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
    sizes: OnceLock<Sizes>,
}

impl Ensemble<AnyStepper> {
    /// An ensemble of steppers whose states are numbers: members whose steppers are [joinable](AnyStepper::joinable) are stepped
    /// together, and have the bits that they have alone.
    pub fn abreast(
        name: &str,
        members: u64,
        steps: u64,
        make: impl Fn(&Member<'_>) -> Result<Start<AnyStepper>, Failure> + Send + Sync + 'static,
    ) -> Self {
        Self::of(name, members, steps, Box::new(make), abreast, false)
    }
}

impl<M: Integrator> Ensemble<M> {
    /// The number of steps between two checks whether a member can go on. A failing member repeats its last piece
    /// step by step.
    pub const PIECE: u64 = 64;

    /// An ensemble of a number of members with a number of steps each, run eight at a time in
    /// [lanes](liestep::numbers::Real#lanes).
    ///
    /// The name distinguishes ensembles in the files. `make` constructs a member's stepper and initial state, or says
    /// why there are none; it must be deterministic. After a change of `make`, choose another name or folder: the
    /// [fingerprint](Self::fingerprint) and a run sample four members only.
    ///
    /// Lanes need scenes that are generic over their scalar, as the library's are: `Top<f64>` here, declared as
    /// `Top<T>`. The methods with lanes are [`Stepper::new`](liestep::Stepper::new),
    /// [`composed`](liestep::Stepper::composed), [`split`](liestep::Stepper::split) and
    /// [`processed`](liestep::Stepper::processed), each of them also [`compensated`](liestep::Stepper::compensated).
    /// Members of other scenes or methods, as Gauss collocation and remedies, run [`one_by_one`](Self::one_by_one).
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

    /// An ensemble for any stepper: as [`new`](Self::new), without lanes.
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
            sizes: OnceLock::new(),
        }
    }

    /// Clears results that depend on the plan.
    fn changed(self) -> Self {
        Self { fingerprint: OnceLock::new(), sizes: OnceLock::new(), ..self }
    }

    /// Sets the seed from which members draw their numbers; the default is zero.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self.changed()
    }

    /// Adds the table of which member `k` reads row `k`, by [`Member::cell`].
    #[must_use]
    pub fn over(mut self, table: Table) -> Self {
        self.table = Some(table);
        self.changed()
    }

    /// Records the columns at the start, after each multiple of a number of steps, and at the end; by default at the
    /// end only.
    ///
    /// A chunk is computed in memory with all rows of its members: this number alone bounds the rows of one member.
    ///
    /// # Panics
    ///
    /// If the number is zero.
    #[must_use]
    pub fn every(mut self, steps: u64) -> Self {
        assert!(steps > 0, "columns are kept after a number of steps above zero");
        self.every = Some(steps);
        self.changed()
    }

    /// Sets the number of members of a chunk, the unit of work of one worker and the content of one file.
    ///
    /// Default chunks grow: the first have as many members as lanes, or one, and their size doubles after 16 chunks; from
    /// a 32nd of a second's work of one core on, by the [cost](Integrator::cost) of a step of the method, after 64; from a
    /// second's work on after 1024; up to a million rows. So all cores and all shares have some, and very many members go
    /// to a few thousand files. A member is in the same chunk on every machine, and whatever the number of members.
    ///
    /// # Panics
    ///
    /// If the number is zero.
    #[must_use]
    pub fn chunks_of(mut self, members: u64) -> Self {
        assert!(members > 0, "a chunk has members");
        self.chunk = Some(members);
        self.changed()
    }

    /// Records columns of these names.
    ///
    /// # Panics
    ///
    /// If a column of that name exists already; `member`, `step` and `status` always do.
    #[must_use]
    pub fn keep<const N: usize>(
        self,
        names: [&str; N],
        values: impl Fn(&Run<'_, M>) -> [f64; N] + Send + Sync + 'static,
    ) -> Self {
        self.keep_named(&names, move |run, row| row.copy_from_slice(&values(run)))
    }

    /// Records columns as [`keep`](Self::keep), by names known at run time: the slice has a place for each, initialised
    /// with NaN.
    ///
    /// # Panics
    ///
    /// On the conditions of [`keep`](Self::keep).
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

    /// Reduces a value of every member that completes its steps.
    ///
    /// # Panics
    ///
    /// If a histogram has no bins or no range, or two reductions have the same name.
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

    /// The number of chunks.
    #[must_use]
    pub fn chunks(&self) -> u64 {
        self.sizes().chunks(self.members)
    }

    pub(crate) fn sizes(&self) -> Sizes {
        *self.sizes.get_or_init(|| self.chunk.map_or_else(|| self.usual_sizes(), Sizes::all_of))
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)] // an estimate
    fn usual_sizes(&self) -> Sizes {
        // Steps of (3.13) that a core computes in a second, in lanes and one by one, and the cost of one such step.
        const STEPS: [f64; 2] = [33_554_432.0, 4_194_304.0];
        const OF_A_STEP: f64 = 448.0;
        const ROWS: u64 = 1 << 20;
        let cost = (self.make)(&self.member(0)).ok().and_then(|(stepper, _)| stepper.cost());
        let ratio = OF_A_STEP / cost.map_or(OF_A_STEP, |cost| cost.least()).max(1.0);
        let second = (STEPS[usize::from(self.takes_turns)] * ratio / self.steps.max(1) as f64) as u64;
        let rows = self.every.map_or(1, |every| self.steps / every + 2);
        Sizes::of_work(second, ROWS / rows.min(ROWS), !self.takes_turns)
    }

    pub(crate) fn member(&self, number: u64) -> Member<'_> {
        Member { number, seed: self.seed, table: self.table.as_ref() }
    }

    /// A digest of the plan: all its numbers and names but the number of members, its table, and the recorded values of
    /// the first member at the start and after a piece, since functions can't be compared.
    ///
    /// An ensemble of more members is the same plan, and [runs](Self::run) on in the folder of one of fewer.
    #[must_use]
    pub fn fingerprint(&self) -> u64 {
        *self.fingerprint.get_or_init(|| self.print())
    }

    fn print(&self) -> u64 {
        let mut digest = Digest::default();
        digest.text(&self.name);
        let table = self.table.as_ref().map_or(0, Table::digest);
        let every = self.every.unwrap_or(0);
        let Sizes { least, second, most } = self.sizes();
        for number in [self.steps, self.seed, every, least, second, most, table] {
            digest.number(number);
        }
        self.names.iter().for_each(|name| digest.text(name));
        for (name, reduction, _) in &self.reductions {
            digest.text(name);
            digest.text(&format!("{reduction:?}"));
        }
        self.sections.iter().for_each(|section| section.describe(&mut digest));
        self.look_at(0, &mut digest);
        digest.value()
    }

    /// A digest of the recorded values of a chunk's first member at the start and after a piece.
    pub(crate) fn sample(&self, chunk: u64) -> u64 {
        let mut digest = Digest::default();
        self.look_at(self.range(chunk).start, &mut digest);
        digest.value()
    }

    /// Adds a member's recorded values to the digest, if there is such a member.
    fn look_at(&self, member: u64, digest: &mut Digest) {
        if member >= self.members {
            return;
        }
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
    /// Records columns where members cross a surface.
    ///
    /// Members stay in lanes; each of their steps is checked, and steps with a crossing are repeated by the member
    /// alone. Each step is made separately, as in every run with [events](liestep::recording::Run::event). Rows stay as
    /// they are, and each has the crossings since the one before. Only the motion bounds their number, and a chunk is
    /// computed in memory.
    ///
    /// # Panics
    ///
    /// On the conditions of [`keep`](Self::keep) and [`reduce`](Self::reduce), for its columns and reductions, and for
    /// the 256th section.
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

    /// All reductions and their names: those of ends, then those of sections.
    pub(crate) fn all_reductions(&self) -> impl Iterator<Item = (&String, &Reduction)> {
        let of_ends = self.reductions.iter().map(|(name, reduction, _)| (name, reduction));
        let of_sections = self.sections.iter().flat_map(|section| &section.reductions);
        of_ends.chain(of_sections.map(|(name, reduction, _)| (name, reduction)))
    }

    /// The outcome of no members.
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
