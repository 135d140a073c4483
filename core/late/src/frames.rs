//! The carriage of a sum: all that its terms carry, one behind the other; or the directions of space, of which all vectors
//! are made.

use liestep_derivation::{Action, Carried, StagedDeclaration};

/// A number that a term carries: the sum of those of the carriage at these places, each times a parameter's number, where
/// there is one, which stands at the first place among the parameters and at the second among the constants of a step.
pub(crate) type Combined = Vec<(Option<[usize; 2]>, usize)>;

/// All that a sum carries.
pub(crate) struct Carriage {
    pub(crate) carried: Vec<Carried>,
    /// The parameters' numbers that a step finds among its constants, the first of them at `constants`.
    pub(crate) weights: Vec<usize>,
    constants: usize,
    in_frames: bool,
}

fn length(carried: &Carried) -> usize {
    carried.shape.0 * carried.shape.1
}

/// The directions of space as a factor sees them, `g^T e_1`, `g^T e_2` and so on.
const fn direction(factor: usize, size: usize) -> Carried {
    Carried { field: None, action: Action::Covector(factor), shape: (size, 1) }
}

/// Whether the value in space is a parameter's, and not the identity.
const fn is_own(carried: &Carried) -> bool {
    carried.field.is_some() && !matches!(carried.action, Action::Covector(_))
}

impl Carriage {
    /// Empty; or with the directions of space of each factor that a vector is seen from, and with each configuration once.
    /// The first directions stand before the configurations, and the others behind, as types of one vector begin.
    pub(crate) fn of(terms: &[&StagedDeclaration], in_frames: bool, constants: usize) -> Self {
        let mut carriage = Self { carried: Vec::new(), weights: Vec::new(), constants, in_frames };
        if !in_frames {
            return carriage;
        }
        let all = || terms.iter().flat_map(|staged| &staged.carried);
        let mut factors: Vec<(usize, usize)> = Vec::new();
        let mut others: Vec<Carried> = Vec::new();
        for one in all() {
            match one.action {
                Action::Covector(factor) if !factors.contains(&(factor, one.shape.0)) => {
                    factors.push((factor, one.shape.0));
                }
                Action::Covector(_) => {}
                _ if one.field.is_none() && !others.contains(one) => others.push(*one),
                _ => {}
            }
        }
        factors.sort_unstable();
        carriage.carried.extend(factors.iter().map(|&(factor, size)| direction(factor, size)));
        carriage.carried.append(&mut others);
        let most = factors.iter().map(|&(_, size)| size).max().unwrap_or(0);
        for number in 1..most {
            let with = factors.iter().filter(|&&(_, size)| number < size);
            carriage.carried.extend(with.map(|&(factor, size)| direction(factor, size)));
        }
        carriage
    }

    /// How many numbers there are.
    pub(crate) fn numbers(&self) -> usize {
        self.carried.iter().map(length).sum()
    }

    /// The first numbers of all that are alike.
    fn places(&self, alike: &Carried) -> Vec<usize> {
        let mut first = 0;
        let all = self.carried.iter().map(|one| {
            first += length(one);
            (one, first - length(one))
        });
        all.filter(|(one, _)| *one == alike).map(|(_, first)| first).collect()
    }

    /// The numbers that a term carries, whose parameters begin at this field and at this number among those of all.
    pub(crate) fn take(&mut self, staged: &StagedDeclaration, fields: usize, numbers: usize) -> Vec<Combined> {
        let mut combined = Vec::new();
        for (at, one) in staged.carried.iter().enumerate() {
            let moved = Carried { field: one.field.map(|field| fields + field), ..*one };
            if !self.in_frames || is_own(one) {
                let first = self.numbers();
                self.carried.push(moved);
                combined.extend((0..length(one)).map(|number| vec![(None, first + number)]));
                continue;
            }
            let Some(field) = one.field else {
                // Configurations are there once, and a term that is a sum may have directions of its own.
                let number = staged.carried[..at].iter().filter(|other| *other == one).count();
                let alike = self.places(one);
                let first = alike.get(number).or(alike.first()).copied().unwrap_or(0);
                combined.extend((0..length(one)).map(|number| vec![(None, first + number)]));
                continue;
            };
            let before: usize = staged.parameters[..field].iter().map(|parameter| parameter.kind.len()).sum();
            let weight = |at: usize| Some([numbers + before + at, self.constants + self.weights.len() + at]);
            let frame = self.places(&Carried { field: None, ..*one });
            let entry =
                |number: usize| frame.iter().enumerate().map(|(at, first)| (weight(at), first + number)).collect();
            combined.extend((0..length(one)).map(entry));
            self.weights.extend((0..frame.len()).map(|at| numbers + before + at));
        }
        combined
    }
}
