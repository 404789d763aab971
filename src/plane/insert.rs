//! Locating, cavities (looking) and filling (acting); removal.
