//! Labels that do not collide.

use serde_json::{Map, Value};

/// Labels longer than this end in a sum over all inputs.
const LONGEST_LABEL: usize = 60;

/// A name that tables of other inputs do not have: the values of all of them, or a checksum where these are
/// long. Columns are told by a table's form.
pub fn label(name: &str, input: &Map<String, Value>) -> String {
    let values = input.iter().filter(|(key, _)| *key != "columns").map(|(key, value)| match value {
        Value::String(text) => format!("-{key}-{text}"),
        other => format!("-{key}-{other}"),
    });
    let all: String = values.collect();
    let plain: String = all.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let is_short = name.len() + plain.len() <= LONGEST_LABEL;
    if is_short { format!("{name}{plain}") } else { format!("{name}-{:08x}", checksum(&all)) }
}

/// FNV-1a, its halves folded to 32 bits.
pub fn checksum(text: &str) -> u64 {
    let step = |sum: u64, byte: u8| (sum ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
    let sum = text.bytes().fold(0xcbf2_9ce4_8422_2325_u64, step);
    (sum >> 32) ^ (sum & 0xffff_ffff)
}
