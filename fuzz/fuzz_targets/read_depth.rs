//! Runs [`cloudtouch_fuzzing::read_depth`] under libFuzzer.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cloudtouch_fuzzing::read_depth(bytes));
