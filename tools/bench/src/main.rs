//! Experiments and measurements: each prints one table. See README.md beside.

mod complexes;
mod corners;
mod densities;
mod engines;
mod fig4;
mod million;
mod pslgs;
mod run;
mod strategies;
mod thirty;
mod wild;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    match args.first().map(String::as_str) {
        Some("fig4") => fig4::print(),
        Some("complexes") => complexes::print(args.get(1).and_then(|n| n.parse().ok()).unwrap_or(200)),
        Some("corners") if args.len() == 2 => corners::print(&args[1]),
        Some("million") => million::print(),
        Some("densities") if args.len() == 2 => told(densities::print(&args[1])),
        Some("engines") if args.len() >= 2 => told(engines::print(&args[1..])),
        Some("pslgs") => {
            let number = |i: usize, default| args.get(i).and_then(|n| n.parse().ok()).unwrap_or(default);
            pslgs::print(number(1, 1000), number(2, 0));
        }
        Some("strategies") if args.len() >= 2 => args[1..].iter().for_each(|path| told(strategies::print(path))),
        Some("thirty") if args.len() >= 2 => told(thirty::print(&args[1..])),
        Some("wild") => wild::print(args.get(1).is_some_and(|word| word == "large")),
        _ => {
            eprintln!(
                "usage: squinch-bench fig4 | complexes [N] | corners DIR | million | densities PSLG | engines PSLG… | pslgs [N] [FROM] | strategies PSLG… | thirty DIR… | wild [large]"
            );
            std::process::exit(2);
        }
    }
}

/// An error ends the program.
fn told(result: Result<(), String>) {
    if let Err(what) = result {
        eprintln!("{what}");
        std::process::exit(1);
    }
}
