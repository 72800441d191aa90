//! The map command as a person runs it: same bytes by every way, whole files, one clear line where it cannot.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// Figure 1 of the paper with steps of 1/150: 95 x 525 pairs in more than one band.
const GRID: &str =
    "map --lambda1 pi^2 --lambda2 pi^2/25 --step 1/150 --h1-range 1/150..2/pi --h2-range 1/150..7/2";

fn kickdrift(words: &str, paths: &[&dyn AsRef<OsStr>]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kickdrift"));
    command.args(words.split_whitespace());
    command.args(paths.iter().map(AsRef::as_ref));
    command.output().unwrap()
}

fn done(words: &str, paths: &[&dyn AsRef<OsStr>]) -> Vec<u8> {
    let output = kickdrift(words, paths);
    assert!(output.status.success(), "{words}: {}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

/// The one line of an error.
fn refused(words: &str, paths: &[&dyn AsRef<OsStr>]) -> String {
    let output = kickdrift(words, paths);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), text.lines().count()), (Some(2), 1), "{words}: {text}");
    assert!(output.stdout.is_empty(), "{words}");
    text
}

/// What GRID with these flags writes into a file of this name.
fn written(folder: &Path, flags: &str, name: &str) -> Vec<u8> {
    let path = folder.join(name);
    assert!(done(&format!("{GRID} {flags} --output"), &[&path]).is_empty());
    fs::read(path).unwrap()
}

fn summary(flags: &str) -> Value {
    serde_json::from_slice(&done(&format!("{GRID} {flags}"), &[])).unwrap()
}

/// The forms of a map, with the flags that go with them.
const FORMS: [(&str, &str); 5] = [
    ("map.csv", ""),
    ("map.npz", ""),
    ("map.json", ""),
    ("map.svg", "--colour growth --curves"),
    ("map.png", "--colour family"),
];

#[test]
fn threads_parts_and_interruptions_change_no_byte() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let parts: Vec<PathBuf> = ["part1", "part2"].map(path).to_vec();
    for (k, part) in (1..).zip(&parts) {
        done(&format!("{GRID} --label --growth --shard {k}/2 --resume"), &[part]);
    }
    for (name, flags) in FORMS {
        let flags = format!("--label --growth {flags}");
        let whole = written(folder.path(), &format!("{flags} --threads 1"), name);
        assert!(whole == written(folder.path(), &format!("{flags} --threads 2"), name), "{name}: threads");
        let merged = path(&format!("merged-{name}"));
        let drawing = flags.replace("--label --growth", "");
        done(&format!("merge {drawing} --output"), &[&merged, &parts[0], &parts[1]]);
        assert!(whole == fs::read(merged).unwrap(), "{name}: parts");
        // One part goes on to the whole map, after losing a band.
        fs::remove_file(parts[0].join("band-00000000")).unwrap();
        let resumed = path(&format!("resumed-{name}"));
        let words = format!("{GRID} {flags} --resume {} --output", parts[0].display());
        done(&words, &[&resumed]);
        assert!(whole == fs::read(resumed).unwrap(), "{name}: resumed");
    }
    let left: Vec<String> =
        fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    assert!(left.iter().all(|name| !name.starts_with('.')), "temporary files are left: {left:?}");
}

/// The arrays of an archive: name, header, elements.
fn arrays(bytes: &[u8]) -> Vec<(String, String, Vec<u8>)> {
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
    (0..archive.len())
        .map(|i| {
            let mut file = archive.by_index(i).unwrap();
            assert_eq!(file.compression(), zip::CompressionMethod::Deflated);
            let (mut content, name) = (Vec::new(), file.name().unwrap().into_owned());
            std::io::Read::read_to_end(&mut file, &mut content).unwrap();
            assert_eq!(&content[..8], b"\x93NUMPY\x01\x00");
            let length = 10 + usize::from(u16::from_le_bytes([content[8], content[9]]));
            assert_eq!(length % 64, 0);
            let header = String::from_utf8(content[10..length].to_vec()).unwrap();
            (name, header.trim_end().to_string(), content[length..].to_vec())
        })
        .collect()
}

#[test]
fn the_arrays_are_numpy_and_tell_what_the_rows_tell() {
    let folder = tempfile::tempdir().unwrap();
    let found = arrays(&written(folder.path(), "--label --growth", "map.npz"));
    let header = |kind: &str, shape: &str| {
        format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({shape}), }}")
    };
    let pairs = 95 * 525;
    let expected = [
        ("h1", "<f8", "95,", 95 * 8),
        ("h2", "<f8", "525,", 525 * 8),
        ("verdict", "|u1", "95,525,", pairs),
        ("tier", "|u1", "95,525,", pairs),
        ("verdict_names", "|S12", "7,", 84),
        ("tier_names", "|S6", "3,", 18),
        ("m", "<i8", "95,525,", 8 * pairs),
        ("a", "<i8", "95,525,", 8 * pairs),
        ("b", "<i8", "95,525,", 8 * pairs),
        ("growth_rate", "<f8", "95,525,", 8 * pairs),
        ("growth_rate_error", "<f8", "95,525,", 8 * pairs),
    ];
    assert_eq!(found.len(), expected.len());
    for ((name, found, content), (key, kind, shape, bytes)) in found.iter().zip(expected) {
        assert_eq!((name.as_str(), found), (format!("{key}.npy").as_str(), &header(kind, shape)));
        assert_eq!(content.len(), bytes, "{key}");
    }
    // Every row of the CSV stands at its place, and the other pairs are plainly stable.
    let csv = String::from_utf8(written(folder.path(), "--label --growth", "map.csv")).unwrap();
    let word = |n: usize, at: usize| <[u8; 8]>::try_from(&found[n].2[8 * at..8 * at + 8]).unwrap();
    let names: Vec<&str> = found[4].2.chunks(12).map(|c| std::str::from_utf8(c).unwrap()).collect();
    let mut marked = 0;
    for row in csv.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let place = |array: usize, h: f64| {
            found[array].2.chunks(8).position(|b| f64::from_le_bytes(b.try_into().unwrap()) == h).unwrap()
        };
        let at = 525 * place(0, number(cells[0])) + place(1, number(cells[1]));
        assert!(names[usize::from(found[2].2[at])].starts_with(cells[4]), "{row}");
        assert_eq!(i64::from_le_bytes(word(6, at)).to_string(), cells[7], "{row}");
        assert_eq!(i64::from_le_bytes(word(7, at)).to_string(), cells[8], "{row}");
        let [rate, error] = [9, 10].map(|array| f64::from_le_bytes(word(array, at)));
        let [lo, hi] = [10, 11].map(|cell| cells[cell].parse::<f64>().unwrap());
        assert!(rate - error <= lo && lo <= rate && rate <= hi && hi <= rate + error, "{row}");
        assert!(hi - lo <= 1e-6 * lo && error <= 1e-6 * lo, "{row}");
        marked += 1;
    }
    assert!(marked > 3000);
    assert_eq!(found[2].2.iter().filter(|&&verdict| verdict != 0).count(), marked);
    assert_eq!(found[6].2.chunks(8).filter(|m| *m != (-1i64).to_le_bytes()).count(), marked);
}

#[test]
fn a_scene_writes_the_same_arrays() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.json");
    let text = r#"{"schema": "kickdrift/scene/1", "lambda1": "pi^2", "lambda2": "pi^2/25",
        "grid": {"step": "1/150", "h1": "1/150..2/pi", "h2": "1/150..7/2"}, "want": ["map.npz", "map.csv"]}"#;
    fs::write(&scene, text).unwrap();
    done("run", &[&scene, &"--output", &folder.path()]);
    let of_scene = ["map.npz", "map.csv"].map(|name| fs::read(folder.path().join(name)).unwrap());
    assert!(of_scene == ["map.npz", "map.csv"].map(|name| written(folder.path(), "", name)));
}

#[test]
fn nothing_is_computed_unasked() {
    let folder = tempfile::tempdir().unwrap();
    let (bare, label) = (summary(""), summary("--label"));
    assert_eq!(bare["work"]["kicks_again"], 0);
    assert!(bare.get("families").is_none() && bare.get("fastest").is_none());
    assert!(label["work"]["kicks_again"].as_u64().unwrap() > 0);
    assert_eq!(bare["work"]["kicks"], label["work"]["kicks"]);
    let of_families: u64 =
        label["families"].as_array().unwrap().iter().map(|family| family["pairs"].as_u64().unwrap()).sum();
    assert_eq!(of_families, label["unstable"].as_u64().unwrap() - label["parabolic"].as_u64().unwrap());
    let header = |flags: &str| {
        let csv = String::from_utf8(written(folder.path(), flags, "map.csv")).unwrap();
        csv.lines().next().unwrap().to_string()
    };
    let plain = "h1,h2,p,q,kind,side,decided_by";
    assert_eq!(header(""), plain);
    assert_eq!(header("--label"), format!("{plain},m,a,b"));
    let growth = ["growth_rate", "steps_until_tenfold"].map(|key| format!("{key}_lo,{key}_hi")).join(",");
    assert_eq!(header("--growth"), format!("{plain},{growth}"));
}

#[test]
fn a_row_says_what_the_verdict_command_says() {
    let fastest = &summary("--label --growth")["fastest"];
    let steps = ["h1", "h2"].map(|key| fastest[key].as_str().unwrap());
    let words =
        format!("verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 {} --h2 {} --format json", steps[0], steps[1]);
    let verdict: Value = serde_json::from_slice(&done(&words, &[])).unwrap();
    let ends = |value: &Value| ["lo", "hi"].map(|end| value[end].as_f64().unwrap());
    let ([lo, hi], [low, high]) = (ends(&fastest["growth_rate"]), ends(&verdict["growth_rate"]));
    assert!(lo <= low && high <= hi && hi - lo <= 1e-6 * lo, "{lo}..{hi} around {low}..{high}");
    // Tenfold in ln 10 / (h2 rate) slow steps.
    let (h2, [few, many]) = (number(steps[1]), ends(&fastest["steps_until_tenfold"]));
    assert!((few * lo * h2 / 10f64.ln() - 1.0).abs() < 1e-6 && few < many, "{few}..{many}");
}

/// Next to an edge doubles know no digit of BC: the rate is an enclosure, as `verdict` tells it.
#[test]
fn a_rate_next_to_an_edge_is_the_verdicts() {
    let steps = "--h1-range 2..2 --h2-range 3..3 --step 1";
    for k in [4, 8, 12, 15] {
        let stiffness = format!("--lambda1 3*(1-10^-{k})/4 --lambda2 1/25");
        let map: Value =
            serde_json::from_slice(&done(&format!("map {stiffness} {steps} --growth"), &[])).unwrap();
        let words = format!("verdict {stiffness} --h1 2 --h2 3 --format json");
        let verdict: Value = serde_json::from_slice(&done(&words, &[])).unwrap();
        let ends = |rate: &Value| ["lo", "hi"].map(|end| rate[end].as_f64().unwrap());
        let ([lo, hi], [low, high]) = (ends(&map["fastest"]["growth_rate"]), ends(&verdict["growth_rate"]));
        assert!(lo <= low && high <= hi && hi - lo <= 1e-6 * lo, "{k}: {lo}..{hi} around {low}..{high}");
    }
}

#[test]
fn a_map_too_large_tells_its_cost_at_once() {
    let fine = "map --lambda1 pi^2 --lambda2 pi^2/25 --step 1/1000000 --h1-range 1/1000000..2/pi \
                --h2-range 1/1000000..7/2";
    let line = refused(fine, &[]);
    for part in ["2228166", "e16 kicks", "days of one core", "--budget", "larger step"] {
        assert!(line.contains(part), "{part}: {line}");
    }
}

fn number(text: &str) -> f64 {
    let (n, d) = text.split_once('/').unwrap_or((text, "1"));
    n.parse::<f64>().unwrap() / d.parse::<f64>().unwrap()
}

#[test]
fn the_form_follows_the_flags() {
    let folder = tempfile::tempdir().unwrap();
    let begins = |flags: &str, name: &str| written(folder.path(), flags, name)[..5].to_vec();
    assert_eq!(begins("", "map"), b"{\n  \"");
    assert_eq!(begins("--format csv", "map.png"), b"h1,h2");
    assert_eq!(begins("", "MAP.PNG"), b"\x89PNG\r");
    assert_eq!(begins("--colour tenfold", "map.svg"), b"<svg ");
    assert_eq!(begins("", "map.txt"), b"49875");
    assert_eq!(begins("", "map.npz"), b"PK\x03\x04-");
}

#[test]
fn a_tongue_from_nearby() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tongue.png");
    let zoom = "map --lambda1 pi^2 --lambda2 pi^2/25 --step1 1/10000 --step2 1/5000 \
                --h1-range 0.43..0.44 --h2-range 1.75..1.77 --colour growth --curves --output";
    done(zoom, &[&path]);
    assert!(fs::metadata(path).unwrap().len() > 10_000);
}

#[test]
fn parts_of_different_maps_are_refused_and_missing_ones_named() {
    let folder = tempfile::tempdir().unwrap();
    let [one, two, other] = ["one", "two", "other"].map(|name| folder.path().join(name));
    done(&format!("{GRID} --shard 1/2 --resume"), &[&one]);
    let alone = refused("merge", &[&one]);
    assert!(alone.contains("band 1 from h1 = ") && alone.contains("run its shard"), "{alone}");
    done(&format!("{GRID} --label --shard 2/2 --resume"), &[&two]);
    let mixed = refused("merge", &[&one, &two]);
    assert!(mixed.contains("another map") && mixed.contains("label is true, not false"), "{mixed}");
    done(&format!("{} --shard 2/2 --resume", GRID.replace("pi^2/25", "pi^2/24")), &[&other]);
    let mixed = refused("merge", &[&one, &other]);
    assert!(mixed.contains("lambda2"), "{mixed}");
    assert!(refused(&format!("{GRID} --resume"), &[&other]).contains("choose another directory"));
    assert!(refused("merge", &[&folder.path()]).contains("map.json"));
    let colour = refused("merge --colour growth --output map.png", &[&one]);
    assert!(colour.contains("without --growth"), "{colour}");
}

/// FNV-1a, as a part of a map ends with it.
fn check(bytes: &[u8]) -> [u8; 8] {
    let step = |hash: u64, &byte: &u8| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, step).to_le_bytes()
}

/// A directory with all bands of GRID, its bytes merged, and the bytes of its second band.
fn whole_part(folder: &Path) -> (PathBuf, Vec<u8>, Vec<u8>) {
    let part = folder.join("part");
    done(&format!("{GRID} --label --growth --resume"), &[&part]);
    let (merged, band) = (done("merge", &[&part]), fs::read(part.join("band-00000001")).unwrap());
    (part, merged, band)
}

#[test]
fn a_band_copied_over_another_one_is_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let (part, whole, _) = whole_part(folder.path());
    fs::copy(part.join("band-00000000"), part.join("band-00000001")).unwrap();
    let line = refused("merge", &[&part]);
    assert!(line.contains("band 1 from h1 = ") && line.contains("run its shard"), "{line}");
    assert!(whole == done(&format!("{GRID} --label --growth --resume"), &[&part]), "another map");
    assert!(whole == done("merge", &[&part]), "not mended by going on");
}

/// Fields that no band has, below a check that is right.
#[test]
fn a_forged_band_is_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let (part, whole, sound) = whole_part(folder.path());
    let start = (0..2).fold(0, |at, _| at + sound[at..].iter().position(|&b| b == b'\n').unwrap() + 1);
    let number =
        |bytes: &[u8], field: usize| u64::from_le_bytes(bytes[start + 8 * field..][..8].try_into().unwrap());
    let (columns, rows, growing) = (number(&sound, 1), number(&sound, 2), number(&sound, 3));
    let pairs = (columns * rows) as usize;
    assert!(growing > 10 && number(&sound, 4) == pairs as u64);
    let forged = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = sound[..sound.len() - 8].to_vec();
        change(&mut bytes);
        bytes.extend(check(&bytes));
        fs::write(part.join("band-00000001"), bytes).unwrap();
    };
    let set = |field: usize, value: u64| {
        move |bytes: &mut Vec<u8>| bytes[start + 8 * field..][..8].copy_from_slice(&value.to_le_bytes())
    };
    forged(&|_| {});
    assert!(whole == done("merge", &[&part]), "the check is not that of the program");
    let (verdicts, tiers, list) = (start + 64, start + 64 + pairs, start + 64 + 2 * pairs);
    let stable = sound[verdicts..tiers].iter().position(|&code| code == 0).unwrap();
    // Its columns and rows are 2^32 each, and their product wraps to 0.
    let empty = |bytes: &mut Vec<u8>| {
        bytes.truncate(start + 64);
        [1, 2].into_iter().for_each(|field| set(field, 1 << 32)(bytes));
        [3, 4].into_iter().for_each(|field| set(field, 0)(bytes));
    };
    let put = |at: usize, value: u64| {
        move |bytes: &mut Vec<u8>| bytes[at..][..8].copy_from_slice(&value.to_le_bytes())
    };
    type Forgery<'a> = Box<dyn Fn(&mut Vec<u8>) + 'a>;
    let changes: [(&str, Forgery); 17] = [
        ("first", Box::new(set(0, 1))),
        (
            "columns and rows swapped",
            Box::new(|bytes| {
                [(1, rows), (2, columns)].into_iter().for_each(|(field, n)| set(field, n)(bytes))
            }),
        ),
        ("a product that wraps", Box::new(empty)),
        ("no list", Box::new(set(3, 0))),
        ("a list without end", Box::new(set(3, u64::MAX))),
        ("pairs", Box::new(set(4, 7))),
        ("kicks", Box::new(set(5, u64::MAX))),
        ("kicks again", Box::new(set(6, u64::MAX))),
        ("escalated", Box::new(set(7, pairs as u64 + 1))),
        ("a verdict's code", Box::new(|bytes| bytes[verdicts] = 7)),
        ("a stable pair that grows", Box::new(|bytes| bytes[verdicts + stable] = 1)),
        ("a tier's code", Box::new(|bytes| bytes[tiers] = 3)),
        ("a position", Box::new(put(list, u64::from(u32::MAX)))),
        ("a position that wraps", Box::new(|bytes| bytes[list + 4] = 1)),
        ("a label", Box::new(put(list + 8, u64::MAX - 1))),
        ("an end that is no number", Box::new(put(list + 16, f64::NAN.to_bits()))),
        ("ends in the wrong order", Box::new(put(list + 24, 0))),
    ];
    for (what, change) in changes {
        forged(&*change);
        let line = refused("merge", &[&part]);
        assert!(line.contains("band 1 from h1 = "), "{what}: {line}");
    }
}

#[cfg(unix)]
#[test]
fn only_regular_files_of_a_bands_size_are_read_as_bands() {
    let folder = tempfile::tempdir().unwrap();
    let (part, whole, sound) = whole_part(folder.path());
    let band = part.join("band-00000001");
    let device = || std::os::unix::fs::symlink("/dev/zero", &band).unwrap();
    let pipe = || assert!(Command::new("mkfifo").arg(&band).status().unwrap().success());
    // What would fill a disk, were it not a hole.
    let hole = || fs::File::create(&band).unwrap().set_len(1 << 50).unwrap_or(());
    let longer = || fs::write(&band, [&sound[..], &[0; 1 << 22]].concat()).unwrap();
    let makes: [&dyn Fn(); 4] = [&device, &pipe, &hole, &longer];
    for make in makes {
        fs::remove_file(&band).unwrap();
        make();
        assert!(refused("merge", &[&part]).contains("band 1 from h1 = "));
    }
    assert!(whole == done(&format!("{GRID} --label --growth --resume"), &[&part]));
    for make in [&device, &pipe] as [&dyn Fn(); 2] {
        let name = part.join("map.json");
        fs::remove_file(&band).unwrap();
        make();
        fs::rename(&band, &name).unwrap();
        assert!(refused("merge", &[&part]).contains("it is no regular file"));
        fs::write(&band, &sound).unwrap();
    }
}

#[test]
fn bad_flags_are_told_in_one_line() {
    for (flags, says) in [
        ("--colour growth", "--output FILE.svg"),
        ("--curves --output map.csv", "--output FILE.svg"),
        ("--a 0..1 --output map.png", "add --curves"),
        ("--curves --a 1..x --output map.png", "a = 1..x"),
        ("--colour pink --output map.png", "pink"),
        ("--shard 1/2", "--resume DIR"),
        ("--shard 3/2 --resume nowhere", "shard = 3/2"),
        ("--shard half --resume nowhere", "write part and parts as 2/16"),
        ("--shard 1/2 --resume nowhere --output map.npz", "kickdrift merge"),
        ("--output no/such/folder/map.npz", "there is no folder no/such/folder: make it first"),
    ] {
        let line = refused(&format!("{GRID} {flags}"), &[]);
        assert!(line.contains(says), "{flags}: {line}");
    }
    assert!(!Path::new("nowhere").exists());
}
