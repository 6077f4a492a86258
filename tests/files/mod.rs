//! Random numbers, and damage to files.
#![allow(dead_code, reason = "each test takes what it needs")]

use glam::Vec3;
use ik_arm::io::OpenError;

/// SplitMix64.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, end: u64) -> u64 {
        self.next() % end
    }

    pub fn coin(&mut self) -> bool {
        self.below(2) == 0
    }

    pub fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len() as u64) as usize]
    }

    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * (self.next() >> 40) as f32 / 16_777_216.0
    }

    /// Any finite number, of any magnitude, and often -0.
    pub fn any(&mut self) -> f32 {
        loop {
            let value = f32::from_bits(self.next() as u32);
            if self.below(16) == 0 {
                return -0.0;
            }
            if value.is_finite() {
                return value;
            }
        }
    }

    pub fn above_0(&mut self) -> f32 {
        self.any().abs().max(f32::from_bits(1))
    }

    /// Of any magnitude.
    pub fn point(&mut self) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.any()))
    }

    pub fn point_within(&mut self, size: f32) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.between(-size, size)))
    }
}

/// What an error says, which is always something and of a readable length.
pub fn message(error: OpenError) -> String {
    let message = error.to_string();
    assert!((1..1000).contains(&message.chars().count()), "{message}");
    message
}

/// Files that are cut, have other bytes, or other values.
pub fn mutations(text: &str, random: &mut Random, count: usize) -> Vec<Vec<u8>> {
    (0..count).map(|_| mutated(text, random)).collect()
}

fn mutated(text: &str, random: &mut Random) -> Vec<u8> {
    const VALUES: [&str; 16] = [
        "null",
        "true",
        "-1",
        "1e39",
        "0",
        "4294967295",
        "1e-400",
        "\"\"",
        "[]",
        "{}",
        "[[]]",
        "3.4e38",
        "-0.0",
        "[0,0,0]",
        "18446744073709551616",
        "\"\\ud800\"",
    ];
    let mut bytes = text.as_bytes().to_vec();
    let at = |random: &mut Random| random.below(text.len() as u64) as usize;
    match random.below(4) {
        0 => bytes.truncate(at(random)),
        1 => {
            for _ in 0..=random.below(3) {
                let place = at(random);
                bytes[place] = random.next() as u8;
            }
        }
        2 => {
            let place = at(random);
            bytes[place] = random.one_of(b"0123456789-+.eE,:[]{}\"\\ \n");
        }
        _ => {
            let is_value = |byte: &u8| b":[,".contains(byte);
            let start = at(random);
            let Some(start) = bytes[start..].iter().position(is_value).map(|n| n + start + 1)
            else {
                return bytes;
            };
            let is_end = |byte: &u8| b",]}\n".contains(byte);
            let end = bytes[start..].iter().position(is_end).map_or(bytes.len(), |n| n + start);
            bytes.splice(start..end, random.one_of(&VALUES).bytes());
        }
    }
    bytes
}
