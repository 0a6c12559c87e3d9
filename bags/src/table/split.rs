//! Splits one line of a text table into cells.

use std::borrow::Cow;

/// The cells of a line, without blanks and quotation marks around them. A sign between quotation marks separates nothing.
pub(super) fn cells(line: &str, delimiter: u8) -> Vec<String> {
    if delimiter == b' ' {
        return line.split_whitespace().map(|cell| cell.trim_matches('"').to_string()).collect();
    }
    let mut cells = vec![String::new()];
    let mut is_quoted = false;
    for character in line.chars() {
        match character {
            '"' => is_quoted = !is_quoted,
            sign if !is_quoted && sign == char::from(delimiter) => cells.push(String::new()),
            other => {
                if let Some(cell) = cells.last_mut() {
                    cell.push(other);
                }
            }
        }
    }
    cells.iter_mut().for_each(|cell| *cell = cell.trim().to_string());
    cells
}

/// The cells of a line of headings with single blanks in them, in a table whose columns are separated by more.
pub(super) fn wide_cells(line: &str) -> Vec<String> {
    line.trim().split("  ").map(str::trim).filter(|cell| !cell.is_empty()).map(str::to_string).collect()
}

/// How often a sign stands in a line, outside quotation marks.
pub(super) fn count(line: &str, sign: u8) -> usize {
    let mut is_quoted = false;
    line.bytes()
        .filter(|&byte| {
            is_quoted ^= byte == b'"';
            !is_quoted && byte == sign
        })
        .count()
}

/// The text of a cell: UTF-8, or what programs without it write on Windows.
pub(super) fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => encoding_rs::WINDOWS_1252.decode_without_bom_handling(bytes).0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_in_quotation_marks_separate_nothing() {
        let line = "\"Time, s\", \"1,362.3\",x";
        assert_eq!(cells(line, b','), ["Time, s", "1,362.3", "x"]);
        assert_eq!(count(line, b','), 2);
        assert_eq!(cells("a  b\tc", b' '), ["a", "b", "c"]);
        assert_eq!(wide_cells("  Pressure A   Pressure B "), ["Pressure A", "Pressure B"]);
        assert_eq!(cells(";;", b';'), ["", "", ""]);
    }

    #[test]
    fn a_degree_sign_is_one_in_both_encodings() {
        assert_eq!(decoded("°C".as_bytes()), "°C");
        assert_eq!(decoded(b"\xb0C"), "°C");
        assert_eq!(decoded(b"mm\xb2"), "mm²");
    }
}
