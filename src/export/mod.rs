//! Writers: Mesh → files. One file a format; a writer says what its format cannot hold.

pub mod picture;
