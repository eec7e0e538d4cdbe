//! The terms that the attitudes of the stops determine.

use nalgebra::{DMatrix, DVector};

use super::positions::Positions;
use super::regression::WeightedStops;
use super::terms::Term;
use crate::error::{InstrumentError, Unfit};

/// A term whose column the law leaves less than this share of is not distinguishable from the law.
const SMALLEST_SHARE: f64 = 0.03;

pub(super) fn refuse_one_position(positions: &Positions) -> Result<(), InstrumentError> {
    /// Smaller turns hardly change a term in specific force.
    const SMALLEST_TURN_G: f64 = 0.2;
    let stops = positions.time_s.len();
    let Some(first) = positions.force_g.first() else {
        return Err(too_few(stops));
    };
    if stops < 2 {
        return Err(too_few(stops));
    }
    let apart = |force: &[f64; 3]| {
        let squares = (0..3).map(|axis| (force[axis] - first[axis]).powi(2));
        squares.sum::<f64>().sqrt()
    };
    if positions
        .force_g
        .iter()
        .any(|force| apart(force) > SMALLEST_TURN_G)
    {
        return Ok(());
    }
    Err(InstrumentError::unfit(
        Unfit::Undetermined,
        format!("{stops} stops, all in one position"),
        "at least two positions",
        "turn the instrument between stops: over by 180 degrees about a horizontal axis, or to each \
         axis up and down; `import strapdown` evaluates a log in one position",
    ))
}

fn too_few(stops: usize) -> InstrumentError {
    InstrumentError::unfit(
        Unfit::TooShort,
        format!("{stops} static stop(s)"),
        "at least two positions",
        "stop in two, six or twelve positions, or give several logs of one position each",
    )
}

/// The terms of the nominal law that the stops determine, one after the other.
pub(super) fn nominal_law(data: &WeightedStops) -> Vec<Term> {
    let mut law: Vec<Term> = Vec::new();
    for term in Term::NOMINAL {
        if is_new(data, &law, term) {
            law.push(term);
        }
    }
    law
}

/// `true` if the stops determine a term in addition to a law.
pub(super) fn is_new(data: &WeightedStops, law: &[Term], term: Term) -> bool {
    // It is the attitudes that determine a term, however well each stop is measured.
    let column = |term: Term| data.column(term).component_mul(&data.sigma);
    let own = column(term);
    if law.is_empty() {
        return own.norm() > 0.0;
    }
    if law.len() >= data.len() {
        return false;
    }
    let columns: Vec<DVector<f64>> = law.iter().map(|term| column(*term)).collect();
    let span = DMatrix::from_columns(&columns).qr().q();
    let rest = &own - &span * span.tr_mul(&own);
    // A ramp is as long as the test; other terms are held against a g.
    let whole = match term {
        Term::Ramp => own.norm(),
        _ => column(Term::Nominal(0)).norm(),
    };
    rest.norm() > SMALLEST_SHARE * whole
}

/// Of these terms, those that the stops determine beside a law.
pub(super) fn open_terms(
    data: &WeightedStops,
    law: &[Term],
    terms: impl IntoIterator<Item = Term>,
) -> Vec<Term> {
    let terms = terms.into_iter();
    terms
        .filter(|term| !law.contains(term) && is_new(data, law, *term))
        .collect()
}
