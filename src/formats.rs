//! Lists of formats. Each format is one line, from which the macro makes the enum, the list of all and the access to
//! facts.

/// Makes an enum of formats with `ALL`, in the order of the lines, and `facts`, the properties of each format.
macro_rules! formats {
    ($(#[$about:meta])* pub enum Format: $Facts:ident { $($(#[$doc:meta])* $format:ident = $facts:path,)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Format {
            $($(#[$doc])* $format,)*
        }

        impl Format {
            /// Every format, in the order in which they are listed and in which first bytes are compared.
            pub const ALL: [Self; [$(Self::$format),*].len()] = [$(Self::$format),*];

            const fn facts(self) -> &'static $Facts {
                match self {
                    $(Self::$format => &$facts,)*
                }
            }
        }
    };
}
pub(crate) use formats;
