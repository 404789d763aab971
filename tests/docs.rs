//! Checks the documents: tables of guarantees equal what their formulas give, and links lead to files.

use squinch::promise::guaranteed_angle;
use std::f64::consts::{FRAC_PI_3, SQRT_2};
use std::path::{Path, PathBuf};

/// Rows of the tables of a file whose first cell is a τ: the τ, and the numbers of the other cells.
fn rows(file: &str) -> Vec<(f64, Vec<f64>)> {
    let text = std::fs::read_to_string(file).unwrap_or_else(|e| panic!("{file}: {e}"));
    let cells = |line: &str| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let tau = |cell: &str| match cell {
        "π/3" => Some(FRAC_PI_3),
        "→ 0 (straight input)" => Some(0.0),
        number => number.parse().ok(),
    };
    let row = |line: &str| {
        let cells = cells(line);
        let numbers: Option<Vec<f64>> = cells[1..].iter().map(|cell| cell.trim_end_matches('°').parse().ok()).collect();
        Some((tau(&cells[0])?, numbers?))
    };
    text.lines().filter(|line| line.starts_with('|')).filter_map(row).collect()
}

/// η, μ and ζ of a lens angle, as Corollaries 1 and 2 and the corrected Lemma 2 give them.
fn constants(lambda: f64) -> [f64; 3] {
    let t = (lambda / 2.0).tan();
    [(1.0 + t) / (1.0 - t), 1.0 / (1.0 - t), SQRT_2 / (1.0 - t)]
}

/// The bound of Theorem 1, in degrees.
fn kappa_deg(lambda: f64) -> f64 {
    let [eta, mu, zeta] = constants(lambda);
    (0.5 / (SQRT_2 * mu)).asin().min((0.5 / (zeta * eta)).asin()).to_degrees()
}

#[test]
fn the_table_of_the_readme_is_what_the_theorem_gives() {
    let rows = rows("README.md");
    let rows: Vec<_> = rows.iter().filter(|(_, numbers)| numbers.len() == 2).collect();
    assert_eq!(rows.len(), 6);
    for (tau, numbers) in rows {
        assert_eq!(*numbers, [*tau, tau / 2.0].map(|lambda| (kappa_deg(lambda) * 1e3).round() / 1e3), "τ = {tau}");
    }
}

#[test]
fn the_table_of_the_derivation_is_what_its_formulas_give() {
    let rows = rows("docs/guarantee.md");
    let rows: Vec<_> = rows.iter().filter(|(_, numbers)| numbers.len() == 5).collect();
    assert_eq!(rows.len(), 6);
    for (tau, numbers) in rows {
        let rounded = constants(*tau).map(|constant| (constant * 1e5).round() / 1e5);
        assert_eq!(numbers[..3], rounded, "τ = {tau}");
        assert_eq!(numbers[3..], [*tau, tau / 2.0].map(|lambda| (kappa_deg(lambda) * 1e3).round() / 1e3), "τ = {tau}");
    }
}

#[test]
fn the_library_guarantees_what_the_theorem_gives() {
    for k in 0..=100 {
        let lambda = FRAC_PI_3 * f64::from(k) / 100.0;
        assert!((guaranteed_angle(lambda).to_degrees() - kappa_deg(lambda)).abs() < 1e-12, "{lambda}");
    }
}

/// The documents: the Markdown files of the root, and all below some folders.
fn documents() -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> =
        ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "src/README.md", "samples/README.md"]
            .map(PathBuf::from)
            .into();
    let mut folders = vec![PathBuf::from("docs")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder of documents") {
            let path = entry.expect("an entry").path();
            match path.is_dir() {
                true => folders.push(path),
                false => found.push(path),
            }
        }
    }
    found
}

#[test]
fn links_of_documents_lead_to_files() {
    let mut count = 0;
    for document in documents() {
        let text = std::fs::read_to_string(&document).expect("a document");
        let folder = document.parent().unwrap_or(Path::new("."));
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let target = link.split('#').next().unwrap_or(link);
            if target.is_empty() || target.contains("://") {
                continue;
            }
            assert!(folder.join(target).exists(), "{}: {link} leads nowhere", document.display());
            count += 1;
        }
    }
    assert!(count > 30, "links are found: {count}");
}

#[test]
fn every_symbol_of_the_guarantee_is_in_the_list_of_terms() {
    let terms = std::fs::read_to_string("docs/terms.md").expect("the terms");
    for symbol in ["κ", "τ", "λ", "η", "μ", "ζ", "β", "C₀", "B(p)", "d(p)", "lfs₀", "ρ̄", "δ₂", "δ₁", "D(p)", "R(p)"]
    {
        assert!(terms.contains(symbol), "{symbol}");
    }
}
