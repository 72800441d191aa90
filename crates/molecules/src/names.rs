//! Names of the motions of a molecule: "O-H stretch of HOH", "HIS 12 N-H stretch".
//!
//! A mode e, mass-weighted and normalized, moves atom i by e_i/√m_i. An internal coordinate q with gradient s
//! has the kinetic energy (s·x)²/g of it, g = Σ |s_i|²/m_i (Wilson's G): of bonds that is the stretch, of
//! neighbouring bonds the bend, of a whole molecule its rotation and translation. The first of these that has
//! half of the energy names the mode; a mode without such a part has no name.

use std::collections::BTreeMap;

/// The symbol, standard mass (u, CIAAW 2021, abridged) and covalent radius (Å, Cordero et al. 2008) of
/// elements; 0: of ions and metals, which are bonded to nothing here.
const ELEMENTS: [(&str, f64, f64); 21] = [
    ("H", 1.008, 0.31),
    ("H", 2.014, 0.31),
    ("Li", 6.94, 0.0),
    ("B", 10.81, 0.84),
    ("C", 12.011, 0.76),
    ("N", 14.007, 0.71),
    ("O", 15.999, 0.66),
    ("F", 18.998, 0.57),
    ("Na", 22.990, 0.0),
    ("Mg", 24.305, 0.0),
    ("Si", 28.085, 1.11),
    ("P", 30.974, 1.07),
    ("S", 32.06, 1.05),
    ("Cl", 35.45, 1.02),
    ("K", 39.098, 0.0),
    ("Ca", 40.078, 0.0),
    ("Fe", 55.845, 0.0),
    ("Cu", 63.546, 0.0),
    ("Zn", 65.38, 0.0),
    ("Br", 79.904, 1.20),
    ("I", 126.90, 1.39),
];

/// How far, u, force fields' masses are from those of elements.
const ISOTOPES: f64 = 0.05;

/// Atoms are bonded up to so many times the sum of their radii, where the closest two atoms of all set what a
/// radius is: the unit of length is unknown here. Bonds of one kind differ by less, and hydrogen bonds
/// are 1.8 times as long.
const BONDED: f64 = 1.3;

/// Sines of angles below this belong to a straight line, about which no bend is defined.
const STRAIGHT: f64 = 0.1;

/// Kinds of motion and residues that have less than this part of the most that one has are not named.
const LEAST_PART: f64 = 0.2;

/// The most kinds of motions and of residues that are listed.
const MOST_LISTED: usize = 3;

/// Atoms: what they are called, and where known what they are and where they stand.
#[derive(Clone, Debug, Default)]
pub struct Names {
    /// As `H1 HOH 4`: atom, kind of residue and its number, or a text of one's own; empty where there are
    /// none.
    labels: Vec<String>,
    structure: Option<Structure>,
}

#[derive(Clone, Debug)]
struct Structure {
    positions: Vec<[f64; 3]>,
    /// The masses of the atoms that move.
    masses: Vec<f64>,
    elements: Vec<&'static str>,
    bonds: Vec<[usize; 2]>,
    /// The molecule of each atom.
    molecule: Vec<usize>,
}

/// The atoms as a file describes them; each field may be missing.
#[derive(Clone, Debug, Default)]
pub struct Told {
    pub labels: Vec<String>,
    pub elements: Vec<String>,
    pub bonds: Option<Vec<[usize; 2]>>,
    /// The mass of each atom, as the file gives it: before hydrogens are made heavier.
    pub masses: Vec<f64>,
}

/// Kind and number; of a molecule that is no residue its formula alone.
type Residue = (String, String);

impl Names {
    /// Names for atoms at these positions that move with these masses.
    pub fn new(told: Told, positions: &[[f64; 3]], masses: Vec<f64>) -> Names {
        let Told { labels, elements, bonds, masses: given } = told;
        if positions.is_empty() || masses.len() != positions.len() {
            return Names { labels, structure: None };
        }
        let element = |i: usize| {
            let symbol = elements.get(i).map(String::as_str);
            let named = ELEMENTS.iter().find(|triple| symbol == Some(triple.0)).map(|triple| triple.0);
            let weighed = || {
                let mass = given.get(i).copied().unwrap_or(masses[i]);
                ELEMENTS.iter().find(|triple| (triple.1 - mass).abs() < ISOTOPES).map(|triple| triple.0)
            };
            // Heavy hydrogens and what gave them mass: their names begin with what they are.
            let initial = || {
                let label = labels.get(i)?;
                ["H", "C", "N", "O", "S", "P"].into_iter().find(|text| label.starts_with(text))
            };
            named.or_else(weighed).or_else(initial).unwrap_or("atom")
        };
        let elements: Vec<&'static str> = (0..masses.len()).map(element).collect();
        let in_range = |bonds: &Vec<[usize; 2]>| bonds.iter().flatten().all(|&i| i < masses.len());
        let bonds = bonds.filter(in_range).unwrap_or_else(|| neighbours(positions, &elements));
        let molecule = molecules(masses.len(), &bonds);
        let structure = Structure { positions: positions.to_vec(), masses, elements, bonds, molecule };
        Names { labels, structure: Some(structure) }
    }

    /// Names alone, of atoms or of coordinates.
    pub fn of_labels(labels: Vec<String>) -> Names {
        Names { labels, structure: None }
    }

    /// Who has most of the kinetic energy: up to three names, as long as they have a tenth of it and the
    /// first ones not nine.
    pub fn atoms(&self, shape: &[f64]) -> String {
        let each = if shape.len().is_multiple_of(3) && self.labels.len() != shape.len() { 3 } else { 1 };
        let share = |values: &[f64]| values.iter().map(|x| x * x).sum::<f64>();
        let mut shares: Vec<(usize, f64)> = shape.chunks(each).map(share).enumerate().collect();
        let whole: f64 = shares.iter().map(|(_, value)| value).sum();
        shares.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        let (mut sum, mut names) = (0.0, Vec::new());
        for (i, value) in shares.into_iter().take(3) {
            if sum > 0.9 * whole || value < 0.1 * whole {
                break;
            }
            sum += value;
            names.push(self.labels.get(i).cloned().unwrap_or_else(|| format!("atom {}", i + 1)));
        }
        names.join(", ")
    }

    /// The name of several modes together, each of one shape or of the two parts of a complex one; `None`
    /// where none of them has one.
    pub fn motion(&self, modes: &[Vec<&[f64]>]) -> Option<String> {
        let structure = self.structure.as_ref()?;
        let (mut found, mut has_others) = (Vec::<Motion>::new(), false);
        for shares in modes.iter().map(|parts| structure.shares(parts)) {
            let Some(word) = shares.first().map(|share| share.word) else {
                has_others = true;
                continue;
            };
            let place = found.iter().position(|motion| motion.word == word).unwrap_or(found.len());
            if place == found.len() {
                found.push(Motion { word, ..Motion::default() });
            }
            let motion = &mut found[place];
            motion.modes += 1;
            for Share { kind, atom, energy, .. } in shares {
                *motion.kinds.entry(kind).or_default() += energy;
                *motion.residues.entry(self.residue(structure, atom)).or_default() += energy;
            }
        }
        found.sort_by_key(|found| std::cmp::Reverse(found.modes));
        let mut names: Vec<String> = found.iter().map(Motion::name).collect();
        if has_others && !names.is_empty() {
            names.push("others".into());
        }
        (!names.is_empty()).then(|| names.join("; "))
    }

    /// The residue of an atom by its label; else its molecule by the formula.
    fn residue(&self, structure: &Structure, atom: usize) -> Residue {
        let label = self.labels.get(atom).map_or("", String::as_str);
        let words: Vec<&str> = label.split_whitespace().collect();
        match words[..] {
            [_, kind, number] => (kind.into(), number.into()),
            [_, text] if text.contains(char::is_alphabetic) => {
                let kind = text.trim_end_matches(|c: char| c.is_ascii_digit());
                (kind.into(), text[kind.len()..].into())
            }
            _ => (structure.formula(atom), String::new()),
        }
    }
}

/// Modes of one kind of motion: whose energy is in which coordinates, and where these are.
#[derive(Default)]
struct Motion {
    word: &'static str,
    modes: usize,
    kinds: BTreeMap<String, f64>,
    residues: BTreeMap<Residue, f64>,
}

/// The keys that have a part of the largest value, the largest first.
fn most<K: Clone + Ord>(all: &BTreeMap<K, f64>) -> Vec<K> {
    let largest = all.values().fold(0.0, |a: f64, x| a.max(*x));
    let mut kept: Vec<_> = all.iter().filter(|pair| *pair.1 >= LEAST_PART * largest).collect();
    kept.sort_by(|a, b| b.1.total_cmp(a.1));
    kept.into_iter().map(|pair| pair.0.clone()).collect()
}

impl Motion {
    /// "HIS 12 N-H stretch", "O-H stretch of HOH".
    fn name(&self) -> String {
        let mut words: Vec<String> = most(&self.kinds).into_iter().take(MOST_LISTED).collect();
        words.retain(|words| !words.is_empty());
        let name = format!("{} {}", words.join(", "), self.word);
        let name = name.trim_start();
        let mut residues = most(&self.residues);
        residues.sort();
        let mut kinds: Vec<&str> = residues.iter().map(|(kind, _)| kind.as_str()).collect();
        kinds.dedup();
        match (&residues[..], kinds.len()) {
            ([(kind, number)], _) if !number.is_empty() => format!("{kind} {number} {name}"),
            (_, 1..=MOST_LISTED) => format!("{name} of {}", kinds.join(", ")),
            (_, many) => format!("{name} of {many} kinds of residues"),
        }
    }
}

/// The kinetic energy that a motion has of a mode, and an atom by which it is placed.
struct Share {
    kind: String,
    word: &'static str,
    atom: usize,
    energy: f64,
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] - b[k])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn times(a: [f64; 3], factor: f64) -> [f64; 3] {
    a.map(|x| factor * x)
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Hydrogen last.
fn ordered<'a>(a: &'a str, b: &'a str) -> [&'a str; 2] {
    if (a == "H", a) <= (b == "H", b) { [a, b] } else { [b, a] }
}

impl Structure {
    /// Who has half of the energy: stretches, bends, or the motions of whole molecules; empty where nobody
    /// has, and of shapes in other coordinates than these atoms'.
    fn shares(&self, parts: &[&[f64]]) -> Vec<Share> {
        if parts.iter().any(|part| part.len() != 3 * self.masses.len()) {
            return Vec::new();
        }
        let whole: f64 = parts.iter().flat_map(|part| part.iter()).map(|x| x * x).sum();
        let moved: Vec<Vec<[f64; 3]>> = parts.iter().map(|part| self.moved(part)).collect();
        let [libration, translation] = self.rigid(&moved);
        let all = [self.stretches(&moved), self.bends(&moved), libration, translation];
        let has_half = |shares: &Vec<Share>| {
            let value = shares.iter().map(|share| share.energy).sum::<f64>();
            value > 0.0 && 2.0 * value >= whole
        };
        all.into_iter().find(has_half).unwrap_or_default()
    }

    fn moved(&self, part: &[f64]) -> Vec<[f64; 3]> {
        let of = |(e, m): (&[f64], &f64)| std::array::from_fn(|k| e[k] / m.sqrt());
        part.chunks_exact(3).zip(&self.masses).map(of).collect()
    }

    /// The energy of a coordinate with these gradients.
    fn energy(&self, gradient: &[(usize, [f64; 3])], moved: &[Vec<[f64; 3]>]) -> f64 {
        let g: f64 = gradient.iter().map(|&(i, s)| dot(s, s) / self.masses[i]).sum();
        let rate = |part: &Vec<[f64; 3]>| gradient.iter().map(|&(i, s)| dot(s, part[i])).sum::<f64>();
        moved.iter().map(|part| rate(part).powi(2)).sum::<f64>() / g
    }

    fn unit(&self, from: usize, to: usize) -> ([f64; 3], f64) {
        let apart = minus(self.positions[to], self.positions[from]);
        let length = dot(apart, apart).sqrt();
        (times(apart, length.recip()), length)
    }

    fn stretches(&self, moved: &[Vec<[f64; 3]>]) -> Vec<Share> {
        let of = |&[i, j]: &[usize; 2]| {
            let (unit, _) = self.unit(j, i);
            let energy = self.energy(&[(i, unit), (j, times(unit, -1.0))], moved);
            let kind = ordered(self.elements[i], self.elements[j]).join("-");
            let atom = if self.elements[i] == "H" { j } else { i };
            Share { kind, word: "stretch", atom, energy }
        };
        self.bonds.iter().map(of).collect()
    }

    fn bends(&self, moved: &[Vec<[f64; 3]>]) -> Vec<Share> {
        let mut ends = vec![Vec::new(); self.masses.len()];
        for &[i, j] in &self.bonds {
            ends[i].push(j);
            ends[j].push(i);
        }
        let mut shares = Vec::new();
        for (centre, ends) in ends.iter().enumerate() {
            for (k, &a) in ends.iter().enumerate() {
                for &b in &ends[..k] {
                    let ((u, p), (v, q)) = (self.unit(centre, a), self.unit(centre, b));
                    let cosine = dot(u, v);
                    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
                    if sine < STRAIGHT {
                        continue;
                    }
                    let s = times(minus(times(u, cosine), v), (p * sine).recip());
                    let t = times(minus(times(v, cosine), u), (q * sine).recip());
                    let middle = times([s[0] + t[0], s[1] + t[1], s[2] + t[2]], -1.0);
                    let energy = self.energy(&[(a, s), (b, t), (centre, middle)], moved);
                    let [first, last] = ordered(self.elements[a], self.elements[b]);
                    let kind = if first == "H" {
                        ["H", self.elements[centre], "H"]
                    } else {
                        [first, self.elements[centre], last]
                    };
                    shares.push(Share { kind: kind.join("-"), word: "bend", atom: centre, energy });
                }
            }
        }
        shares
    }

    /// Rotations and translations of whole molecules, among others.
    fn rigid(&self, moved: &[Vec<[f64; 3]>]) -> [Vec<Share>; 2] {
        let mut atoms: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        self.molecule.iter().enumerate().for_each(|(i, &index)| atoms.entry(index).or_default().push(i));
        if atoms.len() < 2 {
            return Default::default();
        }
        let of = |atoms: &Vec<usize>| {
            let weight: f64 = atoms.iter().map(|&i| self.masses[i]).sum();
            let centre: [f64; 3] = std::array::from_fn(|k| {
                atoms.iter().map(|&i| self.masses[i] * self.positions[i][k]).sum::<f64>() / weight
            });
            let axes: [[f64; 3]; 3] =
                std::array::from_fn(|k| std::array::from_fn(|l| f64::from(u8::from(k == l))));
            // A translation moves no atom about the centre: the two kinds are orthogonal as they stand.
            let along =
                axes.map(|axis| atoms.iter().map(|&i| (i, times(axis, self.masses[i]))).collect::<Vec<_>>());
            let about = axes.map(|axis| {
                let turned =
                    |&i: &usize| (i, times(cross(axis, minus(self.positions[i], centre)), self.masses[i]));
                atoms.iter().map(turned).collect::<Vec<_>>()
            });
            [("libration", about), ("translation", along)].map(|(word, motions)| {
                let energy = self.span_energy(motions, moved);
                Share { kind: String::new(), word, atom: atoms[0], energy }
            })
        };
        let (librations, translations) = atoms.values().map(of).map(|[turn, shift]| (turn, shift)).unzip();
        [librations, translations]
    }

    /// The energy of all coordinates in the span of three.
    fn span_energy(&self, motions: [Vec<(usize, [f64; 3])>; 3], moved: &[Vec<[f64; 3]>]) -> f64 {
        let product = |a: &[(usize, [f64; 3])], b: &[(usize, [f64; 3])]| -> f64 {
            a.iter().zip(b).map(|(&(i, s), &(_, t))| dot(s, t) / self.masses[i]).sum()
        };
        let mut basis: Vec<Vec<(usize, [f64; 3])>> = Vec::new();
        for mut motion in motions {
            let size = product(&motion, &motion);
            for pairs in &basis {
                let part = product(&motion, pairs) / product(pairs, pairs);
                motion.iter_mut().zip(pairs).for_each(|(x, &(_, s))| x.1 = minus(x.1, times(s, part)));
            }
            // A rotation about the line of two atoms moves them by roundings alone.
            if product(&motion, &motion) > 1e-12 * size && size > 0.0 {
                basis.push(motion);
            }
        }
        basis.iter().map(|pairs| self.energy(pairs, moved)).sum()
    }

    /// The atoms of its molecule counted, carbon and hydrogen first (Hill).
    fn formula(&self, atom: usize) -> String {
        let mut counts: BTreeMap<(u8, &str), usize> = BTreeMap::new();
        let own = |i: &usize| self.molecule[*i] == self.molecule[atom];
        let atoms: Vec<&str> = (0..self.masses.len()).filter(own).map(|i| self.elements[i]).collect();
        let organic = atoms.contains(&"C");
        for element in atoms {
            let place = match element {
                "C" => 0,
                "H" if organic => 1,
                _ => 2,
            };
            *counts.entry((place, element)).or_default() += 1;
        }
        let one = |((_, element), count): ((u8, &str), usize)| {
            if count == 1 { element.to_string() } else { format!("{element}{count}") }
        };
        counts.into_iter().map(one).collect()
    }
}

/// Who is near enough to be bonded; a hydrogen to the nearest alone.
fn neighbours(positions: &[[f64; 3]], elements: &[&str]) -> Vec<[usize; 2]> {
    let radius =
        |i: usize| ELEMENTS.iter().find(|triple| triple.0 == elements[i]).map_or(0.0, |triple| triple.2);
    let radii: Vec<f64> = (0..elements.len()).map(radius).collect();
    let part = |i: usize, j: usize| {
        let apart = minus(positions[i], positions[j]);
        dot(apart, apart).sqrt() / (radii[i] + radii[j])
    };
    let some: Vec<usize> = (0..radii.len()).filter(|&i| radii[i] > 0.0).collect();
    let pairs = || some.iter().enumerate().flat_map(|(k, &i)| some[..k].iter().map(move |&j| [j, i]));
    let least = pairs().map(|[i, j]| part(i, j)).fold(f64::INFINITY, f64::min);
    let near: Vec<[usize; 2]> = pairs().filter(|&[i, j]| part(i, j) < BONDED * least).collect();
    let is_nearest = |i: usize, indexes: [usize; 2]| {
        let of = |pair: &&[usize; 2]| pair.contains(&i);
        let first = near.iter().filter(of).min_by(|a, b| part(a[0], a[1]).total_cmp(&part(b[0], b[1])));
        elements[i] != "H" || first == Some(&indexes)
    };
    near.iter().copied().filter(|&[i, j]| is_nearest(i, [i, j]) && is_nearest(j, [i, j])).collect()
}

/// The first atom of each atom's molecule.
fn molecules(atoms: usize, bonds: &[[usize; 2]]) -> Vec<usize> {
    let mut first: Vec<usize> = (0..atoms).collect();
    let mut moved = true;
    while std::mem::take(&mut moved) {
        for &[i, j] in bonds {
            let least = first[i].min(first[j]);
            moved |= first[i] != least || first[j] != least;
            (first[i], first[j]) = (least, least);
        }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A water in nm, its bend in the plane of x and y, beside another far away.
    fn waters(labels: &[&str]) -> Names {
        let one = [[0.0, 0.0, 0.0], [0.0757, 0.0586, 0.0], [-0.0757, 0.0586, 0.0]];
        let positions: Vec<_> = one.into_iter().chain(one.map(|[x, y, z]| [x + 0.3, y, z])).collect();
        let masses = [15.999, 1.008, 1.008].repeat(2);
        let labels = labels.iter().map(ToString::to_string).collect();
        Names::new(Told { labels, masses: masses.clone(), ..Told::default() }, &positions, masses)
    }

    /// The mass-weighted, normalized shape of displacements.
    fn shape(moved: &[[f64; 3]]) -> Vec<f64> {
        let roots = [15.999f64, 1.008, 1.008].repeat(2);
        let values: Vec<f64> = moved.iter().zip(roots).flat_map(|(x, m)| x.map(|x| x * m.sqrt())).collect();
        let size = values.iter().map(|x| x * x).sum::<f64>().sqrt();
        values.into_iter().map(|x| x / size).collect()
    }

    #[test]
    fn motions_of_water_have_the_names_that_spectroscopy_gives_them() {
        let still = [[0.0; 3]; 3];
        let one = |values: [[f64; 3]; 3]| shape(&[values, still].concat());
        let (u, v) = ([0.79, 0.61, 0.0], [-0.79, 0.61, 0.0]);
        let stretch = one([[0.0, -0.077, 0.0], u, v]);
        let bend = one([[0.0, -0.1, 0.0], [-0.61, 0.79, 0.0], [0.61, 0.79, 0.0]]);
        // About the axis of x through the centre of mass.
        let turn = one([[0.0, 0.0, -0.0066], [0.0, 0.0, 0.052], [0.0, 0.0, 0.052]]);
        let shift = one([[1.0, 0.0, 0.0]; 3]);
        let names = waters(&["O HOH 7", "H1 HOH 7", "H2 HOH 7", "O HOH 8", "H1 HOH 8", "H2 HOH 8"]);
        let name = |values: &Vec<f64>| names.motion(&[vec![values]]);
        assert_eq!(name(&stretch).as_deref(), Some("HOH 7 O-H stretch"));
        assert_eq!(name(&bend).as_deref(), Some("HOH 7 H-O-H bend"));
        assert_eq!(name(&turn).as_deref(), Some("HOH 7 libration"));
        assert_eq!(name(&shift).as_deref(), Some("HOH 7 translation"));
        // Half in both waters, and in none that has a name.
        let other = shape(&[still, [[0.0, -0.077, 0.0], u, v]].concat());
        assert_eq!(names.motion(&[vec![&stretch], vec![&other]]).as_deref(), Some("O-H stretch of HOH"));
        assert_eq!(waters(&[]).motion(&[vec![&stretch]]).as_deref(), Some("O-H stretch of H2O"));
        assert_eq!(Names::of_labels(Vec::new()).motion(&[vec![&stretch]]), None);
        assert_eq!(names.motion(&[vec![&stretch[..6]]]), None);
    }

    #[test]
    fn hydrogen_bonds_are_no_bonds_and_ions_have_none() {
        let told = |masses: &[f64]| Told { masses: masses.to_vec(), ..Told::default() };
        // O-H ... O at 0.18 nm, and a sodium at 0.23 nm.
        let positions = [[0.0; 3], [0.0957, 0.0, 0.0], [0.2757, 0.0, 0.0], [0.0, 0.23, 0.0]];
        let masses = vec![15.999, 1.008, 15.999, 22.990];
        let names = Names::new(told(&masses), &positions, masses.clone());
        assert_eq!(names.structure.unwrap().bonds, [[0, 1]]);
        // In Å, and with a heavy hydrogen that its label names.
        let far = positions.map(|positions| times(positions, 10.0));
        let heavy = vec![13.983, 3.024, 15.999, 22.990];
        let labels = ["OW", "HW", "OW", "NA"].map(String::from).to_vec();
        let names = Names::new(Told { labels, ..told(&heavy) }, &far, heavy.clone());
        assert_eq!(names.structure.unwrap().bonds, [[0, 1]]);
    }
}
