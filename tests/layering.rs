//! The order of the modules (`docs/architecture.md`): a module imports only modules that stand above it in [`ORDER`], so that
//! circles cannot occur; siblings on one line are strangers. A plain scan of the text of `src/`: comments, literals and
//! `#[cfg(test)]` items are blanked, everything else counts, whether it is imported with `use` or named where it is used.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The modules from the ground up. Those on one line do not import one another.
const ORDER: [&[&str]; 18] = [
    &["finding", "mistake"],
    &["units", "constants"],
    &["math"],
    &["geometry"],
    &["tables"],
    &["spectrum"],
    &["illuminant"],
    &["photometry"],
    &["colorimetry"],
    &["conversion"],
    &["uncertainty"],
    &["correction"],
    &["image"],
    &["luminaire", "brdf"],
    &["capture", "render"],
    &["selfcheck", "trade"],
    &["plot", "report"],
    &["cli"],
];

/// What only the command line may do, and what nobody may: a library neither prints nor ends the process nor opens files.
const FOR_THE_COMMAND_LINE: [&str; 12] = [
    "println!",
    "eprintln!",
    "print!",
    "eprint!",
    "dbg!",
    "process::exit",
    "process::abort",
    "stdout()",
    "stderr()",
    "stdin()",
    "File::open",
    "fs::",
];

/// One source file: its path below `src/`, with `/`, and its text.
struct Source {
    path: String,
    text: String,
}

impl Source {
    fn new(path: &str, text: &str) -> Self {
        Self { path: path.to_owned(), text: text.to_owned() }
    }

    /// The module path of the file: `spectrum/format/error.rs` is `[spectrum, format, error]`.
    fn module(&self) -> Vec<&str> {
        let stem = self.path.strip_suffix(".rs").unwrap_or(&self.path);
        let stem = stem.strip_suffix("/mod").unwrap_or(stem);
        stem.split('/').collect()
    }

    fn is_root(&self) -> bool {
        matches!(self.path.as_str(), "lib.rs" | "main.rs")
    }
}

fn level(module: &str) -> Option<usize> {
    ORDER.iter().position(|names| names.contains(&module))
}

// ------------------------------------------------------------------------------------------------ reading Rust

/// The text with comments and the insides of literals blanked; lines stay where they are.
fn without_comments_and_literals(text: &str) -> String {
    let c: Vec<char> = text.chars().collect();
    let mut out = String::with_capacity(text.len());
    let mut i = 0;
    let blank = |out: &mut String, c: char| out.push(if c == '\n' { '\n' } else { ' ' });
    while i < c.len() {
        let at = |k: usize| c.get(k).copied().unwrap_or('\0');
        if at(i) == '/' && at(i + 1) == '/' {
            while i < c.len() && c[i] != '\n' {
                out.push(' ');
                i += 1;
            }
        } else if at(i) == '/' && at(i + 1) == '*' {
            let mut depth = 0;
            while i < c.len() {
                if at(i) == '/' && at(i + 1) == '*' {
                    depth += 1;
                    out.push_str("  ");
                    i += 2;
                } else if at(i) == '*' && at(i + 1) == '/' {
                    depth -= 1;
                    out.push_str("  ");
                    i += 2;
                    if depth == 0 {
                        break;
                    }
                } else {
                    blank(&mut out, c[i]);
                    i += 1;
                }
            }
        } else if let Some(end) = raw_string(&c, i) {
            c[i..end].iter().for_each(|&ch| blank(&mut out, ch));
            i = end;
        } else if at(i) == '"' {
            out.push('"');
            i += 1;
            while i < c.len() && c[i] != '"' {
                if c[i] == '\\' {
                    out.push(' ');
                    i += 1;
                }
                if i < c.len() {
                    blank(&mut out, c[i]);
                    i += 1;
                }
            }
            out.push('"');
            i += 1;
        } else if at(i) == '\'' && (at(i + 1) == '\\' || (at(i + 2) == '\'' && at(i + 1) != '\'')) {
            // A character, not a lifetime.
            let mut end = if at(i + 1) == '\\' { i + 3 } else { i + 2 };
            while end < c.len() && c[end] != '\'' {
                end += 1;
            }
            c[i..(end + 1).min(c.len())].iter().for_each(|_| out.push(' '));
            i = end + 1;
        } else {
            out.push(c[i]);
            i += 1;
        }
    }
    out
}

/// Where a raw string that begins here (`r"…"`, `br#"…"#`) ends.
fn raw_string(c: &[char], start: usize) -> Option<usize> {
    let in_word = start > 0 && (c[start - 1].is_alphanumeric() || c[start - 1] == '_');
    let mut i = start;
    if c.get(i) == Some(&'b') {
        i += 1;
    }
    if in_word || c.get(i) != Some(&'r') {
        return None;
    }
    i += 1;
    let hashes = c[i..].iter().take_while(|ch| **ch == '#').count();
    i += hashes;
    if c.get(i) != Some(&'"') {
        return None;
    }
    let end: Vec<char> = std::iter::once('"').chain(std::iter::repeat_n('#', hashes)).collect();
    (i + 1..c.len()).find(|&k| c[k..].starts_with(&end)).map(|k| k + end.len())
}

/// The text without items under `#[cfg(test)]`, and the modules in files of their own that were declared so.
fn without_tests(text: &str) -> (String, Vec<String>) {
    const MARK: &str = "#[cfg(test)]";
    let mut out = String::with_capacity(text.len());
    let mut files = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find(MARK) {
        out.push_str(&rest[..at]);
        let item = &rest[at + MARK.len()..];
        let end = item_end(item);
        let words: Vec<&str> = item[..end].split_whitespace().collect();
        if let [.., "mod", name] = words.as_slice()
            && let Some(name) = name.strip_suffix(';')
        {
            files.push(name.to_owned());
        }
        out.extend(item[..end].chars().filter(|c| *c == '\n'));
        rest = &item[end..];
    }
    out.push_str(rest);
    (out, files)
}

/// Where the item that begins here ends: after its block, or after its semicolon outside of brackets.
fn item_end(item: &str) -> usize {
    let mut depth = 0_i32;
    for (i, c) in item.char_indices() {
        match c {
            '{' | '(' | '[' => depth += 1,
            '}' | ')' | ']' => {
                depth -= 1;
                if depth == 0 && c == '}' {
                    return i + 1;
                }
            }
            ';' if depth == 0 => return i + 1,
            _ => {}
        }
    }
    item.len()
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// A path that leaves the file: the line it stands on, and the first name below the crate's root; `*` for all of them, nothing
/// for the root itself.
struct Reference {
    line: usize,
    name: String,
}

/// All paths that begin with `crate` or climb to it with `super`.
fn references(text: &str, module: &[&str]) -> Vec<Reference> {
    let mut found = Vec::new();
    let mut i = 0;
    while let Some((start, word)) = next_word(text, i) {
        i = start + word.len();
        let (root, after) = match word {
            "crate" => (true, i),
            "super" => climb(text, i, module.len()),
            _ => continue,
        };
        i = after;
        if root {
            let line = text[..start].matches('\n').count() + 1;
            found.extend(names(&text[after..]).into_iter().map(|name| Reference { line, name }));
        }
    }
    found
}

fn next_word(text: &str, from: usize) -> Option<(usize, &str)> {
    let start = from + text[from..].find(is_word)?;
    let end = text[start..].find(|c| !is_word(c)).map_or(text.len(), |n| start + n);
    Some((start, &text[start..end]))
}

/// Follows `::super` as often as it comes; whether the crate's root is reached from a file `depth` modules below it.
fn climb(text: &str, mut at: usize, depth: usize) -> (bool, usize) {
    let mut steps = 1;
    while let Some(after) = strip_separator(&text[at..]) {
        match next_word(after, 0) {
            Some((0, "super")) => {
                steps += 1;
                at = text.len() - after.len() + "super".len();
            }
            _ => break,
        }
    }
    (steps >= depth, at)
}

fn strip_separator(text: &str) -> Option<&str> {
    text.trim_start().strip_prefix("::").map(str::trim_start)
}

/// The names that follow the root: one, or those of a group.
fn names(after: &str) -> Vec<String> {
    let Some(rest) = strip_separator(after) else {
        // `pub(crate)` and `pub(super)` name no module; `use crate as x` and `use super as x` do.
        let aliased = next_word(after, 0).is_some_and(|(at, word)| word == "as" && after[..at].trim().is_empty());
        return if aliased { vec![String::new()] } else { Vec::new() };
    };
    if rest.starts_with('*') {
        return vec!["*".to_owned()];
    }
    let Some(group) = rest.strip_prefix('{') else {
        return next_word(rest, 0).into_iter().map(|(_, word)| word.to_owned()).collect();
    };
    let mut out = Vec::new();
    let (mut depth, mut fresh) = (0, true);
    for (i, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => fresh = true,
            '*' if fresh => {
                out.push("*".to_owned());
                fresh = false;
            }
            c if fresh && is_word(c) => {
                let word = next_word(group, i).map_or("", |(_, word)| word);
                out.push(if word == "self" { String::new() } else { word.to_owned() });
                fresh = false;
            }
            _ => {}
        }
    }
    out
}

// ---------------------------------------------------------------------------------------------------- the rules

/// Everything in the sources that breaks the order or the manners of a library, one line each.
fn violations(sources: &[Source]) -> Vec<String> {
    let prepared: Vec<(&Source, String, Vec<String>)> = (sources.iter())
        .map(|s| {
            let (text, tests) = without_tests(&without_comments_and_literals(&s.text));
            (s, text, tests)
        })
        .collect();
    let test_files: BTreeSet<String> = (prepared.iter())
        .flat_map(|(s, _, tests)| {
            let folder = if s.path.ends_with("/mod.rs") || s.is_root() {
                s.path.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"))
            } else {
                format!("{}/", s.path.trim_end_matches(".rs"))
            };
            tests.iter().map(move |name| format!("{folder}{name}.rs"))
        })
        .collect();
    let mut out = Vec::new();
    for (source, text, _) in prepared.iter().filter(|(s, ..)| !s.is_root() && !test_files.contains(&s.path)) {
        let module = source.module();
        let own = module[0];
        let Some(here) = level(own) else {
            out.push(format!("{}: the module `{own}` is not in the list of tests/layering.rs", source.path));
            continue;
        };
        for Reference { line, name } in references(text, &module) {
            let place = format!("src/{}:{line}", source.path);
            match (name.as_str(), level(&name)) {
                ("*" | "", _) => out.push(format!("{place}: imports the crate's root whole")),
                (name, _) if name == own => {}
                (name, None) => out.push(format!("{place}: `{name}` is not in the list of tests/layering.rs")),
                (name, Some(there)) if there == here => {
                    out.push(format!("{place}: `{own}` imports its sibling `{name}`"));
                }
                (name, Some(there)) if there > here => {
                    out.push(format!("{place}: `{own}` imports `{name}`, which stands below it"));
                }
                _ => {}
            }
        }
        if own != "cli" {
            for (n, line) in text.lines().enumerate() {
                for call in FOR_THE_COMMAND_LINE.iter().filter(|call| stands_in(line, call)) {
                    out.push(format!("src/{}:{}: `{call}` in the library", source.path, n + 1));
                }
            }
        }
    }
    out
}

/// Whether `call` stands in a line as a word of its own: `println!` is not in `eprintln!`.
fn stands_in(line: &str, call: &str) -> bool {
    line.match_indices(call).any(|(at, _)| !line[..at].ends_with(is_word))
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut folders: Vec<PathBuf> = vec![root.clone()];
    let mut out = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder of src/") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let below =
                    path.strip_prefix(&root).expect("below src/").to_str().expect("plain names").replace('\\', "/");
                out.push(Source { path: below, text: fs::read_to_string(&path).expect("UTF-8") });
            }
        }
    }
    out
}

#[test]
fn no_module_imports_one_below_or_beside_it_and_only_the_command_line_prints() {
    let sources = sources();
    assert!(sources.len() > 50, "src/ was found: {} files", sources.len());
    let found = violations(&sources);
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn every_module_of_the_crate_is_in_the_list() {
    let library = sources().into_iter().find(|s| s.path == "lib.rs").expect("src/lib.rs");
    let (text, _) = without_tests(&without_comments_and_literals(&library.text));
    let modules: Vec<&str> = (text.lines())
        .filter_map(|line| line.trim().trim_start_matches("pub ").strip_prefix("mod ")?.strip_suffix(';'))
        .collect();
    assert!(modules.len() > 10, "{modules:?}");
    for module in modules {
        assert!(level(module).is_some(), "`{module}` is not in the list of tests/layering.rs");
    }
}

#[test]
fn the_list_has_no_module_twice() {
    let all: Vec<&str> = ORDER.iter().flat_map(|names| names.iter().copied()).collect();
    assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len());
}

// -------------------------------------------------------------------------------------- the scan can fail

fn caught(path: &str, text: &str) -> Vec<String> {
    violations(&[Source::new(path, text)])
}

#[test]
fn an_invented_downward_import_is_caught_however_it_is_spelt() {
    for (path, text) in [
        ("spectrum/mod.rs", "use crate::photometry::luminous;"),
        ("spectrum/format/error.rs", "use crate::{finding::Finding, report};"),
        ("spectrum/format/error.rs", "use super::super::super::cli::run;"),
        ("spectrum/format/mod.rs", "use super::super::{\n    finding,\n    colorimetry::{cct, Observer},\n};"),
        ("math/mod.rs", "fn f() -> f64 { crate :: spectrum :: zero() }"),
        ("finding.rs", "use super::units::Lux;"),
        ("tables/info.rs", "pub use crate::spectrum as s;"),
        ("illuminant/planck.rs", "macro_rules! m { () => { $crate::conversion::f() } }"),
        ("geometry/mod.rs", "use crate::*;"),
        ("geometry/mod.rs", "use crate as all;"),
        ("geometry/mod.rs", "use super::{self as all};"),
    ] {
        assert_eq!(caught(path, text).len(), 1, "{path}: {text}: {:?}", caught(path, text));
    }
    assert!(
        caught("spectrum/mod.rs", "\n\nuse crate::cli;")[0]
            .starts_with("src/spectrum/mod.rs:3: `spectrum` imports `cli`")
    );
}

#[test]
fn siblings_are_strangers() {
    for (path, text) in [
        ("units.rs", "use crate::constants::K_M;"),
        ("constants.rs", "use crate::units::Lux;"),
        ("plot/mod.rs", "use crate::report::conversion::keys;"),
        ("report/mod.rs", "use crate::plot::Format;"),
        ("luminaire/mod.rs", "use crate::brdf::Brdf;"),
        ("capture/mod.rs", "use crate::render::Scene;"),
    ] {
        assert!(caught(path, text)[0].contains("sibling"), "{path}: {:?}", caught(path, text));
    }
}

#[test]
fn a_module_missing_from_the_list_is_caught_on_both_ends() {
    assert!(caught("gadgets/mod.rs", "")[0].contains("`gadgets` is not in the list"));
    assert!(caught("spectrum/mod.rs", "use crate::gadgets::Spring;")[0].contains("`gadgets` is not in the list"));
}

#[test]
fn printing_and_exiting_are_caught_in_the_library_and_nowhere_else() {
    for text in [
        "fn f() { println!(\"x\") }",
        "fn f() { eprintln!(\"x\") }",
        "fn f() { print!(\"x\") }",
        "fn f() { std::process::exit(1) }",
        "fn f() { dbg!(1); }",
        "fn f() { let _ = io::stdout(); }",
        "fn f() { std::fs::read(\"x\"); }",
    ] {
        assert_eq!(caught("spectrum/mod.rs", text).len(), 1, "{text}: {:?}", caught("spectrum/mod.rs", text));
        assert_eq!(caught("cli/mod.rs", text), Vec::<String>::new(), "{text}");
    }
}

#[test]
fn upward_and_own_imports_comments_literals_and_tests_are_left_alone() {
    for (path, text) in [
        ("spectrum/format/error.rs", "use super::super::UnitError; use super::Entry; use crate::spectrum::Grid;"),
        ("spectrum/mod.rs", "use crate::{finding::{Checked, Finding}, constants, math::interpolate};"),
        ("spectrum/mod.rs", "pub(crate) fn f() {} pub(super) fn g() {} pub(in crate::spectrum) fn h() {}"),
        ("spectrum/mod.rs", "// use crate::cli;\n/* use crate::cli; /* println!() */ */ /// [`crate::cli`]\nfn f() {}"),
        (
            "spectrum/mod.rs",
            "const A: &str = \"crate::cli println!\"; const B: &str = r#\"\"crate::cli\"#; const C: char = '\"';",
        ),
        ("spectrum/mod.rs", "fn f<'a>(x: &'a str) -> char { '\\'' } // crate::cli"),
        ("spectrum/mod.rs", "#[cfg(test)]\nmod tests {\n    use crate::cli;\n    fn f() { println!(\"x\") }\n}"),
        ("spectrum/mod.rs", "#[cfg(test)]\nuse crate::cli;\nfn f() {}"),
        ("cli/mod.rs", "use crate::report::text; use crate::plot;"),
        ("report/csv.rs", "use super::conversion::keys;"),
    ] {
        assert_eq!(caught(path, text), Vec::<String>::new(), "{path}: {text}");
    }
    // What follows a test module still counts, and on its own line.
    let after = caught("spectrum/mod.rs", "#[cfg(test)]\nmod tests {\n}\nuse crate::cli;");
    assert!(after[0].starts_with("src/spectrum/mod.rs:4:"), "{after:?}");
    let files = [
        Source::new("spectrum/mod.rs", "#[cfg(test)]\nmod tests;\n"),
        Source::new("spectrum/tests.rs", "use crate::cli;"),
        Source::new("spectrum/other.rs", "use crate::cli;"),
    ];
    let found = violations(&files);
    assert!(found.len() == 1 && found[0].contains("other.rs"), "{found:?}");
}
