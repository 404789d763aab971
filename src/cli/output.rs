//! Outputs: mesh files or pictures of the mesh, their names, and the files of each.

use super::Halt;
use squinch::meshio;
use squinch::picture;
use squinch::run::request::Request;
use std::fs;
use std::path::{Path, PathBuf};

/// The format of an output.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Output {
    Mesh(meshio::Format),
    /// A picture, which holds no mesh.
    Picture(picture::Format),
}

impl Output {
    fn all() -> impl Iterator<Item = Self> {
        meshio::Format::ALL.into_iter().map(Self::Mesh).chain(picture::Format::ALL.into_iter().map(Self::Picture))
    }

    /// The names of all formats, for people.
    fn names() -> String {
        Self::all().map(Self::name).collect::<Vec<_>>().join(", ")
    }

    /// The name by which a user asks for the format.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mesh(format) => format.name(),
            Self::Picture(format) => format.name(),
        }
    }

    /// Suffixes of the files that an output consists of, in the order of [`Output::encode`].
    pub fn suffixes(self) -> &'static [&'static str] {
        match self {
            Self::Mesh(format) => format.suffixes(),
            Self::Picture(format) => format.suffixes(),
        }
    }

    /// The format of this name, for options.
    pub fn named(name: &str) -> Result<Self, String> {
        let found = Self::all().find(|output| output.name().eq_ignore_ascii_case(name));
        found.ok_or_else(|| format!("one of {}", Self::names()))
    }

    /// The format of an output: as given, else by its suffix.
    pub fn of(path: &Path, asked: Option<Self>) -> Result<Self, Halt> {
        let by_suffix = || {
            let mesh = meshio::Format::to_write(path).map(Self::Mesh);
            mesh.or_else(|| picture::Format::of(path).map(Self::Picture))
        };
        let output = asked
            .or_else(by_suffix)
            .ok_or_else(|| Halt::Usage(format!("{}: say its format by --format: {}", path.display(), Self::names())))?;
        if path.as_os_str() == "-" && output.files(path).len() > 1 {
            let files = output.suffixes().join(", .");
            return Err(Halt::Usage(format!("-o -: {} is several files: .{files}", output.name())));
        }
        Ok(output)
    }

    /// The files of an output: the one named, and for some formats others beside it. Where the first file has the
    /// user's name, the others need a [`stem`].
    pub fn files(self, path: &Path) -> Vec<PathBuf> {
        let several = self.suffixes();
        let as_named = match self {
            Self::Mesh(format) => format.first_as_named(),
            Self::Picture(_) => true,
        };
        let by_suffix = || several.iter().map(|suffix| path.with_extension(suffix));
        let is_beside = |suffix: &&str| path.extension().is_some_and(|given| given.eq_ignore_ascii_case(suffix));
        match several {
            [_, beside @ ..] if as_named => {
                if beside.is_empty() || stem(path).is_none() {
                    return vec![path.to_owned()];
                }
                if beside.iter().any(is_beside) {
                    return by_suffix().collect();
                }
                [path.to_owned()].into_iter().chain(by_suffix().skip(1)).collect()
            }
            _ => by_suffix().collect(),
        }
    }

    /// Refuses a format that cannot hold the requested order, before there is a mesh.
    pub fn hold_order(self, request: &Request) -> Result<(), Halt> {
        let order = u64::from(request.order);
        match self {
            Self::Mesh(format) => {
                format.holds_order(order as u8).map_err(|e| Halt::Usage(format!("--order {order}: {e}")))
            }
            Self::Picture(_) => Ok(()),
        }
    }
}

/// The name without suffix by which other files of an output refer to it; `None` for a stream, and for a name that is
/// not text.
pub fn stem(path: &Path) -> Option<String> {
    let is_stream =
        path.as_os_str() == "-" || fs::metadata(path).is_ok_and(|there| !there.is_file() && !there.is_dir());
    let stem = path.file_stem()?.to_str()?;
    (!is_stream && !stem.contains(char::is_control)).then(|| stem.to_owned())
}
