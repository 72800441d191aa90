//! Words: what is known of published integrators, and random words against products of the test's own.

use kickdrift::number::{Laurent, Radical, Rational, Ring, Sign, parse::parse_rational, rational::ratio};
use kickdrift::word::{Forces, METHODS, Stability, Trigonometric, Word, at, method};
use num_traits::{One, Signed, Zero};

fn word(text: &str) -> Word {
    text.parse().unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn of(name: &str) -> Word {
    method(name).unwrap().word()
}

fn stability(word: &Word) -> Stability {
    Stability::of(&word.polynomials(&Forces::one()))
}

const LAMBDA: &str = "-0.2123418310626054";

/// PEFRL's drifts with these kicks.
fn pefrl_with(kicks: [&str; 4]) -> Word {
    let (xi, chi) = ("0.1786178958448091", "-0.06626458266981849");
    let [a, b, c, d] = kicks;
    word(&format!("D({xi}) K({a}) D({chi}) K({b}) D(1-2*({chi}+{xi})) K({c}) D({chi}) K({d}) D({xi})"))
}

/// The first edge of ω h is within `off` of the figure; and the test's own product says so.
fn has_edge(word: &Word, figure: f64, off: f64) {
    let all = stability(word);
    let edge = all.nominal_edge().unwrap_or_else(|| panic!("{word} has no edge"));
    let (lo, hi) = edge.s().sqrt(96).unwrap().to_f64_enclosure();
    assert!(hi - lo < 1e-14 && (lo - figure).abs() < off, "{word}: {lo}..{hi}, not {figure}");
    let (lo, hi) = edge.ends.clone();
    let off = ratio(1, 1_000_000_000_000);
    assert!(own_verdict(word, &(lo - &off), &Rational::zero()) == Some(true), "{word}");
    assert!(own_verdict(word, &(hi + &off), &Rational::zero()) == Some(false), "{word}");
}

/// The width of the grid on which the figures were found.
const GRID: f64 = 1e-4;

#[test]
fn first_edges_are_those_known() {
    has_edge(&of("2mn-velocity"), 2.5532, GRID);
    has_edge(&of("2mn-position"), 2.5532, GRID);
    has_edge(&word("K(0.21178) D(1/2) K(1-2*0.21178) D(1/2) K(0.21178)"), 2.6343, GRID);
    has_edge(&of("bcss-3"), 4.6619, GRID);
    has_edge(&of("forest-ruth"), 1.5735, GRID);
    has_edge(&of("pefrl"), 2.9895, GRID);
    has_edge(&of("4mn5fv"), 3.1421, GRID);
    has_edge(&of("predescu-3"), 4.583_768, 1e-6);
    has_edge(&of("vefrl"), 3.469_636, 1e-6);
    has_edge(&of("fg-adada"), 2.926_948, 1e-6);
    has_edge(&of("fg-badadadab"), 2.184_445, 1e-6);
    has_edge(&of("bcss-4"), 5.35, 5e-3);
    // The published decimals of these open unstable intervals, which exact coefficients close.
    for (name, strict) in [("bcss-3-decimals", 2.97632), ("bcss-4", 3.04299), ("predescu-3", 2.96718)] {
        let edge = stability(&of(name)).first_edge().unwrap().s().sqrt(96).unwrap().mid_f64();
        assert!((edge - strict).abs() < 2e-5, "{name}: {edge}");
    }
    assert!(stability(&of("bcss-3")).first_edge().unwrap().compare(&ratio(21, 1)) == Sign::Positive);
    let chin = stability(&of("chin-4a"));
    assert_eq!(chin.first_edge().unwrap().rational(), Some(ratio(12, 1)));
}

/// 6 a b - 2 a - b + 1/2 = 0 makes a zero of A and one of D coincide; b rounded to 14 digits opens an
/// unstable interval there.
#[test]
fn rounding_opens_an_unstable_interval_of_bcss_3() {
    let (exact, rounded) = (stability(&of("bcss-3")), stability(&of("bcss-3-decimals")));
    assert!(exact.intervals[0].stable && exact.intervals.len() + 2 == rounded.intervals.len());
    let ends = |edge: &Option<kickdrift::word::Edge>| edge.as_ref().unwrap().s().sqrt(96).unwrap().mid_f64();
    let (from, to) = (ends(&rounded.intervals[1].lower), ends(&rounded.intervals[1].upper));
    assert!(!rounded.intervals[1].stable && (2.97632..2.97633).contains(&from));
    assert!((9e-14..1e-13).contains(&(to - from)), "{from}..{to}");
}

/// github.com/SPECFEM/specfem3d/issues/1863, kicks as posted there.
#[test]
fn a_word_that_was_asked_about_is_not_consistent() {
    let posted = pefrl_with([LAMBDA, LAMBDA, &format!("1-2*({LAMBDA})"), LAMBDA]);
    let sums = posted.sums();
    assert!(sums[0].1.is_one() && sums[1].0 == "K");
    assert_eq!(
        sums[1].1.as_rational(),
        Some(Rational::one() + "-0.2123418310626054".parse::<Laurent>().unwrap().as_rational().unwrap())
    );
    assert!(!posted.is_consistent() && posted.order().order == 0);
    let place = posted.asymmetry().unwrap();
    assert_eq!(
        (place.letter, place.there.as_str(), place.mirrored.as_str()),
        (4, "K(-0.2123418310626054)", "K(1.4246836621252108)")
    );
    has_edge(&posted, 1.958, 5e-4);
}

#[test]
fn the_catalogue_is_what_its_sources_say() {
    let asymmetric = [
        "symplectic-euler",
        "mclachlan-atela-2",
        "ruth-3",
        "mclachlan-atela-3",
        "mclachlan-atela-4",
        "mclachlan-atela-5",
        "calvo-sanz-serna-4",
        "bbk",
        "wisdom-holman-composition",
    ];
    for method in METHODS {
        let word = method.word();
        let order = word.order();
        // Decimals sum to 1 by construction, or to 18 digits of them.
        let sums_to_one = |(_, sum): &(&str, Radical)| {
            let off = (sum - &Radical::one()).as_rational().unwrap();
            off.abs() < ratio(1, 1_000_000_000_000_000)
        };
        // Of equilibrium MOLLY's slow force a mode with a fast one feels nothing.
        let felt = method.name != "molly-equilibrium";
        assert!(word.sums().iter().all(|own| sums_to_one(own) || !felt && own.0 == "K2"), "{}", method.name);
        assert!(order.nominal >= method.order, "{}: {} {}", method.name, order.nominal, method.order);
        assert_eq!(word.asymmetry().is_none(), !asymmetric.contains(&method.name), "{}", method.name);
        assert_eq!(word.to_string().parse::<Word>().unwrap(), word);
    }
    // Exact coefficients have their order exactly.
    for (name, order) in [
        ("forest-ruth", 4),
        ("suzuki-4", 4),
        ("chin-4a", 4),
        ("chin-4c", 4),
        ("bcss-2", 2),
        ("midpoint", 2),
        ("avi-3-2", 2),
        ("ruth-3", 3),
        ("takahashi-imada", 2),
        ("saba-3", 2),
    ] {
        let own = of(name).order();
        assert_eq!((own.order, own.nominal), (order, order), "{name}");
    }
    let (verlet, evaluations) = (of("velocity-verlet").order(), |name: &str| of(name).cost().evaluations);
    let c = |n, d| Radical::from_rational(&ratio(n, d));
    assert_eq!((verlet.frequency, verlet.impedance), (Some((2, c(1, 24))), Some((2, c(-1, 8)))));
    assert_eq!(verlet.error.map(|c| c.coefficient(0)), [c(0, 1), c(1, 6), c(1, 12), c(0, 1)]);
    assert_eq!(
        [evaluations("velocity-verlet"), evaluations("respa-4"), evaluations("avi-3-2")],
        [[1, 0], [4, 1], [3, 2]]
    );
    assert!(stability(&of("midpoint")).begins_stable() && stability(&of("midpoint")).first_edge().is_none());
}

/// r-RESPA and AVI as words are the project's own.
#[test]
fn words_of_two_forces_decide_as_the_ladder_does() {
    use kickdrift::propagator::Oscillator;
    use kickdrift::verdict::{Limits, decide};
    let x = |n: i64, d: i64| Laurent::from_rational(ratio(n, d));
    let mut unstable = 0;
    for (name, fast, slow) in [("respa-4", 4, 1), ("avi-3-2", 3, 2)] {
        for (i, rho) in (1..60).flat_map(|i| [(i, ratio(1, 25)), (i, ratio(2, 1)), (i, ratio(-1, 9))]) {
            let product = of(name).polynomials(&Forces::ratio(&rho));
            let h = x(i, 7);
            let [h1, h2] = [fast, slow].map(|n| &h * &x(1, n));
            let oscillator = Oscillator::new(x(1, 1), Laurent::from_rational(rho.clone()), h1, h2).unwrap();
            let wanted = decide(&oscillator.clocks().unwrap(), &Limits::default()).unwrap().verdict;
            let found = at(&product, &(&h * &h)).unwrap();
            assert_eq!((found.kind, found.side), (wanted.kind().name(), wanted.side()), "{name} {i} {rho}");
            unstable += u32::from(!found.is_stable());
        }
    }
    assert!(unstable > 50, "{unstable}");
    // With transcendental steps.
    let product = of("respa-4").polynomials(&Forces::ratio(&ratio(1, 25)));
    let found = at(&product, &"pi^2".parse().unwrap()).unwrap();
    assert!(found.trace.mid_f64().is_finite() && found.kind != "parabolic");
}

/// Numbers that look random.
struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        // Knuth's linear congruence; its high bits.
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 33) % n
    }

    fn fraction(&mut self) -> Rational {
        ratio(self.below(25) as i64 - 9, self.below(9) as i64 + 1)
    }
}

/// A letter as the test has it: what, which force, coefficients.
type Own = (char, u64, Vec<Rational>);

fn written(letters: &[Own]) -> String {
    let one = |(name, force, c): &Own| {
        let force = if *force == 0 { String::new() } else { force.to_string() };
        let numbers: Vec<String> = c.iter().map(Rational::to_string).collect();
        format!("{name}{force}({})", numbers.join(","))
    };
    letters.iter().map(one).collect::<Vec<_>>().join(" ")
}

/// The images of (1, 0) and (0, 1) at h² Λ1 = s, kicked and drifted one by one: A, B, C, D.
fn kicked(letters: &[Own], s: &Rational, rho: &Rational) -> Option<[Rational; 4]> {
    let image = |mut x: Rational, mut v: Rational| {
        for (name, force, c) in letters {
            let force = match force {
                0 => s + s * rho,
                1 => s.clone(),
                _ => s * rho,
            };
            match name {
                'D' => x += &c[0] * &v,
                'K' => {
                    let strength = c.iter().rev().fold(Rational::zero(), |sum, c| (sum + c) * &force);
                    v -= strength * &x;
                }
                _ => {
                    // x' = x + c (v + v')/2, v' = v - c F (x + x')/2.
                    let c = &c[0] / ratio(2, 1);
                    let below = Rational::one() + &c * &c * &force;
                    if below.is_zero() {
                        return None;
                    }
                    let new_v =
                        (&v * (Rational::one() - &c * &c * &force) - &c * &force * &x * ratio(2, 1)) / below;
                    x += c * (&v + &new_v);
                    v = new_v;
                }
            }
        }
        Some((x, v))
    };
    let ((a, c), (b, d)) =
        (image(Rational::one(), Rational::zero())?, image(Rational::zero(), Rational::one())?);
    Some([a, b, c, d])
}

fn verdict_of([a, b, c, d]: &[Rational; 4]) -> bool {
    let size = (a + d).abs();
    size < ratio(2, 1) || size == ratio(2, 1) && b.is_zero() && c.is_zero()
}

/// Letters with rational coefficients of a word, or balls' midpoints of irrational ones, which is enough
/// 1e-12 away from an edge.
fn own_verdict(word: &Word, s: &Rational, rho: &Rational) -> Option<bool> {
    use kickdrift::number::Real;
    use kickdrift::word::{Force, Letter};
    let number = |x: &Radical| x.as_rational().unwrap_or_else(|| x.enclosure(200).lower());
    let force = |force: &Force| match force {
        Force::All => 0,
        Force::First => 1,
        Force::Second => 2,
    };
    let own = |letter: &&Letter| match letter {
        Letter::Drift(time) => ('D', 0, vec![number(time)]),
        Letter::Kick { force: named, powers, .. } => ('K', force(named), powers.iter().map(number).collect()),
        Letter::Flow { .. } | Letter::Friction { .. } => unreachable!("words of kicks, drifts and midpoints"),
        Letter::Midpoint { force: named, time } => ('C', force(named), vec![number(time)]),
    };
    let letters: Vec<Own> = word.letters().iter().map(own).collect();
    Some(verdict_of(&kicked(&letters, s, rho)?))
}

/// Random words against their letters, one by one in numbers: entries, verdicts, intervals, sums, symmetry.
fn random_words(count: u64, seed: u64) {
    let mut random = Random(seed);
    let (mut inside, mut stable, mut palindromes) = (0, 0, 0);
    for case in 0..count {
        let (named, length) = (random.below(2) == 1, 1 + random.below(40));
        let mut letters: Vec<Own> = (0..length)
            .map(|_| {
                let force = if named { random.below(3) } else { 0 };
                match random.below(12) {
                    0 => ('C', force, vec![random.fraction()]),
                    1 => ('K', force, vec![random.fraction(), random.fraction()]),
                    2..=6 => ('K', force, vec![random.fraction()]),
                    _ => ('D', 0, vec![random.fraction()]),
                }
            })
            .collect();
        let mirrored = random.below(3) == 0;
        if mirrored {
            letters.truncate(20);
            letters.extend(letters.clone().into_iter().rev());
        }
        let text = written(&letters);
        let own = word(&text);
        assert_eq!(own.to_string().parse::<Word>().unwrap(), own, "{text}");
        if mirrored {
            assert!(own.asymmetry().is_none(), "{text}: {:?}", own.asymmetry());
            palindromes += 1;
        }
        let drifts: Rational = letters.iter().filter(|(name, ..)| *name != 'K').map(|(.., c)| &c[0]).sum();
        assert_eq!(own.sums()[0].1.as_rational(), Some(drifts), "{text}");
        let rho = if own.names_forces() { random.fraction() } else { Rational::zero() };
        let product = own.polynomials(&Forces::ratio(&rho));
        let all = Stability::of(&product);
        for _ in 0..4 {
            let s = ratio(random.below(400) as i64 + 1, random.below(40) as i64 + 1);
            let Some(wanted) = kicked(&letters, &s, &rho) else {
                assert!(at(&product, &Laurent::from_rational(s)).is_none(), "{case}: {text}");
                continue;
            };
            let here = Radical::from_rational(&s);
            let value = |f: &kickdrift::number::Polynomial<Radical>| f.eval(&here).as_rational().unwrap();
            let q = value(&product.denominator);
            let entries = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|at| value(&product.matrix[at]) / &q);
            assert_eq!(entries, wanted, "{case}: {text} at s = {s}, rho = {rho}");
            let found = at(&product, &Laurent::from_rational(s.clone())).unwrap();
            assert_eq!(found.is_stable(), verdict_of(&wanted), "{case}: {text} at s = {s}, rho = {rho}");
            let trace = &wanted[0] + &wanted[3];
            assert!(found.trace.contains(&trace), "{case}: {text}");
            let holds = |own: &&kickdrift::word::Interval| {
                let lower = own.lower.as_ref().map_or(Sign::Negative, |edge| edge.compare(&s));
                let upper = own.upper.as_ref().map_or(Sign::Positive, |edge| edge.compare(&s));
                (lower == Sign::Negative || lower == Sign::Zero && own.includes[0])
                    && (upper == Sign::Positive || upper == Sign::Zero && own.includes[1])
            };
            let holding: Vec<_> = all.intervals.iter().filter(holds).collect();
            assert_eq!(holding.len(), 1, "{case}: {text} at s = {s}, rho = {rho}");
            assert_eq!(holding[0].stable, verdict_of(&wanted), "{case}: {text} at s = {s}, rho = {rho}");
            inside += 1;
            stable += u64::from(holding[0].stable);
        }
        let flips = all.intervals.windows(2).all(|pair| pair[0].stable != pair[1].stable);
        assert!(flips, "{case}: {text}: neighbours have one answer");
    }
    println!("{inside} steps of {count} words, {stable} stable, {palindromes} palindromes");
    // Enough of both answers: most steps are too long for words as wild as these.
    assert!(stable * 100 > inside && palindromes * 5 > count, "{stable} of {inside}, {palindromes}");
}

// Ledger: words; 400 random words, seed 1; products of their letters
#[test]
fn random_words_are_what_their_letters_do() {
    random_words(400, 1);
}

// Ledger: words; 10_000 random words, seed 2; products of their letters
#[test]
#[ignore = "ten thousand words take minutes"]
fn ten_thousand_random_words_are_what_their_letters_do() {
    random_words(10_000, 2);
}

/// An edge that is rational is no step between edges.
#[test]
fn stable_intervals_beside_rational_edges_are_found() {
    let own = word("K2(3) K(-1) K2(8/9) C1(2/3) D(-8/5) C1(2/3) K2(8/9) K(-1) K2(3)");
    let all = Stability::of(&own.polynomials(&Forces::ratio(&ratio(2, 3))));
    let (below, above) = (ratio(25, 2), ratio(13, 1));
    let holds = |own: &&kickdrift::word::Interval| {
        own.lower.as_ref().is_some_and(|edge| edge.compare(&below) == Sign::Negative)
            && own.upper.as_ref().is_none_or(|edge| edge.compare(&above) == Sign::Positive)
    };
    assert!(all.intervals.iter().any(|own| own.stable && holds(&own)));
}

/// Ten thousand texts that are nearly words: no panic, and one line that says where.
#[test]
fn mutated_texts_are_words_or_one_line() {
    const PIECES: [&str; 27] = [
        "K",
        "D",
        "C",
        "(",
        ")",
        "1",
        "/",
        "*",
        "^",
        "-",
        "sqrt(",
        ",",
        " ",
        "2*(",
        "K1(",
        "0.5",
        "e",
        "99999999999",
        "é",
        "\n",
        "\u{202e}",
        "R(1)",
        "[sinc(x/2)^2]",
        "]",
        "O(1)",
        "^(1/3)",
        "/0",
    ];
    let mut random = Random(3);
    let (mut read, mut refused) = (0, 0);
    for case in 0..10_000 {
        let base = METHODS[random.below(METHODS.len() as u64) as usize].text;
        let mut text: Vec<char> = base.chars().take(60 + random.below(60) as usize).collect();
        for _ in 0..1 + random.below(4) {
            let place = random.below(text.len() as u64 + 1) as usize;
            match random.below(3) {
                0 if place < text.len() => drop(text.remove(place)),
                1 if place < text.len() => {
                    text[place] = PIECES[random.below(27) as usize].chars().next().unwrap()
                }
                _ => drop(text.splice(place..place, PIECES[random.below(27) as usize].chars())),
            }
        }
        let text: String = text.into_iter().collect();
        match text.parse::<Word>() {
            Ok(word) => {
                assert_eq!(word.to_string().parse::<Word>().unwrap(), word, "{case}: {text}");
                read += 1;
            }
            Err(error) => {
                let line = error.to_string();
                assert!(
                    !line.contains(char::is_control) && line.contains("character "),
                    "{case}: {text:?}: {line}"
                );
                refused += 1;
            }
        }
    }
    assert!(read > 100 && refused > 5000, "{read} read, {refused} refused");
}

#[test]
fn errors_name_the_place() {
    let line = |text: &str| text.parse::<Word>().unwrap_err().to_string();
    assert_eq!(
        line("K(1/2) E(1)"),
        "word = K(1/2) E(1): character 8: unexpected 'E'; K(c) is a kick, D(c) a drift; other letters are K1, K2, C, C1, C2, R, R1, R2, O, F, I and n*(...)"
    );
    assert!(line("K(1/2").contains("character 6: expected ')'"), "{}", line("K(1/2"));
    assert!(line("K(sqrt(2)) D(sqrt(3))").contains("one root"), "{}", line("K(sqrt(2)) D(sqrt(3))"));
    assert!(line("D(1/0)").contains("character 4: divides by zero"), "{}", line("D(1/0)"));
    assert!(line("").contains("a word has letters"));
    // √12 = 2 √3, and 4^(1/3) = (2^(1/3))².
    assert_eq!(word("K(sqrt(12)) D(2*sqrt(3))"), word("K(2*sqrt(3)) D(sqrt(12))"));
    assert_eq!(word("K(4^(1/3)) D(2^(1/3))"), word("K(2^(2/3)) D(2^(1/3))"));
}

/// Λ = (2 π/T)² of the periods 10 and 40.
fn periods_10_and_40() -> [Laurent; 2] {
    [ratio(1, 25), ratio(1, 400)].map(|c| Laurent::monomial(c, 2))
}

/// Unstable steps below 16 of periods 10 and 40, to four places, the enclosures being narrower.
#[test]
fn trigonometric_integrators_are_unstable_where_they_are_known_to_be() {
    let known: [(Trigonometric, &[(f64, f64)]); 6] = [
        (Trigonometric::Impulse, &[(4.7067, 5.0), (9.4180, 10.0), (14.1381, 15.0)]),
        (Trigonometric::Gautschi, &[(4.2202, 5.7798), (14.2202, 15.7798)]),
        (Trigonometric::Short, &[(4.8703, 5.0), (14.9577, 15.0)]),
        (Trigonometric::Linear, &[(4.9470, 5.0), (14.9981, 15.0)]),
        (Trigonometric::Long, &[]),
        (Trigonometric::HairerLubich, &[]),
    ];
    let [fast, slow] = periods_10_and_40();
    for (method, expected) in known {
        let found = method.unstable(&fast, &slow, 16.0);
        assert_eq!(found.len(), expected.len(), "{method:?}: {found:?}");
        for ([lower, upper], (from, to)) in found.into_iter().zip(expected) {
            for ((lo, hi), figure) in [(lower, from), (upper, to)] {
                assert!(lo <= hi && hi - lo < 1e-10, "{method:?}: {lo}..{hi}");
                assert!((lo - figure).abs() < 5e-5 + 1e-10, "{method:?}: {lo}..{hi} is not {figure}");
            }
        }
        assert_eq!(method.is_free(&ratio(1, 16)), expected.is_empty(), "{method:?}");
    }
}

/// The traces themselves, in doubles, on a grid beside the enclosures; other ratios, too.
#[test]
fn the_traces_of_trigonometric_integrators_say_the_same() {
    let sinc = |x: f64| x.sin() / x;
    let g = |method: Trigonometric, x: f64| match method {
        Trigonometric::Impulse => sinc(x),
        Trigonometric::Gautschi => sinc(x / 2.0).powi(2),
        Trigonometric::Short => sinc(x) * sinc(x / 2.0).powi(2),
        Trigonometric::Linear => sinc(x) * sinc(x / 2.0).powi(4),
        Trigonometric::Long => sinc(x).powi(3),
        Trigonometric::HairerLubich => sinc(x).powi(2),
    };
    let (mut stable, mut unstable) = (0, 0);
    for rho in [ratio(1, 16), ratio(1, 2), ratio(3, 2), ratio(9, 1)] {
        let slow = Laurent::from_rational(rho.clone());
        for method in Trigonometric::ALL {
            let found = method.unstable(&Laurent::from_integer(1), &slow, 20.0);
            for n in 1..2000 {
                let h = f64::from(n) * 0.01 + 0.0037;
                let near = found.iter().flatten().any(|(lo, hi)| lo - 1e-6 < h && h < hi + 1e-6);
                let trace =
                    2.0 * h.cos() - h * h * num_traits::ToPrimitive::to_f64(&rho).unwrap() * g(method, h);
                if near || h > 20.0 || (trace.abs() - 2.0).abs() < 1e-9 {
                    continue;
                }
                let inside = found.iter().any(|[(lo, _), (_, hi)]| *lo < h && h < *hi);
                assert_eq!(inside, trace.abs() > 2.0, "{method:?}, rho = {rho}, h = {h}: {trace}");
                (stable, unstable) = (stable + u32::from(!inside), unstable + u32::from(inside));
            }
        }
    }
    assert!(stable > 20_000 && unstable > 5_000, "{stable} and {unstable}");
}

/// h < 2/√Λ2 = 40/π, exactly: the midpoint rule for what is fast leaves no resonance.
#[test]
fn implicit_explicit_is_stable_up_to_40_over_pi() {
    let [fast, slow] = periods_10_and_40();
    let rho = Laurent::ratio(&slow, &fast).unwrap();
    let stability = Stability::of(&of("implicit-explicit").polynomials(&Forces::ratio(&rho)));
    let edge = stability.first_edge().unwrap();
    // s = h² Λ1 = (40/π)² π²/25 = 64.
    assert_eq!(edge.rational(), Some(ratio(64, 1)));
    assert!(stability.intervals.len() == 2 && !stability.intervals[1].stable);
}

/// The stiffness of a ring polymer's fastest mode of so many beads at 300 K, in 1/fs²: w = 2 n k T/ħ = 4 π n
/// k T/(2 π ħ), with Boltzmann's and Planck's constants exactly as the SI defines them.
fn top_ring_mode(beads: i64) -> Laurent {
    let exact = |text: &str| parse_rational("x", text).unwrap();
    let (boltzmann, planck) = (exact("1.380649"), exact("6.62607015"));
    // k T/(2 π ħ) in 1/fs: 10^-23 300 / (10^-34 10^15).
    let turns = boltzmann * exact("300") / (planck * exact("10000"));
    let c = ratio(4 * beads, 1) * turns;
    Laurent::monomial(&c * &c, 2)
}

/// An external period of 10 fs beside the fastest mode of 16 and of 32 beads.
#[test]
fn ring_polymers_are_unstable_where_they_are_known_to_be() {
    use kickdrift::word::{Enclosed, Shape};
    let slow = Laurent::monomial(ratio(1, 25), 2);
    let (exact, cayley) = (of("rpmd"), of("rpmd-cayley"));
    for (beads, from, to) in [(16, 2.0125, 2.4996), (32, 1.1765, 1.2498)] {
        let fast = top_ring_mode(beads);
        let by_factors = Shape::of(&exact).unwrap().pieces(&fast, &slow, 0.0, 3.0);
        let in_balls = Enclosed::new(&exact, &fast, &slow, &Laurent::zero()).pieces(0.0, 3.0).unwrap();
        for found in [by_factors, in_balls] {
            let first = found.iter().find(|own| !own.stable).unwrap();
            for ((lo, hi), figure) in [(first.lower, from), (first.upper, to)] {
                // The figure is rounded to its fourth place.
                assert!(lo <= hi && hi - lo < 1e-10, "{beads}: {lo}..{hi}");
                assert!((lo - figure).abs() < 5e-5 + 1e-10, "{beads}: {lo}..{hi} is not {figure}");
            }
        }
        // Cayley's transform has none: stable up to 2/√Λ2 = 10/π, where h² Λ2 = 4, exactly.
        let rho = Laurent::ratio(&slow, &fast).unwrap();
        let stability = Stability::of(&cayley.polynomials(&Forces::ratio(&rho)));
        assert!(stability.intervals.len() == 2 && stability.begins_stable(), "{beads}");
        assert_eq!(stability.first_edge().unwrap().compare(&(ratio(4, 1) / rho)), Sign::Zero, "{beads}");
    }
}

/// n modes, 0 ≤ F ≤ Λ1, 0 ≤ S ≤ Λ2: no two coupled modes are unstable below the edge of all, many just above
/// it.
#[test]
fn coupled_modes_are_stable_below_the_edge_of_all() {
    let mut state = 7u64;
    let mut random = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let (fast, slow) = (1.0, 0.3);
    let [of_fast, of_slow] = [ratio(1, 1), ratio(3, 10)].map(Laurent::from_rational);
    for method in [Trigonometric::Impulse, Trigonometric::Short, Trigonometric::Linear, Trigonometric::Long] {
        let (lo, hi) = method.coupled_edge(&of_fast, &of_slow).unwrap();
        assert!(lo <= hi && hi - lo < 1e-10);
        let phi = |x: f64| {
            let sinc = |x: f64| if x == 0.0 { 1.0 } else { x.sin() / x };
            match method {
                Trigonometric::Short => sinc(x / 2.0),
                Trigonometric::Linear => sinc(x / 2.0).powi(2),
                Trigonometric::Long => sinc(x),
                _ => 1.0,
            }
        };
        let mut beyond = 0;
        for n in 0..4000 {
            let above = n % 4 == 0;
            let h = if above { lo * 1.002 } else { lo * (0.3 + 0.6999 * random()) };
            let w = [fast, if n % 3 == 0 { 0.0 } else { random() }];
            let (u, a, b) = (3.2 * random(), slow, slow * random());
            let s = [
                [a * u.cos().powi(2) + b * u.sin().powi(2), (a - b) * u.sin() * u.cos()],
                [(a - b) * u.sin() * u.cos(), a * u.sin().powi(2) + b * u.cos().powi(2)],
            ];
            let mut m = nalgebra::Matrix4::<f64>::identity();
            let mut kick = nalgebra::Matrix4::<f64>::identity();
            for i in 0..2 {
                let x = h * w[i];
                m[(i, i)] = x.cos();
                m[(i + 2, i + 2)] = x.cos();
                m[(i, i + 2)] = if w[i] == 0.0 { h } else { x.sin() / w[i] };
                m[(i + 2, i)] = -w[i] * x.sin();
                for j in 0..2 {
                    kick[(i + 2, j)] = -h / 2.0 * phi(x) * s[i][j] * phi(h * w[j]);
                }
            }
            let size = (kick * m * kick).complex_eigenvalues().iter().map(|mu| mu.norm()).fold(0.0, f64::max);
            if above {
                beyond += u32::from(size > 1.0 + 1e-4);
            } else {
                assert!(size < 1.0 + 1e-5, "{method:?}: {size} at h = {h}, w = {w:?}, S = {s:?}");
            }
        }
        // Beyond it nothing is claimed of the long average, and little grows.
        assert!(beyond > 0 || method == Trigonometric::Long, "{method:?}: nothing grows above {lo}");
    }
}

/// Words with exact flows and filters: what is written is read again, and what is wrong has its place.
#[test]
fn flows_filters_and_friction_are_letters() {
    for text in [
        "K2[sinc(x)^2](1/2) R1(1) K2[sinc(x)^2](1/2)",
        "K2[sinc(x/2)/cos(x/2)](1/2) R1(1) K2[sinc(x/2)/cos(x/2)](1/2)",
        "K2[0](1/2) R1(1) K2[0](1/2)",
        "O(1/2) K2[cos(x/2)](1/2) R(1) K2[1/cos(x/2)^2](1/2) O(1/2)",
        "F(1/2) K(1) D(1) I(1/2)",
    ] {
        assert_eq!(word(text).to_string(), text);
    }
    // cos(x/2) sinc(x/2) = sinc(x).
    assert_eq!(word("K2[cos(x/2)*sinc(x/2)](1)"), word("K2[ sinc(x) ](1)"));
    assert_eq!(word("K2[sinc(x)/sinc(x)](1)"), word("K2(1)"));
    let line = |text: &str| text.parse::<Word>().unwrap_err().to_string();
    for (text, wanted) in [
        ("K1[sinc(x)](1)", "character 3: filters stand on K2"),
        ("K2[sin(x)](1)", "character 4: a filter is made of"),
        ("K2[sinc(x)^99](1)", "character 4: the power of a filter"),
        ("K2[1/0](1)", "character 5: divides by zero"),
        ("K2[sinc(x)(1)", "character 11: expected ']'"),
        ("O1(1)", "character 1: O1 is no letter"),
        ("F2(1)", "character 1: F2 is no letter"),
    ] {
        assert!(line(text).contains(wanted), "{text}: {}", line(text));
    }
    assert!(word("K2[sinc(x)^2](1/2) R1(1/2) R1(1/2) K2[sinc(x)^2](1/2)").asymmetry().is_none());
    assert!(word("K2[sinc(x)](1/2) R1(1) K2(1/2)").asymmetry().is_some());
}

/// Orders by power series: of filtered impulses, of flows in fractions, of the flow itself.
#[test]
fn orders_of_words_with_flows() {
    for (text, order) in [
        ("K2(1/2) R1(1) K2(1/2)", 2),
        ("K2(1) R1(1)", 1),
        ("K2[sinc(x)^2](1/2) R1(1) K2[sinc(x)^2](1/2)", 2),
        ("K2[0](1/2) R1(1) K2[0](1/2)", 0),
        ("K2(1/6) R1(1/2) K2(2/3, -1/36) R1(1/2) K2(1/6)", 4),
        ("R(1/2) R(1/2)", kickdrift::word::MOST_ORDER),
    ] {
        assert_eq!(word(text).order().order, order, "{text}");
    }
}

/// What every name of the catalogue answers at periods 10 and 40, from the word itself in balls, and by its
/// factors.
#[test]
fn words_with_flows_are_unstable_where_they_are_known_to_be() {
    use kickdrift::word::{Enclosed, Piece, Shape};
    let known: [(&str, &[(f64, f64)]); 9] = [
        ("impulse", &[(4.7067, 5.0), (9.4180, 10.0), (14.1381, 15.0)]),
        ("deuflhard", &[(4.7067, 5.0), (9.4180, 10.0), (14.1381, 15.0)]),
        ("gautschi", &[(4.2202, 5.7798), (14.2202, 15.7798)]),
        ("molly-short", &[(4.8703, 5.0), (14.9577, 15.0)]),
        ("molly-linear", &[(4.9470, 5.0), (14.9981, 15.0)]),
        ("molly-long", &[]),
        ("molly-equilibrium", &[]),
        ("hairer-lubich", &[]),
        ("grimm-hochbruck", &[]),
    ];
    let [fast, slow] = periods_10_and_40();
    for (name, expected) in known {
        let own = of(name);
        let shape = Shape::of(&own).unwrap();
        let balls = Enclosed::new(&own, &fast, &slow, &Laurent::zero()).pieces(0.0, 16.0).unwrap();
        for found in [shape.pieces(&fast, &slow, 0.0, 16.0), balls] {
            // Those that touch at a pole of Gautschi's filter are one.
            let mut unstable: Vec<Piece> = Vec::new();
            for own in found.iter().filter(|own| !own.stable) {
                match unstable.last_mut().filter(|last| last.upper == own.lower) {
                    Some(last) => last.upper = own.upper,
                    None => unstable.push(*own),
                }
            }
            assert_eq!(unstable.len(), expected.len(), "{name}: {found:?}");
            for (own, (from, to)) in unstable.iter().zip(expected) {
                for ((lo, hi), figure) in [(own.lower, from), (own.upper, to)] {
                    assert!(lo <= hi && hi - lo < 1e-9, "{name}: {lo}..{hi}");
                    assert!((lo - figure).abs() < 5e-5 + 1e-9, "{name}: {lo}..{hi} is not {figure}");
                }
            }
        }
        assert_eq!(shape.is_free(&ratio(1, 16)), expected.is_empty(), "{name}");
    }
}

/// Random words with flows, filters and friction against traces in doubles of the test's own.
#[test]
fn words_in_balls_are_what_their_letters_do() {
    use kickdrift::word::Enclosed;
    let mut random = Random(5);
    let (mut told, mut stable) = (0, 0);
    for case in 0..200 {
        // The second force attracts or repels.
        let rho = if case % 2 == 0 { 0.3 } else { -0.3 };
        let (s, gamma) = (random.below(300) as f64 / 40.0 + 0.1, 0.2);
        let mut text = String::new();
        let sinc = |x: f64| x.sin() / x;
        let mut columns = [[1.0f64, 0.0], [0.0, 1.0]];
        for _ in 0..1 + random.below(6) {
            let (n, kind) = (1 + random.below(4), random.below(8));
            let c = 1.0 / n as f64;
            let half = s.sqrt() / 2.0;
            let act: Box<dyn Fn(f64, f64) -> (f64, f64)> = match kind {
                0 => Box::new(move |x, v| (x + c * v, v)),
                1 => Box::new(move |x, v| (x, v - c * s * x)),
                2 => Box::new(move |x, v| (x, v - c * s * rho * half.cos() * sinc(half).powi(2) * x)),
                3 => Box::new(move |x, v| (x, v * (-gamma * c).exp())),
                4 => Box::new(move |x, v| (x, v * (1.0 - gamma * c))),
                5 => Box::new(move |x, v| (x, v / (1.0 + gamma * c))),
                6 if rho < 0.0 => Box::new(move |x, v| {
                    let w = (s * -rho).sqrt();
                    let (cosh, sinh) = ((c * w).cosh(), (c * w).sinh());
                    (cosh * x + sinh / w * v, cosh * v + w * sinh * x)
                }),
                _ => Box::new(move |x, v| {
                    let s = if kind == 6 { s * rho } else { s };
                    let y = c * s.sqrt();
                    (y.cos() * x + c * sinc(y) * v, y.cos() * v - c * s * sinc(y) * x)
                }),
            };
            let names = ["D", "K1", "K2[cos(x/2)*sinc(x/2)^2]", "O", "F", "I", "R2", "R1"];
            text += &format!("{}(1/{n}) ", names[kind as usize]);
            for column in &mut columns {
                let (x, v) = act(column[0], column[1]);
                *column = [x, v];
            }
        }
        let trace = columns[0][0] + columns[1][1];
        let determinant = columns[0][0] * columns[1][1] - columns[0][1] * columns[1][0];
        let margin = 1.0 + determinant - trace.abs();
        if margin.abs() < 1e-9 {
            continue;
        }
        let own = word(&text);
        let exact = |x: f64| Laurent::from_rational(kickdrift::number::rational::from_f64_exact(x).unwrap());
        let found = Enclosed::new(&own, &exact(s), &exact(s * rho), &exact(gamma)).at(&exact(1.0)).unwrap();
        assert_eq!(
            found.is_stable(),
            margin > 0.0,
            "{case}: {text} at {s}: {found:?}, {trace}, {determinant}"
        );
        assert!((found.trace.mid_f64() - trace).abs() < 1e-9 * (1.0 + trace.abs()), "{case}: {text}");
        (told, stable) = (told + 1, stable + u32::from(margin > 0.0));
    }
    assert!(told > 100 && stable > 20 && told - stable > 20, "{stable} of {told}");
}

/// The end of the stable steps that begin at 0 of a word with friction, for Λ1 and γ.
fn damped_edge(text: &str, stiffness: (i64, i64), friction: (i64, i64), most: f64) -> (f64, f64) {
    use kickdrift::word::Enclosed;
    let of = |(n, d)| Laurent::from_rational(ratio(n, d));
    let own = word(text);
    let pieces =
        Enclosed::new(&own, &of(stiffness), &Laurent::zero(), &of(friction)).pieces(0.0, most).unwrap();
    assert!(pieces[0].stable && pieces[0].lower.0 == 0.0 && !pieces[1].stable, "{text}: {pieces:?}");
    pieces[0].upper
}

/// Symplectic Euler with explicit damping is stable iff k h² + 2 c h < 4, with implicit damping iff
/// ω h < 2 z + 2 √(z² + 1), z = c/2ω.
#[test]
fn damped_springs_are_stable_up_to_the_published_steps() {
    for (k, c) in [((1, 1), (1, 10)), ((2, 1), (1, 1)), ((9, 4), (3, 1)), ((1, 100), (2, 1))] {
        let (stiffness, damping) = (k.0 as f64 / k.1 as f64, c.0 as f64 / c.1 as f64);
        let explicit = ((damping * damping + 4.0 * stiffness).sqrt() - damping) / stiffness;
        let (w, z) = (stiffness.sqrt(), damping / (2.0 * stiffness.sqrt()));
        let implicit = (2.0 * z + 2.0 * (z * z + 1.0).sqrt()) / w;
        for (text, edge) in [("F(1) K(1) D(1)", explicit), ("K(1) I(1) D(1)", implicit)] {
            let (lo, hi) = damped_edge(text, k, c, 2.0 * edge);
            // An end is enclosed to 2^-44 of the range.
            let off = edge * 1e-12;
            assert!(
                hi - lo < off && lo - off < edge && edge < hi + off,
                "{text} {k:?} {c:?}: {lo}..{hi} {edge}"
            );
        }
    }
}

/// Half of the friction explicit, half of it implicit: the trace is 1 + d times cos θ of Verlet, d the
/// determinant.
#[test]
fn brunger_brooks_and_karplus_are_stable_as_verlet_whatever_the_friction() {
    let text = method("bbk").unwrap().text;
    for friction in [(1, 100), (1, 1), (3, 1), (100, 1)] {
        let (lo, hi) = damped_edge(text, (1, 1), friction, 3.0);
        assert!(lo <= 2.0 && 2.0 <= hi && hi - lo < 1e-12, "{friction:?}: {lo}..{hi}");
    }
}

/// An end itself is one, and 10^-60 beside it a step is stable or is not.
#[test]
fn rational_ends_of_damped_steps_are_decided() {
    use kickdrift::word::Enclosed;
    let number = |x: Rational| Laurent::from_rational(x);
    let little = Rational::new(1.into(), num_bigint::BigInt::from(10).pow(60));
    // 2 + 2 = 4; 2 z + 2 √(z² + 1) = 4 for z = 3/4.
    for (text, k, c, edge) in [
        ("F(1) K(1) D(1)", ratio(2, 1), ratio(1, 1), ratio(1, 1)),
        ("K(1) I(1) D(1)", ratio(1, 1), ratio(3, 2), ratio(4, 1)),
    ] {
        let own = word(text);
        let enclosed = Enclosed::new(&own, &number(k), &Laurent::zero(), &number(c));
        let kind = |h: Rational| enclosed.at(&number(h)).unwrap().kind;
        assert_eq!(kind(edge.clone()), "marginal", "{text}");
        assert_eq!(kind(&edge - &little), "damped", "{text}");
        assert_eq!(kind(&edge + &little), "hyperbolic", "{text}");
    }
    // A transcendental step there is none, and balls of 128 bits cannot tell.
    let own = word("F(1) K(1) D(1)");
    let near = number(Rational::one() - &little) + Laurent::monomial(little, 1);
    let found =
        Enclosed::new(&own, &number(ratio(2, 1)), &Laurent::zero(), &Laurent::from_integer(1)).at(&near);
    assert_eq!(found.unwrap().kind, "edge");
}

/// Half a step focuses and half a step defocuses, as strongly: Tr = 2 cos x cosh x, x = h √Λ/2, and the first
/// zero of cos x cosh x + 1 is that of a cantilever.
#[test]
fn a_focusing_and_a_defocusing_half_are_stable_up_to_the_cantilevers_number() {
    use kickdrift::word::Enclosed;
    let one = Laurent::from_integer(1);
    for text in ["R1(1/2) R2(1/2)", "R2(1/4) R1(1/2) R2(1/4)", "R1(1/2) O(1/2) R2(1/2) F(1/2)"] {
        let own = word(text);
        // At short steps both halves cancel, and the trace leaves 2 with h⁴ alone: nothing that balls
        // separate.
        let pieces = Enclosed::new(&own, &one, &-one.clone(), &Laurent::zero()).pieces(0.1, 8.0).unwrap();
        assert!(pieces[0].stable && !pieces[1].stable, "{text}: {pieces:?}");
        let (lo, hi) = pieces[0].upper;
        assert!(hi - lo < 1e-11 && (lo / 2.0 - 1.875_104_068_711_961).abs() < 1e-11, "{text}: {lo}..{hi}");
    }
    // Λ1 + Λ2 = 0: R is a drift.
    let (flow, drift) = (word("R(1) K1(1)"), word("D(1) K1(1)"));
    let trace =
        |own: &Word| Enclosed::new(own, &one, &-one.clone(), &Laurent::zero()).at(&one).unwrap().trace;
    assert_eq!(trace(&flow).to_f64_enclosure(), trace(&drift).to_f64_enclosure());
}

/// The Langevin orders of one splitting have one trace: where O stands does not move the edge of one force,
/// and friction shifts it little.
#[test]
fn langevin_orders_damp_what_the_word_without_friction_leaves_bounded() {
    use kickdrift::word::Enclosed;
    let one = Laurent::from_integer(1);
    for name in ["baoab", "obabo"] {
        let own = of(name);
        assert_eq!(stability(&own).first_edge().unwrap().rational(), Some(ratio(4, 1)), "{name}");
        for (friction, h, stable) in
            [((1, 10), (199, 100), true), ((1, 10), (201, 100), false), ((5, 1), (199, 100), true)]
        {
            let of = |(n, d)| Laurent::from_rational(ratio(n, d));
            let found = Enclosed::new(&own, &one, &Laurent::zero(), &of(friction)).at(&of(h)).unwrap();
            assert_eq!(
                (found.is_stable(), found.kind == "damped"),
                (stable, stable),
                "{name} {friction:?} {h:?}"
            );
        }
    }
}

/// On the edges themselves: h w = n π, c² = ρ s² and ρ s² = 1 at angles whose cosines are rational; rational
/// h² Λ1 is never one.
#[test]
fn edges_of_trigonometric_integrators_are_decided() {
    use Trigonometric::{Gautschi, HairerLubich, Impulse, Linear, Long, Short};
    let at = |r: (i64, i64), rho: (i64, i64), method: Trigonometric| {
        let r = ratio(r.0, r.1);
        method.at(&Laurent::monomial(&r * &r, 2), &ratio(rho.0, rho.1))
    };
    // The filter is 0 at odd n of the long average and of Hairer and Lubich, at even n > 0 of all but the
    // impulse: the step is 1 or -1 there.
    for n in 1..=6 {
        for (method, stable) in [
            (Impulse, [false, false]),
            (Short, [true, false]),
            (Linear, [true, false]),
            (Long, [true, true]),
            (HairerLubich, [true, true]),
            (Gautschi, [true, false]),
        ] {
            assert_eq!(at((n, 1), (1, 16), method), Some(stable[n as usize % 2]), "{method:?} {n}");
        }
    }
    // Tr = -2 and no filter is 0: a Jordan block. cos h w = (rho - 1)/(rho + 1), 1 - 2/rho.
    for (r, rho) in [((1, 2), (1, 1)), ((1, 3), (3, 1)), ((2, 3), (1, 3)), ((5, 3), (3, 1)), ((7, 2), (1, 1))]
    {
        assert_eq!(at(r, rho, Gautschi), Some(false), "{r:?}");
    }
    for (r, rho) in [((1, 2), (2, 1)), ((1, 3), (4, 1)), ((2, 3), (4, 3)), ((4, 3), (4, 3))] {
        assert_eq!(at(r, rho, HairerLubich), Some(false), "{r:?}");
    }
    // A little less of the slow force, and it is none.
    assert_eq!(at((1, 2), (999, 1000), Gautschi), Some(true));
    assert_eq!(at((1, 3), (3999, 1000), HairerLubich), Some(true));
    // h w within 1e-40 of 2 pi, beyond 96 bits: pi to 50 digits.
    let pi = "3.14159265358979323846264338327950288419716939937510";
    let pi: Rational = parse_rational("pi", pi).unwrap();
    let s = Laurent::from_rational(&pi * &pi * ratio(4, 1));
    assert!(Impulse.at(&s, &ratio(1, 16)).is_some());
    // Below, as these digits are, an impulse is unstable.
    assert_eq!(Impulse.at(&s, &ratio(1, 16)), Some(false));
}

/// A slow force far stiffer than the fast one: edges where h w/2 is small. They end, and lie where doubles
/// find them.
#[test]
fn edges_beside_a_stiff_slow_force_are_found() {
    use Trigonometric::{Linear, Long, Short};
    for rho in [20i64, 100, 1_000_000] {
        for (method, cosines, sincs) in [(Short, 0, 3), (Linear, 0, 5), (Long, 1, 3)] {
            // 4 + 2 Tr without squares, at y = h w/2: positive below the first edge.
            let margin = |y: f64| {
                let kicked = rho as f64 * y * y * (y.sin() / y).powi(sincs);
                if cosines == 0 { y.cos() - kicked } else { 1.0 - kicked * y.cos() }
            };
            let (mut lo, mut hi) = (1e-9, 2.0 / (rho as f64).sqrt());
            assert!(margin(lo) > 0.0 && margin(hi) < 0.0);
            for _ in 0..60 {
                let middle = lo + (hi - lo) / 2.0;
                *(if margin(middle) > 0.0 { &mut lo } else { &mut hi }) = middle;
            }
            let [fast, slow] = [4, 4 * rho].map(Laurent::from_integer);
            let found = method.unstable(&fast, &slow, 1.0)[0][0];
            // The margin in doubles is within some units of 1e-16, its slope about 2/y.
            assert!(found.0 - 1e-15 <= lo && lo <= found.1 + 1e-15, "{method:?} {rho}: {found:?} {lo}");
        }
    }
}

/// Velocity Verlet with a gradient in both kicks: the last one is the first of the next step.
#[test]
fn gradients_at_joined_ends_are_counted_once() {
    let cost = |text: &str| text.parse::<Word>().unwrap().cost();
    let joined = cost("K(1/2, 1/24) D(1) K(1/2, 1/24)");
    assert_eq!((joined.evaluations, joined.gradients, joined.total()), ([1, 0], 1, 2));
    let apart = cost("D(1/2) K(1/2, 1/24) D(1/4) K(1/2, 1/24) D(1/4)");
    assert_eq!((apart.evaluations, apart.gradients), ([2, 0], 2));
    // One force's gradient is none of the other's, and a kick without one needs none.
    assert_eq!(cost("K1(1/2, 1/24) K2(1/2) D(1) K2(1/2) K1(1/2, 1/24)").gradients, 1);
    assert_eq!(cost("K1(1/2, 1/24) K2(1/2, 1/24) D(1) K2(1/2) K1(1/2, 1/24)").gradients, 2);
    assert_eq!(cost("K(1/2) D(1) K(1/2, 1/24)").gradients, 1);
}
