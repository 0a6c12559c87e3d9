//! Reads MATLAB version 4: a header of five integers, a name, the numbers (MAT-File Format, chapter 2).

use rosbag2::ReadLimits;

use super::fault::TableFault;
use super::mat_variables::{Budget, Number, Variable};

const HEADER: usize = 20;
/// Maximum length of a variable name; a longer one means that the file has another format.
const NAME_LIMIT: usize = 256;

/// The real full matrices in a file; others are added to `notes`.
pub(super) fn parse(bytes: &[u8], notes: &mut Vec<String>, limits: &ReadLimits) -> Result<Vec<Variable>, TableFault> {
    let mut budget = Budget::new(limits, bytes);
    let mut variables = Vec::new();
    let mut rest = bytes;
    while !rest.is_empty() {
        match next(rest) {
            Some((variable, after)) => {
                budget.take(variable.as_ref().map_or(0, |variable| variable.values.len()))?;
                match variable {
                    Ok(variable) => variables.push(variable),
                    Err(name) => notes.push(format!("{name} is no real matrix and was left out")),
                }
                rest = after;
            }
            None if variables.is_empty() => return Err("it is no MATLAB file of version 4, 6 or 7".into()),
            None => {
                notes.push(format!("the last {} bytes are no whole variable: the file is cut off", rest.len()));
                break;
            }
        }
    }
    Ok(variables)
}

/// The next variable, or its name if its kind is not supported, and the remaining bytes.
fn next(bytes: &[u8]) -> Option<(Result<Variable, String>, &[u8])> {
    let (header, rest) = bytes.split_at_checked(HEADER)?;
    let little = |at: usize| header.get(at..at + 4)?.try_into().ok().map(u32::from_le_bytes);
    // The type is a decimal MOPT; in the wrong byte order even the smallest is far above 4052.
    let big_endian = little(0)? > 4052;
    let field = |at: usize| little(at).map(|value| if big_endian { value.swap_bytes() } else { value });
    let kind = field(0)?;
    let (order, zero, precision, class) = (kind / 1000, kind / 100 % 10, kind / 10 % 10, kind % 10);
    if order > 1 || zero != 0 || class > 2 {
        return None;
    }
    let number = match precision {
        0 => Number::F64,
        1 => Number::F32,
        2 => Number::I32,
        3 => Number::I16,
        4 => Number::U16,
        5 => Number::U8,
        _ => return None,
    };
    let (rows, columns) = (field(4)? as usize, field(8)? as usize);
    let (complex, name_length) = (field(12)?, field(16)? as usize);
    if name_length > NAME_LIMIT || complex > 1 {
        return None;
    }
    let (name, rest) = rest.split_at_checked(name_length)?;
    let name = String::from_utf8_lossy(name.split(|&byte| byte == 0).next().unwrap_or_default()).into_owned();
    let length = rows.checked_mul(columns)?.checked_mul(number.size())?;
    let (real, rest) = rest.split_at_checked(length)?;
    let rest = if complex == 1 { rest.split_at_checked(length)?.1 } else { rest };
    if complex == 1 || class != 0 {
        return Some((Err(name), rest));
    }
    Some((Ok(Variable { name, rows, values: number.read(real, big_endian) }), rest))
}
