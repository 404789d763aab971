//! Whole files or none: written under a temporary name beside the target, then renamed.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Temporary names that are tried before giving up: more than runs that may write the same file at once.
const NAMES: u32 = 1000;

/// Writes a file through `fill`. On any error the target stays as it was, and the temporary file is removed.
pub fn write(path: &Path, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let (temporary, file) = create_beside(path)?;
    let result = fill_and_sync(file, fill).and_then(|()| fs::rename(&temporary, path));
    if result.is_err() {
        // The first error is the one to report; a temporary file that cannot be removed changes nothing of it.
        let _ = fs::remove_file(&temporary);
    }
    result
}

fn fill_and_sync(file: File, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, file);
    fill(&mut out)?;
    out.flush()?;
    // Before the rename, or a crash could leave the name on an empty file.
    out.get_ref().sync_all()
}

/// A new file in the target's folder (a rename does not cross file systems), its name after the target's.
fn create_beside(path: &Path) -> io::Result<(PathBuf, File)> {
    let Some(name) = path.file_name() else {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, format!("'{}' names no file", path.display())));
    };
    for i in 0..NAMES {
        let mut temporary = std::ffi::OsString::from(".");
        temporary.push(name);
        temporary.push(format!(".{}-{i}.part", std::process::id()));
        let temporary = path.with_file_name(temporary);
        match OpenOptions::new().write(true).create_new(true).open(&temporary) {
            Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
            other => return other.map(|file| (temporary, file)),
        }
    }
    Err(io::Error::new(io::ErrorKind::AlreadyExists, "too many unfinished files of this name"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("squinch-atomic-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder for temporary files");
        folder
    }

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = folder("failed");
        let path = folder.join("mesh.vtu");
        write(&path, |out| out.write_all(b"old")).expect("written");
        let failed = write(&path, |out| {
            out.write_all(b"half of the n")?;
            Err(io::Error::other("full"))
        });
        assert_eq!(failed.expect_err("fails").to_string(), "full");
        assert_eq!(fs::read(&path).expect("still there"), b"old");
        assert_eq!(fs::read_dir(&folder).expect("readable").count(), 1);
        write(&path, |out| out.write_all(b"new")).expect("written");
        assert_eq!(fs::read(&path).expect("there"), b"new");
        fs::remove_dir_all(folder).expect("removed");
    }

    #[test]
    fn no_folder_no_file() {
        assert!(write(&folder("none").join("missing/mesh.vtu"), |_| Ok(())).is_err());
        assert!(write(Path::new("/"), |_| Ok(())).is_err());
    }
}
