//! Krylov spaces: one eigenvector of a symmetric operator.

use faer::{Mat, Side};

/// How often a space is looked at.
const EVERY: usize = 16;

/// The eigenvector of the largest eigenvalue of a symmetric operator as a Krylov space from x has it, off the
/// columns of `rigid`: of length 1, rounded. It takes so many steps at most, fewer where the residual falls
/// below `enough` times the eigenvalue. `None` where nothing is left or something has no image.
pub(super) fn top(
    mut x: Mat<f64>,
    rigid: &Mat<f64>,
    steps: usize,
    enough: f64,
    image: impl Fn(&Mat<f64>) -> Option<Mat<f64>>,
) -> Option<Mat<f64>> {
    let (n, steps) = (x.nrows(), steps.min(x.nrows()));
    let (mut basis, mut images) = (Mat::<f64>::zeros(n, steps), Mat::<f64>::zeros(n, steps));
    let mut size = 0;
    loop {
        for _ in 0..2 {
            x -= rigid * (rigid.transpose() * &x);
            let matrix = basis.subcols(0, size);
            x -= matrix * (matrix.transpose() * &x);
        }
        let length = x.norm_l2();
        // The space is used up: what is left of an image is rounding.
        let is_over =
            size == steps || !(length.is_finite() && length > 1e-13 * images.subcols(0, size).norm_max());
        if is_over || size > 0 && size % EVERY == 0 {
            let (matrix, images) = (basis.subcols(0, size), images.subcols(0, size));
            let form = matrix.transpose() * images;
            let form = Mat::from_fn(size, size, |i, j| (form[(i, j)] + form[(j, i)]) / 2.0);
            let eigen = form.self_adjoint_eigen(Side::Lower).ok()?;
            let part = Mat::from_fn(size, usize::from(size > 0), |i, _| eigen.U()[(i, size - 1)]);
            let found = matrix * &part;
            let value = (size > 0).then(|| eigen.S()[size - 1])?;
            if is_over || (images * part - &found * faer::Scale(value)).norm_l2() < enough * value {
                return Some(&found / faer::Scale(found.norm_l2()));
            }
        }
        x /= faer::Scale(length);
        basis.col_mut(size).copy_from(x.col(0));
        x = image(&x)?;
        images.col_mut(size).copy_from(x.col(0));
        size += 1;
    }
}
