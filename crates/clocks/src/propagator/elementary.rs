//! Kick and drift: the two shears that every method here is made of.

use nalgebra::Matrix2;

use number::Ring;

/// K(k) = [[1, 0], [−k, 1]]: the velocity drops by k x. Determinant 1 (theorem `det_propagator` in proofs/).
pub fn kick<S: Ring>(strength: S) -> Matrix2<S> {
    Matrix2::new(S::one(), S::zero(), -strength, S::one())
}

/// D(t) = [[1, t], [0, 1]]: the position advances by t v. Determinant 1 (theorem `det_propagator` in
/// proofs/).
pub fn drift<S: Ring>(time: S) -> Matrix2<S> {
    Matrix2::new(S::one(), time, S::zero(), S::one())
}

/// `m ← K(k) m` in two multiplications instead of the eight of a matrix product.
pub fn apply_kick<S: Ring>(m: &mut Matrix2<S>, strength: &S) {
    for column in 0..2 {
        let x = m[(0, column)].clone();
        m[(1, column)].sub_product(strength, &x);
    }
}

/// `m ← D(t) m` in two multiplications.
pub fn apply_drift<S: Ring>(m: &mut Matrix2<S>, time: &S) {
    for column in 0..2 {
        let v = m[(1, column)].clone();
        m[(0, column)].add_product(time, &v);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::Rational;

    #[test]
    fn applying_equals_multiplying() {
        let r = |n: i64, d: i64| Rational::new(n.into(), d.into());
        let start = Matrix2::new(r(1, 2), r(-3, 1), r(5, 7), r(2, 9));
        let (k, t) = (r(11, 3), r(-4, 5));
        let mut applied = start.clone();
        apply_kick(&mut applied, &k);
        apply_drift(&mut applied, &t);
        assert_eq!(applied, drift(t) * kick(k) * start);
    }
}
