//! A sample that depends on the document alone.

/// So many different numbers below `of`, increasing, drawn by the text's own seed; all of them where there
/// are no more.
pub fn sample(text: &str, count: u64, most: u64) -> Vec<u64> {
    if count <= most {
        return (0..count).collect();
    }
    // FNV-1a of the text, then splitmix64 (Steele, Lea, Flood 2014).
    let seed = text
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
    let mut drawn = std::collections::BTreeSet::new();
    let mut states = (1..).map(|k: u64| seed.wrapping_add(k.wrapping_mul(0x9e37_79b9_7f4a_7c15)));
    while (drawn.len() as u64) < most {
        let mut z = states.next().expect("endless");
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        drawn.insert(((u128::from(z ^ (z >> 31)) * u128::from(count)) >> 64) as u64);
    }
    drawn.into_iter().collect()
}
