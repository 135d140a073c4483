//! Terms that couple bodies within a step, and the coefficients of linear equations of all bodies.

use alloc::vec::Vec;

use nalgebra::{Matrix6, Vector6};

use super::terms::Blocks;

/// A term that couples the bodies at its ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coupling {
    /// The number of the term among those between two bodies.
    pub(super) pair: usize,
    /// The number of its two bodies among the coupled pairs; `None` if one end is in space.
    pub(super) place: Option<usize>,
    /// Whether its first body is the second of that pair.
    pub(super) is_reversed: bool,
}

/// A vector and a matrix of each body, and the blocks of each coupled pair in the equations of the one and of the other.
#[derive(Clone, Default)]
pub(super) struct Coefficients {
    pub(super) vectors: Vec<Vector6<f64>>,
    pub(super) matrices: Vec<Matrix6<f64>>,
    pub(super) blocks: Vec<[Matrix6<f64>; 2]>,
}

impl Coefficients {
    /// Makes room for a number of bodies and of coupled pairs.
    pub(super) fn fit(&mut self, bodies: usize, pairs: usize) {
        self.vectors.resize(bodies, Vector6::zeros());
        self.matrices.resize(bodies, Matrix6::zeros());
        self.blocks.resize(pairs, [Matrix6::zeros(); 2]);
    }

    /// Adds the part of a term between two bodies.
    pub(super) fn add(
        &mut self,
        bodies: &[Option<usize>; 2],
        coupling: Coupling,
        vectors: &[Vector6<f64>; 2],
        matrix: &Blocks<2>,
    ) {
        for (side, body) in bodies.iter().enumerate() {
            if let Some(body) = *body {
                self.vectors[body] += vectors[side];
                self.matrices[body] += matrix[side][side];
            }
        }
        if let Some(place) = coupling.place {
            let (first, second) = (matrix[0][1], matrix[1][0]);
            let [one, other] = if coupling.is_reversed { [second, first] } else { [first, second] };
            let block = &mut self.blocks[place];
            *block = [block[0] + one, block[1] + other];
        }
    }
}

/// The terms that couple bodies, and the pairs of bodies that they couple.
pub(super) fn couplings<'a>(
    pairs: impl Iterator<Item = (&'a [Option<usize>; 2], bool)>,
) -> (Vec<Coupling>, Vec<[usize; 2]>) {
    let (mut couplings, mut coupled) = (Vec::new(), Vec::<[usize; 2]>::new());
    for (pair, (bodies, _)) in pairs.enumerate().filter(|(_, (_, has_unknown))| *has_unknown) {
        let &[Some(one), Some(other)] = bodies else {
            couplings.push(Coupling { pair, place: None, is_reversed: false });
            continue;
        };
        let known = coupled.iter().position(|of| *of == [one, other] || *of == [other, one]);
        let place = known.unwrap_or_else(|| {
            coupled.push([one, other]);
            coupled.len() - 1
        });
        couplings.push(Coupling { pair, place: Some(place), is_reversed: coupled[place][0] != one });
    }
    (couplings, coupled)
}
