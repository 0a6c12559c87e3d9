//! MCAP files byte by byte, also such as no writer makes.

/// A record.
pub fn record(opcode: u8, content: &[u8]) -> Vec<u8> {
    [&[opcode][..], &(content.len() as u64).to_le_bytes(), content].concat()
}

/// Text with its length in front.
pub fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
}

/// Magic and header.
pub fn start() -> Vec<u8> {
    [&b"\x89MCAP0\r\n"[..], &record(0x01, &[text("ros2"), text("")].concat())].concat()
}

/// A schema with number 1 and a channel with number 1.
pub fn topic(name: &str, type_name: &str, encoding: &str, schema: &str) -> Vec<u8> {
    let schema = [&1_u16.to_le_bytes()[..], &text(type_name), &text(encoding), &text(schema)].concat();
    let channel =
        [&1_u16.to_le_bytes()[..], &1_u16.to_le_bytes(), &text(name), &text("cdr"), &0_u32.to_le_bytes()].concat();
    [record(0x03, &schema), record(0x04, &channel)].concat()
}

/// A message on channel 1.
pub fn message(nanoseconds: u64, data: &[u8]) -> Vec<u8> {
    let times = [nanoseconds.to_le_bytes(), nanoseconds.to_le_bytes()].concat();
    record(0x05, &[&1_u16.to_le_bytes()[..], &0_u32.to_le_bytes(), &times, data].concat())
}

/// A chunk without checksum that announces so many bytes.
pub fn zstd_chunk(announced: u64, packed: &[u8]) -> Vec<u8> {
    let head = [&[0; 16][..], &announced.to_le_bytes(), &0_u32.to_le_bytes(), &text("zstd")].concat();
    record(0x06, &[&head[..], &(packed.len() as u64).to_le_bytes(), packed].concat())
}

/// An end without index.
pub fn end() -> Vec<u8> {
    [record(0x0f, &[0; 4]), record(0x02, &[0; 20]), b"\x89MCAP0\r\n".to_vec()].concat()
}

/// A zstd stream of so many times 64 MiB of zeros.
pub fn zeros(count: usize) -> Vec<u8> {
    zstd::bulk::compress(&vec![0; 64 << 20], 1).unwrap().repeat(count)
}
