#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| squinch_fuzz::mesh_file(bytes));
