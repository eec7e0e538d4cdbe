//! Jobs that can be stopped.
//!
//! A fit, a search, a campaign asks its [`Stop`] in every pass over a record, wherever it works. So it is that of
//! a thread, as the counted work of passes is: [`Stop::over`] sets it, and a job that takes further threads hands
//! it on. Once asked, every pass fails. A search may go on without a fit that fails, so an error is not what tells
//! that a job was stopped: functions that answer end by [`finished`].

use core::cell::RefCell;
use core::sync::atomic::{AtomicBool, Ordering};
use std::sync::Arc;

thread_local! {
    static HERE: RefCell<Option<Stop>> = const { RefCell::new(None) };
}

/// Rows of a record after which a pass asks again.
const ROWS: usize = 64;

/// The job was stopped before its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the job was stopped before its end")]
pub struct Stopped;

/// Stops a job, from any thread. Copies stop the same job.
///
/// # Example
/// ```
/// use gyrocal_inference::stop::{self, Stop, Stopped};
///
/// let stop = Stop::default();
/// let found = stop.over(|| {
///     stop.ask();
///     stop::check()
/// });
/// assert_eq!(found, Err(Stopped));
/// // Without a job there is nothing to stop.
/// assert_eq!(stop::check(), Ok(()));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// That of the job of this thread; of a thread without a job one that nobody asks.
    #[must_use]
    pub fn here() -> Self {
        HERE.with_borrow(Clone::clone).unwrap_or_default()
    }

    /// Asks the job to end. This cannot be taken back.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the job was asked to end.
    #[must_use]
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Fails if the job was asked to end.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn check(&self) -> Result<(), Stopped> {
        match self.is_asked() {
            true => Err(Stopped),
            false => Ok(()),
        }
    }

    /// Does work of the job on this thread.
    pub fn over<T>(&self, work: impl FnOnce() -> T) -> T {
        let before = HERE.replace(Some(self.clone()));
        let _restored = Restored(before);
        work()
    }
}

/// Restores what was before, after a panic too.
struct Restored(Option<Stop>);

impl Drop for Restored {
    fn drop(&mut self) {
        HERE.set(self.0.take());
    }
}

/// Whether the job of this thread was asked to end.
#[must_use]
pub fn is_asked() -> bool {
    check().is_err()
}

/// Fails if the job of this thread was asked to end.
///
/// # Errors
/// [`Stopped`].
pub fn check() -> Result<(), Stopped> {
    HERE.with_borrow(|stop| stop.as_ref().map_or(Ok(()), Stop::check))
}

/// The same in a pass over the rows of a record, each of which calls it.
///
/// # Errors
/// [`Stopped`].
pub fn check_at(row: usize) -> Result<(), Stopped> {
    match row.is_multiple_of(ROWS) {
        true => check(),
        false => Ok(()),
    }
}

/// What a job answers. If it was asked to end, neither its answer is whole nor an error its own.
///
/// # Errors
/// [`Stopped`], and the error of the job.
pub fn finished<T, E: From<Stopped>>(answer: Result<T, E>) -> Result<T, E> {
    check()?;
    answer
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_job_within_a_job_has_its_own_stop_and_gives_the_other_back() {
        let (outer, inner) = (Stop::default(), Stop::default());
        outer.ask();
        outer.over(|| {
            assert_eq!(inner.over(check), Ok(()));
            assert_eq!(check(), Err(Stopped));
            let panicked = std::panic::catch_unwind(|| inner.over(|| panic!("as a test does")));
            assert!(panicked.is_err() && is_asked());
        });
        assert!(!is_asked());
    }

    #[test]
    fn further_threads_have_the_stop_that_they_are_handed() {
        let stop = Stop::default();
        stop.over(|| {
            let handed = Stop::here();
            std::thread::scope(|scope| {
                let own = scope.spawn(|| {
                    handed.ask();
                    (is_asked(), handed.over(is_asked))
                });
                assert_eq!(own.join().ok(), Some((false, true)));
            });
            assert_eq!(finished(Ok::<_, Stopped>(1)), Err(Stopped));
        });
    }
}
