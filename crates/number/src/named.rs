//! Enums whose variants have names: in documents, in files, on the command line.

/// An enum of variants without fields, each declared with its name: `ALL` has them in their order, `name` is
/// the one declared.
#[doc(hidden)]
#[macro_export]
macro_rules! named {
    (
        $(#[$meta:meta])*
        $visible:vis enum $Name:ident { $($(#[$about:meta])* $Variant:ident = $name:literal,)* }
    ) => {
        $(#[$meta])*
        $visible enum $Name {
            $($(#[$about])* $Variant,)*
        }

        impl $Name {
            /// All of them, in their order.
            pub const ALL: [$Name; [$($name),*].len()] = [$($Name::$Variant),*];

            /// Their names, in the same order.
            pub const NAMES: &'static [&'static str] = &[$($name),*];

            /// The one of this name.
            pub fn named(name: &str) -> Option<$Name> {
                match name {
                    $($name => Some($Name::$Variant),)*
                    _ => None,
                }
            }

            /// The name in documents.
            pub const fn name(self) -> &'static str {
                match self {
                    $($Name::$Variant => $name,)*
                }
            }
        }
    };
}
