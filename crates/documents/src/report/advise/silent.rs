//! Clocks that no period was given for.

use super::words::{length, typical};
use crate::report::decimal::few;
use molecules::unit::TimeUnit;
use molecules::{Advice, Answer, FAST, SLOW, Scheme, Typical, shortest_of};
use number::to_f64;

/// On which condition a scheme is stable where a clock has no period: its forces' own steps are no longer
/// than all others'.
pub(super) fn condition(advice: &Advice, answer: &Answer) -> String {
    let Some(proven) = answer.needs else { return String::new() };
    let value = proven.max(shortest_of(to_f64(answer.scheme.outer())));
    let [own, proven] = [value, proven].map(|x| advice.unit.of(few(x * 1.005, 3)));
    format!(
        " if no period of {} is below {own} (proven stable above {proven})",
        clocks(advice, &answer.scheme)
    )
}

/// "the forces every 1 fs": those of clocks that no period was given for.
pub(super) fn clocks(advice: &Advice, scheme: &Scheme) -> String {
    let has_none = |clock: &usize| advice.modes.iter().all(|mode| mode.clock != Some(*clock));
    let steps =
        (0..scheme.steps().len()).filter(has_none).map(|clock| length(&scheme.steps()[clock], advice.unit));
    format!("the forces every {}", steps.collect::<Vec<_>>().join(" and every "))
}

/// The periods that nobody gave, and typical ones by name.
pub(super) fn missing(advice: &Advice) -> Vec<String> {
    let in_fs = advice.unit == TimeUnit::Femtoseconds;
    if advice.lacks_fast {
        let of = |all: &[Typical]| {
            let shown = all
                .iter()
                .map(|typical| format!("{} {} fs", typical.asked(), typical.period))
                .collect::<Vec<_>>()
                .join(", ");
            format!("  fast       {shown}: {}", all[0].source)
        };
        return FAST.chunk_by(|a, b| a.source == b.source).map(of).filter(|_| in_fs).collect();
    }
    if !advice.silent {
        return Vec::new();
    }
    let line = format!(
        "  unknown    {} have no period given and are taken as 0; with them unstable steps begin somewhat below the step given here",
        clocks(advice, &advice.schemes[0].scheme)
    );
    let slow = format!("  slow       measured at a minimum: {}", SLOW.each_ref().map(typical).join("; "));
    [line].into_iter().chain(in_fs.then_some(slow)).collect()
}
