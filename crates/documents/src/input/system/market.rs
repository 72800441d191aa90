//! Matrix Market's exchange format: a matrix as text, by coordinates or as an array.
//!
//! ```text
//! %%MatrixMarket matrix coordinate real symmetric
//! % remarks
//! 2 2 3
//! 1 1 4.5
//! 2 1 -1
//! 2 2 4.5
//! ```
//!
//! Rows and columns count from 1; of a symmetric matrix the lower triangle is written; an array is by
//! columns. Entries that are given twice add up, as assembled matrices do.

/// The most elements read: 4096 x 4096.
const MOST_ELEMENTS: usize = 1 << 24;

type Told<T> = std::result::Result<T, String>;

/// The shape of the matrix in a file's text and its entries by rows, or why there is none.
pub(super) fn parse(text: &str) -> Told<(Vec<usize>, Vec<f64>)> {
    let mut lines = (1..).zip(text.lines());
    let banner = lines.next().map(|(_, line)| line.to_lowercase()).unwrap_or_default();
    let words: Vec<&str> = banner.split_whitespace().collect();
    let ["%%matrixmarket", "matrix", layout, field, symmetry] = words.as_slice() else {
        return Err(
            "is no Matrix Market file: its first line is \"%%MatrixMarket matrix coordinate real symmetric\""
                .into(),
        );
    };
    if !["real", "integer", "double"].contains(field) {
        return Err(format!("its entries are {field}: give real ones"));
    }
    let mirror = match *symmetry {
        "general" => 0.0,
        "symmetric" => 1.0,
        other => return Err(format!("it is {other}: give a symmetric matrix, or a general one")),
    };
    let mut rest = lines.filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('%'));
    let (_, sizes) = rest.next().ok_or("its line of sizes is missing")?;
    let sizes = sizes
        .split_whitespace()
        .map(|s| s.parse().map_err(|_| "its line of sizes is not understood".to_string()));
    let sizes: Vec<usize> = sizes.collect::<Told<_>>()?;
    let (rows, columns, entries) = match (*layout, sizes.as_slice()) {
        ("coordinate", &[rows, columns, entries]) => (rows, columns, Some(entries)),
        ("array", &[rows, columns]) => (rows, columns, None),
        _ => return Err("its line of sizes is not understood".into()),
    };
    if rows == 0 || columns == 0 {
        return Err(format!("has no elements: it says {rows} rows and {columns} columns"));
    }
    if rows.checked_mul(columns).is_none_or(|n| n > MOST_ELEMENTS) {
        return Err(format!("has more than {MOST_ELEMENTS} elements"));
    }
    if mirror != 0.0 && rows != columns {
        return Err("it is symmetric, but not square".into());
    }
    let mut values = vec![0.0; rows * columns];
    let mut add = |i: usize, j: usize, x: f64| {
        values[i * columns + j] += x;
        if i != j && mirror != 0.0 {
            values[j * columns + i] += x;
        }
    };
    let mut places =
        (0..columns).flat_map(|j| (if mirror == 0.0 { 0 } else { j }..rows).map(move |i| (i, j)));
    let mut count = 0;
    for (number, line) in rest {
        let bad = || format!("its line {number} is not understood: {line}");
        let words: Vec<&str> = line.split_whitespace().collect();
        let (place, value) = match (entries, words.as_slice()) {
            (Some(_), [i, j, x]) => {
                let index =
                    |word: &str, n: usize| word.parse().ok().filter(|k| (1..=n).contains(k)).map(|k| k - 1);
                (index(i, rows).zip(index(j, columns)), x)
            }
            (None, [x]) => (places.next(), x),
            _ => return Err(bad()),
        };
        let (i, j) = place.ok_or_else(bad)?;
        let value: f64 = value.parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(bad)?;
        add(i, j, value);
        count += 1;
    }
    let complete = entries.map_or_else(|| places.next().is_none(), |n| n == count);
    if !complete {
        return Err(format!("has {count} entries, not as many as it says"));
    }
    Ok((vec![rows, columns], values))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_and_arrays_are_read_and_bad_files_refused() {
        let banner = "%%MatrixMarket matrix coordinate real symmetric\n% a remark\n";
        let symmetric = parse(&format!("{banner}2 2 3\n1 1 4.5\n2 1 -1\n2 1 -1e0\n")).unwrap();
        assert_eq!(symmetric.1, [4.5, -2.0, -2.0, 0.0]);
        let array = parse("%%MatrixMarket matrix array real general\n2 3\n1\n2\n3\n4\n5\n6\n").unwrap();
        assert_eq!(array, (vec![2, 3], vec![1.0, 3.0, 5.0, 2.0, 4.0, 6.0]));
        let triangle = parse("%%MatrixMarket matrix array integer symmetric\n2 2\n1\n2\n3\n").unwrap();
        assert_eq!(triangle.1, [1.0, 2.0, 2.0, 3.0]);
        for bad in
            ["2 2 1\n3 1 1\n", "2 2 2\n1 1 1\n", "2 2 1\n1 1 x\n", "2 2 1\n1 1 inf\n", "2 3 0\n", "", "a\n"]
        {
            assert!(parse(&format!("{banner}{bad}")).is_err(), "{bad}");
        }
        assert!(parse("%%MatrixMarket matrix coordinate complex general\n1 1 0\n").is_err());
    }

    /// Sizes of nothing, whose places would be looked for one after the other.
    #[test]
    fn a_matrix_without_elements_is_refused_whatever_its_sizes() {
        for sizes in ["0 18446744073709551615", "18446744073709551615 0", "0 0"] {
            for (layout, entries) in [("array", ""), ("coordinate", " 0")] {
                let told = parse(&format!("%%MatrixMarket matrix {layout} real general\n{sizes}{entries}\n"));
                assert!(told.unwrap_err().contains("no elements"), "{layout} {sizes}");
            }
        }
        let wraps = format!("%%MatrixMarket matrix array real general\n{} 2\n", 1u64 << 63);
        assert!(parse(&wraps).unwrap_err().contains("more than"));
    }

    #[test]
    fn banners_of_another_form_are_refused() {
        assert!(parse("1 1 0\n").is_err());
    }
}
