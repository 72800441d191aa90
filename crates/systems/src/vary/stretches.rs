//! Stretches of one number that cover a range, each with what is proven of all of it.

use crate::verdict::measured::Holds;
use number::parallel::try_map;
use number::{Error, Result};

/// Numbers of one verdict.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// From this one,
    pub lo: f64,
    /// to this one.
    pub hi: f64,
    /// The verdict that is proven for all numbers in between, [`Holds::Undecided`] where none is.
    pub verdict: Holds,
}

/// Parts of a range that threads share.
const PARTS: u32 = 16;

/// Around an edge, how much narrower than elsewhere the cells may get.
const FINER: f64 = 1e-4;

/// The verdicts on all numbers from `lo` to `hi`, as stretches that cover them, `verdict(a, b)` being what
/// holds for all of \[a, b\]. No interval wider than `width` times the larger end is missed; the ends of
/// those found are sharper.
///
/// # Errors
/// An empty range, a width outside \[10^-9, 1/10\], the first error of `verdict`.
pub fn cover(
    (lo, hi): (f64, f64),
    width: f64,
    verdict: impl Fn(f64, f64) -> Result<Holds> + Sync,
) -> Result<Vec<Stretch>> {
    if !(lo < hi && hi.is_finite() && lo.is_finite()) {
        return Err(Error::input("range", format!("{lo}..{hi}"), "write the smaller number first"));
    }
    check_width(width)?;
    let floor = width * lo.abs().max(hi.abs());
    let place = |k: u32| if k == PARTS { hi } else { lo + (hi - lo) * f64::from(k) / f64::from(PARTS) };
    let parts: Vec<_> = (0..PARTS).map(|k| (place(k), place(k + 1))).collect();
    let found = try_map(&parts, |&ends| cells(ends, floor, &verdict))?;
    let coarse = merged(found.into_iter().flatten());
    // An open stretch gives its neighbours the parts that smaller cells prove.
    let shrink = |stretch: &Stretch| match stretch.verdict {
        Holds::Undecided => shrunk(stretch, FINER * floor, &verdict),
        _ => Ok(vec![*stretch]),
    };
    Ok(merged(try_map(&coarse, shrink)?.into_iter().flatten()))
}

/// Refuses a width that no cell should have: doubles do not separate narrower ones, and they fill the memory.
///
/// # Errors
/// A width outside \[10^-9, 1/10\], or NaN.
pub fn check_width(width: f64) -> Result<()> {
    if !(1e-9..=0.1).contains(&width) {
        return Err(Error::input("resolution", width, "choose 1e-9 to 0.1"));
    }
    Ok(())
}

/// Cells that sharpen the ends of open stretches of a range: of one to three, some 24 each, as measured on
/// data/scenes.
const SHARPENING: f64 = 60.0;

/// The most cells that [`cover`] asks about, roughly: each as narrow as they get, and a wider one tried
/// before it.
pub fn most_cells((lo, hi): (f64, f64), width: f64) -> f64 {
    2.0 * (hi - lo) / (width * lo.abs().max(hi.abs())) + f64::from(PARTS) + SHARPENING
}

/// Cells that sharpen one end.
const MOST_CELLS: usize = 64;

/// From left to right, each cell as wide as proves something.
fn cells(
    (lo, hi): (f64, f64),
    floor: f64,
    verdict: &impl Fn(f64, f64) -> Result<Holds>,
) -> Result<Vec<Stretch>> {
    let (mut found, mut at, mut step) = (Vec::new(), lo, hi - lo);
    while at < hi {
        let end = if at + 1.01 * step >= hi { hi } else { at + step };
        match verdict(at, end)? {
            // Half as much again: at + floor may be a rounding farther than floor.
            Holds::Undecided if end - at > 1.5 * floor => step = ((end - at) / 4.0).max(floor),
            decided => {
                found.push(Stretch { lo: at, hi: end, verdict: decided });
                at = end;
                step *= 2.0;
            }
        }
    }
    Ok(found)
}

/// An open stretch without the parts that cells down to `floor` prove at its ends: near an edge cells are as
/// wide as they are far from it.
fn shrunk(
    stretch: &Stretch,
    floor: f64,
    verdict: &impl Fn(f64, f64) -> Result<Holds>,
) -> Result<Vec<Stretch>> {
    let (mut lo, mut hi) = (stretch.lo, stretch.hi);
    let mut ends = [Vec::new(), Vec::new()];
    for (k, found) in ends.iter_mut().enumerate() {
        let mut step = (hi - lo) / 4.0;
        for _ in 0..MOST_CELLS {
            if step <= floor || lo >= hi {
                break;
            }
            let cell = if k == 0 { (lo, (lo + step).min(hi)) } else { ((hi - step).max(lo), hi) };
            match verdict(cell.0, cell.1)? {
                Holds::Undecided => step /= 2.0,
                decided => {
                    found.push(Stretch { lo: cell.0, hi: cell.1, verdict: decided });
                    *(if k == 0 { &mut lo } else { &mut hi }) = if k == 0 { cell.1 } else { cell.0 };
                }
            }
        }
    }
    let [left, right] = ends;
    let rest = (lo < hi).then_some(Stretch { lo, hi, verdict: Holds::Undecided });
    Ok(left.into_iter().chain(rest).chain(right.into_iter().rev()).collect())
}

/// Neighbours of one verdict as one stretch.
pub fn merged(stretches: impl Iterator<Item = Stretch>) -> Vec<Stretch> {
    let mut all: Vec<Stretch> = Vec::new();
    for stretch in stretches {
        match all.last_mut() {
            Some(last) if last.verdict == stretch.verdict => last.hi = stretch.hi,
            _ => all.push(stretch),
        }
    }
    all
}
