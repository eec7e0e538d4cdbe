//! Long jobs: other threads of Python run beside them, and an interrupt ends them.

use std::panic::resume_unwind;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread::{Builder, scope};
use std::time::Duration;

use gyrocal_inference::Stop;
use pyo3::prelude::*;

use crate::error::{Class, Failure, Outcome};

/// Time between two looks for signals.
const PERIOD: Duration = Duration::from_millis(100);

/// Stack of a job, bytes: that of a main thread.
const STACK: usize = 8 << 20;

/// Does a job without the lock of the interpreter. Signals reach the main thread alone: one that calls hands the job to
/// another thread and looks for them. What a handler raises, as that of an interrupt does, stops the job and is raised
/// once it has ended.
pub(crate) fn run<T: Send>(py: Python<'_>, job: impl FnOnce() -> Outcome<T> + Send) -> PyResult<T> {
    if !is_main_thread(py)? {
        return Ok(py.detach(job)?);
    }
    Ok(py.detach(|| watched(job))??)
}

fn is_main_thread(py: Python<'_>) -> PyResult<bool> {
    let threading = py.import("threading")?;
    let own = threading.call_method0("current_thread")?;
    Ok(own.is(&threading.call_method0("main_thread")?))
}

/// What a job answers, or what a handler of a signal raised.
fn watched<T: Send>(job: impl FnOnce() -> Outcome<T> + Send) -> PyResult<Outcome<T>> {
    let stop = Stop::default();
    scope(|scope| {
        let (done, ended) = channel::<()>();
        let own = stop.clone();
        let thread = Builder::new().stack_size(STACK);
        let worker = thread.spawn_scoped(scope, move || {
            // Dropped at the end, after a panic too.
            let _done = done;
            own.over(job)
        });
        let worker = worker.map_err(|reason| Failure {
            class: Class::Computation,
            message: format!("no thread can be started: {reason}"),
            advice: Some("end other programs or threads".to_owned()),
            ..Failure::default()
        })?;
        let mut raised = None;
        while ended.recv_timeout(PERIOD) == Err(RecvTimeoutError::Timeout) {
            if raised.is_none() {
                raised = Python::attach(|py| py.check_signals()).err();
            }
            if raised.is_some() {
                stop.ask();
            }
        }
        let answer = worker.join().unwrap_or_else(|panic| resume_unwind(panic));
        raised.map_or(Ok(answer), Err)
    })
}
