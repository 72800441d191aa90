//! Tiles: the certified verdicts of a map, by the kernel that makes maps.
//!
//! Level l and place (x, y) mean the `size`² pairs h1 = (x size + i + 1) d1, h2 = (y size + j + 1) d2 with
//! d1 = unit/(size 2^l): some of the pairs that a map of the whole plane with these spacings has. p and q
//! double with each level; from 2^15 kicks on a verdict's cost grows with their logarithm alone, and no tile
//! is refused before they have 84 binary digits.

use num_bigint::{BigInt, BigUint};
use num_traits::ToPrimitive;

use super::point::LIMITS;
use super::query::{Query, count, positive, whole};
use super::reply::Reply;
use super::session::Session;
use clocks::map::{Band, Enclosure, Grid, Map, Products, Resources};
use clocks::propagator::Oscillator;
use clocks::resonance::dominant_family;
use clocks::verdict::{Kind, Tier, Verdict, decide_steps, decide_with_growth};
use number::parallel::try_map;
use number::{Error, Laurent, Rational, Result};

/// Kicks side by side that a tile of verdicts kick by kick may take as long as: about two seconds of a core.
pub(super) const MOST_KICKS: u64 = 4_000_000_000;

/// Multiples of a spacing that a grid can have.
pub(super) const LARGEST: u64 = 1 << 26;

/// The fewest and the most points across.
pub(super) const SIZES: (u64, u64) = (16, 512);

/// The deepest level.
const DEEPEST: u64 = 4096;

/// Binary digits of the multiples up to which pairs are decided: return maps begin in two doubles there, and
/// in numbers that are twenty times as slow beyond.
const DEEPEST_DECIDED: u64 = 84;

/// Binary digits of the multiples up to which a pair's return maps are in doubles.
const IN_DOUBLES: u64 = 38;

/// The values of a tile.
#[derive(Clone, Copy, PartialEq)]
enum What {
    /// A byte: 0 elliptic, 1 hyperbolic, 2 parabolic, 3 coexistence; 4 more where Tr Q < 0.
    Verdict,
    /// f32: the growth rate per unit time, 0 where nothing grows exponentially.
    Growth,
    /// Two i16: a and b of the dominant family; a = −32768 where there is none.
    Family,
}

impl What {
    fn read(field: &str, text: &str) -> Result<What> {
        match text {
            "verdict" => Ok(What::Verdict),
            "growth" => Ok(What::Growth),
            "family" => Ok(What::Family),
            _ => Err(Error::input(field, text, "choose verdict, growth or family")),
        }
    }

    fn products(self) -> Products {
        Products { label: self == What::Family, growth: self == What::Growth }
    }

    /// Bytes of a value.
    fn width(self) -> usize {
        [1, 4, 4][self as usize]
    }
}

/// 16 bytes, `KDT1`, the size and what as u32, the largest growth as f32; then the values, row by row from
/// the lowest h2. All little endian.
///
/// Where multiples are beyond a grid's, pairs are decided one by one, and a tile has fewer of them on the
/// same piece of the plane.
pub(super) fn answer(session: &Session, query: &Query) -> Result<Reply> {
    let place = Place::read(query)?;
    let what = query.read("what", What::read)?.unwrap_or(What::Verdict);
    let (lambda1, lambda2) = query.stiffnesses(session)?;
    let tile = match place.multiples() {
        Some(multiples) => of_grid(&place, multiples, what, lambda1, lambda2)?,
        None if place.bits() <= DEEPEST_DECIDED => of_pairs(&place.thinned(), what, lambda1, lambda2)?,
        None => return Ok(refused(place.cost())),
    };
    Ok(Reply::new("application/octet-stream", tile.bytes()))
}

fn of_grid(
    place: &Place,
    [columns, rows]: [(u64, u64); 2],
    what: What,
    lambda1: Laurent,
    lambda2: Laurent,
) -> Result<Tile> {
    let steps = place.steps().map(Laurent::from_rational);
    let range = |(first, last): (u64, u64), step: &Laurent| {
        let times = |n: u64| step * &Laurent::from_rational(Rational::from_integer(n.into()));
        (times(first), times(last))
    };
    let ranges = (range(columns, &steps[0]), range(rows, &steps[1]));
    let grid = Grid::new(lambda1, lambda2, steps, ranges.0, ranges.1)?;
    let mut tile = Tile::new(what, place.size as usize);
    let resources = Resources { threads: 1, ..Resources::default() };
    Map::of(&grid).with(what.products()).within(resources).for_each_band(|_, band| {
        tile.add(&grid, &band);
        Ok(())
    })?;
    Ok(tile)
}

/// Pair by pair, for periods of any number of kicks.
fn of_pairs(place: &Place, what: What, lambda1: Laurent, lambda2: Laurent) -> Result<Tile> {
    let [columns, rows] = place.multiples_of_steps();
    let pairs = rows
        .iter()
        .flat_map(|h2| columns.iter().map(move |h1| (h1, h2)))
        .map(|(h1, h2)| Oscillator::new(lambda1.clone(), lambda2.clone(), h1.clone(), h2.clone()));
    let pairs = pairs.collect::<Result<Vec<_>>>()?;
    let mut tile = Tile::new(what, place.size as usize);
    if what == What::Verdict {
        let verdicts = try_map(&pairs, |pair| decide_steps(pair, &LIMITS))?;
        tile.values = verdicts.iter().map(|found| code(found.verdict)).collect();
        return Ok(tile);
    }
    let grown = try_map(&pairs, |pair| decide_with_growth(pair, Tier::Filter, &LIMITS))?;
    for (n, ((_, growth), pair)) in grown.iter().zip(&pairs).enumerate() {
        let rate = growth.rate(pair);
        let family =
            growth.label.zip(pair.clocks().ok()).map(|(m, clocks)| dominant_family(clocks.ratio(), m));
        tile.put(n, rate, family);
    }
    Ok(tile)
}

fn refused(kicks: f64) -> Reply {
    let message = format!("the verdicts of this tile would take as long as {kicks:.1e} kicks side by side");
    Reply::too_costly(Some(kicks), MOST_KICKS, &message)
}

/// Which points.
struct Place {
    units: [Rational; 2],
    level: u64,
    at: [BigUint; 2],
    size: u64,
}

impl Place {
    fn read(query: &Query) -> Result<Place> {
        let unit = query.need("unit", positive)?;
        Ok(Place {
            units: [unit.clone(), query.read("unit2", positive)?.unwrap_or(unit)],
            level: query.need("level", count(0, DEEPEST))?,
            at: [query.need("x", whole)?, query.need("y", whole)?],
            size: query.read("size", count(SIZES.0, SIZES.1))?.unwrap_or(256),
        })
    }

    /// d1 and d2.
    fn steps(&self) -> [Rational; 2] {
        let parts = BigInt::from(self.size) << self.level;
        self.units.each_ref().map(|unit| unit / &parts)
    }

    /// The first and the last multiples of the spacings, where a grid can have them.
    fn multiples(&self) -> Option<[(u64, u64); 2]> {
        let [x, y] = self.at.each_ref().map(|at| {
            let first = at.to_u64()?.checked_mul(self.size)?;
            (first + self.size < LARGEST).then_some((first + 1, first + self.size))
        });
        Some([x?, y?])
    }

    /// Binary digits of the larger of the multiples.
    fn bits(&self) -> u64 {
        self.at.iter().map(|at| (at * self.size + self.size).bits()).max().unwrap_or(0)
    }

    /// With so many fewer points that they are decided within about a second of a core.
    fn thinned(&self) -> Place {
        let by = if self.bits() <= IN_DOUBLES { 2 } else { 4 };
        let size = (self.size / by).max(SIZES.0);
        Place { size, units: self.units.clone(), at: self.at.clone(), level: self.level }
    }

    /// All h1 and all h2.
    fn multiples_of_steps(&self) -> [Vec<Laurent>; 2] {
        let steps = self.steps();
        std::array::from_fn(|axis| {
            let first = BigInt::from(&self.at[axis] * self.size);
            let multiple = |i: u64| Rational::from_integer(&first + BigInt::from(i + 1)) * &steps[axis];
            (0..self.size).map(|i| Laurent::from_rational(multiple(i))).collect()
        })
    }

    /// Σ (min(p, q)/2 + 1) where the multiples i, j are so large that they have a common factor as numbers
    /// drawn at random have: the mean of 1/gcd is ζ(3)/ζ(2) = 0.7308.
    fn cost(&self) -> f64 {
        let [d1, d2] = self.units.each_ref().map(|unit| unit.to_f64().unwrap_or(f64::INFINITY));
        let [x, y] =
            self.at.each_ref().map(|at| (at.to_f64().unwrap_or(f64::INFINITY) + 0.5) * self.size as f64);
        let least = x.min(y * d2 / d1);
        (self.size * self.size) as f64 * (0.7308 * least / 2.0 + 1.0)
    }
}

/// Values as they come in.
struct Tile {
    what: What,
    size: usize,
    values: Vec<u8>,
    largest: f32,
}

impl Tile {
    fn new(what: What, size: usize) -> Tile {
        let mut tile = Tile { what, size, values: vec![0; size * size * what.width()], largest: 0.0 };
        if what == What::Family {
            tile.values.chunks_mut(4).for_each(|pair| pair[..2].copy_from_slice(&i16::MIN.to_le_bytes()));
        }
        tile
    }

    /// Bands come column by column; a tile is written row by row.
    fn add(&mut self, grid: &Grid, band: &Band) {
        let (first, size) = ((band.first - grid.columns().0) as usize, self.size);
        let at = |n: usize| (n % band.rows) * size + first + n / band.rows;
        if self.what == What::Verdict {
            for (n, &verdict) in band.verdicts.iter().enumerate() {
                self.values[at(n)] = code(Verdict::ALL[usize::from(verdict)]);
            }
            return;
        }
        let step = grid.steps().0.to_f64();
        for growing in &band.growing {
            let n = growing.position as usize;
            let (i, j) = band.multipliers(grid, n);
            let ratio = grid.ratio(i, j);
            // T = p h1.
            let rate = growing.rate(ratio.p() as f64 * (i as f64 * step)).map_or(0.0, Enclosure::middle);
            self.put(at(n), rate, growing.family(ratio));
        }
    }

    /// The rate or the family of the n-th pair, whichever is shown.
    fn put(&mut self, n: usize, rate: f64, family: Option<(i64, i64)>) {
        let value = if self.what == What::Family {
            let (a, b) = family.unwrap_or((i64::from(i16::MIN), 0));
            let [a, b] = [a, b].map(|x| x.clamp(-32768, 32767) as i16);
            (u32::from(b as u16) << 16 | u32::from(a as u16)).to_le_bytes()
        } else {
            self.largest = self.largest.max(rate as f32);
            (rate as f32).to_le_bytes()
        };
        self.values[4 * n..4 * n + 4].copy_from_slice(&value);
    }

    fn bytes(self) -> Vec<u8> {
        let mut bytes = b"KDT1".to_vec();
        bytes.extend((self.size as u32).to_le_bytes());
        bytes.extend((self.what as u32).to_le_bytes());
        bytes.extend(self.largest.to_le_bytes());
        bytes.extend(self.values);
        bytes
    }
}

/// 0 elliptic, 1 hyperbolic, 2 parabolic, 3 coexistence; 4 more where Tr Q ≤ −2.
pub(super) fn code(verdict: Verdict) -> u8 {
    let kind = match verdict.kind() {
        Kind::Elliptic => 0,
        Kind::Hyperbolic => 1,
        Kind::Parabolic => 2,
        Kind::Coexistence => 3,
    };
    if verdict.side() < 0 { kind + 4 } else { kind }
}
