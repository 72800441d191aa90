//! Constrained bonds: they do not vibrate, so they are on no clock.
//!
//! Assumed is that constraints are solved to convergence at every innermost step, and that the periods given
//! are those of the constrained molecule. Then the projected forces have a potential again, and the proofs
//! for kicks and drifts hold for small motions on the constraints.

use super::mode::Mode;
use number::{Error, Result};

/// Which bonds are held.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Constraints {
    /// Those with a hydrogen.
    HBonds,
    AllBonds,
    /// The modes of these names.
    Named(Vec<String>),
}

impl Constraints {
    /// `h-bonds`, `all-bonds` or names, `OH,NH`.
    pub fn parse(text: &str) -> Constraints {
        match text.trim() {
            "h-bonds" => Constraints::HBonds,
            "all-bonds" => Constraints::AllBonds,
            names => Constraints::Named(names.split(',').map(|name| name.trim().into()).collect()),
        }
    }

    fn hold(&self, mode: &Mode) -> bool {
        match self {
            Constraints::HBonds => mode.is_bond_with_hydrogen() == Some(true),
            Constraints::AllBonds => mode.bond.is_some(),
            Constraints::Named(names) => names.contains(&mode.name),
        }
    }

    /// The modes that vibrate, and those that are held.
    ///
    /// # Errors
    /// A name that no mode has; where none is left.
    pub fn split(&self, modes: Vec<Mode>) -> Result<(Vec<Mode>, Vec<Mode>)> {
        if let Constraints::Named(names) = self {
            let missing = names.iter().find(|name| modes.iter().all(|mode| mode.name != **name));
            if let Some(name) = missing {
                let remedy =
                    "there is no mode of this name: write h-bonds, all-bonds or names of modes, as OH,NH";
                return Err(Error::input("constraints", name, remedy));
            }
        }
        let (held, free): (Vec<Mode>, Vec<Mode>) = modes.into_iter().partition(|mode| self.hold(mode));
        if free.is_empty() && !held.is_empty() {
            let names: Vec<&str> = held.iter().map(|mode| mode.name.as_str()).collect();
            let remedy =
                "all modes given are constrained: give the fastest period that is left, as angle=19.45fs";
            return Err(Error::input("constraints", names.join(", "), remedy));
        }
        Ok((free, held))
    }
}
