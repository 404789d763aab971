//! Experiments and measurements: each prints one table. See README.md beside.

mod complexes;
mod corners;
mod fig4;
mod million;
mod run;
mod wild;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    match args.first().map(String::as_str) {
        Some("fig4") => fig4::print(),
        Some("complexes") => complexes::print(args.get(1).and_then(|n| n.parse().ok()).unwrap_or(200)),
        Some("corners") if args.len() == 2 => corners::print(&args[1]),
        Some("million") => million::print(),
        Some("wild") => wild::print(args.get(1).is_some_and(|word| word == "large")),
        _ => {
            eprintln!("usage: squinch-bench fig4 | complexes [N] | corners DIR | million | wild [large]");
            std::process::exit(2);
        }
    }
}
