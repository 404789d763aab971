//! A case: one run in one text file, to be repeated on any machine: the input's bytes, the request, and the version that made it.
//!
//! Written when we panic, when a promise breaks that no request can excuse, and by `mesh --case`.

use crate::request::Request;
use base64::Engine;
use serde::{Deserialize, Serialize};

/// A recorded run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Version of squinch that wrote it.
    pub squinch: String,
    /// What came of the run, for people: "panic: …", "broken: manifold", "done".
    pub outcome: String,
    pub input: CaseInput,
    pub request: Request,
}

/// The bytes that were read, and how.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseInput {
    /// File name without folders: its suffix and stem tell format and title.
    pub name: String,
    /// Format, where it was given and not told from name and content.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub format: Option<String>,
    #[serde(flatten)]
    content: Content,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Content {
    Text(String),
    Base64(String),
}

/// Why a case file cannot be repeated.
#[derive(Debug, thiserror::Error)]
pub enum CaseError {
    #[error("no case file: {0}")]
    Shape(#[from] toml::de::Error),
    #[error("the input recorded in the case is no base64: {0}")]
    Bytes(#[from] base64::DecodeError),
}

impl Case {
    pub fn new(outcome: impl Into<String>, name: &str, format: Option<&str>, bytes: &[u8], request: &Request) -> Self {
        Self {
            squinch: env!("CARGO_PKG_VERSION").into(),
            outcome: outcome.into(),
            input: CaseInput { name: name.into(), format: format.map(str::to_owned), content: Content::of(bytes) },
            request: request.clone(),
        }
    }

    /// The bytes of the input.
    pub fn bytes(&self) -> Result<Vec<u8>, CaseError> {
        match &self.input.content {
            Content::Text(text) => Ok(text.clone().into_bytes()),
            Content::Base64(text) => Ok(base64::engine::general_purpose::STANDARD.decode(text)?),
        }
    }

    pub fn from_toml(text: &str) -> Result<Self, CaseError> {
        let case: Self = toml::from_str(text)?;
        case.bytes()?;
        Ok(case)
    }

    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("a case holds only strings, numbers and tables of them")
    }

    /// Sixteen hexadecimal digits that stand for input and request, for file names.
    pub fn fingerprint(&self) -> String {
        format!("{:016x}", fnv1a(self.to_toml().as_bytes()))
    }
}

impl Content {
    /// As text where it is readable text whose line ends survive a text file, else in base64.
    fn of(bytes: &[u8]) -> Self {
        match std::str::from_utf8(bytes) {
            Ok(text) if !text.chars().any(|c| c.is_control() && c != '\n' && c != '\t') => Self::Text(text.into()),
            _ => Self::Base64(base64::engine::general_purpose::STANDARD.encode(bytes)),
        }
    }
}

/// The 64-bit hash of Fowler, Noll and Vo, variant 1a: the same on every machine and in every version.
fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_survives_its_file_byte_for_byte() {
        let inputs: [&[u8]; 6] = [
            b"wing\n 1.0 0.0\n 0.0 0.0\n",
            b"\n\nleading and trailing blank lines\n\n",
            b"quotes ''' and \"\"\" and \\ backslash\tand tab",
            b"line ends\r\nof another system\r\n",
            b"\xff\xfe not utf-8 \0",
            b"",
        ];
        for bytes in inputs {
            let case = Case::new("done", "wing.dat", Some("airfoil"), bytes, &Request::default());
            let text = case.to_toml();
            let again = Case::from_toml(&text).unwrap_or_else(|e| panic!("{e}\n{text}"));
            assert_eq!(again, case, "{text}");
            assert_eq!(again.bytes().unwrap(), bytes);
        }
    }

    #[test]
    fn the_fingerprint_tells_requests_apart() {
        let case = |request: &Request| Case::new("done", "a.poly", None, b"x", request).fingerprint();
        let other = Request { min_angle: 10.0, ..Request::default() };
        assert_eq!(case(&Request::default()), case(&Request::default()));
        assert_ne!(case(&Request::default()), case(&other));
        assert_eq!(fnv1a(b"a"), 0xaf63_dc4c_8601_ec8c, "the published test vector");
    }

    #[test]
    fn what_is_no_case_is_refused() {
        assert!(Case::from_toml("squinch = 1").is_err());
        assert!(Case::from_toml("").is_err());
        let text =
            Case::new("done", "a", None, b"\xff", &Request::default()).to_toml().replace("base64 = \"", "base64 = \"!");
        assert!(matches!(Case::from_toml(&text), Err(CaseError::Bytes(_))), "{text}");
    }
}
