#![no_main]
libfuzzer_sys::fuzz_target!(|sketch: squinch_fuzz::sketch::Sketch| squinch_fuzz::mesh(&sketch));
