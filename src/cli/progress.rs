//! Progress on standard error.

use std::fmt::Write;
use std::io::{IsTerminal, stderr};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
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
        EXPECTED_SECONDS.fetch_add(seconds as u64, Ordering::Relaxed);
    }
}

/// All that was announced, seconds of one core.
static EXPECTED_SECONDS: AtomicU64 = AtomicU64::new(0);

/// Whether a bar has counted something.
static COUNTED: AtomicBool = AtomicBool::new(false);

/// Says on a terminal that work which no bar counts goes on: after two seconds, and after twice as long each
/// time. Until it is dropped.
pub struct Patience(#[expect(dead_code, reason = "dropping it ends the thread")] Option<Sender<()>>);

impl Patience {
    pub fn new(quiet: bool) -> Patience {
        if quiet || !stderr().is_terminal() {
            return Patience(None);
        }
        let (work, ended) = channel::<()>();
        std::thread::spawn(move || {
            let (mut passed, mut next) = (0, 2);
            while ended.recv_timeout(Duration::from_secs(next - passed)) == Err(RecvTimeoutError::Timeout) {
                if !COUNTED.load(Ordering::Relaxed) {
                    match EXPECTED_SECONDS.load(Ordering::Relaxed) {
                        0 => eprintln!("kickdrift: {next} s so far"),
                        expected => eprintln!("kickdrift: {next} s so far, of some {expected} s of one core"),
                    }
                }
                (passed, next) = (next, 2 * next);
            }
        });
        Patience(Some(work))
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
