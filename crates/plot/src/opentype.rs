//! Some glyphs of a face as a font file that browsers take: what is embedded in PDF lacks the table of
//! letters (`cmap`), the name and the measures for screens (`OS/2`, `post`). Formats: ISO/IEC 14496-22
//! (OpenType).

use std::collections::BTreeMap;

use subsetter::GlyphRemapper;

use super::font::{Face, table};

/// The font of the numbered glyphs; `letters` has the letter of each glyph by its number in the face.
pub(crate) fn font(face: Face, numbers: &GlyphRemapper, letters: &BTreeMap<u16, char>) -> Vec<u8> {
    let part = face.part(numbers);
    // The empty box stands for what the face lacks: another font of the reader's shows that better.
    let known = letters.iter().filter(|&(&glyph, _)| glyph != 0);
    let mapped =
        known.filter_map(|(&glyph, &letter)| Some((u32::from(letter), numbers.get(glyph)?))).collect();
    // In the order of their tags, as the directory of tables has to be.
    let tables = [b"CFF ", b"OS/2", b"cmap", b"head", b"hhea", b"hmtx", b"maxp", b"name", b"post"];
    file(&tables.map(|tag| {
        let bytes = match tag {
            b"cmap" => map(&mapped),
            b"OS/2" | b"name" => face.table(tag),
            // Version 3: glyphs have no names.
            b"post" => [&[0, 3, 0, 0], &face.table(tag)[4..32]].concat(),
            _ => table(&part, tag),
        };
        (tag, bytes)
    }))
}

/// Letters to glyphs, as Unicode (platform 3): those of 16 bits (encoding 1, format 4) and all (encoding 10,
/// format 12).
fn map(letters: &BTreeMap<u32, u16>) -> Vec<u8> {
    let (small, all) = (segments(letters), groups(letters));
    let mut bytes = Vec::new();
    words(&mut bytes, &[0, 2, 3, 1, 0, 20, 3, 10, 0, 20 + small.len() as u16]);
    [bytes, small, all].concat()
}

/// Format 4: each letter a segment of its own, its glyph the letter's number plus a difference modulo 2^16.
fn segments(letters: &BTreeMap<u32, u16>) -> Vec<u8> {
    let short = letters.range(..0xffff).map(|(&letter, &glyph)| (letter as u16, glyph));
    // The last segment has to be that of 0xffff, which is no letter.
    let (codes, glyphs): (Vec<u16>, Vec<u16>) = short.chain([(0xffff, 0)]).unzip();
    let differences: Vec<u16> =
        codes.iter().zip(&glyphs).map(|(code, glyph)| glyph.wrapping_sub(*code)).collect();
    let count = codes.len() as u16;
    let power = count.ilog2() as u16;
    let range = 2 << power;
    let head = [4, 16 + 8 * count, 0, 2 * count, range, power, 2 * count - range];
    let mut bytes = Vec::new();
    for part in [&head[..], &codes, &[0], &codes, &differences, &vec![0; codes.len()]] {
        words(&mut bytes, part);
    }
    bytes
}

/// Format 12: each letter a group of its own.
fn groups(letters: &BTreeMap<u32, u16>) -> Vec<u8> {
    let mut bytes = vec![0, 12, 0, 0];
    let count = letters.len() as u32;
    longs(&mut bytes, &[16 + 12 * count, 0, count]);
    letters.iter().for_each(|(&letter, &glyph)| longs(&mut bytes, &[letter, letter, glyph.into()]));
    bytes
}

/// The tables behind their directory, each on a multiple of four bytes.
fn file(tables: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
    let count = tables.len() as u16;
    let power = count.ilog2() as u16;
    let range = 16 << power;
    let mut bytes = b"OTTO".to_vec();
    words(&mut bytes, &[count, range, power, 16 * count - range]);
    let mut at = 12 + 16 * tables.len();
    for (tag, table) in tables {
        bytes.extend_from_slice(*tag);
        longs(&mut bytes, &[checksum(table), at as u32, table.len() as u32]);
        at += table.len().next_multiple_of(4);
    }
    for (_, table) in tables {
        bytes.extend_from_slice(table);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    bytes
}

/// The sum of its words of four bytes modulo 2^32.
fn checksum(table: &[u8]) -> u32 {
    let byte = |four: &[u8], i: usize| u32::from(four.get(i).copied().unwrap_or(0));
    let words = table.chunks(4).map(|four| (0..4).fold(0, |word, i| word << 8 | byte(four, i)));
    words.fold(0, u32::wrapping_add)
}

fn words(bytes: &mut Vec<u8>, words: &[u16]) {
    bytes.extend(words.iter().flat_map(|word| word.to_be_bytes()));
}

fn longs(bytes: &mut Vec<u8>, longs: &[u32]) {
    bytes.extend(longs.iter().flat_map(|long| long.to_be_bytes()));
}

#[cfg(test)]
mod tests {
    use super::super::font::curves;
    use super::*;

    #[test]
    fn letters_keep_their_shapes_and_advances() {
        for face in Face::ALL {
            let glyphs = "Tongues of h2/h1 = 5/3, ρ ≤ 5/2".chars().map(|letter| (face.glyph(letter), letter));
            let (letters, mut numbers) = (glyphs.collect::<BTreeMap<_, _>>(), GlyphRemapper::new());
            for &glyph in letters.keys() {
                numbers.remap(glyph);
            }
            let bytes = font(face, &numbers, &letters);
            let found = ttf_parser::Face::parse(&bytes, 0).unwrap();
            for (&glyph, &letter) in &letters {
                let glyph_id = found.glyph_index(letter).unwrap();
                let advance =
                    f64::from(found.glyph_hor_advance(glyph_id).unwrap()) / f64::from(found.units_per_em());
                assert_eq!(advance, face.advance(glyph), "{letter}");
                assert_eq!(curves(&found, glyph_id.0), face.outline(glyph), "{letter}");
            }
            assert_eq!(found.glyph_index('Z'), None, "a letter that is not in use");
        }
    }
}
