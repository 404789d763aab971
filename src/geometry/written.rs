//! Numbers in text, as people and programs write them.

/// The finite number that a token is, as Fortran, C and spreadsheets write it (`.5`, `1.`, `-1.5D-03`); `None` for
/// words such as `nan`.
pub fn number(token: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(token).ok()?;
    if !text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.')) {
        return None;
    }
    let value = match text.parse::<f64>() {
        Ok(value) => value,
        Err(_) => text.replace(['d', 'D'], "e").parse().ok()?,
    };
    value.is_finite().then_some(value)
}

/// The tokens of a line, separated by blanks, commas and semicolons.
pub fn tokens(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|b| b.is_ascii_whitespace() || matches!(b, b',' | b';')).filter(|t| !t.is_empty())
}

/// The tokens of a line, each as a number if it is one.
pub fn numbers(line: &[u8]) -> impl Iterator<Item = Option<f64>> {
    tokens(line).map(number)
}
