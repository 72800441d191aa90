//! A window of steps, searched tongue by tongue: for ranges of ratios, between which first steps each is
//! proven.

use std::collections::BTreeMap;

use super::edges::{edges, labels};
use super::frame::Base;
use super::sector::{Line, Prover, Ratio, Sector, Way, area, value};
use super::taylor::Taylor;
use number::parallel::{go_on, try_map};
use number::{Ball, Error, ExactSign, Laurent, Rational, Real, Result, Sign, rational};

/// Pieces whose halves are tried side by side. The goal is looked at between them.
const BATCH: usize = 512;

/// Bits of constants.
pub(super) const BITS: u32 = 96;

/// Decimal digits of the largest first step, but one.
const DIGITS: i32 = 14;

/// Ratios that are looked at: from 2^-this to 2^this.
const LARGEST: u32 = 12;

/// Where tongues of different curves are to be told apart, both numbers of a ratio are this large at least.
/// Elsewhere those of the curves (0, b) or (a, 0) are looked for.
const LEAST_KICKS: u64 = 10;

/// Where in a range tongues are looked for, as shares of it: far from simple ratios.
const RAYS: [[f64; 2]; 3] = [[0.05, 0.06], [0.38, 0.39], [0.93, 0.94]];

/// Smaller shares of the window are left out.
const LEAST: f64 = 1e-12;

/// A range is thought to be too wide to prove anything where the tongue's share of h1, times the half turns
/// of its simplest ratios, is below this: one in twenty is proven there.
const RESOLVED: f64 = 0.15;

/// Where a range of ratios is cut, as shares of it.
const MIDDLE: [f64; 2] = [0.3, 0.7];

/// Ranges that are narrower than this share of the ratio are not cut: doubles separate their ends, and no
/// more.
const NARROW: f64 = 1e-11;

/// The ratios of a window differ by more than this share.
const CLOSE: f64 = 1e-8;

/// More than the roundings of a side of the window.
const ROOM: f64 = 4.0 * f64::EPSILON;

/// Times that the line between what is proven and the tongue's edge is moved: by this share first, by halves
/// then.
const MOVES: usize = 2;
const FIRST: f64 = 0.6;

/// Two stiffnesses and closed ranges of both steps.
#[derive(Clone, Debug)]
pub struct Window {
    lambdas: [Laurent; 2],
    ranges: [(Laurent, Laurent); 2],
    prover: Prover,
    stiffness: [f64; 2],
    /// The ranges, rounded inwards.
    inner: [(f64, f64); 2],
    /// First steps are whole multiples of 10^-this.
    decimals: i32,
}

/// The result of a search.
#[derive(Clone, Debug)]
pub struct Bands {
    /// Where it looked.
    pub window: Window,
    /// Where every ratio is unstable, by families and ratios; no two of them overlap.
    pub certified: Vec<Sector>,
    /// Ranges of ratios of a tongue that are left to try.
    pub open: u64,
    /// Those that were tried.
    pub tried: u64,
}

/// A range of ratios of one tongue.
#[derive(Clone, Debug)]
struct Piece {
    family: [i64; 2],
    ratios: [Ratio; 2],
    /// About where the tongue is.
    about: (f64, f64),
    /// Both sides of what is proven, and the way that was.
    proven: Option<([Line; 2], Way)>,
}

/// A piece that was tried.
struct Tried {
    piece: Piece,
    /// About the area of the tongue that is left.
    left: f64,
    /// What was added.
    gain: f64,
}

/// Pieces, those with the most area left first.
struct Queue {
    /// The area of the window.
    whole: f64,
    open: BTreeMap<i64, Vec<Piece>>,
    /// Too little is left, or ratios too near to each other.
    done: Vec<Piece>,
}

impl Window {
    /// # Errors
    /// A range that is empty or begins below zero; a stiffness that is not positive, as the turns of both
    /// have to grow with the steps; ratios of the window that are hardly different: their periods have
    /// millions of kicks; ratios beyond 2^±12 alone.
    pub fn new(lambdas: [Laurent; 2], ranges: [(Laurent, Laurent); 2]) -> Result<Window> {
        for ((lo, hi), field) in ranges.iter().zip(["h1-range", "h2-range"]) {
            if lo.sign() == Sign::Negative || (hi - lo).sign() != Sign::Positive {
                return Err(Error::input(field, format!("{lo}..{hi}"), "give LO..HI with 0 <= LO < HI"));
            }
        }
        let base = |index: usize, field| {
            base(&lambdas[index], &lambdas[1 - index]).ok_or_else(|| {
                Error::input(field, &lambdas[index], "has to be positive, so that larger steps turn further")
            })
        };
        let bases = [base(0, "lambda1")?, base(1, "lambda2")?];
        let inner = ranges.each_ref().map(|(lo, hi)| (lo.enclose_f64().1, hi.enclose_f64().0));
        let [(a, b), (c, d)] = inner;
        if d * b <= c * a * (1.0 + CLOSE) {
            let (lo, hi) = &ranges[1];
            return Err(Error::input(
                "h2-range",
                format!("{lo}..{hi}"),
                "makes too small a window: widen it",
            ));
        }
        let most = f64::from(1 << LARGEST);
        if c >= most * b || d * most <= a {
            let (lo, hi) = &ranges[1];
            let remedy = format!(
                "makes no ratio h2/h1 from 1/{most} to {most}, and no others are looked at: bring the ranges nearer to each other"
            );
            return Err(Error::input("h2-range", format!("{lo}..{hi}"), remedy));
        }
        let stiffness = lambdas.each_ref().map(Laurent::to_f64);
        let decimals = DIGITS - inner[0].1.log10().floor() as i32;
        let prover = Prover::new(lambdas.clone(), bases, decimals);
        Ok(Window { lambdas, ranges, prover, stiffness, inner, decimals })
    }

    /// The stiffnesses.
    pub fn lambdas(&self) -> &[Laurent; 2] {
        &self.lambdas
    }

    /// The closed range of a step.
    pub fn range(&self, step: usize) -> &(Laurent, Laurent) {
        &self.ranges[step]
    }

    /// The area of the window.
    pub fn area(&self) -> Laurent {
        let [first, second] = self.ranges.each_ref().map(|(lo, hi)| hi - lo);
        &first * &second
    }

    /// Whether a sector is proven: both sides unstable for every ratio between its ends, and in one tongue.
    pub fn proves(&self, sector: &Sector) -> bool {
        let Sector { family, ratios, sides, decimals } = sector;
        *decimals == self.decimals
            && sides.iter().all(|line| {
                Way::all().any(|way| self.prover.prove(*family, *ratios, *line, Some(way)).is_some())
                    && self.prover.is_in_tongue(*family, *ratios, *line).unwrap_or(false)
            })
    }

    /// Halves ranges of ratios of all tongues that cross the window until so many were tried, or sectors of a
    /// share of the window are certified. Ranges with the largest areas left come first. `see` is called with
    /// the number of ranges tried since its last call. The result is the same on any number of threads.
    ///
    /// # Errors
    /// Where the work was stopped.
    pub fn search(&self, tries: u64, share: Option<&Rational>, see: &dyn Fn(u64)) -> Result<Bands> {
        let whole = self.area().to_f64();
        // Areas are added in doubles: more than all of their roundings.
        let goal = share.map_or(f64::INFINITY, |share| rational::to_f64(share) * whole * (1.0 + 1e-9));
        let mut queue = Queue { whole, open: BTreeMap::new(), done: Vec::new() };
        for (piece, left) in try_map(&self.roots(), |ratios| self.tongues(*ratios))?.into_iter().flatten() {
            queue.put(piece, left);
        }
        let (mut tried, mut certified) = (0, 0.0);
        while tried + 2 <= tries && certified < goal {
            let pieces = queue.take((tries - tried) as usize / 2);
            if pieces.is_empty() {
                break;
            }
            go_on()?;
            let found = try_map(&pieces, |piece| {
                let [first, second] = piece.halves();
                Ok([self.try_piece(first)?, self.try_piece(second)?])
            })?;
            see(2 * pieces.len() as u64);
            tried += 2 * pieces.len() as u64;
            for Tried { piece, left, gain } in found.into_iter().flatten() {
                certified += gain;
                queue.put(piece, left);
            }
        }
        let Queue { open, done, .. } = queue;
        let left = open.values().map(|pieces| pieces.len() as u64).sum();
        let all = done.into_iter().chain(open.into_values().flatten());
        let mut certified: Vec<Sector> = all.filter_map(|piece| piece.sector(self.decimals)).collect();
        let ratio = |sector: &Sector| value(sector.ratios[0]);
        certified.sort_by(|x, y| x.family.cmp(&y.family).then(ratio(x).total_cmp(&ratio(y))));
        Ok(Bands { window: self.clone(), certified, open: left, tried })
    }

    /// Ranges of ratios to begin with, none much wider than those of the window.
    fn roots(&self) -> Vec<[Ratio; 2]> {
        let [(a, b), (c, d)] = self.inner;
        let (least, most) = (c / b, d / a);
        let mut ranges: Vec<[Ratio; 2]> =
            (0..LARGEST).flat_map(|k| [[(1 << k, 1), (2 << k, 1)], [(1, 2 << k), (1, 1 << k)]]).collect();
        let mut roots = Vec::new();
        while let Some(ratios) = ranges.pop() {
            let [from, to] = ratios.map(value);
            let span = to.min(most) - from.max(least);
            if span <= NARROW * to {
                continue;
            }
            // From one whole number to the next, where there are not too many of them.
            let is_wide = |from: f64, to: f64| from < 32.0 && to > from + 1.0;
            let is_narrow = to - from < NARROW * to;
            if !is_narrow && (span < 0.25 * (to - from) || is_wide(from, to) || is_wide(1.0 / to, 1.0 / from))
            {
                let middle = between([from, to], MIDDLE);
                ranges.extend([[ratios[0], middle], [middle, ratios[1]]]);
            } else {
                roots.push(ratios);
            }
        }
        roots
    }

    /// The tongues that cross the window in a range of ratios, and about the area of each.
    fn tongues(&self, ratios: [Ratio; 2]) -> Result<Vec<(Piece, f64)>> {
        go_on()?;
        let [(a, b), (c, d)] = self.inner;
        let [from, to] = ratios.map(value);
        let mut found = BTreeMap::new();
        for part in RAYS {
            let ray = between([from.max(c / b), to.min(d / a)], part);
            let range = self.first_steps(value(ray));
            if range.0 >= range.1 {
                continue;
            }
            for m in labels(self.stiffness, ray, range) {
                let Some(family) = family(m, ray) else { continue };
                found.entry(family).or_insert_with(|| {
                    let about = edges(self.stiffness, ray, m, range, self.inner[0].1);
                    let left = area(ratios, [[about.0; 2], [about.1; 2]]);
                    (Piece { family, ratios, about, proven: None }, left)
                });
            }
        }
        Ok(found.into_values().collect())
    }

    /// Between which first steps a ray is in the window.
    fn first_steps(&self, ratio: f64) -> (f64, f64) {
        let [(a, b), (c, d)] = self.inner;
        ((c / ratio).max(a), (d / ratio).min(b))
    }

    /// Moves the sides of what is proven of a piece towards the edges of the tongue.
    fn try_piece(&self, mut piece: Piece) -> Result<Tried> {
        let [from, to] = piece.ratios.map(value);
        let [first, middle, last] = [[0.05, 0.3], MIDDLE, [0.7, 0.95]].map(|part| between([from, to], part));
        let places = [first, last];
        let label = |(p, q): Ratio| piece.family[0] * p as i64 + piece.family[1] * q as i64;
        let mut about = piece.about;
        let edges = places.map(|place| {
            let found = edges(self.stiffness, place, label(place), about, self.inner[0].1);
            if found.0 < found.1 {
                about = found;
            }
            found
        });
        // About the area of the tongue in the window.
        let inside = |(lo, hi): (f64, f64), place: Ratio| {
            let (from, to) = self.first_steps(value(place));
            0.25 * (hi.min(to) - lo.max(from)).max(0.0) * (lo + hi)
        };
        let all = (to - from) * (inside(edges[0], places[0]) + inside(edges[1], places[1]));
        let turns = label(first).min(label(middle)).min(label(last));
        let resolved = turns as f64 * (edges[0].1 - edges[0].0) / edges[0].1;
        // Lines along the edges, within the window. Its sides of constant h2 are hyperbolas, above their
        // tangents and below their chords.
        let [t, u] = places.map(|place| (value(place) - from) / (to - from));
        let along = |a: f64, b: f64| {
            let slope = (b - a) / (u - t);
            [a - t * slope, b + (1.0 - u) * slope]
        };
        let (lower, upper) = (along(edges[0].0, edges[1].0), along(edges[0].1, edges[1].1));
        let center = 0.5 * (from + to);
        let [(a, b), (c, d)] = self.inner;
        let lower = [0, 1].map(|k| lower[k].max(a).max(c / [from, to][k] * (1.0 + ROOM)));
        let upper = [0, 1].map(|k| {
            let tangent = d / center * (2.0 - [from, to][k] / center) * (1.0 - ROOM);
            upper[k].min(b).min(tangent)
        });
        let unit = 10f64.powi(self.decimals);
        let in_units = |line: [f64; 2]| line.map(|h1| (h1 * unit) as i64);
        let (lower, upper) = (in_units(lower).map(|n| n.saturating_add(1)), in_units(upper).map(|n| n - 1));
        let area = |sides: [Line; 2]| area(piece.ratios, sides.map(|line| line.map(|n| n as f64 / unit)));
        let before = piece.proven.map_or(0.0, |(sides, _)| area(sides));
        let mut now = piece.proven;
        if is_open([lower, upper]) {
            let start = match piece.proven {
                None if resolved < RESOLVED => None,
                None => {
                    let center = mixed(lower, upper, 0.5);
                    let way = self.prover.prove(piece.family, piece.ratios, center, None);
                    way.map(|way| ([center; 2], way))
                }
                proven => proven,
            };
            if let Some((mut sides, way)) = start {
                let is_proven =
                    |line: Line| self.prover.prove(piece.family, piece.ratios, line, Some(way)).is_some();
                for (side, edge) in [lower, upper].into_iter().enumerate() {
                    let mut beyond = edge;
                    for k in 0..MOVES {
                        let line = mixed(sides[side], beyond, if k == 0 { FIRST } else { 0.5 });
                        if is_proven(line) {
                            sides[side] = line;
                        } else {
                            beyond = line;
                        }
                    }
                }
                let [lower, upper] = sides;
                let is_in_tongue = |line: Line| self.prover.is_in_tongue(piece.family, piece.ratios, line);
                let is_wider = is_open(sides) && area(sides) > before;
                if is_wider && is_in_tongue(lower)? && is_in_tongue(upper)? {
                    now = Some((sides, way));
                }
            }
        }
        let certified = now.map_or(0.0, |(sides, _)| area(sides));
        (piece.about, piece.proven) = (about, now);
        Ok(Tried { piece, left: (all - certified).max(0.0), gain: certified - before })
    }
}

impl Queue {
    fn put(&mut self, piece: Piece, left: f64) {
        let share = left / self.whole;
        let [from, to] = piece.ratios.map(value);
        if share > LEAST && to - from > NARROW * to {
            self.open.entry(-(2.0 * share.log2()).floor() as i64).or_default().push(piece);
        } else {
            self.done.push(piece);
        }
    }

    /// So many of the first ones, and no more than a batch.
    fn take(&mut self, most: usize) -> Vec<Piece> {
        let Some((key, mut pieces)) = self.open.pop_first() else { return Vec::new() };
        let rest = pieces.split_off(pieces.len().min(BATCH).min(most));
        if !rest.is_empty() {
            self.open.insert(key, rest);
        }
        pieces
    }
}

impl Piece {
    /// Both parts at the simplest ratio in the middle.
    fn halves(&self) -> [Piece; 2] {
        let middle = between(self.ratios.map(value), MIDDLE);
        let cross =
            |(p, q): Ratio, (r, s): Ratio| i128::from(r) * i128::from(q) - i128::from(p) * i128::from(s);
        let [from, to] = self.ratios;
        // The share of the first half, exactly.
        let part = cross(from, middle) * i128::from(to.1);
        let whole = cross(from, to) * i128::from(middle.1);
        [0, 1].map(|side| {
            let mut half = self.clone();
            half.ratios[1 - side] = middle;
            half.proven = self.proven.and_then(|(mut sides, way)| {
                // Rounded up on the lower side and down on the upper one: within what is proven.
                let below = |[first, last]: Line| {
                    let moved = i128::from(last - first) * part;
                    (i128::from(first) + moved.div_euclid(whole), moved.rem_euclid(whole) > 0)
                };
                let [(lower, is_above), (upper, _)] = sides.map(below);
                sides[0][1 - side] = (lower + i128::from(is_above)) as i64;
                sides[1][1 - side] = upper as i64;
                is_open(sides).then_some((sides, way))
            });
            half
        })
    }

    fn sector(self, decimals: i32) -> Option<Sector> {
        let Piece { family, ratios, proven, .. } = self;
        proven.map(|(sides, _)| Sector { family, ratios, sides, decimals })
    }
}

/// Whether there is something between both sides.
fn is_open([lower, upper]: [Line; 2]) -> bool {
    lower[0] < upper[0] && lower[1] < upper[1]
}

impl Bands {
    /// The area that is certified, enclosed.
    pub fn area(&self) -> (f64, f64) {
        self.sum().to_f64_enclosure()
    }

    /// The share of the window that is certified, enclosed.
    pub fn share(&self) -> (f64, f64) {
        let whole = self.window.area().enclosure(BITS);
        self.sum().div(&whole, BITS).expect("a window has an area").to_f64_enclosure()
    }

    fn sum(&self) -> Ball {
        self.certified.iter().fold(Ball::zero(), |sum, sector| sum.add(&sector.area(), BITS))
    }
}

/// A line between two others.
fn mixed(a: Line, b: Line, share: f64) -> Line {
    [0, 1].map(|k| a[k] + (share * (b[k] - a[k]) as f64) as i64)
}

/// The curve (a, b) with a p + b q = m whose a is nearest to 0, or whose b is where the ratio is below 1:
/// those of the widest tongues.
fn family(m: i64, (p, q): Ratio) -> Option<[i64; 2]> {
    let is_simple = p.min(q) < LEAST_KICKS;
    let (p, q) = (p as i64, q as i64);
    let (large, small) = (p.max(q), p.min(q));
    let most = if is_simple { 0 } else { small / 2 };
    let near = (0..=most).flat_map(|n| [n, -n]).find(|n| (m - n * large) % small == 0)?;
    let other = (m - near * large) / small;
    Some(if p >= q { [near, other] } else { [other, near] })
}

/// The simplest ratio in a part of a range, in doubles: any ratio near it would do.
fn between([from, to]: [f64; 2], part: [f64; 2]) -> Ratio {
    let [mut from, mut to] = part.map(|share| from + share * (to - from));
    // Continued fractions of both ends, as long as they agree.
    let (mut before, mut last) = ((0, 1), (1, 0));
    loop {
        let (whole, up) = (from.floor(), from.ceil());
        let next = |n: f64| {
            let n = n as u64;
            (n * last.0 + before.0, n * last.1 + before.1)
        };
        if up <= to {
            return next(up);
        }
        (before, last) = (last, next(whole));
        (from, to) = (1.0 / (to - whole), 1.0 / (from - whole));
    }
}

/// √Λ/2 and Λ'/(2 √Λ); `None` unless Λ is positive.
pub(super) fn base(value: &Laurent, other: &Laurent) -> Option<Base> {
    let root = value.enclosure(BITS).sqrt(BITS)?.scale2(-1);
    (value.sign() == Sign::Positive).then_some(())?;
    let weight = other.enclosure(BITS).scale2(-2).div(&root, BITS)?;
    Some(Base { root: enclosed(&root), weight: enclosed(&weight) })
}

/// A constant.
pub(super) fn enclosed(ball: &Ball) -> Taylor {
    let (lo, hi) = ball.to_f64_enclosure();
    Taylor::constant(lo, hi - lo)
}
