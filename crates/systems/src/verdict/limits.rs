//! By which means an answer is sought, and what it may cost.

use clocks::verdict;
use number::{Error, Result};

/// Which means are tried for parts of several degrees of freedom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Route {
    /// The cheapest that proves the verdict; where none does within the budget, an estimate.
    Cheapest,
    /// Exact arithmetic, or an error that names its cost.
    Exact,
}

/// Products of dense doubles are so many times as fast as others, which are of words or of few doubles at
/// once, as measured on two machines.
pub(crate) const DENSE: u64 = 10;

/// Products that a kick of the scalar ladder counts as.
const A_KICK: u64 = 1000;

/// Products a second, of rational systems with what goes on around them.
const PACE: f64 = 1e9;

/// The seconds of one core that so many products take, as limits count them: as measured on two machines.
pub fn seconds(products: f64) -> f64 {
    products / PACE
}

/// The most work that one verdict may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Products of doubles or of 64-bit words; of dense doubles ten count as one.
    pub products: u64,
    /// The part of these for the digits of a growth rate that doubles do not give.
    pub refining: u64,
}

/// From so many degrees of freedom on pieces of work with their matrices are worth threads of their own.
pub(crate) const SIDE_BY_SIDE: usize = 64;

impl Default for Limits {
    /// 5·10^10 products: a minute or two at worst; some tenths of a second for the digits of a rate.
    fn default() -> Self {
        Limits { products: 50_000_000_000, refining: 1 << 28 }
    }
}

impl Limits {
    /// That work of this cost may begin; `work` is its description.
    ///
    /// # Errors
    /// A budget error with the cost where it exceeds the limit.
    pub fn allow(&self, cost: u64, work: impl FnOnce() -> String) -> Result<()> {
        if cost <= self.products {
            return Ok(());
        }
        let (cost_told, most) = (cost as f64, self.products as f64);
        let time = match seconds(cost_told) {
            seconds if seconds < 100.0 => format!("{:.0} s", seconds.ceil()),
            seconds if seconds < 6000.0 => format!("{:.0} min", seconds / 60.0),
            seconds => format!("{:.0} h", seconds / 3600.0),
        };
        let work = format!(
            "{} would cost about {cost_told:.1e} products of machine words, up to some {time}, the limit is {most:.1e}",
            work()
        );
        Err(Error::budget(work, cost).or("choose steps with simpler ratios"))
    }

    /// As [`Limits::allow`], of products of dense doubles.
    pub(crate) fn allow_dense(&self, cost: u64, work: impl FnOnce() -> String) -> Result<()> {
        self.allow(cost / DENSE, work)
    }

    /// This limit in kicks of the scalar ladder, whose refine tier spends some thousand products on each.
    pub(crate) fn of_ladder(&self) -> verdict::Limits {
        verdict::Limits { kicks: self.products / A_KICK }
    }

    /// An error of that ladder, its budget in products.
    pub(crate) fn in_products(error: Error) -> Error {
        let Some(kicks) = error.needed() else { return error };
        let work = format!("{} (in kicks, of which each counts as {A_KICK} products)", error.field());
        Error::budget(work, kicks.saturating_mul(A_KICK)).or(error.remedy())
    }
}

/// "1 degree of freedom", "2 degrees of freedom".
pub fn degrees_of_freedom(n: usize) -> String {
    format!("{n} degree{} of freedom", if n == 1 { "" } else { "s" })
}
