//! Runs [`cloudtouch_fuzzing::case_file`] under libFuzzer.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cloudtouch_fuzzing::case_file(bytes));
