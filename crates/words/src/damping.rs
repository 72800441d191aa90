//! Letters of friction: how γ acts on the velocity.

/// How friction γ acts on the velocity over c h.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Damping {
    /// O: v ← exp(−γ c h) v.
    Exact,
    /// F: v ← (1 − γ c h) v.
    Explicit,
    /// I: v ← v/(1 + γ c h).
    Implicit,
}

impl Damping {
    /// All of them, each by its letter.
    pub const ALL: [(char, Damping); 3] =
        [('O', Damping::Exact), ('F', Damping::Explicit), ('I', Damping::Implicit)];

    /// Its letter.
    pub fn letter(self) -> char {
        let listed = Damping::ALL.into_iter().find(|(_, damping)| *damping == self);
        listed.map_or('O', |(letter, _)| letter)
    }

    /// That of a letter.
    pub(super) fn of(letter: char) -> Option<Damping> {
        Damping::ALL.into_iter().find(|(listed, _)| *listed == letter).map(|(_, damping)| damping)
    }
}
