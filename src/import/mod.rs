//! Readers: files → Drawing. One file a format; no cleaning here.

pub mod vtu;
