//! Files: inputs with their bytes, and outputs that are written whole or not at all.

use super::Halt;
use squinch::import::Format;
use squinch::run::Source;
use squinch::run::case::Case;
use squinch::run::request::Request;
use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// An input with its bytes.
#[derive(Clone)]
pub struct Input {
    /// As given; `-` for standard input.
    pub path: String,
    /// The bytes.
    pub bytes: Vec<u8>,
    /// The format, if an option gives it.
    pub format: Option<Format>,
    /// The `.node` file beside a `.poly` file.
    pub nodes: Option<Vec<u8>>,
}

impl Input {
    /// Reads a file, or standard input for `-`.
    pub fn open(path: &Path, format: Option<Format>) -> Result<Self, Halt> {
        let shown = path.display().to_string();
        if path.is_dir() {
            return Err(Halt::Unreadable(format!("{shown}: a folder; `squinch batch` takes folders")));
        }
        let bytes = read(path).map_err(|e| Halt::Unreadable(format!("{shown}: {e}")))?;
        let beside = path.with_extension("node");
        let nodes = path.extension().filter(|e| e.eq_ignore_ascii_case("poly")).and_then(|_| fs::read(beside).ok());
        Ok(Self { path: shown, bytes, format, nodes })
    }

    /// The input of a run.
    pub fn source(&self) -> Source<'_> {
        Source {
            path: &self.path,
            bytes: &self.bytes,
            format: self.format,
            nodes: self.nodes.as_deref(),
            of_many: false,
        }
    }

    /// A case of this input.
    pub fn case(&self, outcome: &str, request: &Request) -> Case {
        Case::new(outcome, &self.source(), request)
    }
}

/// The bytes of a file, or of standard input for `-`.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    if path.as_os_str() != "-" {
        return fs::read(path);
    }
    let mut bytes = Vec::new();
    io::stdin().lock().read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Checks that each output can be written in its folder, before the work begins.
pub fn can_be_written<'a>(files: impl IntoIterator<Item = &'a PathBuf>) -> Result<(), Halt> {
    files.into_iter().filter(|path| path.as_os_str() != "-").try_for_each(|path| {
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.clone());
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        match fs::metadata(&target) {
            Ok(there) if there.is_dir() => return Err(Halt::Unwritable(format!("{}: is a folder", path.display()))),
            // A device or a pipe.
            Ok(there) if !there.is_file() => return Ok(()),
            _ => {}
        }
        if !folder.is_dir() {
            let folder = folder.display();
            let what = format!("{}: there is no folder {folder}: make it first (mkdir -p {folder})", path.display());
            return Err(Halt::Unwritable(what));
        }
        // Only a trial tells whether a file system accepts files.
        let mut trial = Staged::default();
        trial.add(path, &[]).map_err(unwritable)
    })
}

/// Checks that no output is the input or another output.
pub fn each_once(files: impl IntoIterator<Item = PathBuf>) -> Result<(), Halt> {
    let mut seen: Vec<PathBuf> = Vec::new();
    for path in files.into_iter().filter(|path| path.as_os_str() != "-" && !path.starts_with("/dev")) {
        let path = fs::canonicalize(&path).or_else(|_| std::path::absolute(&path)).unwrap_or(path);
        if seen.contains(&path) {
            return Err(Halt::Usage(format!("{} is named twice: each file is read or written once", path.display())));
        }
        seen.push(path);
    }
    Ok(())
}

/// The temporary files that exist now. Ctrl-C removes them.
static TEMPORARY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes all temporary files.
pub fn remove_temporaries() {
    for path in TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner).drain(..) {
        let _ = fs::remove_file(path); // nothing better can be done on the way out
    }
}

fn forget(path: &Path) {
    TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner).retain(|p| p != path);
}

/// Outputs under temporary names. [`Staged::commit`] gives all of them their names; without it none appears.
#[derive(Default)]
pub struct Staged {
    /// Temporary and final name.
    files: Vec<(PathBuf, PathBuf)>,
    /// The bytes for standard output.
    stdout: Vec<u8>,
}

impl Staged {
    /// Stages `bytes` for `path`, or for standard output where it is `-`.
    pub fn add(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        if path.as_os_str() == "-" {
            self.stdout.extend_from_slice(bytes);
            return Ok(());
        }
        let named = |e: io::Error| io::Error::new(e.kind(), format!("{}: {e}", path.display()));
        // A link is followed to its file. A device or a pipe cannot be renamed over.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        match fs::metadata(&target) {
            Ok(there) if there.is_dir() => return Err(named(io::ErrorKind::IsADirectory.into())),
            Ok(there) if !there.is_file() => return fs::write(&target, bytes).map_err(named),
            _ => {}
        }
        let name = target.file_name().ok_or_else(|| named(io::ErrorKind::InvalidInput.into()))?;
        let temporary = target.with_file_name(format!(".{}.{}.tmp", name.to_string_lossy(), std::process::id()));
        TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner).push(temporary.clone());
        self.files.push((temporary.clone(), target));
        fs::write(&temporary, bytes).map_err(named)
    }

    /// Gives every file its name, then writes to standard output.
    pub fn commit(mut self) -> io::Result<()> {
        for (temporary, target) in std::mem::take(&mut self.files) {
            let renamed = fs::rename(&temporary, &target);
            if renamed.is_err() {
                let _ = fs::remove_file(&temporary); // the error that counts is the renaming's
            }
            forget(&temporary);
            renamed.map_err(|e| io::Error::new(e.kind(), format!("{}: {e}", target.display())))?;
        }
        let mut stdout = io::stdout().lock();
        stdout.write_all(&self.stdout)?;
        stdout.flush()
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        for (temporary, _) in &self.files {
            let _ = fs::remove_file(temporary); // it may never have come to exist
            forget(temporary);
        }
    }
}

/// Prints data to standard output.
pub fn print(text: &str) -> Result<(), Halt> {
    let mut staged = Staged::default();
    staged.add(Path::new("-"), text.as_bytes()).and_then(|()| staged.commit()).map_err(unwritable)
}

/// The error of an output.
pub fn unwritable(error: io::Error) -> Halt {
    Halt::Unwritable(error.to_string())
}
