//! Assembles programs of the classic Berkeley packet filter, with labels instead of distances.
//!
//! The machine has an accumulator, an index register and sixteen memory cells. A load outside the packet ends the
//! program, and the packet is dropped. Jumps only go forward, so a program has no loops.

/// One instruction in the format of the kernel (`struct sock_filter`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Instruction {
    pub code: u16,
    /// Instructions to skip if the condition holds.
    pub yes: u8,
    /// Instructions to skip if it does not.
    pub no: u8,
    pub operand: u32,
}

/// Operation codes, `linux/bpf_common.h`.
pub(super) mod code {
    pub const LOAD_WORD: u16 = 0x20;
    pub const LOAD_WORD_AT_INDEX: u16 = 0x40;
    pub const LOAD_HALF_AT_INDEX: u16 = 0x48;
    pub const LOAD_BYTE_AT_INDEX: u16 = 0x50;
    pub const LOAD_CELL: u16 = 0x60;
    pub const LOAD_LENGTH: u16 = 0x80;
    pub const INDEX_FROM_CONSTANT: u16 = 0x01;
    pub const INDEX_FROM_CELL: u16 = 0x61;
    pub const STORE: u16 = 0x02;
    pub const STORE_INDEX: u16 = 0x03;
    pub const ADD: u16 = 0x04;
    pub const ADD_INDEX: u16 = 0x0c;
    pub const SUBTRACT_INDEX: u16 = 0x1c;
    pub const MULTIPLY: u16 = 0x24;
    pub const OR_INDEX: u16 = 0x4c;
    pub const AND: u16 = 0x54;
    pub const SHIFT_LEFT: u16 = 0x64;
    pub const SHIFT_RIGHT: u16 = 0x74;
    pub const JUMP: u16 = 0x05;
    pub const IF_EQUAL: u16 = 0x15;
    pub const IF_GREATER: u16 = 0x25;
    pub const IF_GREATER_THAN_INDEX: u16 = 0x2d;
    pub const IF_BITS: u16 = 0x45;
    pub const RETURN: u16 = 0x06;
    pub const INDEX_FROM_ACCUMULATOR: u16 = 0x07;
    pub const ACCUMULATOR_FROM_INDEX: u16 = 0x87;
}

/// Most instructions that the kernel accepts (`BPF_MAXINSNS`).
pub(super) const MOST_INSTRUCTIONS: usize = 4096;

/// A place in a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Label(usize);

#[derive(Debug, Clone, Copy)]
enum Item {
    Plain { code: u16, operand: u32 },
    Jump(Label),
    Branch { code: u16, operand: u32, yes: Label, no: Label },
    Place(Label),
}

/// A program that is being written.
#[derive(Debug, Default)]
pub(super) struct Assembler {
    items: Vec<Item>,
    labels: usize,
}

impl Assembler {
    /// Creates a label, which is placed later.
    pub fn label(&mut self) -> Label {
        self.labels += 1;
        Label(self.labels - 1)
    }

    /// Places a label here.
    pub fn place(&mut self, label: Label) {
        self.items.push(Item::Place(label));
    }

    /// Adds an instruction without a jump.
    pub fn plain(&mut self, code: u16, operand: u32) {
        self.items.push(Item::Plain { code, operand });
    }

    /// Jumps to a label further down.
    pub fn jump(&mut self, label: Label) {
        self.items.push(Item::Jump(label));
    }

    /// Jumps to one of two labels further down.
    pub fn branch(&mut self, code: u16, operand: u32, yes: Label, no: Label) {
        self.items.push(Item::Branch { code, operand, yes, no });
    }

    /// Jumps to `yes`, or continues with the next instruction.
    pub fn branch_if(&mut self, code: u16, operand: u32, yes: Label) {
        let next = self.label();
        self.branch(code, operand, yes, next);
        self.place(next);
    }

    /// Jumps to `no`, or continues with the next instruction.
    pub fn branch_unless(&mut self, code: u16, operand: u32, no: Label) {
        let next = self.label();
        self.branch(code, operand, next, no);
        self.place(next);
    }

    /// Returns the finished program; `None` if a label is missing or lies before its jump, or if the program is too
    /// long.
    ///
    /// A condition reaches 255 instructions. For longer distances it is followed by a jump, which reaches any distance.
    pub fn assemble(&self) -> Option<Vec<Instruction>> {
        // For each item: whether its `yes` and its `no` need a separate jump.
        let mut far = vec![(false, false); self.items.len()];
        let places = loop {
            let places = self.places(&far);
            let mut grown = false;
            let mut at = 0;
            for (item, far) in self.items.iter().zip(&mut far) {
                if let Item::Branch { yes, no, .. } = item {
                    for (label, far) in [(yes, &mut far.0), (no, &mut far.1)] {
                        let distance = places.get(label.0).copied().flatten()?.checked_sub(at + 1)?;
                        if distance > u8::MAX as usize && !*far {
                            *far = true;
                            grown = true;
                        }
                    }
                }
                at += size(item, *far);
            }
            if !grown {
                break places;
            }
        };
        let mut program = Vec::new();
        for (item, far) in self.items.iter().zip(&far) {
            emit(item, *far, &places, &mut program)?;
        }
        (program.len() <= MOST_INSTRUCTIONS).then_some(program)
    }

    fn places(&self, far: &[(bool, bool)]) -> Vec<Option<usize>> {
        let mut places = vec![None; self.labels];
        let mut at = 0;
        for (item, far) in self.items.iter().zip(far) {
            if let Item::Place(label) = item {
                places[label.0] = Some(at);
            }
            at += size(item, *far);
        }
        places
    }
}

fn size(item: &Item, far: (bool, bool)) -> usize {
    match item {
        Item::Place(_) => 0,
        Item::Plain { .. } | Item::Jump(_) => 1,
        Item::Branch { .. } => 1 + usize::from(far.0) + usize::from(far.1),
    }
}

fn emit(item: &Item, far: (bool, bool), places: &[Option<usize>], program: &mut Vec<Instruction>) -> Option<()> {
    let at = program.len();
    let distance = |from: usize, label: Label| places.get(label.0).copied().flatten()?.checked_sub(from + 1);
    let jump = |from: usize, label: Label| {
        let operand = u32::try_from(distance(from, label)?).ok()?;
        Some(Instruction { code: code::JUMP, yes: 0, no: 0, operand })
    };
    match *item {
        Item::Place(_) => {}
        Item::Plain { code, operand } => program.push(Instruction { code, yes: 0, no: 0, operand }),
        Item::Jump(label) => program.push(jump(at, label)?),
        Item::Branch { code, operand, yes, no } => {
            let near = |label: Label| u8::try_from(distance(at, label)?).ok();
            let to_yes = if far.0 { 0 } else { near(yes)? };
            let to_no = if far.1 { u8::from(far.0) } else { near(no)? };
            program.push(Instruction { code, yes: to_yes, no: to_no, operand });
            if far.0 {
                program.push(jump(at + 1, yes)?);
            }
            if far.1 {
                program.push(jump(program.len(), no)?);
            }
        }
    }
    Some(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::interpreter::run;
    use super::*;

    /// Returns 1 where the first byte is 7, else 2, over a distance.
    fn first_byte_is_seven(distance: usize) -> Option<Vec<Instruction>> {
        let mut program = Assembler::default();
        let (yes, no) = (program.label(), program.label());
        program.plain(code::LOAD_BYTE_AT_INDEX, 0);
        program.branch(code::IF_EQUAL, 7, yes, no);
        for _ in 0..distance {
            program.plain(code::RETURN, 9);
        }
        program.place(yes);
        program.plain(code::RETURN, 1);
        program.place(no);
        program.plain(code::RETURN, 2);
        program.assemble()
    }

    #[test]
    fn conditions_reach_any_distance() {
        for distance in [0, 1, 254, 255, 256, 3000] {
            let program = first_byte_is_seven(distance).unwrap();
            assert_eq!((run(&program, &[7]), run(&program, &[8])), (1, 2), "{distance}");
        }
    }

    #[test]
    fn what_the_kernel_would_refuse_is_not_assembled() {
        assert_eq!(first_byte_is_seven(MOST_INSTRUCTIONS), None);
        let mut program = Assembler::default();
        let nowhere = program.label();
        program.jump(nowhere);
        assert_eq!(program.assemble(), None);
        let mut program = Assembler::default();
        let back = program.label();
        program.place(back);
        program.jump(back);
        assert_eq!(program.assemble(), None);
    }
}
