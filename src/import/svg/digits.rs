//! Tells artwork from exact drawings by the digits of its numbers.

/// Numbers with this many significant digits are exact: pens, screens and single precision give at most nine, and
/// careful programs write twelve.
const EXACT_DIGITS: usize = 13;

/// Largest part of exact numbers in artwork. Some programs write unrounded sums, or compute a symbol.
const STRAY: f64 = 0.1;

/// Whether a file is artwork: few of its numbers have [`EXACT_DIGITS`] or more.
pub(super) fn is_sketch(text: &str) -> bool {
    let counts = significant_digits(text);
    let exact = counts.iter().filter(|&&digits| digits >= EXACT_DIGITS).count();
    exact as f64 <= STRAY * counts.len() as f64
}

/// The number of significant digits of every number but 0, without exponents. A number ends where a second point begins
/// the next, as in path data.
fn significant_digits(text: &str) -> Vec<usize> {
    let mut counts = Vec::new();
    for run in text.split(|c: char| !c.is_ascii_digit() && c != '.') {
        let mut parts = run.split('.');
        let whole = parts.next().unwrap_or_default();
        let first = format!("{whole}{}", parts.next().unwrap_or_default());
        let numbers = [first.as_str()].into_iter().chain(parts);
        counts.extend(numbers.map(|digits| digits.trim_start_matches('0').len()).filter(|&digits| digits > 0));
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_counted_from_the_first_that_is_not_zero() {
        assert_eq!(significant_digits("0.00120 M12.5-3px 0 c2.341.0234.567"), [3, 3, 1, 4, 3, 3]);
    }

    #[test]
    fn exact_numbers_make_no_sketch() {
        assert!(is_sketch("<path d='M12.345678,0l1.5-7.25c2.341.234.567.123.456z'/>"));
        assert!(!is_sketch("<circle cx='2.000000000001' cy='0' r='1'/>"));
    }
}
