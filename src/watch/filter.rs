mod onsets;
mod saving;
mod surprises;

use gyrocal_estimation::{EstimationError, Factors, Innovation, Precision};
use gyrocal_watch::{Candidate, Entry, Grid, Step, Watch};

use super::courses::Courses;
use super::effects::{EFFECTS_BY_DEFAULT, WatchedEffect, columns};
use super::linearised::Linearised;
use super::settings::WatchSettings;
use crate::controller::ControllerFilter;
use crate::controller_error::ControllerError;
use crate::filter::PlatformFilter;
use crate::generated::catalogue::RATES;
use crate::generated::platform::Platform;
use crate::initial_attitude::InitialAttitude;
use crate::limits::Limits;
use crate::saved::SavedNumber;
use crate::settings::FilterSettings;

const N: usize = Platform::STATES;
/// Steps in which each gyro's walk is added once.
const WALK_TURNS: u32 = 24;
/// Elements of the lower half of a matrix over the states.
const L: usize = N * (N + 1) / 2;
/// Onsets of effects that live at a time: with blocks of two hours the oldest is 42 days.
const ONSETS: usize = 10;
/// Onsets of jumps that live at a time: 48 steps.
const JUMPS: usize = 12;

/// A watched filter with the effects of [`EFFECTS_BY_DEFAULT`].
pub type PlatformWatch<T = f32> = WatchedFilter<T, 18, 6>;

/// The filter of a controller with a sequential test for named effects beside it.
///
/// `E` effects are watched, and jumps of the attitude; `D` is the number of its columns: six, or nine
/// where an effect on accelerometers changes with the attitude. The filter carries the factors of the
/// covariance, takes innovations only up to a clip and knows a random walk of each gyro
/// ([`WatchSettings`]).
///
/// ```
/// use gyrocal::watch::{EFFECTS_BY_DEFAULT, PlatformWatch, WatchSettings};
/// use gyrocal::{ControllerError, FilterSettings, InitialAttitude, Limits, Site};
///
/// # fn main() -> Result<(), ControllerError> {
/// // In firmware, a static.
/// let mut watched = PlatformWatch::<f32>::unset(&EFFECTS_BY_DEFAULT);
/// let settings = FilterSettings::at_site(Site::at_latitude_deg(39.1));
/// let watch = WatchSettings::default();
/// watched.start(&settings, &InitialAttitude::aligned(), Limits::default(), &watch)?;
/// watched.update(&[0.0, 0.0, 1.0])?;
/// let step = watched.step(60.0, &[0.003_4, 0.0, 0.999_99])?;
/// if step.alarm.is_some() {
///     watched.candidates(|effect, candidate| {
///         let _ = (effect, candidate.estimate, candidate.sigma, candidate.steps_since);
///     });
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct WatchedFilter<T: Precision, const E: usize, const D: usize> {
    filter: ControllerFilter<T, Factors>,
    watch: Watch<T, 3, 3, N, D, E, ONSETS, JUMPS, L>,
    effects: &'static [WatchedEffect; E],
    settings: WatchSettings<T>,
    linearised: Linearised<T>,
    /// The first value of each course over the next block, at the end of a block.
    early: [T; E],
    /// Time since each walk was last added, s, and the steps until the next.
    walked_s: [T; 3],
    next_walk: u32,
    alarm: Option<Grid>,
}

/// A step of a watched filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WatchedStep<T> {
    /// The innovation of the sample. Standardised, it is as the filter took it; the NIS is that of the
    /// sample.
    pub innovation: Innovation<T, 3>,
    /// An alarm, at every step on which the evidence is beyond its threshold.
    pub alarm: Option<Grid>,
}

impl<T: SavedNumber, const E: usize, const D: usize> WatchedFilter<T, E, D> {
    /// A watched filter that has not started, for `static` memory.
    #[must_use]
    pub const fn unset(effects: &'static [WatchedEffect; E]) -> Self {
        let mut entries = [Entry {
            value: gyrocal_watch::Value::State(0),
            slope: D,
            from_onset: false,
        }; E];
        let mut i = 0;
        while i < E {
            entries[i] = effects[i].entry(D);
            i += 1;
        }
        Self {
            filter: ControllerFilter::unset(),
            watch: Watch::unset(columns::<D>(), entries),
            effects,
            settings: WatchSettings {
                false_alarms_per_year: T::ZERO,
                for_ever: false,
                interval_s: T::ZERO,
                block_s: T::ZERO,
                walk_deg_per_h_per_sqrt_h: [T::ZERO; 3],
                clip: T::ZERO,
                set_width: T::ZERO,
                sought_sigmas: T::ZERO,
                sought_jump_rad: T::ZERO,
            },
            linearised: Linearised::unset(),
            early: [T::ZERO; E],
            walked_s: [T::ZERO; 3],
            next_walk: 0,
            alarm: None,
        }
    }

    /// Starts filter and watch in place, at the first sample, which [`Self::update`] takes.
    ///
    /// # Errors
    /// [`ControllerError::Settings`], also for settings of the watch that have no meaning.
    pub fn start(
        &mut self,
        settings: &FilterSettings<T>,
        attitude: &InitialAttitude<T>,
        limits: Limits<T>,
        watch: &WatchSettings<T>,
    ) -> Result<(), ControllerError> {
        let refused = |expected| {
            Err(ControllerError::Settings(
                EstimationError::InvalidArgument { expected },
            ))
        };
        if !watch.is_valid() {
            return refused("positive settings of the watch");
        }
        self.filter.start(settings, attitude, limits)?;
        self.settings = *watch;
        self.walked_s = [T::ZERO; 3];
        self.next_walk = 0;
        self.alarm = None;
        let mut information = [T::ZERO; E];
        for (place, effect) in information.iter_mut().zip(self.effects) {
            *place = effect.information_of_a_day(settings);
        }
        let courses = self.courses();
        if !self.watch.start(&watch.of_test(information), &courses.0) {
            return refused("blocks of two samples or more");
        }
        Ok(())
    }

    /// Takes the first sample.
    ///
    /// # Errors
    /// As [`ControllerFilter::update`].
    pub fn update(
        &mut self,
        specific_force_g: &[T; 3],
    ) -> Result<Innovation<T, 3>, ControllerError> {
        self.linearised.before_update(self.filter.filter());
        let innovation = self.filter.update(specific_force_g)?;
        self.linearised.updated(self.filter.filter(), &innovation);
        Ok(innovation)
    }

    /// Time passes, and at its end a sample is taken, by the filter and by the watch.
    ///
    /// # Errors
    /// As [`ControllerFilter::step`]. A sample that is too surprising for the filter is seen by the watch:
    /// ask [`Self::alarm`].
    #[inline]
    pub fn step(
        &mut self,
        interval_s: T,
        specific_force_g: &[T; 3],
    ) -> Result<WatchedStep<T>, ControllerError> {
        self.filter.check_interval(interval_s)?;
        self.filter.check_sample(specific_force_g)?;
        let taken = self.pass(interval_s, Some(specific_force_g))?;
        let innovation = taken.ok_or_else(|| self.filter.surprised())?;
        Ok(WatchedStep {
            innovation,
            alarm: self.alarm,
        })
    }

    /// Time passes without a sample.
    ///
    /// # Errors
    /// As [`ControllerFilter::coast`].
    pub fn coast(&mut self, interval_s: T) -> Result<(), ControllerError> {
        self.filter.check_interval(interval_s)?;
        self.pass(interval_s, None).map(|_| ())
    }

    /// An interval, in the parts that the filter divides it into. The innovation of a sample that was
    /// taken.
    #[inline(never)]
    fn pass(
        &mut self,
        interval_s: T,
        sample: Option<&[T; 3]>,
    ) -> Result<Option<Innovation<T, 3>>, ControllerError> {
        let parts = self.filter.filter().parts(interval_s);
        let part_s = interval_s / T::from_u32(parts);
        let (mut innovation, mut alarm) = (None, None);
        let clip = self.settings.clip;
        for part in 1..=parts {
            self.filter.predict(part_s)?;
            self.walk(part_s)?;
            self.linearised.predicted(self.filter.filter());
            let seen = sample.filter(|_| part == parts);
            if let Some(sample) = seen {
                let (found, taken) = self.filter.take_clipped(interval_s, sample, clip)?;
                if taken {
                    self.linearised.updated(self.filter.filter(), &found);
                    innovation = Some(found);
                } else {
                    self.linearised
                        .not_taken(self.filter.filter(), &found, clip);
                }
            }
            let step = Step {
                transition: &self.linearised.transition,
                observed: seen.map(|_| &self.linearised.observed),
                part: part_s / self.settings.block_s,
            };
            let whitened = match seen {
                Some(_) => self.linearised.innovation,
                None => [T::ZERO; 3],
            };
            alarm = self.watch.step(&step, &whitened).or(alarm);
            self.look_ahead();
        }
        self.alarm = alarm;
        Ok(innovation)
    }

    /// Adds the walk of one gyro, one after the other, every eighth step: it is slow.
    #[inline(always)]
    fn walk(&mut self, interval_s: T) -> Result<(), ControllerError> {
        for time in &mut self.walked_s {
            *time = *time + interval_s;
        }
        let turn = self.next_walk;
        self.next_walk = if turn + 1 >= WALK_TURNS { 0 } else { turn + 1 };
        if !turn.is_multiple_of(8) {
            return Ok(());
        }
        let gyro = turn as usize / 8;
        let walks = &self.settings.walk_deg_per_h_per_sqrt_h;
        if let (Some(walk), Some(time), Some(channel)) = (
            walks.get(gyro),
            self.walked_s.get_mut(gyro),
            RATES.get(gyro),
        ) {
            let variance = *walk * *walk * *time * T::from_f64(1.0 / 3600.0);
            *time = T::ZERO;
            if variance.is_positive() {
                let mut direction = [T::ZERO; N];
                if let Some(place) = direction.get_mut(Platform::MOVING + channel.constant) {
                    *place = T::from_f64(1.0);
                }
                return self.filter.displace(&direction, T::ZERO, variance);
            }
        }
        Ok(())
    }

    /// Foretells the courses of the next block, one value in the last step but one and one in the
    /// last, so that no step has both.
    #[inline(always)]
    fn look_ahead(&mut self) {
        let (interval_s, block_s) = (self.settings.interval_s, self.settings.block_s);
        if self.watch.steps_to_go() == 1 {
            let time_s = Courses::<T, E>::time_s(false, block_s) + interval_s;
            self.early = self.values(time_s);
        } else if self.watch.block_is_over() {
            let late = self.values(Courses::<T, E>::time_s(true, block_s));
            let courses = Courses::through(self.effects, &[self.early, late], block_s);
            self.watch.end_block(&courses.0);
        }
    }

    #[inline(never)]
    fn values(&self, time_s: T) -> [T; E] {
        let filter = self.filter.filter();
        let (chart, drift) = (filter.kernel().inputs(), filter.drift().to_array());
        Courses::values(self.effects, chart, &drift, time_s)
    }

    #[inline(never)]
    fn courses(&self) -> Courses<T, E> {
        let filter = self.filter.filter();
        Courses::ahead(
            self.effects,
            filter.kernel().inputs(),
            &filter.drift().to_array(),
            self.settings.block_s,
        )
    }

    /// Calls `each` with every effect that the evidence does not tell apart from the most likely one:
    /// the answer to an alarm, and to the question at any time. The effect is `None` for a jump about
    /// the axis `candidate.effect - E`, whose size is in radians.
    pub fn candidates(&self, mut each: impl FnMut(Option<&'static WatchedEffect>, Candidate<T>)) {
        self.watch.candidates(self.settings.set_width, |candidate| {
            each(self.effects.get(candidate.effect), candidate);
        });
    }

    /// An effect with its best onset, or, beyond the effects, a jump about an axis; `None` while
    /// nothing is known of it.
    #[must_use]
    pub fn candidate(&self, effect: usize) -> Option<Candidate<T>> {
        self.watch.candidate(effect)
    }

    /// Adopts a cause: the filter is corrected by what the effect has left in it, and by the effect
    /// itself where it is a change of a coefficient, with the variance of the estimate. The watch goes
    /// on with new onsets. Returns false, and nothing has changed, for an effect that would go on and
    /// that the filter has no coefficient of: its name belongs into an extended model
    /// (`docs/extending.md`).
    ///
    /// # Errors
    /// [`ControllerError::NotRunning`]; [`ControllerError::Failed`] if the estimate is not finite.
    pub fn adopt(&mut self, candidate: &Candidate<T>) -> Result<bool, ControllerError> {
        let Some(mut direction) = self.watch.deviation(candidate) else {
            return Ok(false);
        };
        if let Some(effect) = self.effects.get(candidate.effect) {
            let place = effect
                .coefficient()
                .and_then(|coefficient| direction.get_mut(coefficient));
            let Some(place) = place else {
                return Ok(false);
            };
            *place = *place + T::from_f64(1.0);
        }
        let variance = candidate.sigma * candidate.sigma;
        self.filter
            .displace(&direction, candidate.estimate, variance)?;
        self.go_on();
        Ok(true)
    }

    /// Goes on after an alarm without adopting a cause: all onsets are dropped and new ones begin. The
    /// expected number of false alarms in a year stays below the declared one.
    pub fn go_on(&mut self) {
        let courses = self.courses();
        self.watch.restart(&courses.0);
    }

    /// Evidence of effects and of jumps, over its threshold.
    #[must_use]
    pub fn evidence(&self) -> [T; 2] {
        self.watch.statistics()
    }

    /// The filter, for its estimates and their sigmas.
    #[must_use]
    pub fn filter(&self) -> &PlatformFilter<T, Factors> {
        self.filter.filter()
    }

    /// The last step, linearised.
    #[must_use]
    pub fn linearised(&self) -> &Linearised<T> {
        &self.linearised
    }
}

impl<T: SavedNumber> Default for PlatformWatch<T> {
    fn default() -> Self {
        Self::unset(&EFFECTS_BY_DEFAULT)
    }
}
