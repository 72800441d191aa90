//! Work beside the interpreter: other threads of Python run meanwhile, and Ctrl-C is heard.

use std::sync::atomic::{AtomicBool, Ordering};
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

/// Runs `work` on a thread of its own without the interpreter. Where a signal raises an exception meanwhile, the exception
/// is returned at once, and the flag is set that the library looks at piece by piece: the work ends soon after, unseen.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> Result<T> + Send + 'static,
) -> PyResult<T> {
    let stopped = Arc::new(AtomicBool::new(false));
    let (sender, receiver) = channel();
    let (receiver, flag) = (Mutex::new(receiver), stopped.clone());
    let thread = std::thread::Builder::new().stack_size(STACK);
    // Nobody receives what comes after a signal.
    thread.spawn(move || drop(sender.send(stoppable(&flag, || work(&flag)))))?;
    loop {
        let received = py.detach(|| receiver.lock().map(|receiver| receiver.recv_timeout(PATIENCE)).ok());
        match received.ok_or_else(lost)? {
            Ok(done) => return done.map_err(|error| raised(&error)),
            Err(RecvTimeoutError::Disconnected) => return Err(lost()),
            Err(RecvTimeoutError::Timeout) => {
                py.check_signals().inspect_err(|_| stopped.store(true, Ordering::Relaxed))?;
            }
        }
    }
}
