//! The rules of the guard, as a program of the packet filter.
//!
//! The program walks the submessages of an RTPS message (RTPS 2.5, 9.4) as RustDDS does. It drops the whole message if
//! one of them would make RustDDS loop or allocate in proportion to a number in it:
//!
//! | submessage | what RustDDS 0.15.1 does | what passes |
//! |---|---|---|
//! | HEARTBEAT | lists every missing number from `firstSN` to `lastSN` | a span of [`Limits::heartbeat_span`], numbers below 2^40 |
//! | GAP | lists `gapStart` to `gapList.base`, unless it knows `gapStart` | a span of [`Limits::gap_span`], or a gap from number 1 |
//! | DATA_FRAG | allocates and clears `sampleSize` bytes, also for unknown writers | [`Limits::sample_bytes`] |
//! | NACK_FRAG | allocates a bit for every fragment up to the number asked for; number 0 ends its thread | 1 to [`Limits::fragments`] |
//!
//! A program has no loops, so the walk is unrolled; [`Shape`] sets its length. A message with more submessages is
//! dropped. Spans are compared in steps of 256: a span within the limit always passes, one that is longer by 256 never
//! does.

use super::assembler::{Assembler, Instruction, Label, code};

/// Bytes before the RTPS message in the view of a filter on a UDP socket.
const UDP_HEADER: u32 = 8;
/// Bytes of the RTPS header.
const RTPS_HEADER: u32 = 20;
/// "RTPS".
const MAGIC: u32 = 0x5254_5053;
/// Bytes of a submessage's header.
const HEADER: u32 = 4;

/// Kinds of submessages, RTPS 9.4.5.1.
mod kind {
    pub const PAD: u32 = 0x01;
    pub const HEARTBEAT: u32 = 0x07;
    pub const GAP: u32 = 0x08;
    pub const INFO_TS: u32 = 0x09;
    pub const NACK_FRAG: u32 = 0x12;
    pub const DATA: u32 = 0x15;
    pub const DATA_FRAG: u32 = 0x16;
}

/// Header of an INFO_TS with a timestamp, little endian, as every peer on a PC or ARM sends it.
const TIME_STAMP: u32 = 0x0901_0800;
/// Its length, bytes.
const TIME_STAMP_BYTES: u32 = 12;

/// Memory cells.
const OFFSET: u32 = 0;
const FIRST: u32 = 1;
const PART: u32 = 2;
const HIGH: u32 = 3;

/// Limits of what passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Limits {
    /// Most numbers that a HEARTBEAT may announce; a multiple of 256.
    pub heartbeat_span: u32,
    /// Most numbers that a GAP may declare irrelevant, unless it begins with number 1; a multiple of 256.
    pub gap_span: u32,
    /// Samples in fragments must be smaller than this; a power of two from 2^16 to 2^30.
    pub sample_bytes: u32,
    /// Numbers of requested fragments must be below this; a power of two from 2^8 to 2^30.
    pub fragments: u32,
}

/// How many submessages a message may have. A message consists of blocks of submessages of any kind, with samples
/// between them. Any of these may be absent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shape {
    /// Submessages of any kind at the beginning, in either byte order.
    pub first: usize,
    /// Samples between two blocks, each with or without its timestamp: RustDDS packs waiting samples into one datagram.
    pub samples: usize,
    /// Submessages of any kind in each further block; those with checks must be little endian.
    pub more: usize,
    /// Number of further blocks.
    pub blocks: usize,
}

/// The program, or `None` if it is longer than the kernel accepts.
pub(super) fn program(limits: &Limits, shape: &Shape) -> Option<Vec<Instruction>> {
    let mut writer = Writer { code: Assembler::default(), limits: *limits };
    writer.head();
    for _ in 0..shape.first {
        writer.any(Checked::BothOrders);
    }
    for _ in 0..shape.blocks {
        for _ in 0..shape.samples {
            writer.sample();
        }
        for _ in 0..shape.more {
            writer.any(Checked::LittleEndian);
        }
    }
    writer.tail();
    writer.code.assemble()
}

/// Byte orders in which submessages with checks are accepted; others are refused.
#[derive(Clone, Copy)]
enum Checked {
    BothOrders,
    LittleEndian,
}

#[derive(Clone, Copy)]
enum Order {
    Little,
    Big,
}

struct Writer {
    code: Assembler,
    limits: Limits,
}

impl Writer {
    /// Passes a packet that is not an RTPS message, since RustDDS rejects it by its first bytes. Loads the offset of
    /// the first submessage into the index.
    fn head(&mut self) {
        let (rtps, other) = (self.code.label(), self.code.label());
        self.code.plain(code::LOAD_LENGTH, 0);
        self.code.branch_unless(code::IF_GREATER, UDP_HEADER + RTPS_HEADER - 1, other);
        self.code.plain(code::LOAD_WORD, UDP_HEADER);
        self.code.branch(code::IF_EQUAL, MAGIC, rtps, other);
        self.code.place(other);
        self.pass();
        self.code.place(rtps);
        self.code.plain(code::INDEX_FROM_CONSTANT, UDP_HEADER + RTPS_HEADER);
    }

    /// Passes a message that ends here, and drops a longer one.
    fn tail(&mut self) {
        self.end_or_go_on();
        self.drop();
    }

    /// Passes a message that ends here.
    fn end_or_go_on(&mut self) {
        let (go_on, end) = (self.code.label(), self.code.label());
        self.code.plain(code::LOAD_LENGTH, 0);
        self.code.branch(code::IF_GREATER_THAN_INDEX, 0, go_on, end);
        self.code.place(end);
        self.pass();
        self.code.place(go_on);
    }

    fn pass(&mut self) {
        self.code.plain(code::RETURN, u32::MAX);
    }

    fn drop(&mut self) {
        self.code.plain(code::RETURN, 0);
    }

    /// One submessage of any kind.
    fn any(&mut self, orders: Checked) {
        let (numbers, data_frag, nack_frag) = (self.code.label(), self.code.label(), self.code.label());
        let (walk, refuse) = (self.code.label(), self.code.label());
        self.end_or_go_on();
        self.code.plain(code::STORE_INDEX, OFFSET);
        self.code.plain(code::LOAD_BYTE_AT_INDEX, 0);
        for (kind, label) in [
            (kind::HEARTBEAT, numbers),
            (kind::GAP, numbers),
            (kind::DATA_FRAG, data_frag),
            (kind::NACK_FRAG, nack_frag),
        ] {
            self.code.branch_if(code::IF_EQUAL, kind, label);
        }
        self.code.jump(walk);
        self.code.place(numbers);
        self.numbers(orders, walk, refuse);
        self.code.place(data_frag);
        self.data_frag(orders, walk, refuse);
        self.code.place(nack_frag);
        self.nack_frag(orders, walk, refuse);
        self.code.place(refuse);
        self.drop();
        self.code.place(walk);
        self.walk();
    }

    /// Emits one part for each byte order. Both continue after the code of `each`.
    fn in_both_orders(&mut self, mut each: impl FnMut(&mut Self, Order)) {
        let (little, big, both) = (self.code.label(), self.code.label(), self.code.label());
        self.code.plain(code::LOAD_BYTE_AT_INDEX, 1);
        self.code.branch(code::IF_BITS, 1, little, big);
        self.code.place(little);
        each(self, Order::Little);
        self.code.jump(both);
        self.code.place(big);
        each(self, Order::Big);
        self.code.place(both);
    }

    /// Loads a sequence number at `place` after the index, divided by 256; refuses numbers from 2^40 on. When sequence
    /// numbers are read, the cell `OFFSET` has the index.
    fn load_number(&mut self, place: u32, order: Order, refuse: Label) {
        match order {
            Order::Big => {
                self.code.plain(code::LOAD_WORD_AT_INDEX, place);
                self.code.branch_if(code::IF_BITS, 0xffff_ff00, refuse);
                self.code.plain(code::LOAD_WORD_AT_INDEX, place + 3);
            }
            Order::Little => {
                // The high word comes first in both byte orders; its bits 0 to 7 are the first byte.
                self.code.plain(code::LOAD_WORD_AT_INDEX, place);
                self.code.branch_if(code::IF_BITS, 0x00ff_ffff, refuse);
                self.code.plain(code::STORE, HIGH);
                self.load_half(place + 6, Order::Little);
                self.code.plain(code::SHIFT_LEFT, 8);
                self.code.plain(code::STORE, PART);
                self.code.plain(code::LOAD_BYTE_AT_INDEX, place + 5);
                for cell in [PART, HIGH] {
                    self.code.plain(code::INDEX_FROM_CELL, cell);
                    self.code.plain(code::OR_INDEX, 0);
                }
                self.code.plain(code::INDEX_FROM_CELL, OFFSET);
            }
        }
    }

    /// Loads two bytes at `place` after the index.
    fn load_half(&mut self, place: u32, order: Order) {
        self.code.plain(code::LOAD_HALF_AT_INDEX, place);
        if matches!(order, Order::Little) {
            // 0xPPQQ times 0x10001 is 0xPPQQPPQQ, which has QQPP in its middle.
            self.code.plain(code::MULTIPLY, 0x1_0001);
            self.code.plain(code::SHIFT_RIGHT, 8);
            self.code.plain(code::AND, 0xffff);
        }
    }

    /// A HEARTBEAT or a GAP, which have the same layout: reader, writer, first number, last number or base of the list.
    fn numbers(&mut self, orders: Checked, walk: Label, refuse: Label) {
        let (first, last) = (HEADER + 8, HEADER + 16);
        let load = |writer: &mut Self, order| {
            writer.load_number(first, order, refuse);
            writer.code.plain(code::STORE, FIRST);
            writer.load_number(last, order, refuse);
        };
        match orders {
            Checked::BothOrders => self.in_both_orders(load),
            Checked::LittleEndian => {
                self.little_endian_or(refuse);
                load(self, Order::Little);
            }
        }
        self.code.plain(code::INDEX_FROM_CELL, FIRST);
        self.code.plain(code::SUBTRACT_INDEX, 0);
        self.code.plain(code::INDEX_FROM_CELL, OFFSET);
        let (long, gap, heartbeat) = (self.code.label(), self.code.label(), self.code.label());
        self.code.branch(code::IF_GREATER, self.limits.gap_span / 256, long, walk);
        self.code.place(long);
        self.code.plain(code::STORE, FIRST);
        self.code.plain(code::LOAD_BYTE_AT_INDEX, 0);
        self.code.branch(code::IF_EQUAL, kind::GAP, gap, heartbeat);
        self.code.place(heartbeat);
        self.code.plain(code::LOAD_CELL, FIRST);
        let longer = self.code.label();
        self.code.branch(code::IF_GREATER, self.limits.heartbeat_span / 256, longer, walk);
        self.code.place(longer);
        // A writer without samples announces a last number one below the first.
        self.code.branch(code::IF_EQUAL, u32::MAX, walk, refuse);
        self.code.place(gap);
        // Too long, unless it begins with number 1: RustDDS then only moves its mark and lists nothing.
        self.code.plain(code::LOAD_WORD_AT_INDEX, first);
        self.code.branch_unless(code::IF_EQUAL, 0, refuse);
        self.word_by_order(orders, first + 4, refuse, |writer, swap| {
            writer.code.branch(code::IF_EQUAL, swap(1), walk, refuse);
        });
    }

    /// Continues if the submessage is little endian, else jumps to `refuse`.
    fn little_endian_or(&mut self, refuse: Label) {
        self.code.plain(code::LOAD_BYTE_AT_INDEX, 1);
        self.code.branch_unless(code::IF_BITS, 1, refuse);
    }

    /// Loads a word in the byte order of the packet. `judge` receives the function that converts a constant to that
    /// order.
    fn word_by_order(&mut self, orders: Checked, place: u32, refuse: Label, judge: impl Fn(&mut Self, fn(u32) -> u32)) {
        let big = self.code.label();
        let other = if matches!(orders, Checked::BothOrders) { big } else { refuse };
        self.little_endian_or(other);
        self.code.plain(code::LOAD_WORD_AT_INDEX, place);
        judge(self, u32::swap_bytes);
        if matches!(orders, Checked::BothOrders) {
            self.code.place(big);
            self.code.plain(code::LOAD_WORD_AT_INDEX, place);
            judge(self, std::convert::identity);
        }
    }

    /// Extra flags, offset, reader, writer, number, first fragment, fragments here, size of a fragment, size of the sample.
    fn data_frag(&mut self, orders: Checked, walk: Label, refuse: Label) {
        let too_large = !(self.limits.sample_bytes - 1);
        self.word_by_order(orders, HEADER + 28, refuse, |writer, swap| {
            writer.code.branch(code::IF_BITS, swap(too_large), refuse, walk);
        });
    }

    /// Reader, writer, number, first fragment.
    fn nack_frag(&mut self, orders: Checked, walk: Label, refuse: Label) {
        let too_large = !(self.limits.fragments - 1);
        self.word_by_order(orders, HEADER + 16, refuse, |writer, swap| {
            writer.code.branch_if(code::IF_EQUAL, 0, refuse);
            writer.code.branch(code::IF_BITS, swap(too_large), refuse, walk);
        });
    }

    /// Goes to the next submessage. A length of 0 extends to the end of the message, except for kinds that may be
    /// empty.
    fn walk(&mut self) {
        let (empty, to_the_end, next) = (self.code.label(), self.code.label(), self.code.label());
        self.in_both_orders(|writer, order| writer.load_half(2, order));
        self.code.branch_if(code::IF_EQUAL, 0, empty);
        self.code.plain(code::ADD_INDEX, 0);
        self.code.plain(code::ADD, HEADER);
        self.code.plain(code::INDEX_FROM_ACCUMULATOR, 0);
        self.code.jump(next);
        self.code.place(empty);
        self.code.plain(code::LOAD_BYTE_AT_INDEX, 0);
        let skip = self.code.label();
        self.code.branch_if(code::IF_EQUAL, kind::INFO_TS, skip);
        self.code.branch(code::IF_EQUAL, kind::PAD, skip, to_the_end);
        self.code.place(to_the_end);
        self.pass();
        self.code.place(skip);
        self.code.plain(code::ACCUMULATOR_FROM_INDEX, 0);
        self.code.plain(code::ADD, HEADER);
        self.code.plain(code::INDEX_FROM_ACCUMULATOR, 0);
        self.code.place(next);
    }

    /// Skips a little endian sample and its timestamp, if any. Stays in place at any other submessage.
    fn sample(&mut self) {
        let (plain, other) = (self.code.label(), self.code.label());
        self.end_or_go_on();
        self.code.plain(code::LOAD_WORD_AT_INDEX, 0);
        self.code.branch_unless(code::IF_EQUAL, TIME_STAMP, plain);
        self.code.plain(code::ACCUMULATOR_FROM_INDEX, 0);
        self.code.plain(code::ADD, TIME_STAMP_BYTES);
        self.code.plain(code::INDEX_FROM_ACCUMULATOR, 0);
        // No message ends with a timestamp: this load drops one that does.
        self.code.plain(code::LOAD_WORD_AT_INDEX, 0);
        self.code.place(plain);
        self.code.plain(code::AND, 0xff01_0000);
        self.code.branch_unless(code::IF_EQUAL, kind::DATA << 24 | 1 << 16, other);
        self.load_half(2, Order::Little);
        self.code.branch_if(code::IF_EQUAL, 0, other);
        self.code.plain(code::ADD_INDEX, 0);
        self.code.plain(code::ADD, HEADER);
        self.code.plain(code::INDEX_FROM_ACCUMULATOR, 0);
        self.code.place(other);
    }
}
