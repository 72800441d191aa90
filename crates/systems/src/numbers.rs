//! Numbers for tests that are the same each time.

/// A linear congruence.
pub struct Numbers(pub u64);

impl Numbers {
    /// The next one, from 0 to n − 1.
    pub fn below(&mut self, n: u64) -> i64 {
        ((self.next() >> 33) % n) as i64
    }

    /// The next one, in \[−1, 1).
    pub fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0
    }
}
