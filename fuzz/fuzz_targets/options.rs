//! Runs [`cloudtouch_fuzzing::options`] under libFuzzer.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cloudtouch_fuzzing::options(bytes));
