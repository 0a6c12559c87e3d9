//! Decimal signs and separators of thousands: which a table has, and the numbers written with them.

/// Signs that separate thousands besides the point and the comma: Swiss tables, and blanks that do not break.
const OTHER_SEPARATORS: [char; 5] = ['\'', '\u{2019}', '\u{a0}', '\u{202f}', ' '];
/// Longest number that is parsed without allocation, bytes.
const SHORT: usize = 48;

/// The number in a text with this decimal sign. Thousands may be separated, but only where three digits follow each separator:
/// `1,362.3` is a number with a decimal point, `13,62` is none.
pub(super) fn number(text: &str, decimal: char) -> Option<f64> {
    let text = text.trim();
    let plain = match decimal {
        ',' if text.contains(',') => with_point(text),
        // A point is no decimal sign here, but `1.5` may still be thousands.
        ',' if text.contains('.') => None,
        _ => text.parse().ok(),
    };
    plain.or_else(|| grouped(text, decimal))
}

/// A number with one decimal comma and no other separator.
fn with_point(text: &str) -> Option<f64> {
    if text.contains('.') {
        return None;
    }
    let mut buffer = [0; SHORT];
    let bytes = buffer.get_mut(..text.len())?;
    bytes.copy_from_slice(text.as_bytes());
    *bytes.iter_mut().find(|byte| **byte == b',')? = b'.';
    std::str::from_utf8(bytes).ok()?.parse().ok()
}

/// A number whose thousands are separated.
fn grouped(text: &str, decimal: char) -> Option<f64> {
    let (sign, digits) = match text.strip_prefix(['+', '-']) {
        Some(rest) => (if text.starts_with('-') { "-" } else { "" }, rest),
        None => ("", text),
    };
    let end = digits.find(['e', 'E']).unwrap_or(digits.len());
    let (mantissa, exponent) = digits.split_at(end);
    let (whole, fraction) = mantissa.split_once(decimal).unwrap_or((mantissa, ""));
    let thousands = if decimal == ',' { '.' } else { ',' };
    let separator = whole.chars().find(|c| !c.is_ascii_digit())?;
    let is_separator = separator == thousands || OTHER_SEPARATORS.contains(&separator);
    if !is_separator || !are_thousands(whole, separator) || !fraction.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let whole: String = whole.chars().filter(char::is_ascii_digit).collect();
    format!("{sign}{whole}.{fraction}{exponent}").parse().ok()
}

/// Whether a text is up to three digits and then groups of three; a number with thousands does not begin with zero.
fn are_thousands(whole: &str, separator: char) -> bool {
    let mut groups = whole.split(separator);
    let is_digits = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    let first = groups.next().unwrap_or_default();
    (1..=3).contains(&first.len())
        && is_digits(first)
        && !first.starts_with('0')
        && groups.all(|group| group.len() == 3 && is_digits(group))
}

/// What cells say about the decimal sign.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Evidence {
    point: usize,
    comma: usize,
    /// Cells like `1,362`, which may be a fraction or thousands.
    doubtful_commas: usize,
}

impl Evidence {
    /// Counts a number as written, without its unit.
    pub fn add(&mut self, digits: &str) {
        let digits = digits.trim_start_matches(['+', '-']);
        let mantissa = digits.split(['e', 'E']).next().unwrap_or_default();
        let count = |sign: char| mantissa.matches(sign).count();
        let whole = |decimal: char| mantissa.rsplit_once(decimal).map_or("", |(whole, _)| whole);
        match (count('.'), count(',')) {
            (0, 0) => {}
            (1, 0) => self.point += 1,
            (0, 1) if are_thousands(mantissa, ',') => self.doubtful_commas += 1,
            (0, 1) => self.comma += 1,
            (0, _) => self.point += usize::from(are_thousands(mantissa, ',')),
            (_, 0) => self.comma += usize::from(are_thousands(mantissa, '.')),
            // Of both, the last one is the decimal sign.
            (1, _) if mantissa.rfind('.') > mantissa.rfind(',') => {
                self.point += usize::from(are_thousands(whole('.'), ','))
            }
            (_, 1) if mantissa.rfind(',') > mantissa.rfind('.') => {
                self.comma += usize::from(are_thousands(whole(','), '.'))
            }
            _ => {}
        }
    }

    /// The decimal sign. Where every comma may be either, it is a fraction, unless it also separates columns: who exports with commas
    /// between columns writes fractions with a point.
    pub fn decimal(self, delimiter: u8) -> char {
        let is_doubtful = self.point == 0 && self.comma == 0 && self.doubtful_commas > 0;
        if self.comma > self.point || (is_doubtful && delimiter != b',') { ',' } else { '.' }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_read_only_where_they_are_thousands() {
        for (text, decimal, wanted) in [
            ("1.5", '.', Some(1.5)),
            ("-1,362.3", '.', Some(-1362.3)),
            ("12,345,678", '.', Some(12_345_678.0)),
            ("1.362,3", ',', Some(1362.3)),
            ("1'362.3", '.', Some(1362.3)),
            ("1\u{202f}362,3", ',', Some(1362.3)),
            ("30,127", ',', Some(30.127)),
            ("1,5E-3", ',', Some(1.5e-3)),
            ("300", ',', Some(300.0)),
            ("nan", '.', None),
            ("13,62", '.', None),
            ("0,127", '.', None),
            ("1.5", ',', None),
            ("1,3623", '.', None),
            ("1,362,3", '.', None),
            ("10:00", '.', None),
            ("", '.', None),
            ("-", '.', None),
        ] {
            assert_eq!(number(text, decimal).filter(|value| value.is_finite()), wanted, "{text} {decimal}");
        }
    }

    #[test]
    fn the_decimal_sign_is_that_of_the_numbers_that_say_so() {
        let sign = |cells: &[&str], delimiter: u8| {
            let mut evidence = Evidence::default();
            cells.iter().for_each(|cell| evidence.add(cell));
            evidence.decimal(delimiter)
        };
        assert_eq!(sign(&["0,002", "1,362"], b';'), ',');
        assert_eq!(sign(&["1,362", "2,192"], b';'), ',');
        assert_eq!(sign(&["1,362", "2,192"], b','), '.');
        assert_eq!(sign(&["30,12", "1,362"], b','), ',');
        assert_eq!(sign(&["0.002", "1,362.3"], b','), '.');
        assert_eq!(sign(&["1.362,3"], b';'), ',');
        assert_eq!(sign(&["1.362", "5"], b';'), '.');
        assert_eq!(sign(&["1.362.000"], b';'), ',');
        assert_eq!(sign(&[], b';'), '.');
    }
}
