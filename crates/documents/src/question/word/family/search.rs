//! The best value of a parameter, closed in by exact comparisons.

use std::cmp::Ordering;

use super::asked::{Family, Goal};
use super::member::Member;
use crate::question::asking::Work;
use num_traits::{Signed, Zero};
use number::rational::{scale2, simplest};
use number::{Ball, Rational, Result, ratio};

/// The best member that was found.
#[derive(Clone, Debug)]
pub struct Best {
    pub goal: Goal,
    pub member: Member,
    /// Of one parameter with a range: values that were tried on both sides, none of them better; or those
    /// between which an unstable interval closes. Equal to the value at an end of the range.
    pub bracket: Option<(Rational, Rational)>,
    /// Whether the first unstable interval closes there, so that the stable steps go on beyond it.
    pub closes: bool,
    /// The values tried beyond the rows.
    pub tried: u64,
    /// Whether no value of the range is better but those between the two of the bracket.
    pub proven: bool,
}

/// The members of a family.
#[derive(Clone, Debug)]
pub struct Members {
    /// In the order of the values, those of the last range first.
    pub all: Vec<Member>,
    /// The degree of the errors that are compared: one more than the least Nyström order.
    pub degree: Option<u64>,
    pub best: Option<Best>,
}

/// The most values that are tried about one row.
const MOST_TRIED: u64 = 120;

/// A bracket this narrow, as a part of the first one, is narrow enough.
const NARROW_LOG2: i64 = -48;

/// The most unstable intervals whose closing is looked for.
const MOST_CLOSINGS: usize = 4;

/// How good a member is; `None` for what has no such number, which is the worst.
type Score<'a> = &'a dyn Fn(&Member) -> Option<Ball>;

/// Whether one is better; `None` where balls do not tell.
fn compare(one: &Option<Ball>, other: &Option<Ball>) -> Option<Ordering> {
    match (one, other) {
        (Some(one), Some(other)) => one.compare(other),
        (one, other) => Some(one.is_some().cmp(&other.is_some())),
    }
}

impl Family {
    /// The best member: of the rows, of the values about the best row, and of those at which the first
    /// unstable interval closes, so that the stable steps go on beyond it.
    pub(super) fn best(
        &self,
        goal: Goal,
        all: &[Member],
        degree: Option<u64>,
        work: &Work,
    ) -> Result<Option<Best>> {
        let score = |member: &Member| member.score(goal, degree);
        let beside = |one: &Member, other: &Member| compare(&score(one), &score(other));
        let is_better = |one: &Member, other: &Member| beside(one, other) == Some(Ordering::Greater);
        let best = (1..all.len()).fold(0, |best, n| if is_better(&all[n], &all[best]) { n } else { best });
        if score(&all[best]).is_none() {
            return Ok(None);
        }
        let row =
            Best { goal, member: all[best].clone(), bracket: None, closes: false, tried: 0, proven: false };
        let mut ranged = self.parameter.ranged();
        let (Some((at, _)), None) = (ranged.next(), ranged.next()) else { return Ok(Some(row)) };
        let least = degree.filter(|_| goal == Goal::Error).and_then(|degree| self.least_error(at, degree));
        if let Some(ends) = least {
            let member = self.member(&replaced(&row.member, at, short(&ends.0, &ends.1)), work)?;
            return Ok(Some(Best { member, bracket: Some(ends), tried: 1, proven: true, ..row }));
        }
        let about = |n: usize| [n.saturating_sub(1), n, (n + 1).min(all.len() - 1)];
        // Edges as they are: an unstable interval that closes makes the nominal one jump.
        let strict = |member: &Member| member.strict_score(goal, degree);
        let mut found = self.section(at, goal, about(best).map(|n| &all[n]), &strict, work)?;
        if is_better(&row.member, &found.member) {
            let [lo, _, hi] = about(best).map(|n| all[n].values[at].clone());
            found = Best { bracket: Some((lo, hi)), tried: found.tried, ..row };
        }
        if matches!(goal, Goal::Edge | Goal::Efficiency) {
            let closeness = |member: &Member| member.closeness();
            let wide = |n: usize| all[n].closeness();
            let is_least = |&n: &usize| {
                let others = about(n).map(wide);
                wide(n).is_some()
                    && others.iter().all(|other| compare(other, &wide(n)) != Some(Ordering::Greater))
            };
            for n in (0..all.len()).filter(is_least).take(MOST_CLOSINGS) {
                let near = self.section(at, goal, about(n).map(|n| &all[n]), &closeness, work)?;
                let (lo, hi) = near.bracket.clone().expect("of one parameter");
                let simple = self.member(&replaced(&near.member, at, short(&lo, &hi)), work)?;
                let tried = found.tried + near.tried + 1;
                let off = self.member(
                    &replaced(&near.member, at, if lo == simple.values[at] { hi } else { lo }),
                    work,
                )?;
                for member in [near.member.clone(), simple] {
                    // At the very place it closes; beside it the nominal edge may be longer by less than
                    // 2^-60.
                    if jumps(&member, &off) && beside(&member, &found.member) != Some(Ordering::Less) {
                        found = Best { member, closes: true, ..near.clone() };
                    }
                }
                found.tried = tried;
            }
        }
        Ok(Some(found))
    }

    /// Closes in on the best value between two rows about a third: the larger part is cut, and the worse end
    /// left out.
    fn section(&self, at: usize, goal: Goal, about: [&Member; 3], score: Score, work: &Work) -> Result<Best> {
        let [mut lo, mut hi] = [about[0], about[2]].map(|member| member.values[at].clone());
        let narrow = (&hi - &lo) * scale2(&1.into(), NARROW_LOG2);
        let (mut member, mut tried) = (about[1].clone(), 0);
        while &hi - &lo > narrow && tried < MOST_TRIED {
            let x = member.values[at].clone();
            let is_above = &hi - &x >= &x - &lo;
            let room = if is_above { &hi - &x } else { &lo - &x };
            // A short fraction about two fifths on.
            let ends = [ratio(3, 10), ratio(9, 20)].map(|part| &x + &room * part);
            let y = short((&ends[0]).min(&ends[1]), (&ends[0]).max(&ends[1]));
            let next = self.member(&replaced(&member, at, y.clone()), work)?;
            tried += 1;
            match compare(&score(&next), &score(&member)) {
                Some(Ordering::Greater) => {
                    *if is_above { &mut lo } else { &mut hi } = x;
                    member = next;
                }
                Some(Ordering::Less) => *if is_above { &mut hi } else { &mut lo } = y,
                _ => break,
            }
        }
        Ok(Best { goal, member, bracket: Some((lo, hi)), closes: false, tried, proven: false })
    }
}

/// Whether the stable steps of one go far beyond those of a neighbour.
fn jumps(member: &Member, neighbour: &Member) -> bool {
    const FAR: f64 = 1.001;
    let edges = member.linted.nominal_edge().zip(neighbour.linted.edge_omega_h());
    edges.is_some_and(|(far, near)| far.mid_f64() > FAR * near.mid_f64())
}

/// The rational of least denominator in [lo, hi], of any signs.
fn short(lo: &Rational, hi: &Rational) -> Rational {
    match (lo.is_positive(), hi.is_negative()) {
        (true, _) => simplest(lo, hi),
        (_, true) => -simplest(&-hi, &-lo),
        _ => Rational::zero(),
    }
}

/// The values of a member with another one of the parameter `at`.
fn replaced(member: &Member, at: usize, value: Rational) -> Vec<Rational> {
    let mut values = member.values.clone();
    values[at] = value;
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::question::asking::{Fields, Question};
    use number::{from_f64_exact, to_f64};

    const TWO_STAGES: &str = "K(b) D(1/2) K(1-2*b) D(1/2) K(b)";

    fn best(fields: &[(&str, &str)]) -> Best {
        let input = fields.iter().map(|(name, value)| (name.to_string(), (*value).into())).collect();
        let question = Family::read(&input).unwrap();
        question.answer(&Work::default()).unwrap().best.unwrap()
    }

    fn brackets(best: &Best, value: f64) {
        let (lo, hi) = best.bracket.clone().unwrap();
        let value = from_f64_exact(value).unwrap();
        assert!(lo <= value && value <= hi, "{value} lies not between {lo} and {hi}");
    }

    #[test]
    fn the_least_error_of_two_stages_is_that_of_omelyan() {
        let found = best(&[("word", TWO_STAGES), ("parameter", "b=0.15..0.25:1/100"), ("minimize", "error")]);
        // Omelyan, Mryglod and Folk (2002) give 16 digits.
        assert!((to_f64(&found.member.values[0]) - 0.193_183_327_503_783_6).abs() < 1e-14);
        assert!(found.proven);
        let (lo, hi) = found.bracket.unwrap();
        assert!(hi - lo < scale2(&1.into(), -40));
    }

    #[test]
    fn no_value_has_a_smaller_error_than_the_one_that_is_proven_best() {
        let words = [
            TWO_STAGES,
            "D(b) K(1/2) D(1-2*b) K(1/2) D(b)",
            // A gradient, of degree 2.
            "K(b) D(1/2) K(1-2*b, b*b-1/12) D(1/2) K(b)",
        ];
        for word in words {
            let fields = [("word", word), ("parameter", "b=0.05..0.45:1/500"), ("minimize", "error")];
            let input = fields.iter().map(|(name, value)| (name.to_string(), (*value).into())).collect();
            let members = Family::read(&input).unwrap().answer(&Work::default()).unwrap();
            let best = members.best.unwrap();
            assert!(best.proven, "{word}");
            let square =
                |member: &Member| member.square(members.degree.unwrap()).unwrap().as_rational().unwrap();
            let least = members.all.iter().map(square).min().unwrap();
            // The value that is shown is one of the bracket, where the error is as good as flat.
            assert!(square(&best.member) <= least, "{word}");
        }
    }

    #[test]
    fn of_quotients_no_least_error_is_proven() {
        let found = best(&[
            ("word", "K(1/(2+b)) D(1/2) K(1-2/(2+b)) D(1/2) K(1/(2+b))"),
            ("parameter", "b=2..5:1/10"),
            ("minimize", "error"),
        ]);
        assert!(!found.proven);
        assert!((to_f64(&found.member.values[0]) - (1.0 / 0.193_183_327_503_783_6 - 2.0)).abs() < 1e-9);
    }

    #[test]
    fn the_least_energy_error_of_two_stages_is_that_of_blanes_casas_and_sanz_serna() {
        let found = best(&[("word", TWO_STAGES), ("parameter", "b=0.15..0.25:1/100"), ("minimize", "bias")]);
        // Their coefficient for steps up to 2, with five digits.
        assert!((to_f64(&found.member.values[0]) - 0.21178).abs() < 5e-6, "{}", found.member.values[0]);
    }

    /// With this condition a zero of A and one of D coincide: the propagator is -I inside the stable steps.
    #[test]
    fn three_stages_whose_unstable_interval_has_closed_have_an_energy_error() {
        let kick = "(1/2-2*a)/(1-6*a)";
        let word = format!("K({kick}) D(a) K(1/2-{kick}) D(1-2*a) K(1/2-{kick}) D(a) K({kick})");
        let found = best(&[("word", &word), ("parameter", "a=0.29..0.31:1/100"), ("minimize", "bias")]);
        // The method of Blanes, Casas and Sanz-Serna, for steps up to 3.
        assert!(
            (to_f64(&found.member.values[0]) - 0.29619504261126).abs() < 5e-6,
            "{}",
            found.member.values[0]
        );
    }

    #[test]
    fn the_longest_step_of_two_stages_is_that_of_two_verlets_which_no_row_meets() {
        // 1/4 is no multiple of 1/70 beyond 1/5; beside it the trace passes below -2 at s = 8.
        let found = best(&[("word", TWO_STAGES), ("parameter", "b=0.2..0.3:1/70"), ("maximize", "edge")]);
        assert!(found.closes);
        assert_eq!(found.member.values, [ratio(1, 4)]);
        assert_eq!(found.member.linted.edge().and_then(|edge| edge.rational()), Some(ratio(16, 1)));
        brackets(&found, 0.25);
    }

    #[test]
    fn two_forces_and_substeps_have_parameters_too() {
        let word = "K2(c) 2*(K1(1/4) D(1/2) K1(1/4)) K2(1-c)";
        let found = best(&[
            ("word", word),
            ("parameter", "c=1/10..9/10:1/10"),
            ("lambda1", "16"),
            ("lambda2", "1"),
            ("minimize", "error"),
        ]);
        // The symmetric one alone is of order 2.
        assert_eq!(found.member.values, [ratio(1, 2)]);
        assert_eq!(found.member.nystrom_order(), Some(2));
    }
}
