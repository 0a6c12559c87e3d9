//! The meaning of the values of a column.

use parquet::basic::{ConvertedType, LogicalType, TimeUnit, Type};
use parquet::schema::types::ColumnDescriptor;

/// Number of decimal digits that fit in 16 bytes.
const DIGITS: i32 = 38;

/// The meaning of the values of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    /// Plain numbers; unsigned integers are stored in signed types.
    Number { unsigned: bool },
    /// Numbers without their decimal point, with `scale` digits after it.
    Decimal { scale: i32 },
    /// Half-precision floating point, two bytes.
    Half,
    /// Instants, with ns per unit.
    Stamp { nanoseconds: i64 },
    /// Times of day, with the name of their unit.
    TimeOfDay { unit: &'static str },
}

impl Kind {
    /// The kind of a column, or the name of its unsupported type.
    pub fn of(column: &ColumnDescriptor) -> Result<Kind, &'static str> {
        if column.max_rep_level() > 0 {
            return Err("lists");
        }
        let number = Kind::Number { unsigned: false };
        let logical = column.logical_type_ref();
        match column.physical_type() {
            Type::BOOLEAN | Type::FLOAT | Type::DOUBLE => Ok(number),
            Type::INT32 | Type::INT64 => Ok(logical.map_or_else(|| by_older_name(column), by_name).unwrap_or(number)),
            // Only Spark and old versions of pandas store instants in this type, and nothing else uses it.
            Type::INT96 => Ok(Kind::Stamp { nanoseconds: 1 }),
            Type::BYTE_ARRAY | Type::FIXED_LEN_BYTE_ARRAY => match (logical, column.converted_type()) {
                (Some(LogicalType::Decimal(_)), _) | (None, ConvertedType::DECIMAL) => {
                    if column.type_precision() > DIGITS {
                        return Err("decimals of more than 38 digits");
                    }
                    Ok(Kind::Decimal { scale: column.type_scale() })
                }
                (Some(LogicalType::Float16), _) => Ok(Kind::Half),
                (Some(LogicalType::String | LogicalType::Enum | LogicalType::Json), _)
                | (None, ConvertedType::UTF8 | ConvertedType::ENUM | ConvertedType::JSON) => Err("text"),
                _ => Err("bytes"),
            },
        }
    }

    /// The unit that follows from the type.
    pub fn unit(self) -> Option<&'static str> {
        match self {
            Kind::TimeOfDay { unit } => Some(unit),
            _ => None,
        }
    }
}

fn by_name(logical: &LogicalType) -> Option<Kind> {
    Some(match logical {
        LogicalType::Integer(integer) => Kind::Number { unsigned: !integer.is_signed },
        LogicalType::Decimal(decimal) => Kind::Decimal { scale: decimal.scale },
        LogicalType::Date => DAYS,
        LogicalType::Time(time) => Kind::TimeOfDay { unit: unit(time.unit).0 },
        LogicalType::Timestamp(stamp) => Kind::Stamp { nanoseconds: unit(stamp.unit).1 },
        _ => return None,
    })
}

/// Files from before 2018 have type names without parameters.
fn by_older_name(column: &ColumnDescriptor) -> Option<Kind> {
    Some(match column.converted_type() {
        ConvertedType::UINT_8 | ConvertedType::UINT_16 | ConvertedType::UINT_32 | ConvertedType::UINT_64 => {
            Kind::Number { unsigned: true }
        }
        ConvertedType::DECIMAL => Kind::Decimal { scale: column.type_scale() },
        ConvertedType::DATE => DAYS,
        ConvertedType::TIME_MILLIS => Kind::TimeOfDay { unit: "ms" },
        ConvertedType::TIME_MICROS => Kind::TimeOfDay { unit: "us" },
        ConvertedType::TIMESTAMP_MILLIS => Kind::Stamp { nanoseconds: 1_000_000 },
        ConvertedType::TIMESTAMP_MICROS => Kind::Stamp { nanoseconds: 1_000 },
        _ => return None,
    })
}

const DAYS: Kind = Kind::Stamp { nanoseconds: 86_400_000_000_000 };

/// Name of a unit and its length in ns.
fn unit(unit: TimeUnit) -> (&'static str, i64) {
    match unit {
        TimeUnit::MILLIS => ("ms", 1_000_000),
        TimeUnit::MICROS => ("us", 1_000),
        TimeUnit::NANOS => ("ns", 1),
    }
}
