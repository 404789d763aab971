//! What the digits of a picture's numbers say of the care with which it was drawn.

/// Digits that no picture needs: pens, screens and single precision end at nine, careful programs write twelve.
const EXACT_DIGITS: usize = 13;

/// Part of a file's numbers that are exact in a picture too: sums that a program left as they came out.
const STRAY: f64 = 0.01;

/// Whether next to no number of a file has more digits than pictures need.
pub(super) fn is_sketch(text: &str) -> bool {
    let of_word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '#' | '_');
    let counts = text.split(|c| !of_word(c)).map(significant).filter(|&digits| digits > 0);
    let (numbers, exact) =
        counts.fold((0u64, 0u64), |(n, exact), digits| (n + 1, exact + u64::from(digits >= EXACT_DIGITS)));
    exact as f64 <= STRAY * numbers as f64
}

/// The significant digits of a number, without its exponent; 0 of any other word.
fn significant(word: &str) -> usize {
    if !word.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        return 0;
    }
    let mantissa = word.split(['e', 'E']).next().unwrap_or(word);
    let digits = mantissa.bytes().filter(u8::is_ascii_digit);
    digits.skip_while(|&digit| digit == b'0').count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_counted_from_the_first_that_is_not_zero() {
        let counts = ["0.00120", "12.5e-13", "path1234", "#ff0011", "3px", "0"].map(significant);
        assert_eq!(counts, [3, 3, 0, 0, 1, 0]);
    }

    #[test]
    fn exact_numbers_make_no_sketch() {
        assert!(is_sketch("<path d='M12.345678,0l1.5-7.25z'/>"));
        assert!(!is_sketch("<circle cx='2.000000000001' cy='0' r='1'/>"));
    }
}
