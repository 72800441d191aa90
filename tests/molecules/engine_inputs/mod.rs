//! Small inputs in the style of each engine's documentation, with what the engine itself does with them: its
//! steps, or that it refuses.
//!
//! LAMMPS and OpenMM were asked: inputs and scripts ran, and the steps are those that they took. The others'
//! rules are in the files.

mod ipi;
mod lines;
mod logs;
mod openmm;
mod serialized;
mod tinker;

use std::time::Duration;

use kickdrift::advise::engine::{Engine, Reading, read};
use kickdrift::advise::unit::decimal;
use kickdrift::error::Error;
use kickdrift::number::rational::ratio;

fn steps(reading: &Reading) -> String {
    reading.scheme.steps().iter().map(decimal).collect::<Vec<_>>().join(",")
}

/// Read alone; a run of Tinker is started with 3 fs.
fn of(text: &str) -> Result<Reading, Error> {
    read(&[text], Some(&ratio(3, 1)))
}

/// Each text has these steps.
fn all_have_their_steps(engine: Engine, texts: &[(&str, &str)]) {
    for (text, expected) in texts {
        let reading = of(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!((reading.engine, steps(&reading).as_str()), (engine, *expected), "{text}");
        assert_eq!(reading.forces.len(), reading.scheme.steps().len(), "{text}: {:?}", reading.forces);
        assert!(!reading.used.is_empty(), "{text}");
        // What is rewritten reads as the new step, in a number that is no fraction.
        let outer = reading.scheme.last_but_one() * ratio(2, 1);
        if let Ok(new) = reading.rewritten(&outer) {
            let again = read(&[&new], Some(&outer)).unwrap_or_else(|error| panic!("{new}: {error}"));
            assert_eq!(again.scheme.outer(), &outer, "{new}");
            assert!(
                !new.lines().any(|line| line.contains('/') && !text.contains(line) && line.len() < 30),
                "{new}"
            );
        }
    }
}

/// Each text is refused, about this field, in a message of one line that has these words.
fn all_are_refused(texts: &[(&str, &str, &str)]) {
    for (text, field, words) in texts {
        let error = of(text).err().unwrap_or_else(|| panic!("{text}: is read"));
        let message = error.to_string();
        assert!(
            error.field() == *field && message.contains(words) && !message.contains('\n'),
            "{text}: {message}"
        );
    }
}

/// The processor time of this thread so far, which a busy machine leaves as it is.
#[cfg(unix)]
fn thread_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.try_into().unwrap()
}

#[cfg(not(unix))]
fn thread_time() -> Duration {
    std::time::SystemTime::UNIX_EPOCH.elapsed().unwrap()
}
