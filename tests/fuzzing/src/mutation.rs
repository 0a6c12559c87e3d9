//! Good bytes made bad, the same way every time.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Longest that repeating a part makes them: enough to see that something grows faster than its input.
const LONGEST_REPEAT: usize = 32 * 1024;
/// Texts that numbers in a text are replaced with.
const NUMBERS: [&str; 9] =
    ["-1", "0", "1e308", "-1e-320", "nan", "inf", "99999999999999999999", "2147483648", "18446744073709551615"];
/// Whole numbers that lengths and counts in binary formats are replaced with.
const WORDS: [u64; 8] = [0, 1, 0x7f, 0xffff, 0x7fff_ffff, 0xffff_ffff, i64::MAX as u64, u64::MAX];

/// Draws changes.
pub struct Mutator {
    numbers: ChaCha8Rng,
}

impl Mutator {
    /// With the same seed the same changes.
    pub fn new(seed: u64) -> Mutator {
        Mutator { numbers: ChaCha8Rng::seed_from_u64(seed) }
    }

    fn below(&mut self, limit: usize) -> usize {
        self.numbers.random_range(0..limit.max(1))
    }

    /// One of the seeds, with a few changes.
    pub fn changed(&mut self, seeds: &[Vec<u8>]) -> Vec<u8> {
        let Some(seed) = seeds.get(self.below(seeds.len())) else { return Vec::new() };
        let mut bytes = seed.clone();
        // Mostly few: after many nothing of a format is left, and only its first check is tried.
        for _ in 0..1 + self.below(3) * self.below(3) {
            self.change(&mut bytes, seeds);
        }
        bytes
    }

    fn change(&mut self, bytes: &mut Vec<u8>, seeds: &[Vec<u8>]) {
        let at = self.below(bytes.len());
        let end = (at + self.below(40)).min(bytes.len());
        let at = at.min(end);
        match self.below(11) {
            0 if !bytes.is_empty() => bytes[at] ^= 1 << self.below(8),
            1 if !bytes.is_empty() => bytes[at] = [0, 0x7f, 0x80, 0xff][self.below(4)],
            2 if self.below(4) == 0 => bytes.truncate(at),
            3 => bytes.insert(at, self.numbers.random()),
            4 => {
                let part = bytes[at..end].to_vec();
                let to = self.below(bytes.len() + 1);
                bytes.splice(to..to, part);
            }
            5 => self.word(bytes, at),
            6 => self.digit(bytes),
            7 => self.number(bytes),
            8 => {
                // A part of another good one.
                let Some(other) = seeds.get(self.below(seeds.len())) else { return };
                let from = self.below(other.len());
                let to = (from + self.below(200)).min(other.len());
                bytes.splice(at..end, other[from.min(to)..to].iter().copied());
            }
            9 if self.below(8) == 0 => {
                let part = bytes[at..end].to_vec();
                let times = LONGEST_REPEAT / part.len().max(1);
                bytes.splice(at..end, part.repeat(1 + self.below(times)));
            }
            _ => {
                bytes.drain(at..end);
            }
        }
    }

    /// A whole number of 2 to 8 bytes of either order.
    fn word(&mut self, bytes: &mut [u8], at: usize) {
        let (word, length) = (WORDS[self.below(WORDS.len())], [2, 4, 8][self.below(3)]);
        let word = if self.below(2) == 0 { word.to_le_bytes() } else { (word << (64 - 8 * length)).to_be_bytes() };
        for (byte, new) in bytes.iter_mut().skip(at).take(length).zip(word) {
            *byte = new;
        }
    }

    fn digit(&mut self, bytes: &mut [u8]) {
        let digits: Vec<usize> = (0..bytes.len()).filter(|at| bytes[*at].is_ascii_digit()).collect();
        if let Some(at) = digits.get(self.below(digits.len())) {
            bytes[*at] = b'0' + self.below(10) as u8;
        }
    }

    fn number(&mut self, bytes: &mut Vec<u8>) {
        let is_start = |at: &usize| bytes[*at].is_ascii_digit() && (*at == 0 || !bytes[*at - 1].is_ascii_digit());
        let starts: Vec<usize> = (0..bytes.len()).filter(is_start).collect();
        if let Some(&at) = starts.get(self.below(starts.len())) {
            let length = bytes[at..].iter().take_while(|byte| byte.is_ascii_digit()).count();
            let number = NUMBERS[self.below(NUMBERS.len())];
            bytes.splice(at..at + length, number.bytes());
        }
    }
}
