//! Score tests of named effects in a fitted model: detection, naming, alternatives.
//!
//! # What it is
//!
//! [`search`] takes a [`FittedModel`] and a selection of the effects of its [`Plant`], adds those that
//! the record shows to the model, one after the other, and returns them with estimates,
//! family-wise p-values, confidence sets and exact equivalents. What no effect explains is
//! returned as [`Unmodelled`], and each finding has the probability that a cause outside of the catalogue
//! is beside it. [`fit_with`] fits effects that are given. [`signature`] is the one place that makes
//! columns of an effect.
//!
//! # The equations
//!
//! Let θ be the fitted parameters and β the sizes of further effects, zero in the model. Linearised
//! about the fit, with the moving states at all rows eliminated, the whitened innovations are
//!
//! ```text
//! e = e₀ − X_θ δθ − X_β β,     e ~ N(0, I)
//! ```
//!
//! where the columns of X are the derivatives of the predicted innovations: the *signatures*. Score
//! and information of β, with θ projected out (W is the inverse of the prior covariance of θ), are
//!
//! ```text
//! s = X_βᵀ e₀ − J_βθ (J_θθ + W)⁻¹ (X_θᵀ e₀ − W θ)                               (1)
//! J = J_ββ − J_βθ (J_θθ + W)⁻¹ J_θβ,        J_ab = X_aᵀ X_b                     (2)
//! ```
//!
//! The *score test* (Rao 1948) of one hypothesis with columns h is
//!
//! ```text
//! l_h = s_hᵀ J_hh⁻¹ s_h  ~  χ²(number of columns)  if the effect is absent       (3)
//! ```
//!
//! An effect with an unknown onset or time constant has several *variants*; its statistic is the
//! largest of theirs, l = max_v l_v, whose distribution lies above χ². The *search penalty* q of a
//! hypothesis is the excess of its 99 % quantile over that of χ²(1). Hypotheses are ranked by l − q;
//! the detection test takes the *maximum statistic*
//!
//! ```text
//! M = max_h (l_h − c q_h),        c = 0.6                                       (4)
//! ```
//!
//! Under the null hypothesis s ~ N(0, J) jointly: q, the threshold of M at the family-wise
//! probability of a false alarm, and its p-value come from 4096 draws of s,
//!
//! ```text
//! P(M ≥ m) = share of the draws with M ≥ m, beyond the last ten the tail of χ²(1) (5)
//! ```
//!
//! The *confidence set* of a detected effect a holds every hypothesis b with
//!
//! ```text
//! (l_a − q_a) − (l_b − q_b) < 3.5                                               (6)
//! ```
//!
//! given the other effects. Where the model asks for it ([`FittedModel::sets_need_fits`]), l_b of the nearest
//! rivals is that of a fit with b in the place of a, and of two effects whose sizes are hardly told apart one
//! is taken out if the other, fitted anew, explains as much; it stays in the set. One effect takes the place
//! of any two if both together are not detected beside it. [`CONFIDENCE_SET_DEVIANCE`] is calibrated by
//! simulation. Where a statistic exceeds [`FAR_OFF`], the effect to add is the best of fits, errors of the set-up among
//! them. An effect gives way to one that is nested in it unless it is better by the 5 % point of χ²(1), [`NESTED_MODEL_CHI2`].
//!
//! # Noise and random walks
//!
//! White noise of the rates and random walks of their constants belong to the null hypothesis. With
//! θ₀ the nominal parameters, V the covariance of the record by noise ν and walks w, and S a set of
//! effects with sizes β, the restricted log-likelihood is (Patterson, Thompson 1971)
//!
//! ```text
//! l(ν, w, S) = −½ [ln |V| + ln |J_θ₀θ₀ + W| + min over θ₀, β of |e|²] + ln p(ν)    (7)
//! ```
//!
//! An effect is detected if 2 [l(ν̂₁, 0, S + h) − l(ν̂₀, 0, S)] − c q exceeds the threshold: the score
//! test, whose noise is that of the model without the effect, only chooses what is fitted. Walks are
//! tested by 2 [l(ν̂, ŵ, ∅) − l(ν̂, 0, ∅)], a mixture of χ² under the null hypothesis. Where effects are
//! detected, the best effects without walks and walks with what effects stand beside them are both
//! fitted, and compared by D, the difference of 2 l less threshold + q of every effect but one
//! ([`WALK_SET_DEVIANCE`], [`BESIDE_WALKS`]):
//!
//! | D | result |
//! |---|---|
//! | above 12 | the effects |
//! | 6 to 12 | the effects, walks in their set |
//! | 0 to 6 | walks, the effects in their set |
//! | below 0 | walks |
//!
//! The onset or time constant s of an accepted effect is estimated with all sizes: l(s) of (3), the
//! sizes of the effect taken out of the fit, is its profile likelihood. Its 95 % interval is
//!
//! ```text
//! {s : max l − l(s) ≤ c}                                                         (8)
//! ```
//!
//! with c the 95 % quantile of max l − l(true s), drawn from the joint normal distribution of the
//! scores at all shapes with the estimated effect in the data: 3.84 where l is quadratic, more where
//! an onset is a change point. Noise that a model estimates is here that of
//! [`FittedModel::restricted_noise`]; c then has the degrees of freedom of the variance of the shape.
//!
//! # What it does not do
//!
//! It knows no gyro, no file and no filter: a plant is data ([`Plant`]), a fit is a trait.

mod accepted;
mod bank;
mod budget;
mod by_fits;
mod context;
mod continuation;
mod curve;
mod finding;
mod fitted_stage;
mod forward;
mod given;
mod hypothesis;
mod information;
mod jump;
mod line;
mod merged;
mod model;
mod null_distribution;
mod outside;
mod pattern;
mod plant;
mod rate_noise;
mod reach;
mod reassess;
mod replaced;
mod result;
mod rows;
mod score;
mod score_table;
mod search;
mod shape;
mod shape_estimates;
mod shape_interval;
mod signature;
mod smooth_functions;
mod state;
mod unmodelled;
mod walk_by_rate;
mod walk_candidates;
mod walk_findings;
mod walks;

pub use bank::{JointScore, NominalEstimate, ScoreBank};
pub use by_fits::FAR_OFF;
pub use context::{Proposed, SearchOptions};
pub use continuation::{Phase, RecordOffset, continued, continued_shapes, recurs};
pub use finding::{
    Alternative, CONFIDENCE_SET_DEVIANCE, EffectEstimate, ExactEquivalent, Finding, NoneOfThese,
};
pub use given::{FittedWith, fit_with};
pub use gyrocal_inference::{Column, ExtraColumns, Singular, Stop, Stopped, stop};
pub use hypothesis::{Hypothesis, HypothesisSet, Selection, Unavailable, Variant};
pub use information::{information, sigmas};
pub use model::{FittedModel, ModelExtension, StateJump};
pub use null_distribution::DETECTION_PENALTY_FRACTION;
pub use pattern::{ChannelIndex, Pattern, Unmodelled};
pub use plant::{Plant, WeightInputs};
pub use rate_noise::{RateNoise, RateNoiseFit};
pub use rows::{Covariate, Rows};
pub use score::{NESTED_MODEL_CHI2, Ranked};
pub use score_table::{ScoreTable, ScoredEffect};
pub use search::{Searched, search, search_from, select};
pub use signature::{Source, scale, shape_derivative, signature};
pub use walk_candidates::{BESIDE_WALKS, WALK_SET_DEVIANCE};
