//! Numbers and names for people.

/// "1 curve", "12 345 curves".
pub fn counted(n: usize, what: &str) -> String {
    let many = if what == "vertex" { "vertices".to_owned() } else { format!("{what}s") };
    counted_words(n, [what, &many])
}

/// A count with its noun in singular and plural.
pub fn counted_words(n: usize, [one, many]: [&str; 2]) -> String {
    let digits = n.to_string();
    let mut number = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            number.push('\u{202f}');
        }
        number.push(c);
    }
    format!("{number} {}", if n == 1 { one } else { many })
}

/// A number with three significant digits.
pub fn short(v: f64) -> String {
    if v == 0.0 || !v.is_finite() {
        return format!("{v}");
    }
    let digits = libm::floor(libm::log10(v.abs()));
    if (-3.0..5.0).contains(&digits) {
        let decimals = (2.0 - digits).max(0.0) as usize;
        let text = format!("{v:.decimals$}");
        let short = if decimals > 0 { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        return short.to_owned();
    }
    format!("{v:.2e}")
}

/// A text cut to this many characters.
pub fn clipped(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        text.to_owned()
    } else {
        text.chars().take(most - 2).chain("…".chars()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_significant_digits() {
        let texts = [0.0, 20.705, 0.001234, 123456.0, 60.0, 1e-9, 2.5e7].map(short);
        assert_eq!(texts, ["0", "20.7", "0.00123", "1.23e5", "60", "1.00e-9", "2.50e7"]);
    }
}
