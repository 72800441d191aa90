//! Products of very many slowly varying factors: a giant partial quotient, two steps near a simple ratio.
//!
//! The branch's interval is halved until on each piece one of two forms holds. Where the factor's two
//! multipliers stay apart, it is brought to [`Normal`] form, in which factors commute and their product is a
//! closed sum. Where they meet, at |Tr| = 2, the piece is so short that all its factors together do little:
//! they are [`Near`] the identity in fit coordinates, and powers of two of them are functions on all of the
//! piece. So the pieces are as many as the logarithm of the quotient.

mod near;
mod normal;

use std::collections::HashMap;
use std::rc::Rc;

use super::branch::{Branch, Budget};
use super::coefficient::Coefficient;
use super::map::Map;
use super::wanted::Wanted;
use near::Near;
use normal::{Normal, roundings};

/// From so many factors on, pieces are taken in place of doubling. Entries and sign changes keep more digits
/// by pieces from 2^10 factors on. Verdicts alone are found faster by doubling up to 2^12, and fewer of them
/// are lost: beside simple ratios under strong kicks 2 of 3,000, and 59 by pieces.
pub fn worth(wanted: Wanted) -> u128 {
    if wanted == Wanted::Verdict { 1 << 12 } else { 1 << 10 }
}

/// A piece of so few steps is left to its single factors.
const FEW: i128 = 32;

/// The cost of an attempt to find a normal form, in products of functions.
const ATTEMPT: u64 = 20;

/// A product that its factors' roundings leave no more digits is not begun.
const HOPELESS: f64 = 1e-6;

enum Form<T> {
    Normal(Box<Normal<T>>),
    Near(Box<Near<T>>),
    /// Single factors.
    Rough,
}

/// A branch and the forms of its pieces.
pub struct Slow<T> {
    branch: Branch<T>,
    /// The relative error of the product of a piece allowed beside roundings.
    allowed: f64,
    /// By start and length; `None` is halved.
    forms: HashMap<(i128, i128), Option<Rc<Form<T>>>>,
}

/// The product so far, in the coordinates of the last piece, and what leads out of these.
struct Chain<T> {
    product: Option<Map<T>>,
    bridge: Option<Map<T>>,
}

/// The later one after the earlier, where there is one.
pub fn after<T: Coefficient>(later: Map<T>, earlier: Option<Map<T>>, budget: &mut Budget) -> Option<Map<T>> {
    match earlier {
        Some(earlier) => budget.product(&later, &earlier),
        None => Some(later),
    }
}

impl<T: Coefficient> Chain<T> {
    /// A single factor.
    fn step(&mut self, factor: Map<T>, budget: &mut Budget) -> Option<()> {
        self.bridge = Some(after(factor, self.bridge.take(), budget)?);
        Some(())
    }

    /// The factors of a piece in its coordinates, what leads into these and out of them.
    fn go(&mut self, enter: Map<T>, product: Map<T>, leave: Map<T>, budget: &mut Budget) -> Option<()> {
        let bridge = after(enter, self.bridge.take(), budget)?;
        let entered = after(bridge, self.product.take(), budget)?;
        self.product = Some(budget.product(&product, &entered)?);
        self.bridge = Some(leave);
        Some(())
    }

    fn end(self, budget: &mut Budget) -> Option<Map<T>> {
        match self.bridge {
            Some(bridge) => after(bridge, self.product, budget).map(Map::trimmed),
            None => self.product,
        }
    }
}

impl<T: Coefficient> Slow<T> {
    pub fn new(branch: Branch<T>, allowed: f64) -> Self {
        Slow { branch, allowed, forms: HashMap::new() }
    }

    /// P_n on start..start + length, which is not longer than a stride; at a point where the length is 0.
    ///
    /// In the coordinates of each piece its factors have norms near 1. So what leads from those of one piece
    /// to those of the next, as near to 1, is multiplied first, and no bound grows by what coordinates
    /// distort.
    pub fn product(&mut self, n: u128, start: i128, length: i128, budget: &mut Budget) -> Option<Map<T>> {
        if roundings::<T>(n) > HOPELESS {
            return None;
        }
        let stride = self.branch.stride;
        let (mut x, mut left) = (start, n);
        let mut chain = Chain { product: None, bridge: None };
        while left > 0 {
            let (from, long, form) = self.form(x, budget)?;
            // All that is taken, and the state behind it, lies on the piece.
            let within = if stride > 0 {
                (x >= from).then(|| (from + long - length - x) / stride)
            } else {
                (x + length <= from + long).then(|| (x - from) / -stride)
            };
            let steps = (within.unwrap_or(0).max(0) as u128).min(left);
            let end = x + stride * steps as i128;
            let steps = match (&*form, steps) {
                (Form::Normal(normal), 2..) => {
                    let product = normal.product(steps, x, length)?;
                    chain.go(normal.enter(x, length), product, normal.leave(end, length), budget)?;
                    steps
                }
                (Form::Near(near), 2..) => {
                    let product = near.product(steps, x, length, budget)?;
                    chain.go(near.enter(), product, near.leave(), budget)?;
                    steps
                }
                _ => {
                    chain.step(self.branch.on(x, length), budget)?;
                    1
                }
            };
            x += stride * steps as i128;
            left -= steps;
        }
        chain.end(budget)
    }

    /// The piece on which the step from x lies, with its form.
    fn form(&mut self, x: i128, budget: &mut Budget) -> Option<(i128, i128, Rc<Form<T>>)> {
        let (mut from, mut long) = (self.branch.start, self.branch.length);
        loop {
            if !self.forms.contains_key(&(from, long)) {
                let form = self.found(from, long, budget)?.map(Rc::new);
                self.forms.insert((from, long), form);
            }
            if let Some(form) = &self.forms[&(from, long)] {
                return Some((from, long, form.clone()));
            }
            let half = long / 2;
            let is_below = if self.branch.stride > 0 { x < from + half } else { x <= from + half };
            (from, long) = if is_below { (from, half) } else { (from + half, long - half) };
        }
    }

    /// The form on a piece; within `Some`, `None` where it has none and is to be halved.
    #[allow(clippy::option_option)]
    fn found(&self, from: i128, long: i128, budget: &mut Budget) -> Option<Option<Form<T>>> {
        let steps = long / self.branch.stride.abs();
        if steps < FEW {
            return Some(Some(Form::Rough));
        }
        let piece = self.branch.restricted(from, long);
        if let Some(near) = Near::new(&piece, steps as u128, budget)? {
            return Some(Some(Form::Near(Box::new(near))));
        }
        if !normal::is_apart(&piece.map) {
            return Some(None);
        }
        budget.spend::<T>(ATTEMPT)?;
        Some(Normal::new(&piece, steps as u128, self.allowed).map(|normal| Form::Normal(Box::new(normal))))
    }
}
