//! Runs [`cloudtouch_fuzzing::query`] under libFuzzer.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cloudtouch_fuzzing::query(bytes));
