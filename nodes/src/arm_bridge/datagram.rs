//! Decodes numbers from datagrams.

use super::description::{ByteOrder, NumberKind, Udp};

/// The raw values of a datagram in the order of its fields; `None` if its length is wrong.
pub(super) fn decode(datagram: &[u8], layout: &Udp) -> Option<Vec<f64>> {
    if datagram.len() != layout.length {
        return None;
    }
    layout.fields.iter().map(|field| number(datagram.get(field.at..)?, field.kind, layout.byte_order)).collect()
}

/// The sequence number of a datagram, if the layout has one.
pub(super) fn sequence_number(datagram: &[u8], layout: &Udp) -> Option<u64> {
    let field = layout.sequence?;
    whole(datagram.get(field.at..)?, field.kind.length(), layout.byte_order)
}

fn whole(bytes: &[u8], length: usize, order: ByteOrder) -> Option<u64> {
    let mut raw = [0_u8; 8];
    raw.get_mut(..length)?.copy_from_slice(bytes.get(..length)?);
    if order == ByteOrder::Big {
        raw[..length].reverse();
    }
    Some(u64::from_le_bytes(raw))
}

fn number(bytes: &[u8], kind: NumberKind, order: ByteOrder) -> Option<f64> {
    let whole = whole(bytes, kind.length(), order)?;
    let low = (whole & u64::from(u32::MAX)) as u32;
    Some(match kind {
        NumberKind::U8 => f64::from(low as u8),
        NumberKind::I8 => f64::from(low as u8 as i8),
        NumberKind::U16 => f64::from(low as u16),
        NumberKind::I16 => f64::from(low as u16 as i16),
        NumberKind::U32 => f64::from(low),
        NumberKind::I32 => f64::from(low as i32),
        NumberKind::F32 => f64::from(f32::from_bits(low)),
        NumberKind::F64 => f64::from_bits(whole),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm_bridge::description::{DatagramField, LOOPBACK, SequenceField, SequenceKind};
    use crate::arm_bridge::signals::Treatment;

    fn layout(byte_order: ByteOrder) -> Udp {
        let treatment = Treatment {
            signal: "pump_flow".into(),
            scale: 1.0,
            offset: 0.0,
            minimum: None,
            maximum: None,
            age: 1.0,
            delay: 0.0,
        };
        let field = |at, kind| DatagramField { at, kind, treatment: treatment.clone() };
        Udp {
            port: 1,
            address: LOOPBACK,
            senders: Vec::new(),
            length: 14,
            byte_order,
            sequence: Some(SequenceField { at: 12, kind: SequenceKind::U16 }),
            fields: vec![field(0, NumberKind::I16), field(2, NumberKind::F32), field(6, NumberKind::F64)],
        }
    }

    #[test]
    fn numbers_of_both_orders_are_read() {
        let mut little = (-2_i16).to_le_bytes().to_vec();
        little.extend(0.5_f32.to_le_bytes());
        little.extend(1e-4_f64.to_le_bytes());
        assert_eq!(decode(&little, &layout(ByteOrder::Little)), Some(vec![-2.0, 0.5, 1e-4]));
        let mut big = (-2_i16).to_be_bytes().to_vec();
        big.extend(0.5_f32.to_be_bytes());
        big.extend(1e-4_f64.to_be_bytes());
        assert_eq!(decode(&big, &layout(ByteOrder::Big)), Some(vec![-2.0, 0.5, 1e-4]));
    }

    #[test]
    fn the_sequence_number_is_read_in_both_orders() {
        let mut datagram = [0; 14];
        datagram[12..].copy_from_slice(&[1, 2]);
        assert_eq!(sequence_number(&datagram, &layout(ByteOrder::Little)), Some(0x0201));
        assert_eq!(sequence_number(&datagram, &layout(ByteOrder::Big)), Some(0x0102));
        assert_eq!(sequence_number(&datagram, &Udp { sequence: None, ..layout(ByteOrder::Big) }), None);
    }

    #[test]
    fn datagrams_of_another_length_are_refused() {
        assert_eq!(decode(&[0; 13], &layout(ByteOrder::Little)), None);
        assert_eq!(decode(&[0; 15], &layout(ByteOrder::Little)), None);
    }
}
