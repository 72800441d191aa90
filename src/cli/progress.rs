//! Progress on standard error.

use std::fmt::Write;
use std::io::IsTerminal;

use indicatif::{HumanCount, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

/// A bar that shows itself on a terminal only, and nowhere where `quiet`; `things` names what is counted.
pub fn progress(quiet: bool, length: u64, things: &str) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::stderr());
    let template = format!("{{bar:30}} {{human_pos}} of {{human_len}} {things}, {{rate}}/s, {{eta}} left");
    let style = ProgressStyle::with_template(&template).expect("the template is sound");
    bar.with_style(style.with_key("rate", rate))
}

/// Says on a terminal what is about to take more than a second, and about how long: for work that no bar counts.
pub fn announce(quiet: bool, work: &str, seconds: f64) {
    if seconds > 1.0 && !quiet && std::io::stderr().is_terminal() {
        eprintln!("kickdrift: {work}: some {seconds:.0} s of one core");
    }
}

/// Whole things a second.
fn rate(state: &ProgressState, to: &mut dyn Write) {
    // A bar that cannot write its rate is no reason to stop.
    let _ = write!(to, "{}", HumanCount(state.per_sec() as u64));
}
