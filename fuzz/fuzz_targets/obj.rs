#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| ik_arm_fuzz::obj(data));
