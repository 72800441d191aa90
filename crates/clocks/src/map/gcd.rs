//! Greatest common divisors of one number with a run of consecutive ones, by a sieve.

use std::collections::BTreeMap;

/// gcd(Π numbers, j) for every j in `first..first + gcds.len()`; all positive, the last j below 2^32.
pub(super) fn with_run(numbers: &[u64], first: u64, gcds: &mut [u32]) {
    gcds.fill(1);
    let mut exponents = BTreeMap::new();
    for (prime, exponent) in numbers.iter().flat_map(|&n| factors(n)) {
        *exponents.entry(prime).or_insert(0) += exponent;
    }
    for (prime, exponent) in exponents {
        let mut power = 1;
        for _ in 0..exponent {
            power *= prime;
            let skip = (power - first % power) % power;
            if skip >= gcds.len() as u64 {
                break;
            }
            gcds[skip as usize..].iter_mut().step_by(power as usize).for_each(|g| *g *= prime as u32);
        }
    }
}

/// The prime factors of n with their exponents, by trial division.
fn factors(mut n: u64) -> Vec<(u64, u32)> {
    let mut found = Vec::new();
    let mut prime = 2;
    while prime * prime <= n {
        let mut exponent = 0;
        while n.is_multiple_of(prime) {
            n /= prime;
            exponent += 1;
        }
        if exponent > 0 {
            found.push((prime, exponent));
        }
        prime += 1 + prime % 2;
    }
    if n > 1 {
        found.push((n, 1));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_integer::Integer;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_sieve_follows_the_definition(
            m in 1u64..100_000, n in 1u64..1000, first in 1u64..100_000, len in 0usize..3000,
        ) {
            let mut gcds = vec![0; len];
            with_run(&[m, n], first, &mut gcds);
            for (j, g) in (first..).zip(gcds) {
                prop_assert_eq!(u64::from(g), (m * n).gcd(&j));
            }
        }
    }
}
