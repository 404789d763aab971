//! Sizes by place as a user gives them: an expression, or a file of places with a size each.

use super::Expression;
use crate::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The default growth of the size away from a sample, a unit of distance: neighbouring cells differ by a third.
pub const SAMPLE_GRADE: f64 = 0.3;

/// How large cells are to be, by place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "Form", into = "Form")]
pub enum Given {
    /// A formula in x and y.
    Expression(Expression),
    /// x, y and the size there, which grows with the distance.
    Samples(Vec<[f64; 3]>),
}

/// Its form in a file of options.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
enum Form {
    Text(String),
    Samples(Vec<[f64; 3]>),
}

impl TryFrom<Form> for Given {
    type Error = String;
    fn try_from(form: Form) -> Result<Self, String> {
        match form {
            Form::Text(text) => text.parse(),
            Form::Samples(samples) => Ok(Self::Samples(samples)),
        }
    }
}

impl From<Given> for Form {
    fn from(given: Given) -> Self {
        match given {
            Given::Expression(expression) => Self::Text(expression.text().to_owned()),
            Given::Samples(samples) => Self::Samples(samples),
        }
    }
}

impl FromStr for Given {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        Expression::read(text).map(Self::Expression)
    }
}

impl fmt::Display for Given {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Expression(expression) => f.write_str(expression.text()),
            Self::Samples(samples) => write!(f, "{} places", samples.len()),
        }
    }
}

impl Given {
    /// Reads a file of sizes: `x y size` on every line, between blanks, commas or semicolons; `#` begins a comment.
    ///
    /// # Errors
    /// A sentence with the first line that has another form.
    pub fn read_samples(text: &str) -> Result<Self, String> {
        rows_of(text, "x y size").map(Self::Samples)
    }

    /// What is out of bounds, as a phrase; `None` if nothing is.
    pub fn flaw(&self) -> Option<&'static str> {
        match self {
            Self::Expression(_) => None,
            Self::Samples(samples) if samples.is_empty() => Some("a place with a size is needed"),
            Self::Samples(samples) if samples.iter().any(|s| !(s[2] > 0.0 && s[2].is_finite())) => {
                Some("every size must be a positive number")
            }
            Self::Samples(_) => None,
        }
    }

    /// The first of some places at which an expression has no positive finite value.
    pub fn undefined_at(&self, places: impl IntoIterator<Item = Point>) -> Option<Point> {
        match self {
            Self::Expression(expression) => {
                places.into_iter().find(|&p| !(expression.at(p) > 0.0 && expression.at(p).is_finite()))
            }
            Self::Samples(_) => None,
        }
    }
}

/// Rows of N finite numbers, separated by blanks, commas or semicolons; `#` begins a comment.
///
/// # Errors
/// A sentence with the first line that is not of the form `form`.
pub fn rows_of<const N: usize>(text: &str, form: &str) -> Result<Vec<[f64; N]>, String> {
    let mut rows = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default();
        let tokens: Vec<&str> =
            line.split(|c: char| c.is_whitespace() || matches!(c, ',' | ';')).filter(|t| !t.is_empty()).collect();
        if tokens.is_empty() {
            continue;
        }
        let numbers: Option<Vec<f64>> = tokens.iter().map(|t| t.parse().ok().filter(|v: &f64| v.is_finite())).collect();
        let row: Option<[f64; N]> = numbers.and_then(|n| n.try_into().ok());
        rows.push(row.ok_or_else(|| format!("line {}: `{form}` is expected", i + 1))?);
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_read_with_comments_and_separators() {
        let read = Given::read_samples("# size field\n0 0 0.1\n\n1,2;3 # here\n").unwrap();
        assert_eq!(read, Given::Samples(vec![[0.0, 0.0, 0.1], [1.0, 2.0, 3.0]]));
        assert_eq!(Given::read_samples("0 0 1\n1 2").unwrap_err(), "line 2: `x y size` is expected");
        assert_eq!(Given::read_samples("0 0 nan").unwrap_err(), "line 1: `x y size` is expected");
        assert!(Given::Samples(vec![[0.0, 0.0, -1.0]]).flaw().is_some());
        assert!(Given::read_samples("").unwrap().flaw().is_some());
    }

    #[test]
    fn an_expression_is_asked_where_it_gives_no_size() {
        let given: Given = "x - 1".parse().unwrap();
        assert_eq!(given.undefined_at([Point::new(2.0, 0.0), Point::new(1.0, 5.0)]), Some(Point::new(1.0, 5.0)));
        assert_eq!(given.undefined_at([Point::new(2.0, 0.0)]), None);
    }
}
