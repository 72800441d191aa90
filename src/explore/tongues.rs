//! Certified tongues as vectors: what they cost does not depend on how deep the window lies.

use serde_json::{Value, json};

use super::frame::Frame;
use super::query::{Query, count, positive};
use super::rays::ratios;
use super::reply::Reply;
use super::session::Session;
use clocks::tongue::{Bounds, Listing, Request, Selection, StepWindow, Stiffness, Tongue, TongueEdge};
use documents::question::StepRange;
use number::{Ratio, Rational, Result, rational};

/// Segments, about, that a page can draw while it is dragged.
const MOST_SEGMENTS: f64 = 3000.0;

/// Masses and springs that are laid out for all ratios together.
pub(super) const MOST_KICKS: u64 = 2_000_000;

/// Candidates for the largest p + q; the first one is always allowed.
const SUMS: [u64; 20] =
    [6, 8, 12, 16, 24, 32, 40, 48, 64, 96, 128, 192, 256, 384, 512, 1024, 2048, 4096, 8192, 16384];

/// Digits of a tongue's place in its window, beyond those that lead to the window.
const DIGITS: u32 = 8;

/// Depth from which doubles do not place edges in the window.
const DEEP: u32 = 9;

/// Every tongue of every ratio up to `max_sum`, or as far as the limit allows, that lies in the window,
/// narrower ones than `min_width` (in h1) left out; the rest of the story is in `segment`.
pub(super) fn answer(session: &Session, query: &Query) -> Result<Reply> {
    let (stiffness, window) = (query.stiffness(session)?, query.window(session)?);
    let asked = query.read("max_sum", count(2, 100_000))?;
    let least = query.read("min_width", positive)?.map_or(0.0, |width| rational::to_f64(&width));
    let frame = Frame::new(&window);
    let (ratios, max_sum) = affordable(&frame, &window, &stiffness, asked);
    let question = question(ratios, stiffness, window, &frame)?;
    let (mut segments, mut narrow) = (Vec::new(), 0);
    question.each(&(), |part| {
        for tongue in part {
            if width(tongue) < least {
                narrow += 1;
            } else {
                segments.extend(segment(tongue, &frame));
            }
        }
        Ok(())
    })?;
    let complete = asked.is_none_or(|asked| asked <= max_sum);
    let body = json!({
        "segments": segments, "max_sum": max_sum, "complete": complete, "ratios": question.ratios.len(), "narrower": narrow,
    });
    Ok(Reply::json(&body))
}

/// Ratios up to the largest sum that the limits allow, and that sum.
fn affordable(
    frame: &Frame,
    window: &[StepRange; 2],
    stiffness: &Stiffness,
    asked: Option<u64>,
) -> (Vec<Ratio>, u64) {
    let range = frame.ratios();
    let root = stiffness.lambda1.as_ref().map_or(1.0, |lambda1| lambda1.to_f64().sqrt());
    let steps = window.each_ref().map(|(lo, hi)| (lo.to_f64(), hi.to_f64()));
    let sums = SUMS.into_iter().filter(|&sum| asked.is_none_or(|asked| sum < asked)).chain(asked);
    let (mut best, mut largest) = (Vec::new(), 0);
    for sum in sums {
        let Some(found) = ratios(&range, sum, 20_000) else { break };
        let kicks: u64 = found.iter().map(|ratio| ratio.kicks()).sum();
        let segments: f64 = found.iter().map(|&ratio| expected(ratio, steps, root)).sum();
        if largest > 0 && (kicks > MOST_KICKS || segments > MOST_SEGMENTS) {
            break;
        }
        (best, largest) = (found, sum);
    }
    (best, largest)
}

/// About how many tongues a ratio has in the window: one a half turn pθ/π up to the fast clock's limit, the q
/// − 1 others beyond it.
fn expected(ratio: Ratio, [(a, b), (c, d)]: [(f64, f64); 2], root: f64) -> f64 {
    let (p, q) = (ratio.p() as f64, ratio.q() as f64);
    let turns = |h1: f64| p * (h1 * root / 2.0).clamp(0.0, 1.0).asin() / std::f64::consts::FRAC_PI_2;
    let (from, upto) = (a.max(c * q / p), b.min(d * q / p));
    let beyond = if upto * root > 2.0 { q } else { 0.0 };
    (turns(upto) - turns(from)).max(0.0) + beyond + 1.0
}

/// The tongues in the window with a half of itself on each side.
fn question(
    ratios: Vec<Ratio>,
    stiffness: Stiffness,
    window: [StepRange; 2],
    frame: &Frame,
) -> Result<Listing> {
    let digits = Some(frame.depth()).filter(|&depth| depth >= DEEP).map(|depth| depth + DIGITS);
    let [h1, h2] = window.map(Some);
    Listing::new(
        ratios,
        stiffness,
        StepWindow { h1, h2 },
        Selection::default(),
        Request { digits, ..Request::default() },
    )
}

/// The width in h1, nearly; infinite for the last tongue.
fn width(tongue: &Tongue) -> f64 {
    let Some(h1) = tongue.lower.steps.as_ref().map(|[h1, _]| h1.lo) else { return f64::INFINITY };
    // s = h1² L1: dh1 = h1 ds/(2 s).
    tongue.row.gap.width.1 * h1 / (2.0 * tongue.lower.s.lo)
}

/// `p, q, ratio, m, a, b, closed`; `from`, `to`: (h1, h2) of its edges, to null of the last tongue; `line`:
/// what of it lies in the window and half a window around it, as fractions (u, v, u, v) of the window;
/// `ends`: whether those are its edges.
fn segment(tongue: &Tongue, frame: &Frame) -> Option<Value> {
    let (ratio, gap) = (tongue.row.ratio, &tongue.row.gap);
    let slope = Rational::from(ratio);
    let [across, up] = frame.around();
    let (left, right) = (across.0.max(up.0 / &slope), across.1.min(up.1 / &slope));
    let lower = h1(&tongue.lower)?;
    let upper = tongue.upper.as_ref().and_then(h1);
    let ends = [lower >= left, upper.as_ref().is_some_and(|upper| *upper <= right)];
    let (from, to) = (lower.max(left), upper.map_or(right.clone(), |upper| upper.min(right)));
    if from > to {
        return None;
    }
    let at = |h1: &Rational| [frame.fraction(0, h1), frame.fraction(1, &(h1 * &slope))];
    let (a, b) = tongue.row.family.unwrap_or_default();
    let steps = |edge: &TongueEdge| {
        edge.steps.as_ref().map(|steps| steps.each_ref().map(|h| 0.5 * h.lo + 0.5 * h.hi))
    };
    let line = [at(&from), at(&to)].concat();
    Some(json!({
        "p": ratio.p(), "q": ratio.q(), "ratio": ratio.to_string(), "m": gap.m, "a": a, "b": b, "closed": gap.closed,
        "from": steps(&tongue.lower), "to": tongue.upper.as_ref().and_then(steps),
        "line": line, "ends": ends,
    }))
}

/// The middle of an edge's enclosure in h1, by as many digits as there are.
fn h1(edge: &TongueEdge) -> Option<Rational> {
    let Bounds { lo, hi, precise } = &edge.steps.as_ref()?[0];
    match precise {
        Some(precise) => Some(precise.middle()),
        None => rational::from_f64_exact(0.5 * lo + 0.5 * hi),
    }
}
