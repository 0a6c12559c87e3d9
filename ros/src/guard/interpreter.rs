//! Interpreter for packet filter programs, for tests: behaves as the kernel does.

use super::assembler::{Instruction, code};

/// What a program returns for a packet: 0 drops it. A load outside the packet returns 0.
pub(super) fn run(program: &[Instruction], packet: &[u8]) -> u32 {
    let (mut accumulator, mut index, mut cells) = (0_u32, 0_u32, [0_u32; 16]);
    let mut at = 0;
    loop {
        let Instruction { code, yes, no, operand } = program[at];
        at += 1;
        let load = |place: u32, bytes: usize| {
            let place = place as usize;
            let bytes = packet.get(place..place.checked_add(bytes)?)?;
            Some(bytes.iter().fold(0_u32, |value, byte| value << 8 | u32::from(*byte)))
        };
        let skip = |holds: bool| usize::from(if holds { yes } else { no });
        let at_index = index.checked_add(operand);
        match code {
            code::LOAD_WORD | code::LOAD_WORD_AT_INDEX | code::LOAD_HALF_AT_INDEX | code::LOAD_BYTE_AT_INDEX => {
                let (place, bytes) = match code {
                    code::LOAD_WORD => (Some(operand), 4),
                    code::LOAD_WORD_AT_INDEX => (at_index, 4),
                    code::LOAD_HALF_AT_INDEX => (at_index, 2),
                    _ => (at_index, 1),
                };
                let Some(value) = place.and_then(|place| load(place, bytes)) else { return 0 };
                accumulator = value;
            }
            code::LOAD_CELL => accumulator = cells[operand as usize],
            code::LOAD_LENGTH => accumulator = packet.len() as u32,
            code::INDEX_FROM_CONSTANT => index = operand,
            code::INDEX_FROM_CELL => index = cells[operand as usize],
            code::STORE => cells[operand as usize] = accumulator,
            code::STORE_INDEX => cells[operand as usize] = index,
            code::ADD => accumulator = accumulator.wrapping_add(operand),
            code::ADD_INDEX => accumulator = accumulator.wrapping_add(index),
            code::SUBTRACT_INDEX => accumulator = accumulator.wrapping_sub(index),
            code::MULTIPLY => accumulator = accumulator.wrapping_mul(operand),
            code::OR_INDEX => accumulator |= index,
            code::AND => accumulator &= operand,
            code::SHIFT_LEFT => accumulator <<= operand,
            code::SHIFT_RIGHT => accumulator >>= operand,
            code::JUMP => at += operand as usize,
            code::IF_EQUAL => at += skip(accumulator == operand),
            code::IF_GREATER => at += skip(accumulator > operand),
            code::IF_GREATER_THAN_INDEX => at += skip(accumulator > index),
            code::IF_BITS => at += skip(accumulator & operand != 0),
            code::RETURN => return operand,
            code::INDEX_FROM_ACCUMULATOR => index = accumulator,
            code::ACCUMULATOR_FROM_INDEX => accumulator = index,
            other => panic!("instruction {other:#x}"),
        }
    }
}
