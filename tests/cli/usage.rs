//! What is typed: help, options, the config file, what is refused.

use super::*;

#[test]
fn help_answers() {
    let bench = Bench::new("help");
    let help = printed(&bench.ends(0, &["--help"]));
    for word in ["mesh", "check", "convert", "inspect", "draw", "replay", "reduce", "Exit codes", "130"] {
        assert!(help.contains(word), "{word}\n{help}");
    }
    for verb in ["mesh", "check", "batch", "convert", "schema", "inspect", "draw", "replay", "reduce"] {
        assert!(printed(&bench.ends(0, &[verb, "--help"])).contains("Usage: squinch"), "{verb}");
    }
    let mesh = printed(&bench.ends(0, &["mesh", "--help"]));
    for option in [
        "--engine",
        "--min-angle",
        "--max-turning",
        "--beta",
        "--ball-shrinking",
        "--midpoint",
        "--max-area",
        "--max-edge",
        "--min-edge",
        "--chord-error",
        "--edge-turning",
        "--grade",
        "--size-of",
        "--order",
        "--tolerance",
        "--fill-rule",
        "--keep",
        "--unit",
        "--scale",
        "--corner-arcs",
        "--max-vertices",
        "--timeout",
        "--report",
        "--case",
        "--trailing-edge",
        "--far-field",
        "--incidence",
        "--config",
        "--threads",
        "--quiet",
        "--input-format",
        "--format",
    ] {
        assert!(mesh.contains(option), "{option}");
    }
}

#[test]
fn wrong_usage_is_2_and_leaves_nothing() {
    let bench = Bench::new("usage");
    fs::write(bench.0.join("word.toml"), "beta = 'much'\n").unwrap();
    fs::write(bench.0.join("key.toml"), "beto = 0.9\n").unwrap();
    let inputs = bench.made();
    let wrong: Vec<Vec<&str>> = vec![
        vec![],
        vec!["mash"],
        vec!["mesh"],
        vec!["mesh", "square.poly"],
        vec!["mesh", "square.poly", "-o", "a.unknown"],
        vec!["mesh", "square.poly", "-o", "-"],
        vec!["mesh", "square.poly", "-o", "-", "--format", "vtu", "--report", "-"],
        vec!["mesh", "square.poly", "-o", "a.vtu", "-o", "b.svg", "--format", "vtu"],
        vec!["draw", "square.poly", "-o", "a.vtu"],
        vec!["draw", "square.poly", "-o", "a.svg", "--view", "1,1,0,0"],
        with(&["--min-angle", "60"]),
        with(&["--min-angle", "some"]),
        with(&["--max-turning", "1.1"]),
        with(&["--beta", "1"]),
        with(&["--max-area", "0"]),
        with(&["--chord-error", "0%"]),
        with(&["--size-of", "0.1"]),
        with(&["--unit", "cubit"]),
        with(&["--input-format", "dwg"]),
        with(&["--config", "missing.toml"]),
        with(&["--config", "word.toml"]),
        with(&["--config", "key.toml"]),
        with(&["--threads", "0"]),
        with(&["--quiet", "--verbose"]),
    ];
    for arguments in wrong {
        let output = bench.ends(2, &arguments);
        assert!(!output.stderr.is_empty() && output.stdout.is_empty(), "{arguments:?}");
    }
    assert_eq!(bench.made(), inputs);
}

#[test]
fn what_comes_later_is_refused_by_name() {
    let bench = Bench::new("later");
    for option in ["--radius-edge=2", "--max-volume=1"] {
        let output = bench.ends(2, &["mesh", "square.poly", "-o", "a.vtu", option]);
        assert!(said(&output).contains("not in this version"), "{option}: {}", said(&output));
    }
    assert!(bench.made().is_empty());
}

#[test]
fn an_option_below_its_bound_is_answered_by_the_bound() {
    let bench = Bench::new("negative");
    for [option, value, why] in [
        ["--min-angle", "-1", "an angle from 0"],
        ["--tolerance", "-1", "not negative"],
        ["--max-area", "-1e-3", "a positive number"],
        ["--chord-error", "-0.5", "a positive length"],
        ["--far-field", "-2", "1 chord or more"],
    ] {
        let output = bench.ends(2, &with(&[option, value]));
        assert!(said(&output).contains(why), "{option} {value}: {}", said(&output));
    }
}

#[test]
fn an_option_that_has_no_use_is_told() {
    let bench = Bench::new("unused");
    let output = bench.ends(0, &with(&["--far-field", "5", "--incidence", "-3", "--report", "r.json"]));
    assert!(said(&output).contains("--far-field, --incidence: only for airfoils"), "{}", said(&output));
    let notes = bench.report("r.json")["input"]["notes"].to_string();
    assert!(notes.contains("--far-field, --incidence"), "{notes}");
    assert!(!said(&bench.ends(0, &with(&[]))).contains("airfoils"));
}

#[test]
fn the_command_line_wins_over_the_config_file() {
    let bench = Bench::new("config");
    fs::write(
        bench.0.join("c.toml"),
        "min-angle = 12\nmax-turning = 'auto'\nbeta = 0.5\ncorner-arcs = 'off'\nsize-of = ['below=0.2']\n",
    )
    .unwrap();
    bench.ends(0, &["mesh", "lens.json", "-o", "a.vtu", "--config", "c.toml", "--beta", "0.8", "--report", "r.json"]);
    let request = &bench.report("r.json")["request"];
    assert_eq!(request["angle_min_deg"], 12.0);
    assert_eq!(request["beta"], 0.8);
    assert_eq!(request["max_turning"], "auto");
    assert_eq!(request["corner_arcs"], false);
    assert_eq!(request["size_of"]["below"], 0.2);
    assert!(request["tau_rad"].as_f64() > Some(0.5), "12° is proven on arcs beyond τ = 0.5: {request}");
}

#[test]
fn the_version_tells_commit_and_features() {
    let version = printed(&Bench::new("version").ends(0, &["--version"]));
    let rest = version.strip_prefix(concat!("squinch ", env!("CARGO_PKG_VERSION"), " (")).expect("name and version");
    let (commit, features) = rest.split_once("; features: ").expect("two parts");
    assert!(commit == "unknown commit" || commit.bytes().all(|b| b.is_ascii_hexdigit()), "{version}");
    assert_eq!(features, format!("{})\n", if cfg!(feature = "cad") { "cad" } else { "none" }));
}

#[test]
fn short_help_is_for_jobs_and_long_help_for_all() {
    let bench = Bench::new("short-help");
    for verb in ["mesh", "batch"] {
        let [short, long] = ["-h", "--help"].map(|help| printed(&bench.ends(0, &[verb, help])));
        for option in ["--delta2", "--ball-shrinking", "--steiner"] {
            assert!(long.contains(option) && !short.contains(option), "{option}");
        }
        for option in ["--min-angle", "--max-edge", "--engine", "--order", "--plain", "--format"] {
            assert!(short.contains(option), "{option}\n{short}");
        }
    }
    assert!(printed(&bench.ends(0, &["-h"])).contains("By job:"));
    assert!(!printed(&bench.ends(0, &["-h"])).contains("130"), "exit codes are in the long help");
}

/// Every format is in the lists that people read, on the command line and in the README.
#[test]
fn help_lists_every_format() {
    let bench = Bench::new("help-formats");
    let help = |verb| printed(&bench.ends(0, &[verb, "--help"])).split_whitespace().collect::<Vec<_>>().join(" ");
    let [mesh, convert, check, inspect] = ["mesh", "convert", "check", "inspect"].map(help);
    let all = meshio::Format::ALL.map(|f| f.name()).into_iter().chain(picture::Format::ALL.map(|f| f.name()));
    let refused = said(&bench.ends(2, &["mesh", "square.poly", "-o", "square.vtu", "--format", "none"]));
    for name in all {
        assert!(refused.contains(name), "{name} is not offered: {refused}");
    }
    for format in meshio::Format::ALL {
        let main = format.suffixes()[0];
        assert!(mesh.contains(&format!(".{main}")), "{main} is not among the outputs of `squinch mesh`");
        if let Some(reading) = format.reading() {
            let suffix = format!(".{}", reading.suffix);
            assert!(convert.contains(&suffix) && check.contains(&suffix), "{suffix} is not among the meshes read");
        }
    }
    for format in picture::Format::ALL {
        assert!(mesh.contains(&format!(".{}", format.name())), "{format:?} is not among the outputs");
    }
    let names = import::Format::ALL.map(|f| f.name()).join(", ");
    assert!(mesh.contains(&names), "--input-format names {names}");
    for format in import::Format::ALL {
        let suffix = format!(".{}", format.suffixes()[0]);
        assert!(mesh.contains(&suffix), "{suffix} is not among the drawings of `squinch mesh`");
        let is_solid = matches!(format, import::Format::Smesh | import::Format::Off | import::Format::Stl);
        assert!(is_solid || inspect.contains(&suffix), "{suffix} is not among the drawings of `squinch inspect`");
    }
    let readme = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).expect("a README");
    let bullet = |word: &str| {
        let from = readme.split_once(&format!("- **{word}**")).expect(word).1;
        from.split("\n- **").next().unwrap_or(from).to_lowercase()
    };
    let (reads, writes) = (bullet("Reads"), bullet("Writes"));
    import::Format::ALL.iter().for_each(|f| assert!(reads.contains(f.name()), "{f:?} is not in the README"));
    meshio::Format::ALL.iter().for_each(|f| assert!(writes.contains(f.name()), "{f:?} is not in the README"));
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/algorithms/gcdr.md");
    let strategies = fs::read_to_string(page).expect("a page of strategies");
    for steiner in squinch::plane::gcdr::Steiner::ALL {
        let word = serde_json::to_value(steiner).expect("a word");
        let quoted = format!("`{}`", word.as_str().expect("a word"));
        assert!(strategies.contains(&quoted), "{quoted} is not in docs/algorithms/gcdr.md");
    }
}

/// The commands that a help text shows.
fn shown_in(help: &str) -> Vec<Vec<String>> {
    let commands = help.lines().filter_map(|line| line.split_once("  squinch "));
    commands.map(|(_, command)| command.split(['>', '|']).next().unwrap_or(command)).map(words).collect()
}

fn words(command: &str) -> Vec<String> {
    command.split_whitespace().map(|word| word.trim_matches('\'').to_owned()).collect()
}

#[test]
fn commands_of_the_help_work_when_typed() {
    let bench = Bench::new("help-commands");
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples");
    let mut run = 0;
    for help in [printed(&bench.ends(0, &["-h"])), printed(&bench.ends(0, &["mesh", "-h"]))] {
        for command in shown_in(&help) {
            // Into a folder of the test, from the samples that the text names from the root.
            let placed = command.iter().map(|word| match word.strip_prefix("samples") {
                Some(rest) => format!("{}{rest}", samples.display()),
                None => word.clone(),
            });
            let placed: Vec<String> = placed.collect();
            let placed: Vec<&str> = placed.iter().map(String::as_str).collect();
            let code = bench.run(&placed).status.code();
            assert_eq!(code, Some(0), "{command:?}");
            run += 1;
        }
    }
    assert!(run >= 10, "{run} commands");
}
