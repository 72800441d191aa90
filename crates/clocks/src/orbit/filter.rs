//! The first tier: the half period in Floquet coordinates and doubles, with a proven error bound.
//!
//! Pairs run one by one or in groups; [`super::kernel`] does the updates, [`super::certificate`] knows what
//! the result proves.

use super::certificate::{Certificate, Certificates, Hardest};
use super::floquet::{Floquet, Pair};
use super::kernel::Watch;
use super::lanes::{InLanes, Lanes, Orbits};
use super::winding;
use crate::propagator::PartialSigns;
use number::vector::each;
use number::vector::instructions::{Instructions, Task};
use number::{Sign, U};

/// Where the even and the odd solution stand at T/2, with proven bounds: in Floquet coordinates from here,
/// kick by kick from [`super::plain`].
#[derive(Clone, Copy, Debug)]
pub struct Ends {
    pub even: End,
    pub odd: End,
    /// ⌊Θ/(π/2)⌋, Θ the even solution's turn over the half period; counted on request.
    pub quarters: i64,
}

/// One solution at T/2 in the coordinates of the run: the exact vector is 2^exponent a ((x, v) + t J(x,
/// v)/|(x, v)|²) with |t| ≤ across and |a − 1| ≤ stretch/(1 − stretch).
#[derive(Clone, Copy, Debug)]
pub struct End {
    /// A or B, in the scale that leaves the products AD and BC as they are.
    pub x: f64,
    /// C or D.
    pub v: f64,
    /// The relative error of x and of v as they stand here, beside that.
    pub rounding: f64,
    pub exponent: i64,
    pub across: f64,
    pub stretch: f64,
    signs: (Option<Sign>, Option<Sign>),
}

impl End {
    /// With the signs that these bounds certify; a thousandth covers the roundings of the comparison.
    pub(super) fn new([x, v]: [f64; 2], rounding: f64, exponent: i64, across: f64, stretch: f64) -> End {
        let slack = 1.001 * across / x.hypot(v);
        let certain = |z: f64| (z.abs() > slack).then(|| Sign::from_ordering(z.total_cmp(&0.0)));
        End { x, v, rounding, exponent, across, stretch, signs: (certain(x), certain(v)) }
    }
}

impl Ends {
    /// The signs as far as the bounds certify them.
    pub fn signs(&self) -> PartialSigns {
        let ((a, c), (b, d)) = (self.even.signs, self.odd.signs);
        PartialSigns { a, b, c, d }
    }
}

/// Signs, bounds and turns: all that is known of one pair.
struct SignsAndTurns;

impl Watch for SignsAndTurns {
    const MEASURE: bool = true;
    const WIND: bool = true;
}

/// Signs and bounds.
struct Measured;

impl Watch for Measured {
    const MEASURE: bool = true;
    const WIND: bool = false;
}

/// Signs and whether the bounds hold.
struct SignsOnly;

impl Watch for SignsOnly {
    const MEASURE: bool = false;
    const WIND: bool = false;
}

/// No certificate: what the kernel costs alone, for the benchmark.
struct Bare;

impl Watch for Bare {
    const MEASURE: bool = false;
    const WIND: bool = false;
    const CERTIFY: bool = false;
}

/// Runs the half period; `None` where the bound's conditions cannot be met (very strong kicks).
pub fn run(floquet: &Floquet) -> Option<Ends> {
    let mut ends = [None];
    Group::<1>::new(Instructions::best()).everything(&[floquet.pair()], &mut ends);
    ends[0]
}

/// The filter could not decide.
pub const UNDECIDED: u8 = u8::MAX;

/// At most L pairs, 1, 16 or 32, that run side by side. One certificate serves all: that of the strongest
/// kick, the steepest slope and the most updates.
pub struct Group<const L: usize> {
    instructions: Instructions,
    lanes: Lanes<L>,
    /// Cosine and sine of the base's last turn.
    left: [[f64; L]; 2],
    kicks: u64,
    certificates: Certificates,
}

impl<const L: usize> Group<L> {
    /// Room for L pairs.
    pub fn new(instructions: Instructions) -> Self {
        let certificates = if L == 1 { Certificates::alone() } else { Certificates::of_groups() };
        Group { instructions, lanes: Lanes::empty(), left: [[0.0; L]; 2], kicks: 0, certificates }
    }

    /// A group with at most so many updates between two looks: the fewer, the sharper its bounds.
    pub fn watched(instructions: Instructions, most: u64) -> Self {
        Group { certificates: Certificates::watched(most), ..Group::new(instructions) }
    }

    /// Runs the half periods of the pairs and writes of each what [`run`] returns for one.
    pub fn everything(&mut self, pairs: &[Pair], ends: &mut [Option<Ends>]) {
        let certificate = self.run::<SignsAndTurns, _>(pairs);
        self.report(pairs, certificate, ends);
    }

    /// As [`Group::everything`], without counting the turns.
    pub fn measured(&mut self, pairs: &[Pair], ends: &mut [Option<Ends>]) {
        let certificate = self.run::<Measured, _>(pairs);
        self.report(pairs, certificate, ends);
    }

    fn report(&self, pairs: &[Pair], certificate: Option<Certificate>, ends: &mut [Option<Ends>]) {
        let Some(certificate) = certificate else { return ends.fill(None) };
        let halves = self.instructions.perform(Finish(self, &certificate));
        for (i, (pair, end)) in pairs.iter().zip(ends).enumerate() {
            *end = halves.ends(self, &certificate, pair, i);
        }
    }

    /// Runs the half periods of the pairs for their verdicts: positions in `Verdict::ALL`, or [`UNDECIDED`].
    pub fn verdicts<P: InLanes>(&mut self, pairs: &[P]) -> [u8; L] {
        let certificate = self.run::<SignsOnly, P>(pairs);
        self.proven(certificate)
    }

    /// The signs as they come out, certified or not: for the benchmark alone.
    pub fn uncertified<P: InLanes>(&mut self, pairs: &[P]) -> [u8; L] {
        let certificate = self.run::<Bare, _>(pairs).map(Certificate::void);
        self.proven(certificate)
    }

    /// The verdicts after a run as far as its certificate goes.
    fn proven(&self, certificate: Option<Certificate>) -> [u8; L] {
        certificate
            .map_or([UNDECIDED; L], |certificate| self.instructions.perform(Verdicts(self, &certificate)))
    }

    /// All updates of the pairs, with the certificate for their strongest kick, steepest slope and most
    /// updates.
    fn run<W: Watch, P: InLanes>(&mut self, pairs: &[P]) -> Option<Certificate> {
        let (hardest, kicks) = self.instructions.perform(Start(pairs, &mut self.lanes, &mut self.left));
        self.kicks = kicks;
        let certificate = self.certificates.get(hardest)?;
        (self.lanes.worst, self.lanes.strong) = (certificate.worst, certificate.strong);
        // Who does not look needs no blocks.
        let block = if W::CERTIFY { certificate.block } else { u64::MAX };
        self.lanes.advance::<W>(self.instructions, block);
        Some(certificate)
    }

    /// The kicks that the pairs of the latest run composed.
    pub fn kicks(&self) -> u64 {
        self.kicks
    }
}

/// The work that is compiled for each instruction set.
struct Start<'a, P, const L: usize>(&'a [P], &'a mut Lanes<L>, &'a mut [[f64; L]; 2]);
struct Finish<'a, const L: usize>(&'a Group<L>, &'a Certificate);
struct Verdicts<'a, const L: usize>(&'a Group<L>, &'a Certificate);

impl<P: InLanes, const L: usize> Task for Start<'_, P, L> {
    /// The hardest of them, and the kicks of all.
    type Output = (Hardest, u64);

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Start(pairs, lanes, left) = self;
        let (constants, turn) = P::constants(pairs);
        lanes.start(constants);
        *left = turn;
        (lanes.hardest(), lanes.kicks(pairs.len()))
    }
}

impl<const L: usize> Task for Finish<'_, L> {
    type Output = Halves<L>;

    #[inline(always)]
    fn run(self) -> Halves<L> {
        Halves::new(self.0, self.1)
    }
}

impl<const L: usize> Task for Verdicts<'_, L> {
    type Output = [u8; L];

    #[inline(always)]
    fn run(self) -> [u8; L] {
        Halves::new(self.0, self.1).verdicts()
    }
}

/// The signs of x and v at T/2: 0 where they are not certain, everywhere where a condition of the theorem
/// failed on the way. (NaN fails.)
#[inline(always)]
fn signs<const L: usize>(
    certificate: &Certificate,
    [x, v]: &[[f64; L]; 2],
    orbits: &Orbits<L>,
) -> [[f64; L]; 2] {
    let length: [f64; L] = each(|i| (x[i] * x[i] + v[i] * v[i]).sqrt());
    let held = |i: usize| orbits.worst[i] <= certificate.worst;
    let across: [f64; L] =
        each(|i| if held(i) { certificate.across * orbits.squares[i] } else { f64::INFINITY });
    let sign =
        |form: f64, i: usize| if form.abs() * length[i] > across[i] { 1f64.copysign(form) } else { 0.0 };
    [each(|i| sign(x[i], i)), each(|i| sign(v[i], i))]
}

/// The half periods of a group.
struct Halves<const L: usize> {
    /// (re, im) of the even solution before the base's last turn.
    even: [[f64; L]; 2],
    /// (x, v) of the even and the odd solution, and their signs, 0 where uncertain.
    ends: [[[f64; L]; 2]; 2],
    signs: [[[f64; L]; 2]; 2],
}

impl<const L: usize> Halves<L> {
    #[inline(always)]
    fn new(group: &Group<L>, certificate: &Certificate) -> Self {
        let [even, odd] = group.lanes.ends();
        let ends = [group.turned(&even), group.turned(&odd)];
        let (lanes, [e, o]) = (&group.lanes, &ends);
        let signs = [signs(certificate, e, &lanes.even), signs(certificate, o, &lanes.odd)];
        Halves { even, ends, signs }
    }

    /// Positions in `Verdict::ALL`: BC > 0, AD < 0, BC < 0 < AD.
    #[inline(always)]
    fn verdicts(&self) -> [u8; L] {
        let [[a, c], [b, d]] = &self.signs;
        let mut verdicts = [UNDECIDED; L];
        for (i, verdict) in verdicts.iter_mut().enumerate() {
            let (bc, ad) = (b[i] * c[i], a[i] * d[i]);
            *verdict = if bc < 0.0 && ad > 0.0 { 0 } else { *verdict };
            *verdict = if ad < 0.0 { 2 } else { *verdict };
            *verdict = if bc > 0.0 { 1 } else { *verdict };
        }
        verdicts
    }

    /// All about lane i; `None` where the theorem's conditions did not hold all the way.
    fn ends(&self, group: &Group<L>, certificate: &Certificate, pair: &Pair, i: usize) -> Option<Ends> {
        let lanes = &group.lanes;
        let end = |n: usize, orbits: &Orbits<L>| {
            let certain = |x: f64| (x != 0.0).then(|| Sign::from_ordering(x.total_cmp(&0.0)));
            let (squares, worst) = (orbits.squares[i], orbits.worst[i]);
            let stretch = certificate.stretch(worst);
            let end = End {
                x: self.ends[n][0][i],
                v: self.ends[n][1][i],
                rounding: 0.0,
                exponent: orbits.exponent[i] as i64,
                across: certificate.across * squares,
                stretch: stretch + 2.0 * U,
                signs: (certain(self.signs[n][0][i]), certain(self.signs[n][1][i])),
            };
            (worst <= certificate.worst).then_some(end)
        };
        let lane = |pair: &[[f64; L]; 2]| [pair[0][i], pair[1][i]];
        let quarters = winding::at_end(pair, lanes.even_quarter(i), lane(&self.even), lane(&group.left));
        Some(Ends { even: end(0, &lanes.even)?, odd: end(1, &lanes.odd)?, quarters })
    }
}

impl<const L: usize> Group<L> {
    /// (x, v) = (Re, −Im) of g e^{iω}, ω the turn left.
    #[inline(always)]
    fn turned(&self, [re, im]: &[[f64; L]; 2]) -> [[f64; L]; 2] {
        let [cos, sin] = &self.left;
        [each(|i| re[i] * cos[i] - im[i] * sin[i]), each(|i| -(re[i] * sin[i] + im[i] * cos[i]))]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::propagator::{TwoClocks, half_period};
    use num_integer::Integer;
    use number::{Ratio, Rational, ratio};
    use proptest::prelude::*;

    fn pairs() -> impl Strategy<Value = Vec<Floquet>> {
        let pair = (1u64..300, 1u64..300, 1i64..3999, -2000i64..2000).prop_map(|(p, q, s, k)| {
            let g = p.gcd(&q);
            Floquet::new(&TwoClocks::new(
                Ratio::new(p / g, q / g).unwrap(),
                ratio(s, 1000),
                ratio(2 * k + 1, 2000),
            ))
        });
        prop::collection::vec(pair, 1..40).prop_map(|pairs| pairs.into_iter().flatten().collect())
    }

    /// All that groups of `L` lanes report on at most as many pairs, as text: doubles by their shortest exact
    /// name.
    fn written<const L: usize>(instructions: Instructions, pairs: &[Pair]) -> String {
        let (mut group, mut text) = (Group::<L>::new(instructions), String::new());
        for pairs in pairs.chunks(L) {
            let mut ends = vec![None; pairs.len()];
            group.everything(pairs, &mut ends);
            text += &format!("{ends:?} {:?}\n", &group.verdicts(pairs)[..pairs.len()]);
        }
        text
    }

    proptest! {
        #[test]
        fn every_instruction_set_gives_the_same_bits(floquets in pairs()) {
            prop_assume!(!floquets.is_empty());
            let pairs: Vec<Pair> = floquets.iter().map(Floquet::pair).collect();
            let results: Vec<String> = Instructions::available()
                .map(|set| written::<1>(set, &pairs) + &written::<16>(set, &pairs) + &written::<32>(set, &pairs))
                .collect();
            prop_assert!(results.windows(2).all(|two| two[0] == two[1]), "{results:?}");
        }

        #[test]
        fn side_by_side_and_alone_agree(floquets in pairs()) {
            prop_assume!(!floquets.is_empty());
            let pairs: Vec<Pair> = floquets.iter().map(Floquet::pair).collect();
            let mut group = Group::<32>::new(Instructions::best());
            let verdicts = pairs.chunks(32).flat_map(|pairs| group.verdicts(pairs).into_iter().take(pairs.len()));
            for (floquet, verdict) in floquets.iter().zip(verdicts) {
                let alone = run(floquet).and_then(|ends| ends.signs().verdict());
                prop_assert!(verdict == UNDECIDED || alone.is_some_and(|alone| alone.index() == verdict));
            }
        }

        #[test]
        fn the_exact_end_lies_within_the_bound(
            p in 1u64..60, q in 1u64..60, s in 1i64..3999, k in -2000i64..2000,
        ) {
            let g = p.gcd(&q);
            let clocks = TwoClocks::new(Ratio::new(p / g, q / g).unwrap(), ratio(s, 1000), ratio(2 * k + 1, 2000));
            let Some(ends) = Floquet::new(&clocks).as_ref().and_then(run) else { return Ok(()) };
            let half = half_period(&clocks);
            let exact = |x: f64| Rational::from_float(x).unwrap();
            // Products do not depend on the scale; two errors across, two of length.
            let check = |value: Rational, x: f64, one: &End, v: f64, other: &End| {
                let slack = |end: &End| end.across / end.x.hypot(end.v);
                let error = x.abs() * slack(other) + v.abs() * slack(one) + slack(one) * slack(other)
                    + 3.0 * (one.stretch + other.stretch) * (x * v).abs();
                let distance = value - exact(x) * exact(v);
                (exact(2.0 * error) >= distance.clone()) && (exact(-2.0 * error) <= distance)
            };
            let (even, odd) = (&ends.even, &ends.odd);
            prop_assume!(even.exponent == 0 && odd.exponent == 0);
            prop_assert!(check(half.b() * half.c(), odd.x, odd, even.v, even));
            prop_assert!(check(half.a() * half.d(), even.x, even, odd.v, odd));
        }
    }
}
