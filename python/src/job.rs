//! Work beside the interpreter: other threads of Python run meanwhile, and Ctrl-C is heard.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use kickdrift::error::Result;
use kickdrift::parallel::stoppable;
use pyo3::prelude::*;

use crate::error::{lost, raised};

/// How long a signal waits at most until it is heard.
const PATIENCE: Duration = Duration::from_millis(100);

/// As much stack as a process's first thread has.
const STACK: usize = 8 << 20;

/// Who hears how far a work is: called with what is done and what there is in all.
pub struct Listener {
    pub called: Option<Py<PyAny>>,
    pub total: usize,
}

impl Listener {
    const NOBODY: Listener = Listener { called: None, total: 0 };

    fn tell(&self, py: Python<'_>, done: usize) -> PyResult<()> {
        self.called.as_ref().map_or(Ok(()), |called| called.call1(py, (done, self.total)).map(drop))
    }
}

/// Runs `work` on a thread of its own without the interpreter. Where a signal raises an exception meanwhile,
/// the exception is returned at once, and the flag is set that the library looks at piece by piece: the work
/// ends soon after, unseen.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> Result<T> + Send + 'static,
) -> PyResult<T> {
    run_heard(py, Listener::NOBODY, |stopped, _| work(stopped))
}

/// As [`run`], of work that counts what is done: the listener hears it ten times a second, and all of it at
/// the end. What the listener raises ends the work as a signal does.
pub fn run_heard<T: Send + 'static>(
    py: Python<'_>,
    listener: Listener,
    work: impl FnOnce(&AtomicBool, &AtomicUsize) -> Result<T> + Send + 'static,
) -> PyResult<T> {
    let (stopped, done) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicUsize::new(0)));
    let (sender, receiver) = channel();
    let (receiver, flag, count) = (Mutex::new(receiver), stopped.clone(), done.clone());
    let thread = std::thread::Builder::new().stack_size(STACK);
    // Nobody receives what comes after a signal.
    thread.spawn(move || drop(sender.send(stoppable(&flag, || work(&flag, &count)))))?;
    loop {
        let received = py.detach(|| receiver.lock().map(|receiver| receiver.recv_timeout(PATIENCE)).ok());
        match received.ok_or_else(lost)? {
            Ok(found) => {
                let found = found.map_err(|error| raised(&error))?;
                listener.tell(py, listener.total)?;
                return Ok(found);
            }
            Err(RecvTimeoutError::Disconnected) => return Err(lost()),
            Err(RecvTimeoutError::Timeout) => {
                let heard = py.check_signals().and_then(|()| listener.tell(py, done.load(Ordering::Relaxed)));
                heard.inspect_err(|_| stopped.store(true, Ordering::Relaxed))?;
            }
        }
    }
}
