//! Upper bounds on norms of matrices of doubles.

use faer::Mat;

/// Frobenius's norm, rounded up by more than its rounding errors (fewer than 10^12 entries).
pub(crate) fn frobenius(m: &Mat<f64>) -> f64 {
    // Sums side by side: one after the other they wait for each other.
    let mut sums = [0.0; 8];
    for j in 0..m.ncols() {
        let parts = m.col_as_slice(j).chunks_exact(sums.len());
        let add = |sums: &mut [f64; 8], part: &[f64]| {
            sums.iter_mut().zip(part).for_each(|(sum, x)| *sum += x * x);
        };
        let rest = parts.remainder();
        parts.for_each(|part| add(&mut sums, part));
        add(&mut sums, rest);
    }
    1.01 * sums.iter().sum::<f64>().sqrt()
}

/// More than the spectral norm of the matrix of absolute values: Frobenius's norm, or the root of the largest
/// sum of a column times that of a row, which is nearer where entries fall off away from the diagonal.
pub fn absolute(m: &Mat<f64>) -> f64 {
    let size = frobenius(m);
    if !size.is_finite() {
        return size;
    }
    size.min(by_sums(m.nrows(), (0..m.ncols()).map(|j| m.col_as_slice(j))))
}

/// The bound by sums alone, for a matrix of finite entries given by its columns, or by its rows, each of this
/// length.
pub(crate) fn by_sums<'a>(length: usize, lines: impl Iterator<Item = &'a [f64]>) -> f64 {
    let (mut across, mut largest) = (vec![0.0; length], 0.0_f64);
    for line in lines {
        across.iter_mut().zip(line).for_each(|(sum, x)| *sum += x.abs());
        largest = largest.max(line.iter().map(|x| x.abs()).sum());
    }
    1.01 * (largest * across.into_iter().fold(0.0, f64::max)).sqrt()
}

/// More than the spectral norm, by at most a factor n^(1/8): ‖A‖₂^4 = ‖(Aᵀ A)²‖₂ ≤ ‖(Aᵀ A)²‖_F.
///
/// Rounding: with ν = ‖A‖_F ≤ √n ‖A‖₂ each product is off by less than 10^-12 of its norm for n < 10^4, the
/// bound by less than 1.01. A is scaled by its Frobenius norm first, so that nothing overflows.
pub fn spectral(a: &Mat<f64>) -> f64 {
    let size = frobenius(a);
    if size == 0.0 || !size.is_finite() {
        return size;
    }
    let scaled = Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)] / size);
    let gram = scaled.transpose() * &scaled;
    (1.01 * size * frobenius(&(&gram * &gram)).sqrt().sqrt()).min(absolute(a))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_is_above_the_largest_singular_value_and_near_it() {
        for n in [1, 3, 20] {
            let a = Mat::from_fn(n, n, |i, j| ((7 * i + 3 * j * j + i * j) % 11) as f64 - 5.0);
            let exact = a.singular_values().unwrap().iter().copied().fold(0.0, f64::max);
            let bound = spectral(&a);
            assert!(
                exact <= bound && bound <= 1.04 * (n as f64).powf(1.0 / 8.0) * exact.max(1e-300),
                "{exact} {bound}"
            );
            let sizes = Mat::from_fn(n, n, |i, j| a[(i, j)].abs());
            let largest = sizes.singular_values().unwrap().iter().copied().fold(0.0, f64::max);
            assert!(absolute(&a) >= largest && absolute(&a) <= 1.5 * largest, "{largest}");
            let band = Mat::from_fn(n, n, |i, j| if i.abs_diff(j) < 2 { a[(i, j)] } else { 0.0 });
            assert!(spectral(&band) <= absolute(&band));
        }
    }
}
