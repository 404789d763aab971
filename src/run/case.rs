//! A case: one run in one text file, which repeats it on any machine. It holds the bytes of the input, the request, and
//! the version of squinch.
//!
//! A case is written on a panic, on a broken guarantee that holds whatever the request, and by `mesh --case`.

use super::Source;
use super::request::Request;
use base64::Engine;
use serde::{Deserialize, Serialize};
use std::any::Any;
use std::cell::{Cell, RefCell};
use std::panic::AssertUnwindSafe;
use std::path::Path;
use std::sync::Once;

/// A recorded run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Version of squinch that wrote it.
    pub squinch: String,
    /// The end of the run, for people: "panic: …", "broken: manifold", "done".
    pub outcome: String,
    /// The input, bytes included.
    pub input: CaseInput,
    /// The options of the run.
    pub request: Request,
}

/// The bytes that were read, and how.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseInput {
    /// File name without folders. Its suffix and stem give format and title.
    pub name: String,
    /// The format, if it was given by an option.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub format: Option<String>,
    /// The bytes themselves, under `text` or `base64`.
    #[serde(flatten)]
    content: Content,
    /// The `.node` file beside a `.poly` file.
    #[serde(skip_serializing_if = "Option::is_none")]
    nodes: Option<Content>,
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
    /// The text is no TOML, or not the TOML of a case.
    #[error("not a case file: {0}")]
    Shape(#[from] toml::de::Error),
    /// The recorded bytes are not valid base64.
    #[error("the input recorded in the case is not base64: {0}")]
    Bytes(#[from] base64::DecodeError),
}

impl Case {
    /// Records a run; of the source's path only the file name.
    pub fn new(outcome: impl Into<String>, source: &Source, request: &Request) -> Self {
        let name = Path::new(source.path).file_name().map_or("-".into(), |n| n.to_string_lossy().into_owned());
        Self {
            squinch: env!("CARGO_PKG_VERSION").into(),
            outcome: outcome.into(),
            input: CaseInput {
                name,
                format: source.format.map(|f| f.name().to_owned()),
                content: Content::of(source.bytes),
                nodes: source.nodes.map(Content::of),
            },
            request: request.clone(),
        }
    }

    /// The bytes of the input, and those of its `.node` file.
    ///
    /// # Errors
    /// [`CaseError::Bytes`] where the recorded base64 is broken.
    pub fn bytes(&self) -> Result<(Vec<u8>, Option<Vec<u8>>), CaseError> {
        Ok((self.input.content.bytes()?, self.input.nodes.as_ref().map(Content::bytes).transpose()?))
    }

    /// Reads a case file, and checks that its bytes can be restored.
    ///
    /// # Errors
    /// [`CaseError::Shape`] where the text is not the TOML of a case, [`CaseError::Bytes`] where its base64 is broken.
    pub fn from_toml(text: &str) -> Result<Self, CaseError> {
        let case: Self = toml::from_str(text)?;
        case.bytes()?;
        Ok(case)
    }

    /// The text of the case file, from which [`Case::from_toml`] restores the case exactly.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("a case holds only strings, numbers and tables of them")
    }

    /// Sixteen hexadecimal digits that identify input and request, for file names.
    pub fn fingerprint(&self) -> String {
        format!("{:016x}", fnv1a(self.to_toml().as_bytes()))
    }
}

impl Content {
    fn bytes(&self) -> Result<Vec<u8>, CaseError> {
        match self {
            Self::Text(text) => Ok(text.clone().into_bytes()),
            Self::Base64(text) => Ok(base64::engine::general_purpose::STANDARD.decode(text)?),
        }
    }

    /// As text, if it is text whose line ends survive a text file, else in base64.
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

/// A caught panic: its message and place.
#[derive(Clone, Debug, PartialEq)]
pub struct Panic {
    /// The panic's message.
    pub message: String,
    /// Source file and line.
    pub place: String,
}

impl std::fmt::Display for Panic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} ({})", self.message, self.place)
    }
}

thread_local! {
    /// Number of calls of [`caught`] that are open on this thread.
    static CATCHING: Cell<usize> = const { Cell::new(0) };
    /// Where this thread last panicked inside of [`caught`]. The payload of a panic has the message only.
    static PLACE: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Runs `work`. A panic in it is returned as a value, and nothing is printed.
///
/// # Errors
/// [`Panic`] with message and place, where `work` panicked.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, Panic> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let others = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if CATCHING.get() == 0 {
                return others(info);
            }
            let place = info.location().map_or_else(String::new, |at| format!("{}:{}", at.file(), at.line()));
            PLACE.set(place);
        }));
    });
    CATCHING.set(CATCHING.get() + 1);
    let result = std::panic::catch_unwind(AssertUnwindSafe(work));
    CATCHING.set(CATCHING.get() - 1);
    result.map_err(|payload| Panic { message: message(payload.as_ref()), place: PLACE.take() })
}

fn message(payload: &dyn Any) -> String {
    let text = payload.downcast_ref::<&str>().copied().or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("a panic without a message").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::Format;

    fn source(bytes: &[u8]) -> Source<'_> {
        Source { path: "folder/wing.dat", bytes, format: Some(Format::Airfoil), nodes: None, of_many: false }
    }

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
            for nodes in [None, Some(bytes)] {
                let case = Case::new("done", &Source { nodes, ..source(bytes) }, &Request::default());
                let text = case.to_toml();
                let again = Case::from_toml(&text).unwrap_or_else(|e| panic!("{e}\n{text}"));
                assert_eq!(again, case, "{text}");
                assert_eq!(again.input.name, "wing.dat");
                assert_eq!(again.bytes().unwrap(), (bytes.to_vec(), nodes.map(<[u8]>::to_vec)));
            }
        }
    }

    #[test]
    fn the_fingerprint_tells_requests_apart() {
        let fingerprint = |request: &Request| Case::new("done", &source(b"x"), request).fingerprint();
        let other = Request { min_angle: 10.0, ..Request::default() };
        assert_eq!(fingerprint(&Request::default()), fingerprint(&Request::default()));
        assert_ne!(fingerprint(&Request::default()), fingerprint(&other));
        assert_eq!(fnv1a(b"a"), 0xaf63_dc4c_8601_ec8c, "the published test vector");
    }

    #[test]
    fn what_is_no_case_is_refused() {
        assert!(Case::from_toml("squinch = 1").is_err());
        assert!(Case::from_toml("").is_err());
        let text = Case::new("done", &source(b"\xff"), &Request::default()).to_toml();
        let text = text.replace("base64 = \"", "base64 = \"!");
        assert!(matches!(Case::from_toml(&text), Err(CaseError::Bytes(_))), "{text}");
    }

    #[test]
    fn a_panic_comes_back_with_its_place() {
        let panic = caught(|| panic!("{} went wrong", "it")).expect_err("it panics");
        assert_eq!(panic.message, "it went wrong");
        assert!(panic.place.contains("case.rs:"), "{panic}");
        assert_eq!(caught(|| 3), Ok(3));
    }
}
