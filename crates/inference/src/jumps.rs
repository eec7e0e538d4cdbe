//! Scores of a sudden change of the states, for every step in one backward pass.

use gyrocal_estimation::EstimationError;

use crate::error::PassError;
use crate::pass::{Made, Pass, Taken, Watch};
use crate::small::{apply_transposed, dot};

/// Score and information of a jump of the moving states in the step before a row (auxiliary
/// residuals: de Jong, Penzer, J. Amer. Statist. Assoc. 93, 1998).
#[derive(Clone, Debug, PartialEq)]
pub struct JumpScore {
    /// Score of the jump: sum of products of the innovations with their derivatives by the jump. Then,
    /// for each column, the sum of products of its innovations with those derivatives. Each has one number for
    /// each state.
    pub columns: Vec<Vec<f64>>,
    /// Information on the jump if all columns were known, by rows.
    pub information: Vec<f64>,
    /// Score of a change of each reading of the row; zero for a missing one.
    pub readings: Vec<f64>,
}

/// Row, output, and reciprocal of the standard deviation of an innovation.
type Seen = (usize, usize, f64);

/// What the backward pass needs of the forward one.
#[derive(Default)]
struct Kept {
    seen: Vec<Seen>,
    /// For each output its Jacobian over the standard deviation of its innovation, and the gain of the states
    /// times it.
    vectors: Vec<f64>,
    /// Whitened innovations and columns.
    innovations: Vec<f64>,
    transitions: Vec<f64>,
}

impl Watch for Kept {
    fn take(&mut self, taken: &Taken<'_>) {
        let whitened = &taken.whitened;
        let reciprocal = 1.0 / whitened.deviation;
        self.seen.push((whitened.row, whitened.output, reciprocal));
        let both = taken.jacobian.iter().chain(taken.cross);
        self.vectors
            .extend(both.map(|element| element * reciprocal));
        self.innovations.extend_from_slice(whitened.columns);
    }

    fn step(&mut self, made: &Made<'_>) -> Result<(), EstimationError> {
        self.transitions.extend_from_slice(made.by_states);
        Ok(())
    }
}

/// Score and information of a change of the states, going backward.
struct Adjoint {
    states: usize,
    /// A change's score, then its products with each column.
    columns: Vec<f64>,
    /// By rows.
    information: Vec<f64>,
    memory: Vec<f64>,
}

impl Adjoint {
    /// Goes back over an output. Later innovations see what its update leaves, (I - g h)ᵀ.
    fn update(&mut self, jacobian: &[f64], gain: &[f64], innovations: &[f64]) {
        let n = self.states;
        for (sum, value) in self.columns.chunks_exact_mut(n).zip(innovations) {
            let left = value - dot(sum, gain);
            for (sum, jacobian) in sum.iter_mut().zip(jacobian) {
                *sum += jacobian * left;
            }
        }
        // (I − h gᵀ) N (I − g hᵀ) + h hᵀ = N − h (N g)ᵀ − (N g) hᵀ + (1 + gᵀ N g) h hᵀ
        for (along, row) in self.memory.iter_mut().zip(self.information.chunks_exact(n)) {
            *along = dot(row, gain);
        }
        let own = 1.0 + dot(&self.memory, gain);
        for i in 0..n {
            for j in 0..n {
                self.information[i * n + j] += own * jacobian[i] * jacobian[j]
                    - jacobian[i] * self.memory[j]
                    - self.memory[i] * jacobian[j];
            }
        }
    }

    /// Goes back over a step.
    fn predict(&mut self, transition: &[f64]) {
        let n = self.states;
        for sum in self.columns.chunks_exact_mut(n) {
            apply_transposed(transition, sum, &mut self.memory);
        }
        // Φᵀ N Φ of a symmetric N: by rows, transposed, by rows again.
        for _ in 0..2 {
            for row in self.information.chunks_exact_mut(n) {
                apply_transposed(transition, row, &mut self.memory);
            }
            for i in 0..n {
                for j in 0..i {
                    self.information.swap(i * n + j, j * n + i);
                }
            }
        }
    }
}

impl Pass<'_> {
    /// Passes forward and backward over the record. `watch` gets each row but the first, in falling
    /// order, with the score of a jump in the step before it.
    ///
    /// # Errors
    /// As [`Self::reduce`].
    pub fn jumps(&self, mut watch: impl FnMut(usize, &JumpScore)) -> Result<(), PassError> {
        let mut kept = Kept::default();
        self.run(None, &mut kept)?;
        let layout = self.record.layout();
        let (n, _) = self.sizes();
        let count = 1 + self.columns.len();
        let mut adjoint = Adjoint {
            states: n,
            columns: vec![0.0; n * count],
            information: vec![0.0; n * n],
            memory: vec![0.0; n],
        };
        let mut score = JumpScore {
            columns: vec![vec![0.0; layout.states]; count],
            information: vec![0.0; layout.states * layout.states],
            readings: vec![0.0; layout.outputs],
        };
        for row in (1..self.count()).rev() {
            score.readings.fill(0.0);
            while let Some((_, output, reciprocal)) = kept.seen.pop_if(|(of, ..)| *of == row) {
                let columns = &kept.innovations[kept.seen.len() * count..][..count];
                let vectors = &kept.vectors[kept.seen.len() * 2 * n..][..2 * n];
                let (jacobian, gain) = vectors.split_at(n);
                let along = dot(gain, &adjoint.columns[..n]);
                score.readings[output] = (columns[0] - along) * reciprocal;
                adjoint.update(jacobian, gain, columns);
            }
            for (target, sum) in score
                .columns
                .iter_mut()
                .zip(adjoint.columns.chunks_exact(n))
            {
                target.copy_from_slice(&sum[..layout.states]);
            }
            let rows = score.information.chunks_exact_mut(layout.states);
            for (target, row) in rows.zip(adjoint.information.chunks_exact(n)) {
                target.copy_from_slice(&row[..layout.states]);
            }
            watch(row, &score);
            adjoint.predict(&kept.transitions[(row - 1) * n * n..row * n * n]);
        }
        Ok(())
    }
}
