//! `word --check`: what authors claim about their words, held against what is found.

use super::support::{Desk, Ended};

/// The end of `word --check` on this text.
fn check(text: &str) -> Ended {
    let desk = Desk::new();
    desk.write("claims.toml", text);
    desk.run(&["word", "--check", "claims.toml"])
}

/// The end of a check of one word with these claims.
fn claim(word: &str, claims: &str) -> Ended {
    check(&format!("[[word]]\n{word}\n{claims}\n"))
}

/// The lines of a check that ends with 1.
fn failing(word: &str, claims: &str) -> String {
    let ended = claim(word, claims);
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(1), ""), "{word} {claims}: {}", ended.stdout);
    ended.stdout
}

/// The one line on standard error of a file that cannot be checked.
fn refused(text: &str) -> String {
    let ended = check(text);
    assert_eq!((ended.code, ended.stdout.as_str()), (Some(2), ""), "{text}");
    ended.stderr
}

fn data(name: &str) -> String {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("data/words").join(name);
    std::fs::read_to_string(path).unwrap()
}

const VERLET: &str = "word = \"K(1/2) D(1) K(1/2)\"";

#[test]
fn claims_that_hold_end_with_0_and_one_line() {
    let ended = check(&data("claims.toml"));
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""), "{}", ended.stdout);
    assert_eq!(ended.stdout, "17 claims about 6 words: all hold\n");
}

/// JuliaGNI/GeometricIntegrators.jl 220.
#[test]
fn coefficients_in_the_wrong_order_are_found_with_order_2_and_the_commutators_that_are_left_over() {
    let ended = check(&data("swapped.toml"));
    assert_eq!(ended.code, Some(1));
    let lines: Vec<&str> = ended.stdout.lines().collect();
    assert_eq!(
        lines,
        [
            "claims.toml:10: McLachlan 1995, five stages: general_order is 2, not 4: its error begins with -19/600 [B,[A,B]] - 19/600 [A,[A,B]]",
            "claims.toml:11: McLachlan 1995, five stages: limit is 2.6301821907026761(3), not 3.0355: 4.1e-1 less",
            "claims about a word that do not hold: 2 of 3",
        ]
    );
}

#[test]
fn each_claim_that_does_not_hold_has_a_line_with_what_is_in_its_way() {
    for (word, claims, line) in [
        (VERLET, "order = 4", "order is 2 on oscillators, not 4: its error begins with "),
        (VERLET, "order = 1", "order is 2 on oscillators, not 1\n"),
        (VERLET, "nystrom_order = 4", "nystrom_order is 2, not 4: its error begins with "),
        (VERLET, "symmetric = false", "symmetric is true, not false\n"),
        (VERLET, "consistent = false", "consistent is true, not false\n"),
        (VERLET, "limit = \"none\"", "limit is 2, not none\n"),
        ("method = \"midpoint\"", "limit = 4", "limit is none, not 4\n"),
        (
            "method = \"mclachlan-atela-4\"",
            "general_order = 4",
            "general_order is 3 nominally (1 exactly), not 4: its error begins with -1.768060e-3 [B,[B,[A,B]]]\n",
        ),
        (
            "word = \"K(1/2) D(1) K(1/3)\"",
            "consistent = true",
            "consistent is false, not true: the coefficients of K sum to 5/6\n",
        ),
        (
            "word = \"K(1/3) D(1/2) K(1/3) D(1/4) K(1/3) D(1/4)\"",
            "symmetric = true",
            "symmetric is false, not true: letter 1 is K(1/3), its mirror image D(1/4)\n",
        ),
    ] {
        let told = failing(word, claims);
        assert!(told.contains(line), "{claims}: {told}");
    }
}

#[test]
fn a_limit_is_held_to_half_a_unit_of_its_last_decimal_and_exactly_without_decimals() {
    // 1.57340195...
    let forest = "method = \"forest-ruth\"";
    for right in ["1.6", "1.57", "1.573", "1.5734", "1.57340"] {
        assert_eq!(claim(forest, &format!("limit = {right}")).code, Some(0), "{right}");
    }
    for wrong in ["1.58", "1.574", "1.5733", "1.57341", "2", "\"11/7\"", "\"sqrt(2)\""] {
        failing(forest, &format!("limit = {wrong}"));
    }
    for right in ["2", "2.0", "2.000", "\"sqrt(4)\"", "\"4/2\""] {
        assert_eq!(claim(VERLET, &format!("limit = {right}")).code, Some(0), "{right}");
    }
    failing(VERLET, "limit = \"2+1/10^30\"");
    // Its square alone is rational: 17 digits of it are no exact claim.
    let chin = "word = \"K(1/6) D(1/2) K(2/3, -1/36) D(1/2) K(1/6)\"";
    assert_eq!(claim(chin, "limit = \"2*sqrt(3)\"").code, Some(0));
    failing(chin, "limit = \"3.4641016151377546/1\"");
}

#[test]
fn rounded_coefficients_are_taken_nominally() {
    let rounded = "method = \"bcss-3-decimals\"";
    assert_eq!(claim(rounded, "limit = 4.662\norder = 2\nconsistent = true").code, Some(0));
}

#[test]
fn an_order_on_oscillators_alone_is_told() {
    let ended = claim("method = \"mclachlan-atela-4\"", "order = 4");
    assert_eq!(ended.code, Some(0));
    assert!(ended.stdout.contains("note: order = 4 is the order on oscillators; on all problems it is 3"));
}

#[test]
fn a_malformed_file_ends_with_2_and_its_line_and_key() {
    let verlet = "[[word]]\nword = \"K(1/2) D(1) K(1/2)\"\n";
    for (key, told) in [
        ("ordr = 1", "claims.toml:3: ordr = 1: unknown; did you mean order?\n"),
        ("order = = 1", "claims.toml:3: this is no TOML ("),
        ("order = [1]", "claims.toml:3: order = array: write a number, "),
        ("order = -1", "claims.toml:3: order = -1: write a whole number"),
        ("symmetric = 1", "claims.toml:3: symmetric = 1: write true or false\n"),
        ("limit = nan", "claims.toml:3: limit = nan: write a positive number "),
        ("limit = -2", "claims.toml:3: limit = -2: write a positive number "),
        ("general_order = 12", "claims.toml:3: general_order = 12: orders above 9 "),
        ("", "claims.toml:1: claims missing: nothing is claimed: "),
    ] {
        let line = refused(&format!("{verlet}{key}\n"));
        assert!(line.starts_with(&format!("kickdrift: {told}")), "{key}: {line}");
    }
    for (text, told) in [
        ("[[word]]\n\nword = \"K(1 D(1)\"\norder = 1\n", "claims.toml:3: word = K(1 D(1): character "),
        (
            "[[word]]\nmethod = \"midpoint\"\ngeneral_order = 2\n",
            "claims.toml:3: general_order = 2: cannot be checked, as the midpoint rule C ",
        ),
        ("[[word]]\nmethod = \"respa-4\"\nlimit = 2\n", "claims.toml:1: lambda1 missing: "),
        ("[[word]]\norder = 1\n", "claims.toml:1: word missing: add word = "),
        ("[word]\nmethod = \"pefrl\"\norder = 1\n", "claims.toml:1: key = word: write [[word]] above "),
        ("words = 1\n", "claims.toml:1: key = words: is no part of a word: write [[word]] "),
        ("", "claims.toml = empty: write [[word]] above "),
    ] {
        let line = refused(text);
        assert!(line.starts_with(&format!("kickdrift: {told}")), "{text}: {line}");
    }
}

#[test]
fn several_files_are_checked_at_once() {
    let desk = Desk::new();
    desk.write("a.toml", &data("claims.toml"));
    desk.write("b.toml", &data("swapped.toml"));
    let ended = desk.run(&["word", "--check", "a.toml", "b.toml"]);
    assert_eq!(ended.code, Some(1));
    assert!(
        ended.stdout.starts_with("b.toml:10: ") && ended.stdout.ends_with("do not hold: 2 of 20\n"),
        "{}",
        ended.stdout
    );
}

#[test]
fn a_check_is_a_document_that_is_verified() {
    let desk = Desk::new();
    desk.write("swapped.toml", &data("swapped.toml"));
    let ended = desk.run(&["word", "--check", "swapped.toml", "--output", "d.json"]);
    assert_eq!(ended.code, Some(1), "{}", ended.stderr);
    assert_eq!(desk.run(&["verify", "d.json"]).code, Some(0));
    let document = String::from_utf8(desk.read("d.json")).unwrap();
    desk.write("d.json", &document.replace("\"failed\": 2", "\"failed\": 1"));
    assert_eq!(desk.run(&["verify", "d.json"]).code, Some(2));
}
