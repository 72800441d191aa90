//! The tiers of the ladder, and how much work each may do.

use number::{Error, Result, named};

named! {
    /// Which tier decided.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
    #[derive(serde::Serialize, serde::Deserialize)]
    pub enum Tier {
        /// Doubles in Floquet coordinates, min(p, q)/2 updates, with a proven bound; where there are none,
        /// kick by kick, and a closed form where only one clock kicks.
        Filter = "filter",
        /// Kicks and drifts in multiple precision, p + q of them, with the same bound.
        Refine = "refine",
        /// Exact arithmetic.
        Exact = "exact",
    }
}

/// How much work one verdict may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The most kicks that one tier may compose: min(p, q)/2 in the filter, (p + q)/2 in the refine tier; for
    /// the exact tier its cost in kicks of the refine tier,
    /// [`Decidable::exact_cost`](super::Decidable::exact_cost).
    pub kicks: u64,
}

impl Default for Limits {
    /// 10^8 kicks: about a second in the filter, minutes in the other tiers. That is p + q up to some 2·10^8
    /// in the refine tier, 2·10^5 in the exact one over the rationals, 900 over Q\[π\].
    fn default() -> Self {
        Limits { kicks: 100_000_000 }
    }
}

impl Limits {
    /// # Errors
    /// A budget error that states the cost where `kicks` exceeds the limit.
    pub fn allow(&self, kicks: u64, tier: Tier) -> Result<()> {
        if kicks <= self.kicks {
            return Ok(());
        }
        // A kick costs the filter some 10 ns, the others about 1 µs a pass.
        let seconds = if tier == Tier::Filter { kicks / 100_000_000 } else { kicks / 1_000_000 };
        let work = match tier {
            Tier::Exact => "work as long as for",
            _ => "compose",
        };
        let (tier, seconds, limit) = (tier.name(), seconds.max(1), self.kicks);
        let cost = format!(
            "the {tier} tier would {work} {kicks} kicks, on the order of {seconds} s; the budget is {limit}"
        );
        Err(Error::budget(cost, kicks).or("choose steps with a simpler ratio"))
    }
}
