//! The operators of a ring type, from five functions on references.

/// Implements `+ - *` on values and references, `+= -= *=` and unary minus for a type that has
/// `sum`, `difference`, `times` and `negated`, each taking references; and makes it a [`Ring`](crate::Ring)
/// in which `$from` is the rational `$x`.
macro_rules! ring_operators {
    ([$($generics:tt)*] $type:ty, |$x:ident| $from:expr) => {
        impl<$($generics)*> $crate::Ring for $type {
            fn from_rational($x: &$crate::Rational) -> Self {
                $from
            }

            fn add_product(&mut self, a: &Self, b: &Self) {
                *self += a.times(b);
            }

            fn sub_product(&mut self, a: &Self, b: &Self) {
                *self -= a.times(b);
            }

            fn product(a: &Self, b: &Self) -> Self {
                a.times(b)
            }
        }

        ring_operators!(@binary [$($generics)*] $type, Add, add, sum, AddAssign, add_assign);
        ring_operators!(@binary [$($generics)*] $type, Sub, sub, difference, SubAssign, sub_assign);
        ring_operators!(@binary [$($generics)*] $type, Mul, mul, times, MulAssign, mul_assign);

        impl<$($generics)*> std::ops::Neg for $type {
            type Output = $type;
            fn neg(self) -> $type {
                self.negated()
            }
        }

        impl<$($generics)*> std::ops::Neg for &$type {
            type Output = $type;
            fn neg(self) -> $type {
                self.negated()
            }
        }
    };
    (@binary [$($generics:tt)*] $type:ty, $op:ident, $method:ident, $by:ident, $assign:ident, $assign_method:ident) => {
        impl<$($generics)*> std::ops::$op for $type {
            type Output = $type;
            fn $method(self, other: $type) -> $type {
                self.$by(&other)
            }
        }

        impl<$($generics)*> std::ops::$op<&$type> for &$type {
            type Output = $type;
            fn $method(self, other: &$type) -> $type {
                self.$by(other)
            }
        }

        impl<$($generics)*> std::ops::$assign for $type {
            fn $assign_method(&mut self, other: $type) {
                *self = self.$by(&other);
            }
        }

        impl<$($generics)*> std::ops::$assign<&$type> for $type {
            fn $assign_method(&mut self, other: &$type) {
                *self = self.$by(other);
            }
        }
    };
}

pub(super) use ring_operators;
