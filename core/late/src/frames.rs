//! The advected parameters of a sum: those of its terms, one after the other; or the directions of space, of which all
//! vectors are linear combinations.

use liestep_derivation::{Action, Carried, StagedDeclaration};

/// A number of a term's advected parameters as a linear combination: the sum of the sum's numbers at these places, each
/// times a parameter's number, if there is one, whose first place is among the parameters and whose second is among the
/// constants of a step.
pub(crate) type Combination = Vec<(Option<[usize; 2]>, usize)>;

/// The advected parameters of a sum, with the weights of its vectors.
pub(crate) struct Carriage {
    pub(crate) carried: Vec<Carried>,
    /// Numbers of parameters that a step has among its constants, the first of them at `constants`.
    pub(crate) weights: Vec<usize>,
    constants: usize,
    in_frames: bool,
}

fn length(carried: &Carried) -> usize {
    carried.shape.0 * carried.shape.1
}

/// The directions of space in a factor's frame, `g^T e_1`, `g^T e_2` and so on.
const fn direction(factor: usize, size: usize) -> Carried {
    Carried { field: None, action: Action::Covector(factor), shape: (size, 1) }
}

/// Whether the value in space is that of a parameter, and not the identity.
const fn is_own(carried: &Carried) -> bool {
    carried.field.is_some() && !matches!(carried.action, Action::Covector(_))
}

impl Carriage {
    /// No parameters, or the directions of space in the frame of each factor that advects a vector, and each
    /// configuration once. The first directions stand before the configurations, and the others behind, as types of one
    /// vector begin.
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

    /// The number of numbers of all advected parameters.
    pub(crate) fn numbers(&self) -> usize {
        self.carried.iter().map(length).sum()
    }

    /// The first numbers of all parameters that equal this one.
    fn places(&self, alike: &Carried) -> Vec<usize> {
        let mut first = 0;
        let all = self.carried.iter().map(|one| {
            first += length(one);
            (one, first - length(one))
        });
        all.filter(|(one, _)| *one == alike).map(|(_, first)| first).collect()
    }

    /// The advected parameters of a term as combinations of the sum's; the term's own parameters begin at this field,
    /// and their numbers at this one.
    pub(crate) fn take(&mut self, staged: &StagedDeclaration, fields: usize, numbers: usize) -> Vec<Combination> {
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
                // Configurations occur once, and a term that is a sum may have directions of its own.
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
