#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| squinch_fuzz::read_mesh(bytes));
