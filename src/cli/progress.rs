//! Progress on standard error.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar that shows itself on a terminal only, and nowhere where `quiet`; `things` names what is counted.
pub fn progress(quiet: bool, length: u64, things: &str) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::stderr());
    let template = format!("{{bar:30}} {{human_pos}} of {{human_len}} {things}, {{per_sec}}, {{eta}} left");
    bar.with_style(ProgressStyle::with_template(&template).expect("the template is sound"))
}
