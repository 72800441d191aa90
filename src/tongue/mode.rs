//! A vibration mode near κ, and what its Rayleigh quotient proves about the eigenvalue.
//!
//! **The vector.** Run the recurrence from both ends and join the two halves at the node r where |x→ x←| is
//! largest: that product is (K − κM)⁻¹_rr times a constant, so r is where the mode lives, and neither half is
//! followed into the region where rounding errors outgrow it. (Twisted factorization: Parlett and Dhillon.)
//!
//! **Its quotient** μ = Σ d_j²/ℓ_j / Σ m_j z_j², d_j = z_j − z_{j−1}, is off from the eigenvalue by the *square* of the
//! vector's error only; so the vector may be rough, but its quotient is evaluated almost exactly. z is rounded to
//! a grid on which all d_j are exact; z = z' + z'' with z' an integer, so Σ z'² is exact, and the corrections
//! z''(z + z') are smaller by about 2^-20; likewise d² and its division by ℓ.
//!
//! **Theorem** (Weinstein; Temple, Kato). Let ε² = ‖(K − κM) z‖²_{M⁻¹}/‖z‖²_M for any κ. Some eigenvalue lies in
//! \[μ − ε, μ + ε\]. If all but the k-th are ≤ α or ≥ β with α < μ − ε and μ + ε < β, it is the k-th one, and
//!
//! ```text
//!     μ - ε²/(β - μ) <= κ_k <= μ + ε²/(μ - α).
//! ```

use super::string::{Entry, HalfString};
use super::sturm::{BLOCK, Kicks, LANES, Lanes, lanes, rescale, start};
use super::twofold::Twofold;

const U: f64 = f64::EPSILON / 2.0;

/// A Rayleigh quotient and its residual, both proven.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mode {
    /// μ, off by at most `relative` μ.
    pub quotient: Twofold,
    pub relative: f64,
    /// ε.
    pub residual: f64,
}

/// Both recurrences at every node: x 2^exponent, the exponents by block.
#[derive(Clone, Debug, Default)]
pub(super) struct Workspace {
    forward: Vec<Lanes>,
    backward: Vec<Lanes>,
    forward_exponents: Vec<[i64; LANES]>,
    backward_exponents: Vec<[i64; LANES]>,
}

/// 2^e, clipped to the range of normal doubles.
fn power_of_two(e: i64) -> f64 {
    f64::from_bits(((e.clamp(-1022, 1023) + 1023) as u64) << 52)
}

/// The bits that hold a node's number in [`Workspace::twist`]: as many as the longest string needs.
const NODE_NUMBER: u64 = (1 << 24) - 1;

/// The factors that join the two recurrences to one vector, by block.
struct Joint {
    at: Lanes,
    forward: Vec<Lanes>,
    backward: Vec<Lanes>,
}

impl Workspace {
    /// The modes near κ, one for each lane.
    pub fn modes(&mut self, string: &HalfString, entry: Entry, kappa: &Lanes) -> [Mode; LANES] {
        let kicks = string.kicks(kappa);
        // Σ z'² and Σ d'² of n terms below 2^(2 bits + 2) must stay below 2^53.
        let count = 64 - (string.nodes.len() as u64).leading_zeros();
        let bits = ((50 - count as i32) / 2).min(20);
        let mut sums = Sums::new(string, entry, bits);
        self.vectors(string, entry, &kicks, 2f64.powi(bits), |j, z| sums.add(j, z, &kicks));
        sums.finish()
    }

    /// The Rayleigh quotients of the modes near κ, as near as doubles get and without proof.
    pub fn quotients(&mut self, string: &HalfString, entry: Entry, kappa: &Lanes) -> Lanes {
        let (mut springs, mut masses, mut last) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        self.vectors(string, entry, &string.kicks(kappa), 1.0, |j, z| {
            let (mass, stiffness) = (string.mass(j), if j > 0 { string.nodes[j].inverse } else { 0.0 });
            for i in 0..LANES {
                let d = z[i] - last[i];
                springs[i] += d * d * stiffness;
                masses[i] += z[i] * z[i] * mass;
            }
            last = z;
        });
        lanes(|i| springs[i] / masses[i])
    }

    /// Hands the amplitudes z_0, z_1, ... of the modes to `each`, |z_r| = `size`.
    fn vectors(
        &mut self,
        string: &HalfString,
        entry: Entry,
        kicks: &Kicks,
        size: f64,
        mut each: impl FnMut(usize, Lanes),
    ) {
        self.run_forward(string, entry, kicks);
        self.run_backward(string, entry, kicks);
        let joint = self.join(&self.twist(), size);
        for (block, (forward, backward)) in
            self.forward.chunks(BLOCK).zip(self.backward.chunks(BLOCK)).enumerate()
        {
            let (f, b) = (&joint.forward[block], &joint.backward[block]);
            for (k, (x, y)) in forward.iter().zip(backward).enumerate() {
                let j = block * BLOCK + k;
                let z = lanes(|i| if j as f64 <= joint.at[i] { x[i] * f[i] } else { y[i] * b[i] });
                each(j, z);
            }
        }
    }

    fn run_forward(&mut self, string: &HalfString, entry: Entry, kicks: &Kicks) {
        self.forward.clear();
        self.forward_exponents.clear();
        let mut exponents = [0; LANES];
        let (mut x, mut v) = start(entry.starts_free(), &kicks[string.nodes[0].kind]);
        for (j, node) in string.nodes[..=string.end(entry)].iter().enumerate() {
            if j % BLOCK == 0 {
                let more = rescale(&mut x, &mut v);
                (0..LANES).for_each(|i| exponents[i] += more[i]);
                self.forward_exponents.push(exponents);
            }
            if j > 0 {
                let kick = &kicks[node.kind];
                for i in 0..LANES {
                    x[i] += node.length * v[i];
                    v[i] -= kick[i] * x[i];
                }
            }
            self.forward.push(x);
        }
    }

    /// The same from T/2, v being the slope seen backwards.
    fn run_backward(&mut self, string: &HalfString, entry: Entry, kicks: &Kicks) {
        let n = string.end(entry);
        self.backward.resize(n + 1, [0.0; LANES]);
        self.backward_exponents.resize(n / BLOCK + 1, [0; LANES]);
        let mut exponents = [0; LANES];
        let (mut x, mut v) = start(entry.ends_free(), &kicks[string.nodes[n].kind]);
        for j in (0..=n).rev() {
            if j % BLOCK == BLOCK - 1 || j == n {
                let more = rescale(&mut x, &mut v);
                (0..LANES).for_each(|i| exponents[i] += more[i]);
                self.backward_exponents[j / BLOCK] = exponents;
            }
            if j < n {
                let (length, kick) = (string.nodes[j + 1].length, &kicks[string.nodes[j].kind]);
                for i in 0..LANES {
                    x[i] += length * v[i];
                    v[i] -= kick[i] * x[i];
                }
            }
            self.backward[j] = x;
        }
    }

    /// r for each lane.
    fn twist(&self) -> [usize; LANES] {
        let exponents = self.forward_exponents.iter().zip(&self.backward_exponents);
        let sums: Vec<[i64; LANES]> = exponents.map(|(f, b)| std::array::from_fn(|i| f[i] + b[i])).collect();
        let top: [i64; LANES] = std::array::from_fn(|i| sums.iter().map(|s| s[i]).max().unwrap_or(0));
        let mut best = [0.0; LANES];
        let pairs = self.forward.chunks(BLOCK).zip(self.backward.chunks(BLOCK)).zip(&sums);
        for (block, ((forward, backward), sum)) in pairs.enumerate() {
            // 2^-400 keeps the product of two blocks' growths in range.
            let factor = lanes(|i| power_of_two(sum[i] - top[i]) * 2f64.powi(-400));
            for (k, (x, y)) in forward.iter().zip(backward).enumerate() {
                let j = (block * BLOCK + k) as u64;
                for i in 0..LANES {
                    // The node's number takes the product's last bits: a maximum without branches.
                    let product = ((x[i] * factor[i]) * y[i]).abs().to_bits();
                    let marked = f64::from_bits((product & !NODE_NUMBER) | j);
                    best[i] = if marked > best[i] { marked } else { best[i] };
                }
            }
        }
        best.map(|marked: f64| ((marked.to_bits() & NODE_NUMBER) as usize).min(self.forward.len() - 1))
    }

    /// Scales both halves to |z_r| = `size`.
    fn join(&self, at: &[usize; LANES], size: f64) -> Joint {
        let scaled = |values: &[Lanes], exponents: &[[i64; LANES]]| -> Vec<Lanes> {
            let peak = lanes(|i| size / values[at[i]][i]);
            let base: [i64; LANES] = std::array::from_fn(|i| exponents[at[i] / BLOCK][i]);
            exponents.iter().map(|e| lanes(|i| peak[i] * power_of_two(e[i] - base[i]))).collect()
        };
        Joint {
            at: lanes(|i| at[i] as f64),
            forward: scaled(&self.forward, &self.forward_exponents),
            backward: scaled(&self.backward, &self.backward_exponents),
        }
    }
}

/// 1.5 · 2^52: adding and subtracting it rounds to an integer.
const TO_INTEGER: f64 = 6755399441055744.0;

/// Σ w z² as an exact part and a correction.
#[derive(Clone, Copy, Debug)]
struct Square {
    exact: Lanes,
    correction: Lanes,
}

impl Square {
    const ZERO: Square = Square { exact: [0.0; LANES], correction: [0.0; LANES] };

    /// Adds `weight` z², weight = 1/2 or 1.
    fn add(&mut self, weight: f64, z: &Lanes) {
        for (z, (exact, correction)) in z.iter().zip(self.exact.iter_mut().zip(&mut self.correction)) {
            let whole = (z + TO_INTEGER) - TO_INTEGER;
            *exact += weight * (whole * whole);
            *correction += weight * ((z - whole) * (z + whole));
        }
    }

    fn total(&self, i: usize) -> Twofold {
        Twofold::sum(self.exact[i], self.correction[i])
    }
}

/// The running sums of the quotient and of the residual.
struct Sums<'a> {
    string: &'a HalfString,
    entry: Entry,
    /// 1.5 · 2^52 grid units, the grid being 2^(bits − 50): |z| < 2^(bits + 1) leaves 51 bits.
    to_grid: f64,
    fast: Square,
    slow: Square,
    /// Σ d²/ℓ.
    springs: Square,
    residual: Lanes,
    /// The exponent bits that any z on its way to the grid changed: none, if all were in range.
    strayed: [u64; LANES],
    z: Lanes,
    force: Lanes,
}

impl<'a> Sums<'a> {
    fn new(string: &'a HalfString, entry: Entry, bits: i32) -> Self {
        let zero = [0.0; LANES];
        Sums {
            string,
            entry,
            to_grid: 1.5 * 2f64.powi(bits + 2),
            fast: Square::ZERO,
            slow: Square::ZERO,
            springs: Square::ZERO,
            residual: zero,
            strayed: [0; LANES],
            z: zero,
            force: zero,
        }
    }

    /// Adds node j with amplitude z, and the spring before it.
    fn add(&mut self, j: usize, z: Lanes, kicks: &Kicks) {
        let (node, n) = (&self.string.nodes[j], self.string.end(self.entry));
        let raised = z.map(|z| z + self.to_grid);
        (0..LANES).for_each(|i| self.strayed[i] |= raised[i].to_bits() ^ self.to_grid.to_bits());
        let z = raised.map(|z| z - self.to_grid);
        if j > 0 {
            let force = self.add_spring(j, &z);
            if j > 1 || self.entry.starts_free() {
                self.balance(j - 1, &force, kicks);
            }
            self.force = force;
        }
        if node.fast > 0.0 {
            self.fast.add(node.fast, &z);
        }
        if node.slow > 0.0 {
            self.slow.add(node.slow, &z);
        }
        self.z = z;
        if j == n && self.entry.ends_free() {
            self.balance(n, &[0.0; LANES], kicks);
        }
    }

    /// Adds d²/ℓ = t + (d'² − t ℓ + d''(d + d'))/ℓ, t the integer nearest to d'²/ℓ; returns d/ℓ, rounded.
    fn add_spring(&mut self, j: usize, z: &Lanes) -> Lanes {
        let node = &self.string.nodes[j];
        let mut force = [0.0; LANES];
        for i in 0..LANES {
            let d = z[i] - self.z[i];
            let whole = (d + TO_INTEGER) - TO_INTEGER;
            let square = whole * whole;
            let t = (square * node.inverse + TO_INTEGER) - TO_INTEGER;
            self.springs.exact[i] += t;
            self.springs.correction[i] +=
                ((square - t * node.length) + (d - whole) * (d + whole)) * node.inverse;
            force[i] = d * node.inverse;
        }
        force
    }

    /// Adds the residual of the equation at node j, the forces before and after it rounded, over its mass.
    fn balance(&mut self, j: usize, after: &Lanes, kicks: &Kicks) {
        let (mass, kick) = (self.string.mass(j), &kicks[self.string.nodes[j].kind]);
        let weight = if mass > 0.0 { 1.0 / mass } else { 0.0 };
        for i in 0..LANES {
            let (before, after, load) = (self.force[i], after[i], kick[i] * self.z[i]);
            // Forces are off by 2u, the load by 4u, the two sums by u each of at most the three together.
            let slack = 6.0 * U * (before.abs() + after.abs() + load.abs());
            let r = (before - after - load).abs() + slack;
            self.residual[i] += r * r * weight;
        }
    }

    fn finish(self) -> [Mode; LANES] {
        std::array::from_fn(|i| self.mode(i))
    }

    /// The corrections are sums of n rounded terms: each is off by at most (n + 8) u Σ|term|. With |z''| ≤ 1/2,
    /// Σ |z''(z + z')| ≤ Σ |z| + n/4 ≤ √n (Σ z²)^½ + n/4 (Cauchy), and Σ |d''(d + d')|/ℓ + |d'² − tℓ|/ℓ ≤
    /// (W Σ d²/ℓ)^½ + W/4 + 0.6 n with W = Σ 1/ℓ (|d'² − tℓ| ≤ 0.6 ℓ).
    fn mode(&self, i: usize) -> Mode {
        let n = self.string.nodes.len() as f64;
        let (fast, slow, springs) = (self.fast.total(i), self.slow.total(i), self.springs.total(i));
        let terms = 1.01 * (n + 8.0) * U;
        let loss = |sum: f64| terms * ((n * sum).sqrt() + n);
        let stiffness = self.string.stiffness;
        let springs_loss = terms * ((stiffness * springs.hi).sqrt() + 0.25 * stiffness + 0.6 * n);
        let mass = fast.plus(self.string.slow_mass.times(slow));
        let mass_loss = loss(fast.hi) + self.string.slow_mass.hi * loss(slow.hi);
        // 2^-96 covers the twofold operations, 1.01 this line.
        let relative = 1.01 * (springs_loss / springs.hi + mass_loss / mass.hi) + 2f64.powi(-96);
        let residual = (1.01 * self.residual[i] / mass.hi).sqrt();
        // A vector off the grid's range proves nothing.
        let in_range = self.strayed[i] >> 52 == 0;
        let residual = if in_range && residual.is_finite() { residual } else { f64::INFINITY };
        Mode { quotient: springs.over(mass), relative, residual }
    }
}
