//! The proof behind a run of the filter: the theorem of [`super::bound`] with the kernel's constants.
//!
//! proofs/FILTER.md derives every constant, and gives examples that the tests compare with; in short, with
//! u = 2^-53 and g in the coordinates of [`super::floquet`], where a kick has the norm κ ≤ |β|/2 + √(1 +
//! β²/4) and a turn the norm 1,
//!
//! ```text
//!     |r_k| ≤ u (κ (28 + 11 tan(θ/2)) + 6.1 |β|) |g_(k-1)| + u (1 + tan(θ/2)) |g_k|
//! ```
//!
//! is what one update (four shears) adds to the error.

use super::bound::StepBound;
use number::U;

/// |r_k| is at most the sum of two terms. The first is u (κ (`TURN` + `TURN_SLOPE` tan(θ/2)) + `KICK` |β|) |g_(k-1)|.
const TURN: f64 = 28.0;
const TURN_SLOPE: f64 = 11.0;
const KICK: f64 = 6.1;

/// The second term of the bound on |r_k| is u (`LAST` + `LAST_SLOPE` tan(θ/2)) |g_k|.
const LAST: f64 = 1.0;
const LAST_SLOPE: f64 = 1.0;

/// x and v are computed from g with an error of at most u (`FORM` + `FORM_SLOPE` tan(θ/2)) |g|.
const FORM: f64 = 7.0;
const FORM_SLOPE: f64 = 5.0;

/// Covers terms of second order, the rounding of sums of 10^13 terms at most, and of the constants
/// themselves.
const SECOND_ORDER: f64 = 1.01;

/// The most updates between two looks at |g| in a group.
const BLOCK: u64 = 128;

/// |g| may grow by this in a block: the bound has digits to spare, a look costs an update.
const BLOCK_GROWTH: f64 = 64.0;

/// More steps than this are not certified.
const MOST_STEPS: u64 = 1 << 43;

/// The hardest pair of a group in each respect: strongest kick, steepest slope, most steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hardest {
    /// |β|, to within 64u.
    pub beta: f64,
    /// tan(θ/2).
    pub slope: f64,
    /// Updates, the half kick at t = 0 included.
    pub steps: u64,
}

/// The constants of the certification, all dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    step: StepBound,
    steps: u64,
    /// Updates between two looks at |g|.
    pub block: u64,
    /// 2b ≤ `ratio` · `squares/|g|²` · |g|² at every step whose nearest look found that `squares/|g|²`.
    ratio: f64,
    /// The largest `squares/|g|²` that the theorem's condition on τ admits.
    pub worst: f64,
    /// 2b and the error of evaluating a linear form of g are together at most this times `squares`.
    pub across: f64,
    /// Whether |g|² may pass 2^900, from 2^100 at most at the start.
    pub strong: bool,
}

impl Certificate {
    /// For all pairs that are no harder, in blocks of `most` updates at most; `None` where the theorem's
    /// conditions cannot be met.
    fn new(Hardest { beta, slope, steps }: Hardest, most: u64) -> Option<Certificate> {
        // 1 + 64u covers the roundings of β and of this line.
        let beta = beta * (1.0 + 64.0 * U);
        let kappa = (beta / 2.0 + (1.0 + beta * beta / 4.0).sqrt()) * (1.0 + 8.0 * U);
        let before = kappa * (TURN + TURN_SLOPE * slope) + KICK * beta;
        let after = LAST + LAST_SLOPE * slope;
        let epsilon = SECOND_ORDER * U * (before + 1.01 * kappa * after);
        let step = StepBound { kappa, epsilon };
        let tau = step.tau(steps)?;
        let growth = step.growth();
        let (mut block, mut grown) = (1, growth);
        while block < most && grown * growth <= BLOCK_GROWTH {
            (block, grown) = (block + 1, grown * growth);
        }
        // Every step is within block/2 of a look, and at most `block` steps share one: with the inequality of
        // the means Σ |r_j| |g_j| ≤ u (before + after) block growth^(2 ⌊block/2⌋) squares.
        let away = (0..2 * (block / 2)).fold(1.0, |power, _| power * growth);
        let b = SECOND_ORDER * U * (before + after) * block as f64 * away;
        // Between two looks |g|² is smaller than at the nearer one by `away` at most.
        let ratio = 2.0 * b * away;
        let across = 2.0 * b + SECOND_ORDER * U * (FORM + FORM_SLOPE * slope);
        let strong = steps as f64 * growth.log2() > 400.0;
        let certificate =
            Certificate { step, steps, block, ratio, worst: 0.99 * tau / ratio, across, strong };
        (steps < MOST_STEPS && ratio.is_finite()).then_some(certificate)
    }

    /// One that takes every sign as certain: for the benchmark.
    pub fn void(self) -> Certificate {
        Certificate { across: 0.0, ..self }
    }

    /// How far the orbit's length may be off, relatively, where `squares/|g|²` was `worst` at most.
    pub fn stretch(&self, worst: f64) -> f64 {
        self.step.length_uncertainty(self.steps, self.ratio * worst)
    }
}

/// Makes certificates, and remembers those for groups.
#[derive(Clone, Debug)]
pub struct Certificates {
    /// The most updates between two looks.
    most: u64,
    /// None for pairs that run alone.
    made: Vec<Option<(Hardest, Option<Certificate>)>>,
}

/// Certificates that are remembered.
const REMEMBERED: usize = 64;

/// The grid of |β| and of tan(θ/2) on which they are.
const BETAS: f64 = 16.0;
const SLOPES: f64 = 4.0;

impl Certificates {
    /// For pairs that run alone, watched at every update: the sharpest bound.
    pub fn alone() -> Self {
        Certificates { most: 1, made: Vec::new() }
    }

    /// For groups: certificates for slightly harder pairs serve many groups. They do not depend on the groups
    /// before.
    pub fn of_groups() -> Self {
        Certificates { most: BLOCK, made: vec![None; REMEMBERED] }
    }

    /// The certificate with at most so many updates between two looks: the fewer, the sharper.
    pub fn watched(most: u64) -> Self {
        Certificates { most, ..Certificates::of_groups() }
    }

    /// The certificate.
    #[inline(always)]
    pub fn get(&mut self, hardest: Hardest) -> Option<Certificate> {
        if self.made.is_empty() {
            return Certificate::new(hardest, self.most);
        }
        let up = |x: f64, grid: f64| (x * grid).ceil() / grid;
        let (beta, slope) = (up(hardest.beta, BETAS), up(hardest.slope, SLOPES));
        let harder = Hardest { beta, slope, steps: hardest.steps.next_power_of_two() };
        let place = &mut self.made[(beta * BETAS) as usize % REMEMBERED];
        if let Some((_, made)) = place.as_ref().filter(|(hardest, _)| *hardest == harder) {
            return *made;
        }
        let made = Certificate::new(harder, self.most);
        *place = Some((harder, made));
        made
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An error u (plain + slope tan(θ/2)) relative to |g|, as sections 3 and 5 of proofs/FILTER.md add it
    /// up.
    #[derive(Clone, Copy)]
    struct Error {
        plain: f64,
        slope: f64,
    }

    const fn error(plain: f64, slope: f64) -> Error {
        Error { plain, slope }
    }

    fn sum(errors: &[Error]) -> Error {
        let add = |a: Error, b: &Error| error(a.plain + b.plain, a.slope + b.slope);
        errors.iter().fold(error(0.0, 0.0), add)
    }

    /// √2, from above: ν_t.
    const NU: f64 = 1.4143;

    /// No constant is smaller than what the roundings add up to, nor larger than the next one with its
    /// digits.
    #[test]
    fn the_constants_are_the_sums_of_the_roundings() {
        // Section 2, in units of u, relative: tan(θ/2), k, B; absolute: T_k (over tan(θ/2)), t and S.
        let (slope, k) = (2.0, 3.0);
        let b = k + slope + 1.0;
        let place = slope + 1.0 + 1.0;
        let (t, bt, sb) = (4.0, 1.0, 2.0);
        // A coefficient T ∓ t of a shear of re: rounded, and made of T_k, t and B t.
        let shear = error(1.0 + t + bt, 1.0 + place);
        let e1 = sum(&[error(NU, 0.0), shear]);
        let e2 = error(1.0 + (sb + t) * NU, 0.0);
        let e3 = sum(&[error(1.0, 1.0), shear]);
        // e2 meets one more shear before the kick.
        let turn = sum(&[e1, error(NU * e2.plain, 0.0), e3]);
        let least = |constant: f64, needed: f64, digit: f64| {
            assert!(needed <= constant && constant < needed + digit, "{constant} for {needed}");
        };
        least(TURN, turn.plain, 1.0);
        least(TURN_SLOPE, turn.slope, 1.0);
        least(KICK, b * (1.0 + 1e-3), 0.1);
        // e4 rounds im' and meets the shear from X' to re.
        least(LAST, 1.0, 1.0);
        least(LAST_SLOPE, 1.0, 1.0);
        // re = X + T im with T_k rounded once more, im = B w; cos and sin of the last turn, and the two
        // products of each.
        let form = sum(&[error(1.0, place + 1.0), error(1.0, 0.0), error(2.0, 0.0), error(2.0 * NU, 0.0)]);
        least(FORM, form.plain, 1.0);
        least(FORM_SLOPE, form.slope, 1.0);
    }

    /// The worked examples of proofs/FILTER.md: they change with every constant of the bound.
    #[test]
    fn the_examples_of_the_proof_come_out() {
        let text = include_str!("../../../../proofs/FILTER.md");
        let table = text.lines().skip_while(|line| !line.starts_with("| \\|β\\| |")).skip(2);
        let examples: Vec<&str> = table.take_while(|line| line.starts_with('|')).collect();
        assert!(examples.len() >= 5);
        let found: Vec<String> = examples.iter().map(|row| example(row)).collect();
        assert_eq!(found, examples);
    }

    /// The row that the code writes for the input of `row`.
    fn example(row: &str) -> String {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).take(4).collect();
        let number = |x: &str| x.parse::<f64>().expect("a number");
        let steps = cells[2].parse().expect("steps");
        let hardest = Hardest { beta: number(cells[0]), slope: number(cells[1]), steps };
        let proof = match Certificate::new(hardest, cells[3].parse().expect("a block")) {
            None => "none | | | | |".to_owned(),
            Some(c) => {
                let stretch = c.stretch(c.worst);
                format!(
                    "{} | {:e} | {:e} | {:e} | {:e} | {stretch:e} |",
                    c.block, c.step.epsilon, c.ratio, c.worst, c.across
                )
            }
        };
        format!("| {} | {proof}", cells.join(" | "))
    }

    /// Groups get a certificate that holds for pairs that are no harder, whatever was asked before.
    #[test]
    fn a_remembered_certificate_is_no_sharper_than_a_new_one() {
        let mut groups = Certificates::of_groups();
        for k in 1..2000u64 {
            let x = k as f64;
            let hardest =
                Hardest { beta: (0.37 * x) % 5.0, slope: 0.01 + (0.11 * x) % 3.0, steps: 1 + 7 * k % 900 };
            let (Some(group), Some(sharp)) = (groups.get(hardest), Certificate::new(hardest, BLOCK)) else {
                panic!("{hardest:?}")
            };
            assert_eq!(Some(group), Certificates::of_groups().get(hardest));
            // For the same block a harder pair's bound is the weaker one in every respect.
            if group.block == sharp.block {
                assert!(group.across >= sharp.across && group.worst <= sharp.worst, "{hardest:?}");
            }
            assert!(group.block <= sharp.block);
        }
    }
}
