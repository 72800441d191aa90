//! Progress on standard error.

use std::fmt::Write;
use std::io::{IsTerminal, stderr};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use clocks::tongue::Progress;
use indicatif::{HumanCount, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use number::error::visible;

/// A bar that shows itself on a terminal only, and nowhere where `quiet`; `things` names what is counted.
pub fn progress(quiet: bool, length: u64, things: &str) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    COUNTED.store(true, Ordering::Relaxed);
    let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::stderr());
    let template = format!("{{bar:30}} {{human_pos}} of {{human_len}} {things}, {{rate}}/s, {{eta}} left");
    let style = ProgressStyle::with_template(&template).expect("the template is sound");
    bar.with_style(style.with_key("rate", rate))
}

/// Says on a terminal what is about to take more than a second, and about how long: for work that no bar
/// counts.
pub fn announce(quiet: bool, work: &str, seconds: f64) {
    if seconds > 1.0 && !quiet && stderr().is_terminal() {
        let work = visible(work).replace('\n', " ");
        eprintln!("kickdrift: {work}: some {seconds:.0} s of one core");
        EXPECTED_SECONDS.fetch_add(seconds.round() as u64, Ordering::Relaxed);
    }
}

/// All that was announced, seconds of one core.
static EXPECTED_SECONDS: AtomicU64 = AtomicU64::new(0);

/// Whether a bar has counted something.
static COUNTED: AtomicBool = AtomicBool::new(false);

/// Shows on a terminal that work which no other bar counts goes on: seconds over those that were announced,
/// or a line after two seconds and after twice as long each time. Until it is dropped.
pub struct Patience(Option<(Sender<()>, JoinHandle<()>)>);

impl Patience {
    pub fn new(quiet: bool) -> Patience {
        if quiet || !stderr().is_terminal() {
            return Patience(None);
        }
        let (work, ended) = channel::<()>();
        let thread = std::thread::spawn(move || {
            let (mut passed, mut next) = (0, 2);
            while ended.recv_timeout(Duration::from_secs(1)) == Err(RecvTimeoutError::Timeout) {
                passed += 1;
                let is_due = passed == next;
                next = if is_due { 2 * next } else { next };
                match EXPECTED_SECONDS.load(Ordering::Relaxed) {
                    _ if passed < 2 || COUNTED.load(Ordering::Relaxed) => {}
                    0 if is_due => eprintln!("kickdrift: {passed} s so far"),
                    0 => {}
                    expected => show_rest(passed, expected),
                }
            }
        });
        Patience(Some((work, thread)))
    }
}

impl Drop for Patience {
    fn drop(&mut self) {
        let Some((work, thread)) = self.0.take() else { return };
        drop(work);
        // It has nothing to tell.
        let _ = thread.join();
        make_room();
    }
}

/// The bar over announced work, while it is on the screen.
static WAITING: Mutex<Option<ProgressBar>> = Mutex::new(None);

fn show_rest(passed: u64, expected: u64) {
    let mut waiting = WAITING.lock().unwrap_or_else(PoisonError::into_inner);
    let bar = waiting.get_or_insert_with(|| {
        let style = ProgressStyle::with_template("{bar:30} {msg}").expect("the template is sound");
        ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr()).with_style(style)
    });
    bar.set_length(expected);
    bar.set_position(passed.min(expected));
    bar.set_message(rest(passed, expected));
}

/// How long announced work has taken, and how long it may take.
fn rest(passed: u64, expected: u64) -> String {
    match expected.checked_sub(passed) {
        Some(left) if left > 0 => format!("{passed} s of some {expected} s of one core, some {left} s left"),
        _ => format!("{passed} s, longer than the {expected} s expected"),
    }
}

/// Takes the bar over announced work off the screen, before something else is written there.
pub fn make_room() {
    if let Some(bar) = WAITING.lock().unwrap_or_else(PoisonError::into_inner).take() {
        bar.finish_and_clear();
    }
}

/// Whole things a second.
fn rate(state: &ProgressState, to: &mut dyn Write) {
    // A bar that cannot write its rate is no reason to stop.
    let _ = write!(to, "{}", HumanCount(state.per_sec() as u64));
}

/// Progress, shown by a bar.
pub struct Shown(pub ProgressBar);

impl Progress for Shown {
    fn expect(&self, total: u64) {
        self.0.set_length(total);
    }

    fn advance(&self, more: u64) {
        self.0.inc(more);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn announced_work_has_a_rest_time_until_it_takes_longer() {
        assert_eq!(rest(12, 40), "12 s of some 40 s of one core, some 28 s left");
        assert_eq!(
            [rest(40, 40), rest(44, 40)],
            [40, 44].map(|n| format!("{n} s, longer than the 40 s expected"))
        );
    }
}
