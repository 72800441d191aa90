//! Lines and outlines clipped to a box: nothing outside costs a byte, however far away it runs.

/// A point on the page.
pub(crate) type Point = [f64; 2];

/// Left, top, right, bottom on the page.
pub(crate) type Rect = [f64; 4];

/// Whether a point lies in the box, rim included; a NaN never does.
pub(crate) fn holds(rect: Rect, [x, y]: Point) -> bool {
    rect[0] <= x && x <= rect[2] && rect[1] <= y && y <= rect[3]
}

/// The part of the segment from `a` to `b` in the box (Liang and Barsky): the segment is a + t (b - a), and
/// each side of the box bounds t from one side.
pub(crate) fn segment(rect: Rect, a: Point, b: Point) -> Option<(Point, Point)> {
    let (mut first, mut last) = (0.0f64, 1.0f64);
    for axis in 0..2 {
        let run = b[axis] - a[axis];
        let (low, high) = (rect[axis] - a[axis], rect[axis + 2] - a[axis]);
        if run == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        let (enter, leave) = if run > 0.0 { (low / run, high / run) } else { (high / run, low / run) };
        (first, last) = (first.max(enter), last.min(leave));
    }
    let sound = a.iter().chain(&b).all(|c| c.is_finite());
    let at = |t: f64| match t {
        // The ends themselves, so that a line inside the box stays as it is to the last bit.
        0.0 => a,
        1.0 => b,
        _ => [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])],
    };
    (sound && first <= last).then(|| (at(first), at(last)))
}

/// The pieces of a polyline in the box. A point that is not finite breaks the line.
pub(crate) fn polyline(rect: Rect, points: impl IntoIterator<Item = Point>) -> Vec<Vec<Point>> {
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    let mut before = None;
    for point in points {
        if let Some(from) = before
            && let Some((a, b)) = segment(rect, from, point)
        {
            match pieces.last_mut() {
                Some(piece) if piece.last() == Some(&a) => piece.push(b),
                _ => pieces.push(vec![a, b]),
            }
        }
        before = Some(point);
    }
    pieces
}

/// The part of a filled outline in the box (Sutherland and Hodgman): cut along each side in turn.
pub(crate) fn polygon(rect: Rect, outline: impl IntoIterator<Item = Point>) -> Vec<Point> {
    let outline: Vec<Point> = outline.into_iter().filter(|p| p.iter().all(|c| c.is_finite())).collect();
    (0..4).fold(outline, |outline, side| cut(rect, &outline, side))
}

fn cut(rect: Rect, outline: &[Point], side: usize) -> Vec<Point> {
    let (axis, bound) = (side % 2, rect[side]);
    let inside = |p: Point| if side < 2 { p[axis] >= bound } else { p[axis] <= bound };
    let mut kept = Vec::with_capacity(outline.len() + 4);
    for (i, &to) in outline.iter().enumerate() {
        let from = outline[(i + outline.len() - 1) % outline.len()];
        if inside(from) != inside(to) {
            let t = (bound - from[axis]) / (to[axis] - from[axis]);
            let mut crossing = [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])];
            crossing[axis] = bound;
            kept.push(crossing);
        }
        if inside(to) {
            kept.push(to);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const BOX: Rect = [0.0, 0.0, 10.0, 5.0];

    #[test]
    fn a_line_through_the_box_enters_and_leaves_at_its_rim() {
        assert_eq!(segment(BOX, [-5.0, 2.0], [15.0, 2.0]), Some(([0.0, 2.0], [10.0, 2.0])));
        assert_eq!(segment(BOX, [3.0, -5.0], [3.0, 15.0]), Some(([3.0, 0.0], [3.0, 5.0])));
        assert_eq!(segment(BOX, [-1.0, 6.0], [11.0, 6.0]), None);
        assert_eq!(segment(BOX, [-3.0, 0.0], [0.0, -3.0]), None);
        assert_eq!(segment(BOX, [1.0, f64::NAN], [2.0, 2.0]), None);
    }

    #[test]
    fn a_line_that_leaves_and_comes_back_is_two_pieces() {
        let line = [[1.0, 1.0], [1.0, 9.0], [4.0, 9.0], [4.0, 1.0], [5.0, 1.0]];
        let pieces = polyline(BOX, line);
        assert_eq!(pieces, [vec![[1.0, 1.0], [1.0, 5.0]], vec![[4.0, 5.0], [4.0, 1.0], [5.0, 1.0]]]);
        let broken = polyline(BOX, [[1.0, 1.0], [2.0, 1.0], [f64::NAN, 1.0], [3.0, 1.0], [4.0, 1.0]]);
        assert_eq!(broken.len(), 2);
    }

    #[test]
    fn an_outline_around_the_box_becomes_the_box() {
        let area = |p: &[Point]| {
            let next = p.iter().cycle().skip(1);
            p.iter().zip(next).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>().abs() / 2.0
        };
        let around = polygon(BOX, [[-9.0, -9.0], [99.0, -9.0], [99.0, 99.0], [-9.0, 99.0]]);
        assert_eq!(area(&around), 50.0);
        let corner = polygon(BOX, [[8.0, -1.0], [12.0, 3.0], [8.0, 3.0]]);
        assert_eq!(area(&corner), 5.5);
        assert!(polygon(BOX, [[20.0, 20.0], [30.0, 20.0], [30.0, 30.0]]).is_empty());
    }

    proptest! {
        #[test]
        fn what_is_kept_lies_in_the_box_and_on_the_line(
            a in prop::array::uniform2(-20.0..20.0), b in prop::array::uniform2(-20.0..20.0)
        ) {
            let slack = [-1e-9, -1e-9, 10.0 + 1e-9, 5.0 + 1e-9];
            if let Some((p, q)) = segment(BOX, a, b) {
                for point in [p, q] {
                    let off = (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]);
                    prop_assert!(holds(slack, point) && off.abs() < 1e-9);
                }
            } else {
                // A hundred points along the way: none of them inside.
                let along = |t: f64| [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
                let missed = (0..=100).all(|i| !holds(BOX, along(f64::from(i) / 100.0)));
                prop_assert!(missed);
            }
        }
    }
}
