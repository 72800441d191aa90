//! Elements of the Lie algebra of drifts and kicks in commutators of Lyndon words.

use super::series::{Generator, Scalar, Series};
use number::Radical;

/// c times a commutator of A (drifts) and B, or B1 and B2 (kicks), in units of the step.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorTerm {
    /// As "\[A,\[A,B\]\]".
    pub commutator: String,
    pub coefficient: Radical,
}

/// Which products of A and the kicks are equal.
#[derive(Clone, Copy)]
pub(super) struct Algebra {
    pub two_forces: bool,
    pub of_a_potential: bool,
}

impl Algebra {
    pub(super) fn reduced<T: Scalar>(self, series: Series<T>) -> Series<T> {
        if self.of_a_potential { series.of_a_potential() } else { series }
    }
}

/// A generator, or the commutator of two.
enum Bracket {
    Letter(Generator),
    Pair(Box<[Bracket; 2]>),
}

impl Bracket {
    /// The standard bracketing of a Lyndon word: its second half is the longest proper suffix that is one.
    fn standard(word: &[Generator]) -> Bracket {
        if let [one] = word {
            return Bracket::Letter(*one);
        }
        let at = (1..word.len()).find(|&at| is_lyndon(&word[at..])).expect("one letter is a Lyndon word");
        Bracket::Pair(Box::new([Bracket::standard(&word[..at]), Bracket::standard(&word[at..])]))
    }

    fn series<T: Scalar>(&self) -> Series<T> {
        match self {
            Bracket::Letter(one) => Series::generator(*one),
            Bracket::Pair(pair) => pair[0].series().commutator(&pair[1].series()),
        }
    }

    fn degree(&self) -> usize {
        match self {
            Bracket::Letter(_) => 1,
            Bracket::Pair(pair) => pair[0].degree() + pair[1].degree(),
        }
    }

    /// As "[A,[A,B]]", and whether its sign is turned: the drift first, the shorter half first.
    fn text(&self, two_forces: bool) -> (String, bool) {
        let pair = match self {
            Bracket::Letter(Generator::A) => return ("A".into(), false),
            Bracket::Letter(Generator::B1) if !two_forces => return ("B".into(), false),
            Bracket::Letter(one) => return (format!("{one:?}"), false),
            Bracket::Pair(pair) => pair,
        };
        let [(left, left_turned), (right, right_turned)] =
            [&pair[0], &pair[1]].map(|half| half.text(two_forces));
        let is_drift = |half: &Bracket| matches!(half, Bracket::Letter(Generator::A));
        let turned = pair[0].degree() > pair[1].degree() || pair[0].degree() == 1 && is_drift(&pair[1]);
        let (first, second) = if turned { (right, left) } else { (left, right) };
        (format!("[{first},{second}]"), turned ^ left_turned ^ right_turned)
    }
}

/// Whether a word comes before each of its proper suffixes.
fn is_lyndon(word: &[Generator]) -> bool {
    (1..word.len()).all(|at| word < &word[at..])
}

/// What a sum of commutators of one degree is, times `scale`, in commutators of Lyndon words: in whole
/// numbers, for fractions would be reduced at every step. The bracketing of such a word is the word and later
/// ones, so that the first monomial names the next commutator.
///
/// In the algebra of a potential, and for kicks that commute, the Lyndon words whose first monomial is
/// rewritten do not occur, and the others stay a basis: no relation overlaps with itself.
pub(super) fn in_commutators<T: Scalar>(
    mut sum: Series<T>,
    scale: &Radical,
    algebra: Algebra,
) -> Vec<ErrorTerm> {
    let mut terms = Vec::new();
    while let Some((monomial, value)) = sum.first() {
        let bracket = Bracket::standard(&monomial.generators());
        let series = algebra.reduced(bracket.series::<T>());
        debug_assert!(series.first().is_some_and(|(first, one)| first == monomial && one.is_one()));
        sum = sum.sum(&series, &-value.clone());
        let (commutator, turned) = bracket.text(algebra.two_forces);
        let coefficient = &value.radical() * scale;
        terms.push(ErrorTerm { commutator, coefficient: if turned { -coefficient } else { coefficient } });
    }
    terms
}
