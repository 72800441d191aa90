//! Colours that survive print and colour-blind eyes.
//!
//! All are computed in OKLab (Ottosson 2020), where equal distances look equally different: a gradient whose
//! lightness changes at a steady rate stays readable in grey and for every kind of colour vision, whatever
//! its hues do.

use std::fmt;

/// An sRGB colour; shown as `#rrggbb`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Colour(pub u8, pub u8, pub u8);

/// The paper.
pub const WHITE: Colour = Colour(255, 255, 255);
/// Frames, text and lines without a colour of their own: a softened black.
pub const INK: Colour = Colour(0x1b, 0x1b, 0x1f);
/// Lines that should stay in the background.
pub const GREY: Colour = Colour(0x8f, 0x92, 0x99);

/// Exponential growth, linear growth, closed tongues: apart in lightness, and for every kind of colour
/// vision.
pub const HYPERBOLIC: Colour = Colour(0x27, 0x3c, 0x75);
pub const PARABOLIC: Colour = Colour(0xd9, 0x5f, 0x02);
pub const COEXISTENCE: Colour = Colour(0x1b, 0xb0, 0x8a);

/// The judgements of advice: safe, with caution, growing where it was sampled, unstable. From light to dark,
/// so that they differ in grey print.
pub const SAFE: Colour = Colour(0xcf, 0xec, 0xdf);
pub const CAUTION: Colour = Colour(0xf3, 0xb4, 0x7a);
pub const SAMPLED: Colour = Colour(0x8f, 0x8f, 0x9b);
pub const UNSTABLE: Colour = HYPERBOLIC;

impl Colour {
    /// A colour that is seen on it: white on dark ones, ink on light ones.
    #[must_use]
    pub fn opposite(self) -> Colour {
        let Colour(r, g, b) = self;
        // About as light as it looks (ITU-R BT.601, on encoded values); no finer measure is needed to choose
        // one of two.
        let light = 0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b);
        if light > 140.0 { INK } else { WHITE }
    }
}

impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Colour(r, g, b) = self;
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

/// The lightness, chroma and hue (in turns) of one end of a gradient.
type Lch = [f64; 3];

/// A continuous scale of colours over [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient {
    from: Lch,
    to: Lch,
}

impl Gradient {
    /// For marks on white: from a light but visible amber (weak) through red to a deep violet (strong).
    pub const fn on_white() -> Self {
        Gradient { from: [0.81, 0.165, 0.225], to: [0.24, 0.115, -0.21] }
    }

    /// Runs from the other end.
    #[must_use]
    pub const fn reversed(self) -> Self {
        Gradient { from: self.to, to: self.from }
    }

    /// The colour at `t`, clamped to [0, 1].
    pub fn at(&self, t: f64) -> Colour {
        let t = if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) };
        let mix = |i: usize| self.from[i] + t * (self.to[i] - self.from[i]);
        // Bowed outward, for the straight way between two hues leads through grey.
        let chroma = mix(1) + 0.16 * t * (1.0 - t);
        from_lch(mix(0), chroma, mix(2))
    }

    /// `n` colours evenly spaced, both ends included.
    pub fn steps(&self, n: usize) -> Vec<Colour> {
        (0..n).map(|i| self.at(i as f64 / (n.max(2) - 1) as f64)).collect()
    }
}

/// The lightness, chroma and hue of each [`family`]: hue and lightness step differently, so that neighbours
/// differ in both.
pub const FAMILIES: [Lch; 8] = [
    [0.40, 0.17, 0.715],
    [0.68, 0.17, 0.13],
    [0.56, 0.13, 0.45],
    [0.47, 0.19, 0.03],
    [0.76, 0.11, 0.64],
    [0.85, 0.16, 0.26],
    [0.29, 0.13, 0.86],
    [0.62, 0.03, 0.75],
];

/// Eight colours for families that have no order, distinct in lightness as well as in hue; they repeat after
/// that.
pub fn family(index: usize) -> Colour {
    let [lightness, chroma, hue] = FAMILIES[index % FAMILIES.len()];
    from_lch(lightness, chroma, hue)
}

/// The hue of a family for lines behind it: paler, and all about as light as each other.
pub fn behind(index: usize) -> Colour {
    let [lightness, chroma, hue] = FAMILIES[index % FAMILIES.len()];
    from_lch(0.62 + 0.15 * lightness, 0.6 * chroma, hue)
}

/// The sRGB colour of given OKLab lightness, chroma and hue; a chroma that no screen has is reduced to one it
/// has.
fn from_lch(lightness: f64, chroma: f64, hue: f64) -> Colour {
    let (sin, cos) = (hue * std::f64::consts::TAU).sin_cos();
    let at = |chroma: f64| linear(lightness, chroma * cos, chroma * sin);
    let inside = |rgb: [f64; 3]| rgb.iter().all(|c| (0.0..=1.0).contains(c));
    let (mut low, mut high) = (0.0, chroma);
    if inside(at(high)) {
        low = high;
    }
    // Halving to far below what eight bits can show.
    while high - low > 1e-6 {
        let middle = (low + high) / 2.0;
        if inside(at(middle)) { low = middle } else { high = middle }
    }
    let [r, g, b] = at(low).map(encoded);
    Colour(r, g, b)
}

/// OKLab to linear sRGB: the two matrices of its definition.
fn linear(lightness: f64, a: f64, b: f64) -> [f64; 3] {
    let l = (lightness + 0.3963377774 * a + 0.2158037573 * b).powi(3);
    let m = (lightness - 0.1055613458 * a - 0.0638541728 * b).powi(3);
    let s = (lightness - 0.0894841775 * a - 1.2914855480 * b).powi(3);
    [
        4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
        -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
        -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s,
    ]
}

/// The sRGB transfer function, to eight bits.
fn encoded(linear: f64) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let value = if linear <= 0.0031308 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (255.0 * value).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance as a screen shows it (WCAG 2).
    fn luminance(Colour(r, g, b): Colour) -> f64 {
        let linear = |c: u8| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b)
    }

    #[test]
    fn a_gradient_is_monotone_in_grey() {
        let falling: Vec<f64> = Gradient::on_white().steps(64).into_iter().map(luminance).collect();
        assert!(falling.windows(2).all(|pair| pair[1] < pair[0]), "{falling:?}");
    }

    #[test]
    fn the_weakest_mark_is_visible_on_white() {
        let contrast = |colour| 1.05 / (luminance(colour) + 0.05);
        assert!(contrast(Gradient::on_white().at(0.0)) > 1.7);
        assert!((0..8).all(|i| contrast(family(i)) > 1.5));
        // Thin lines need more.
        assert!((0..8).all(|i| contrast(behind(i)) > 2.0));
    }

    #[test]
    fn strokes_are_seen_on_every_family() {
        let contrast = |a: f64, b: f64| (a.max(b) + 0.05) / (a.min(b) + 0.05);
        for colour in (0..8).map(family).chain([SAFE, CAUTION, SAMPLED, UNSTABLE]) {
            let seen = contrast(luminance(colour), luminance(colour.opposite()));
            assert!(seen > 3.0, "{colour}: {seen}");
        }
    }

    #[test]
    fn white_and_black_are_where_they_belong() {
        assert_eq!(from_lch(1.0, 0.0, 0.0), WHITE);
        assert_eq!(from_lch(0.0, 0.0, 0.0), Colour(0, 0, 0));
        assert_eq!(Colour(1, 0xab, 255).to_string(), "#01abff");
    }
}
