//! The verdict from the inertias of the four forms.

use faer::Mat;

use crate::half::float::FloatBlocks;
use crate::half::norm;
use crate::signs::inertia::{self, Inertia};
use clocks::verdict::Kind;
use number::U;

/// The kind, where the forms of the half period in doubles prove it within their error.
pub fn proven(blocks: &FloatBlocks) -> Option<Kind> {
    let forms = Forms { blocks, error: blocks.error? };
    let (p, r) = (forms.p(), forms.r());
    // The numbers of μ outside [−1, 0], and undecided.
    let outside = match (p.definite(), r.definite()) {
        (sign, _) if sign != 0 => r.times(sign),
        (_, sign) if sign != 0 => p.times(sign),
        _ => {
            let w = forms.w();
            let z = (w.definite() == 0).then(|| forms.z());
            let sign = z.as_ref().unwrap_or(&w).definite();
            if sign == 0 {
                return counts_differ([p, r], [Some(w), z]).then_some(Kind::Hyperbolic);
            }
            let (p, r) = (p.times(sign), r.times(sign));
            let both = |f: fn(&Inertia) -> usize| f(&p) + f(&r);
            Inertia { negative: both(|i| i.negative), unknown: both(|i| i.unknown), ..Inertia::default() }
        }
    };
    match outside {
        Inertia { negative: 1.., .. } => Some(Kind::Hyperbolic),
        Inertia { unknown: 0, zero: 0, .. } => Some(Kind::Elliptic),
        _ => None,
    }
}

/// Whether the number of negative eigenvalues of P or R is known and differs from that of W or Z: as many μ
/// are real and outside \[−1, 0\].
fn counts_differ(ends: [Inertia; 2], others: [Option<Inertia>; 2]) -> bool {
    let known = |inertia: Inertia| (inertia.unknown + inertia.zero == 0).then_some(inertia.negative);
    let others: Vec<usize> = others.into_iter().flatten().filter_map(known).collect();
    ends.into_iter().filter_map(known).any(|count| others.iter().any(|other| *other != count))
}

/// The forms of a half period in doubles, within the bound on its error.
struct Forms<'a> {
    blocks: &'a FloatBlocks,
    /// The bound on the error of all blocks together.
    error: f64,
}

impl Forms<'_> {
    /// The inertia of the symmetric matrix that `product` is but for rounding, `x` and `y` being its factors:
    /// each is off by at most e, so the product by e (‖x‖ + ‖y‖ + e), and by (m + 2) u ‖x‖_F ‖y‖_F in being
    /// computed.
    fn inertia(&self, product: Mat<f64>, (x, y): (&Mat<f64>, &Mat<f64>), sign: i8) -> Inertia {
        let (m, e) = (self.blocks.size(), self.error);
        let (size_x, size_y) = (norm::frobenius(x), norm::frobenius(y));
        let rounding = 1.01 * (m as f64 + 4.0) * U * size_x * size_y;
        let slack = e * (size_x.min(self.blocks.norm) + size_y.min(self.blocks.norm) + e) + rounding;
        let symmetric = Mat::from_fn(m, m, |i, j| (product[(i, j)] + product[(j, i)]) / 2.0);
        inertia::proven(&symmetric, 1.01 * slack).times(sign)
    }

    fn p(&self) -> Inertia {
        let [a, b, ..] = &self.blocks.matrices;
        self.inertia(a * b.transpose(), (a, b), 1)
    }

    fn r(&self) -> Inertia {
        let [.., c, d] = &self.blocks.matrices;
        self.inertia(c * d.transpose(), (c, d), -1)
    }

    fn w(&self) -> Inertia {
        let [_, b, _, d] = &self.blocks.matrices;
        self.inertia(b.transpose() * d, (b, d), 1)
    }

    fn z(&self) -> Inertia {
        let [a, _, c, _] = &self.blocks.matrices;
        self.inertia(a.transpose() * c, (a, c), -1)
    }
}
