//! The help: its examples run, and every command has some.

use crate::support::{Desk, stdout};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

#[test]
fn every_command_has_examples_that_run_and_tells_its_exit_codes() {
    let help = stdout(&["--help"]);
    let commands = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let commands: Vec<&str> = commands
        .take_while(|line| line.starts_with("  "))
        .filter_map(|line| line.strip_prefix("  ")?.split(' ').next())
        .filter(|name| !name.is_empty() && *name != "help")
        .collect();
    assert_eq!(commands.len(), 22, "{commands:?}");
    let desk = Desk::new();
    for command in commands {
        let help = stdout(&[command, "--help"]);
        assert!(help.contains("Exit codes:"), "{command}");
        let examples: Vec<String> = help
            .lines()
            .filter_map(|line| line.trim().strip_prefix("kickdrift "))
            .map(|line| line.replace("data/", &format!("{ROOT}/data/")))
            .collect();
        assert!(!examples.is_empty(), "{command}");
        // The parts that merge joins come from other machines; a page is served until it is interrupted.
        let runs = |example: &&String| !["merge", "explore"].iter().any(|name| example.starts_with(name));
        for example in examples.iter().filter(runs) {
            // What stands in double quotes is one argument.
            let parts = example.split('"').enumerate();
            let arguments: Vec<&str> = parts
                .flat_map(|(n, part)| if n % 2 == 1 { vec![part] } else { part.split_whitespace().collect() })
                .collect();
            let ended = desk.run(&arguments);
            assert_eq!(ended.code, Some(0), "{example}: {}", ended.stderr);
        }
    }
}

#[test]
fn the_usage_shows_what_is_required() {
    for (command, part) in
        [("tongues", "(--ratio <P/Q> | --max-sum <N>)"), ("map", "--step <D>"), ("verdict", "--h2 <B>")]
    {
        let help = stdout(&[command, "--help"]);
        let usage = help.lines().find(|line| line.starts_with("Usage:")).unwrap();
        assert!(usage.contains(part), "{usage}");
    }
}
