//! What rosbag2 compressed itself: whole files, or message by message, with zstd.

use std::io::{BufReader, BufWriter, Read, Write};
use std::path::Path;

use bytes::Bytes;

use crate::BagError;
use crate::container::{Damage, DamageKind};

/// First bytes of every zstd frame. No message begins so: its encapsulation begins with a zero.
const ZSTD_MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];
/// No message is larger, not even a picture; of a frame that gives more, only so much is taken.
const MESSAGE_LIMIT: u64 = 256 << 20;

/// Whether the bytes begin like a zstd frame.
pub(crate) fn is_zstd(bytes: &[u8]) -> bool {
    bytes.starts_with(&ZSTD_MAGIC)
}

/// Unpacks a file that was compressed as a whole into the folder for temporary files. What is damaged ends there: the
/// bytes before it are kept.
pub(super) fn unpack(path: &Path) -> Result<(tempfile::TempPath, Option<Damage>), BagError> {
    let packed = std::fs::File::open(path).map_err(BagError::io("open", path))?;
    let packed_length = packed.metadata().map_err(BagError::io("read", path))?.len();
    let mut reader = zstd::stream::read::Decoder::new(BufReader::new(packed)).map_err(BagError::io("read", path))?;
    let temporary = tempfile::NamedTempFile::new().map_err(BagError::io("create", &std::env::temp_dir()))?;
    let mut writer = BufWriter::new(temporary);
    let mut buffer = vec![0; 1 << 16];
    let mut unpacked = 0;
    let fault = loop {
        match reader.read(&mut buffer) {
            Ok(0) => break None,
            Ok(count) => {
                writer.write_all(&buffer[..count]).map_err(|error| cannot_write(&writer, error))?;
                unpacked += count as u64;
            }
            Err(error) => break Some(error.to_string()),
        }
    };
    let temporary = match writer.into_inner() {
        Ok(temporary) => temporary,
        Err(error) => return Err(BagError::io("write", &std::env::temp_dir())(error.into_error())),
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

fn cannot_write(writer: &BufWriter<tempfile::NamedTempFile>, error: std::io::Error) -> BagError {
    BagError::io("write", writer.get_ref().path())(error)
}

/// Messages that were compressed one by one.
#[derive(Debug, Default)]
pub(crate) struct MessageDecompressor {
    bad_messages: u64,
    bad_bytes: u64,
    first_reason: Option<String>,
}

impl MessageDecompressor {
    /// The message as it was before compression; `None`, and counted, when it cannot be won.
    pub fn decompress(&mut self, data: Bytes) -> Option<Bytes> {
        if !is_zstd(&data) {
            return Some(data);
        }
        let mut message = Vec::new();
        let result = zstd::stream::read::Decoder::with_buffer(data.as_ref())
            .and_then(|decoder| decoder.take(MESSAGE_LIMIT).read_to_end(&mut message));
        match result {
            Ok(_) => Some(Bytes::from(message)),
            Err(error) => {
                self.bad_messages += 1;
                self.bad_bytes += data.len() as u64;
                self.first_reason.get_or_insert_with(|| error.to_string());
                None
            }
        }
    }

    /// What could not be decompressed, as damage of the bag.
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
