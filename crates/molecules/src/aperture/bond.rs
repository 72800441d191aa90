//! A bond whose shape is known: its potential, its masses, and where it breaks by itself.

use std::fmt;

use crate::unit::{self, Dimension};
use number::{Error, Rational, Result, to_f64};

/// The energy over x, the length beyond that at rest; in amu, nm, fs.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// E = k x²/2.
    Harmonic { k: Rational },
    /// E = D (1 − exp(−a x))².
    Morse { depth: Rational, a: Rational },
    /// E = k2 x² + k3 x³ + k4 x⁴.
    Polynomial { k2: Rational, k3: Rational, k4: Rational },
}

/// A bond: its name, its shape, its two masses in amu.
#[derive(Clone, Debug, PartialEq)]
pub struct Bond {
    text: String,
    pub name: String,
    pub shape: Shape,
    masses: [Rational; 2],
}

const FORMS: &str = "write NAME:SHAPE,MASS,MASS, the shape k=X (E = k x^2/2), K=X (E = K x^2), morse:D=X,a=Y (E = D (1 - exp(-a x))^2) or poly:k2=X,k3=Y,k4=Z, as OH:morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008";

impl Bond {
    /// Reads `NAME:SHAPE,MASS,MASS`.
    ///
    /// # Errors
    /// Names the bond and the part that is wrong: a shape, a constant, a unit, a mass.
    pub fn read(text: &str) -> Result<Bond> {
        let form = || Error::input("bond", text.trim(), FORMS);
        let (name, rest) = text.split_once(':').ok_or_else(form)?;
        let parts: Vec<&str> = rest.split(',').map(str::trim).collect();
        let [constants @ .., m1, m2] = &parts[..] else { return Err(form()) };
        let shape = Shape::read(name, constants)?.ok_or_else(form)?;
        let masses = [unit::mass(name, m1)?, unit::mass(name, m2)?];
        Ok(Bond { text: text.trim().into(), name: name.trim().into(), shape, masses })
    }

    /// The reduced mass in amu.
    pub fn mass(&self) -> Rational {
        let [m1, m2] = &self.masses;
        m1 * m2 / (m1 + m2)
    }

    /// The curvature at rest in amu/fs².
    pub fn curvature(&self) -> Rational {
        let two = Rational::from_integer(2.into());
        match &self.shape {
            Shape::Harmonic { k } => k.clone(),
            Shape::Morse { depth, a } => two * depth * a * a,
            Shape::Polynomial { k2, .. } => two * k2,
        }
    }

    /// The least energy in amu nm²/fs² at which the bond breaks by itself, whatever the step: the depth of
    /// Morse's potential, the lower barrier of a polynomial one; `None` where it does not break.
    pub fn depth(&self) -> Option<f64> {
        match &self.shape {
            Shape::Harmonic { .. } => None,
            Shape::Morse { depth, .. } => Some(to_f64(depth)),
            Shape::Polynomial { k2, k3, k4 } => barrier([k2, k3, k4].map(to_f64)),
        }
    }
}

/// The lower of the maxima of k2 x² + k3 x³ + k4 x⁴ beside its minimum at 0.
fn barrier([k2, k3, k4]: [f64; 3]) -> Option<f64> {
    let energy = |x: f64| x * x * (k2 + x * (k3 + x * k4));
    // Zeros of 2 k2 + 3 k3 x + 4 k4 x²; the sum of equal signs first, so that no digits are lost.
    let discriminant = 9.0 * k3 * k3 - 32.0 * k2 * k4;
    if discriminant < 0.0 || (k3 == 0.0 && k4 == 0.0) {
        return None;
    }
    let sum = -3.0 * k3 - discriminant.sqrt().copysign(k3);
    let (near, far) = (4.0 * k2 / sum, sum / (8.0 * k4));
    // With k4 > 0 the far one is the bottom of a second well.
    Some(if k4 < 0.0 { energy(near).min(energy(far)) } else { energy(near) })
}

impl Shape {
    /// `None` where the constants are those of no shape.
    fn read(bond: &str, constants: &[&str]) -> Result<Option<Shape>> {
        let field = |name: &str| format!("bond {bond}: {name}");
        let positive = |name: &str, text: &str, dimension| unit::rational(&field(name), text, dimension);
        let signed = |name: &str, text: &str, dimension| unit::signed_rational(&field(name), text, dimension);
        let named: Option<Vec<(&str, &str)>> = constants.iter().map(|part| part.split_once('=')).collect();
        let named = named.unwrap_or_default();
        Ok(match &named[..] {
            [("k", k)] => Some(Shape::Harmonic { k: positive("k", k, Dimension::Stiffness)? }),
            [("K", k)] => {
                let two = Rational::from_integer(2.into());
                Some(Shape::Harmonic { k: two * positive("K", k, Dimension::Stiffness)? })
            }
            [("morse:D", depth), ("a", a)] => Some(Shape::Morse {
                depth: positive("D", depth, Dimension::Energy)?,
                a: positive("a", a, Dimension::Narrowness)?,
            }),
            [("poly:k2", k2), rest @ ..] => {
                let (k3, k4) = match rest {
                    [] => (None, None),
                    [("k3", k3)] => (Some(*k3), None),
                    [("k4", k4)] => (None, Some(*k4)),
                    [("k3", k3), ("k4", k4)] => (Some(*k3), Some(*k4)),
                    _ => return Ok(None),
                };
                let or_none = |name: &str, text: Option<&str>, dimension| {
                    text.map_or_else(|| Ok(Rational::default()), |text| signed(name, text, dimension))
                };
                Some(Shape::Polynomial {
                    k2: positive("k2", k2, Dimension::Stiffness)?,
                    k3: or_none("k3", k3, Dimension::Cubic)?,
                    k4: or_none("k4", k4, Dimension::Quartic)?,
                })
            }
            _ => None,
        })
    }
}

impl fmt::Display for Bond {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::ratio;

    #[test]
    fn constants_are_read_in_their_units() {
        let bond = Bond::read("OH:morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008").unwrap();
        assert_eq!(bond.shape, Shape::Morse { depth: ratio(48572, 100_000_000), a: ratio(2287, 100) });
        let ev = Bond::read("OH:morse:D=5eV,a=2.287/A,15.999amu,1.008amu").unwrap();
        // 1 eV is 96.485332... kJ/mol.
        assert!((ev.depth().unwrap() * 1e6 - 5.0 * 96.485_332).abs() < 1e-5);
        let Shape::Harmonic { k } = Bond::read("OH:K=553kcal/mol/A^2,16,1").unwrap().shape else { panic!() };
        assert_eq!(k, Bond::read("OH:poly:k2=553kcal/mol/A^2,16,1").unwrap().curvature());
    }

    #[test]
    fn a_bond_that_breaks_by_itself_says_at_which_energy() {
        // x² − x³ has its maximum 4/27 at 2/3; 7/12 x⁴ more, as q-TIP4P/F, and there is none.
        assert!((barrier([1.0, -1.0, 0.0]).unwrap() - 4.0 / 27.0).abs() < 1e-15);
        assert_eq!(barrier([1.0, -1.0, 7.0 / 12.0]), None);
        // x² − x⁴: 1/4 on both sides.
        assert_eq!(barrier([1.0, 0.0, -1.0]), Some(0.25));
        assert_eq!(barrier([1.0, 0.0, 0.0]), None);
        // A second well lies beyond a barrier at (9 - sqrt(17))/16, as deep as this one or not.
        let near: f64 = (9.0 - 17f64.sqrt()) / 16.0;
        let energy = near * near * (1.0 - 3.0 * near + 2.0 * near * near);
        assert!((barrier([1.0, -3.0, 2.0]).unwrap() - energy).abs() < 1e-15);
    }

    #[test]
    fn a_bond_that_is_not_one_is_told_what_to_write() {
        for text in [
            "OH",
            "OH:morse:D=5eV,16,1",
            "OH:morse:D=5eV,a=2,16,1",
            "OH:morse:D=-5eV,a=2/A,16,1",
            "OH:poly:k3=1kcal/mol/A^3,16,1",
            "OH:poly:k2=1kcal/mol/A^2,k5=1,16,1",
            "OH:k=5N/m,16",
            "OH:k=5N/m,0,1",
        ] {
            let error = Bond::read(text).unwrap_err();
            assert!(error.field().starts_with("bond") && !error.remedy().is_empty(), "{text}: {error}");
        }
    }
}
