//! Tells the program of which commit and with which features it is built. Without git, or far from a repository, it is just not told.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo names the folder of the package"));
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-env=SQUINCH_FEATURES={}", features());
    println!(
        "cargo:rustc-env=SQUINCH_COMMIT={}",
        packaged(&root).or_else(|| checked_out(&root)).unwrap_or("unknown commit".into())
    );
}

/// Features that are on, in the order of their names, but for those that every program has.
fn features() -> String {
    let on = |(key, _): (String, String)| {
        key.strip_prefix("CARGO_FEATURE_").map(|name| name.to_lowercase().replace('_', "-"))
    };
    let mut features: Vec<String> =
        env::vars().filter_map(on).filter(|name| !["default", "cli", "parallel"].contains(&&name[..])).collect();
    features.sort();
    if features.is_empty() { "none".into() } else { features.join(", ") }
}

/// Digits of a commit that tell it apart.
const DIGITS: usize = 12;

/// The commit that `cargo package` wrote down.
fn packaged(root: &Path) -> Option<String> {
    let text = std::fs::read_to_string(root.join(".cargo_vcs_info.json")).ok()?;
    let commit = text.split_once("\"sha1\"")?.1.split('"').nth(1)?;
    commit.get(..DIGITS).map(str::to_owned)
}

/// The commit that is checked out, if the folder is a repository of its own and not a folder in that of somebody else.
fn checked_out(root: &Path) -> Option<String> {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").arg("-C").arg(root).args(arguments).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let top = PathBuf::from(git(&["rev-parse", "--show-toplevel"])?);
    if top.canonicalize().ok()? != root.canonicalize().ok()? {
        return None;
    }
    // The file that changes with every commit, whatever is checked out.
    for name in ["HEAD", "logs/HEAD"] {
        let path = root.join(git(&["rev-parse", "--git-path", name])?);
        if path.exists() {
            println!("cargo:rerun-if-changed={}", path.display());
        }
    }
    git(&["rev-parse", &format!("--short={DIGITS}"), "HEAD"])
}
