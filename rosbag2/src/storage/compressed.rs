//! Decompresses what rosbag2 compressed: whole files, or single messages, with zstd.

use std::io::{BufReader, BufWriter, Read, Write};
use std::path::Path;

use bytes::Bytes;

use crate::Error;
use crate::container::{Damage, DamageKind};
use crate::limits::{Limit, ReadLimits};
use crate::regular_file::open_regular;

/// First bytes of every zstd frame. No message starts with them: its encapsulation starts with a zero.
const ZSTD_MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// Whether the bytes start like a zstd frame.
pub(crate) fn is_zstd(bytes: &[u8]) -> bool {
    bytes.starts_with(&ZSTD_MAGIC)
}

/// Decompresses a whole file to the folder for temporary files. Decompression stops at damage; the bytes before it are
/// kept.
pub(super) fn unpack(path: &Path, limits: &ReadLimits) -> Result<(tempfile::TempPath, Option<Damage>), Error> {
    let (packed, packed_length) = open_regular(path)?;
    let mut reader = zstd::stream::read::Decoder::new(BufReader::new(packed)).map_err(Error::io("read", path))?;
    let temporary = tempfile::NamedTempFile::new().map_err(Error::io("create", &std::env::temp_dir()))?;
    let mut writer = BufWriter::new(temporary);
    let mut buffer = vec![0; 1 << 16];
    let mut unpacked = 0;
    let fault = loop {
        match reader.read(&mut buffer) {
            Ok(0) => break None,
            Ok(count) => {
                writer.write_all(&buffer[..count]).map_err(|error| cannot_write(&writer, error))?;
                unpacked += count as u64;
                if let Err(error) = limits.check_unpacked(unpacked, packed_length) {
                    break Some(error.to_string());
                }
            }
            Err(error) => break Some(error.to_string()),
        }
    };
    let temporary = match writer.into_inner() {
        Ok(temporary) => temporary,
        Err(error) => return Err(Error::io("write", &std::env::temp_dir())(error.into_error())),
    };
    let damage = fault.map(|reason| Damage {
        file: path.to_path_buf(),
        offset: packed_length,
        lost_bytes: 0,
        readable_until: None,
        kind: DamageKind::BadCompression { reason, unpacked },
    });
    Ok((temporary.into_temp_path(), damage))
}

fn cannot_write(writer: &BufWriter<tempfile::NamedTempFile>, error: std::io::Error) -> Error {
    Error::io("write", writer.get_ref().path())(error)
}

/// Messages that were compressed one by one.
#[derive(Debug)]
pub(crate) struct MessageDecompressor {
    /// Maximum size of a message, bytes.
    most: u64,
    bad_messages: u64,
    bad_bytes: u64,
    first_reason: Option<String>,
}

impl MessageDecompressor {
    pub fn new(limits: &ReadLimits) -> MessageDecompressor {
        MessageDecompressor { most: limits.message, bad_messages: 0, bad_bytes: 0, first_reason: None }
    }

    /// The decompressed message; `None`, and counted, if it cannot be decompressed.
    pub fn decompress(&mut self, data: Bytes) -> Option<Bytes> {
        if !is_zstd(&data) {
            return Some(data);
        }
        let mut message = Vec::new();
        let result = zstd::stream::read::Decoder::with_buffer(data.as_ref())
            .and_then(|decoder| decoder.take(self.most.saturating_add(1)).read_to_end(&mut message))
            .map_err(|error| error.to_string())
            .and_then(|length| Limit::Message.check(length as u64, self.most).map_err(|error| error.to_string()));
        match result {
            Ok(()) => Some(Bytes::from(message)),
            Err(error) => {
                self.bad_messages += 1;
                self.bad_bytes += data.len() as u64;
                self.first_reason.get_or_insert(error);
                None
            }
        }
    }

    /// The messages that could not be decompressed, as damage of the bag.
    pub fn damage(&self, bag: &Path) -> Option<Damage> {
        let reason = self.first_reason.clone()?;
        Some(Damage {
            file: bag.to_path_buf(),
            offset: 0,
            lost_bytes: self.bad_bytes,
            readable_until: None,
            kind: DamageKind::BadMessages { messages: self.bad_messages, reason },
        })
    }
}
