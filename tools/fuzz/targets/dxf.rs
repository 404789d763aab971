#![no_main]
use squinch::import::Format;
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| squinch_fuzz::read(bytes, &[Format::Dxf]));
