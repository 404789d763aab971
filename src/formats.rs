//! How formats are listed: a line each, of which the enum, the list of all and the way to their facts are made.

/// An enum of formats with `ALL`, in the order of the lines, and `facts`, what there is to know of each.
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
