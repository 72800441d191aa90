//! The grammar that numbers of every kind share: sums, products and signs.

use std::ops::Neg;

/// An operator between two numbers.
#[derive(Clone, Copy, PartialEq)]
pub enum Operation {
    Plus,
    Minus,
    Times,
    Over,
}

/// A text and the place in it, with the atoms, powers and limits of its own kind of numbers.
pub trait Arithmetic {
    type Value: Neg<Output = Self::Value>;
    type Error;

    /// The place, in characters.
    fn at(&self) -> usize;

    /// Passes over this character if it comes next.
    fn skip(&mut self, wanted: char) -> bool;

    /// An atom, with a power or without.
    fn power(&mut self) -> Result<Self::Value, Self::Error>;

    /// One operation, which was written at this place, within the limits.
    fn combined(
        &mut self,
        at: usize,
        a: &Self::Value,
        operation: Operation,
        b: &Self::Value,
    ) -> Result<Self::Value, Self::Error>;

    /// sum = product (("+" | "-") product)*
    fn sum(&mut self) -> Result<Self::Value, Self::Error> {
        self.row([('+', Operation::Plus), ('-', Operation::Minus)], Self::product)
    }

    /// product = signed (("*" | "/") signed)*
    fn product(&mut self) -> Result<Self::Value, Self::Error> {
        self.row([('*', Operation::Times), ('/', Operation::Over)], Self::signed)
    }

    /// signed = ("-" | "+")* power
    fn signed(&mut self) -> Result<Self::Value, Self::Error> {
        let mut negative = false;
        loop {
            if self.skip('-') {
                negative = !negative;
            } else if !self.skip('+') {
                let value = self.power()?;
                return Ok(if negative { -value } else { value });
            }
        }
    }

    /// part (operation part)*, from the left.
    fn row(
        &mut self,
        operations: [(char, Operation); 2],
        part: fn(&mut Self) -> Result<Self::Value, Self::Error>,
    ) -> Result<Self::Value, Self::Error> {
        let mut value = part(self)?;
        loop {
            let at = self.at();
            let found = operations.into_iter().find(|&(sign, _)| self.skip(sign));
            let Some((_, operation)) = found else { return Ok(value) };
            let next = part(self)?;
            value = self.combined(at, &value, operation, &next)?;
        }
    }
}
