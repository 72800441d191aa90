//! Numbers that look random and are the same everywhere.

/// Lehmer's multiplicative generator modulo 2^61 - 1.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Random {
        let mut random = Random(1 + seed % ((1 << 61) - 2));
        (0..4).for_each(|_| {
            random.below(2);
        });
        random
    }

    /// A number in 0..n.
    pub fn below(&mut self, n: u64) -> u64 {
        self.0 = (u128::from(self.0) * 437_799_614_237_992_725 % ((1 << 61) - 1)) as u64;
        self.0 % n
    }
}
