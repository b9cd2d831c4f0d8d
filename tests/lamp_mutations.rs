//! Real lamp files, changed as programs, editors and mail change them: what preserves the values keeps the flux, what breaks them is
//! refused. The files are those of the reference folder; the flux is that of the file as it stands, which other tests hold against
//! an independent reader.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use photopic::luminaire::format::{Format, ReadOptions, open};

/// Files that are read as they stand: name, format, text, flux and peak.
struct Sound {
    name: String,
    format: Format,
    text: String,
    flux: f64,
    peak: f64,
}

fn read(bytes: &[u8]) -> Result<(f64, f64), String> {
    match open(bytes, &ReadOptions::default()) {
        Ok(file) => {
            let table = &file.value.luminaire.distribution;
            Ok((table.total_flux(), table.peak().0))
        }
        Err(error) => Err(error.to_string()),
    }
}

fn files(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, out);
        } else {
            out.push(path);
        }
    }
}

/// All sound text files of the formats asked for, not larger than a limit that keeps the test short.
fn sound(formats: &[Format]) -> Vec<Sound> {
    let Some(folder) = common::shared("luminaires/files") else { return Vec::new() };
    let mut paths = Vec::new();
    files(&folder, &mut paths);
    paths.sort();
    let read = |path: PathBuf| {
        let bytes = fs::read(&path).ok().filter(|b| b.len() < 200_000)?;
        // Decimal commas leave no layout but the file's own.
        let file =
            open(&bytes, &ReadOptions::default()).ok().filter(|f| f.findings.iter().all(|f| f.code != "L012"))?;
        let file = file.value;
        let text = String::from_utf8(bytes).ok().filter(|t| !t.starts_with('\u{feff}') && !t.contains('\u{1a}'))?;
        let table = &file.luminaire.distribution;
        Some(Sound {
            name: path.strip_prefix(&folder).unwrap_or(&path).display().to_string(),
            format: file.format,
            text,
            flux: table.total_flux(),
            peak: table.peak().0,
        })
        .filter(|s| formats.contains(&s.format) && s.flux != 0.0)
    };
    paths.into_iter().filter_map(read).collect()
}

const ALL: [Format; 3] = [Format::Ies, Format::Eulumdat, Format::Tm33];

fn kept(file: &Sound, what: &str, bytes: &[u8]) {
    match read(bytes) {
        Ok((flux, peak)) => assert!(
            (flux / file.flux - 1.0).abs() < 1e-9 && (peak / file.peak - 1.0).abs() < 1e-9,
            "{}, {what}: {flux} lm for {}",
            file.name,
            file.flux
        ),
        Err(error) => panic!("{}, {what}: {error}", file.name),
    }
}

/// Lines by any end.
fn lines(text: &str) -> Vec<&str> {
    let plain = text.strip_suffix("\r\n").or_else(|| text.strip_suffix(['\n', '\r'])).unwrap_or(text);
    if plain.contains('\n') {
        plain.split('\n').map(|l| l.strip_suffix('\r').unwrap_or(l)).collect()
    } else {
        plain.split('\r').collect()
    }
}

fn number(token: &str) -> Option<f64> {
    token.replace(['D', 'd'], "e").parse().ok()
}

/// An LM-63 file as header with TILT line, and numbers up to whatever is none.
fn parts(text: &str) -> (Vec<&str>, Vec<&str>) {
    let all = lines(text);
    let tilt = all.iter().position(|l| l.trim().to_uppercase().starts_with("TILT")).expect("a TILT line");
    let tokens = all[tilt + 1..].iter().flat_map(|l| l.split([' ', ',', '\t'])).filter(|t| !t.is_empty());
    (all[..=tilt].to_vec(), tokens.take_while(|t| number(t).is_some()).collect())
}

#[test]
fn encodings_line_ends_and_blanks_keep_the_flux() {
    for file in sound(&ALL) {
        let all = lines(&file.text);
        for end in ["\n", "\r\n", "\r"] {
            kept(&file, &format!("line ends {end:?}"), (all.join(end) + end).as_bytes());
        }
        kept(&file, "no last line end", all.join("\r\n").as_bytes());
        kept(&file, "mixed line ends", all.join("\n").replacen('\n', "\r\n", all.len() / 2).as_bytes());
        let wide: Vec<u16> = file.text.encode_utf16().collect();
        let little: Vec<u8> = wide.iter().flat_map(|u| u.to_le_bytes()).collect();
        let big: Vec<u8> = wide.iter().flat_map(|u| u.to_be_bytes()).collect();
        kept(&file, "UTF-8 with BOM", &[b"\xef\xbb\xbf", file.text.as_bytes()].concat());
        // An XML declaration that names another encoding than the bytes have is a contradiction of its own.
        kept(&file, "UTF-16 LE", &[b"\xff\xfe".as_slice(), &little].concat());
        kept(&file, "UTF-16 BE", &[b"\xfe\xff".as_slice(), &big].concat());
        if file.format != Format::Tm33 {
            kept(&file, "Ctrl-Z", (file.text.clone() + "\u{1a}").as_bytes());
            kept(
                &file,
                "blanks at line ends",
                all.iter().map(|l| format!("{l}  \t\r\n")).collect::<String>().as_bytes(),
            );
            kept(&file, "blanks at line starts", all.iter().map(|l| format!("  {l}\n")).collect::<String>().as_bytes());
            kept(
                &file,
                "Latin-1",
                &all.join("\n").chars().map(|c| u8::try_from(c).unwrap_or(b'?')).collect::<Vec<u8>>(),
            );
            kept(&file, "blank lines at the end", (all.join("\n") + "\n\n \n\r\n").as_bytes());
        }
    }
}

#[test]
fn lm_63_numbers_may_stand_in_any_layout() {
    for file in sound(&[Format::Ies]) {
        let (header, tokens) = parts(&file.text);
        let head = header.join("\n");
        let with = |numbers: String| format!("{head}\n{numbers}\n");
        kept(&file, "one number a line", with(tokens.join("\n")).as_bytes());
        kept(&file, "blank lines between", with(tokens.join("\r\n\r\n")).as_bytes());
        kept(&file, "all on one line", with(tokens.join(" ")).as_bytes());
        kept(&file, "commas", with(tokens.join(",")).as_bytes());
        kept(&file, "commas and blanks", with(tokens.join(" , ")).as_bytes());
        kept(&file, "tabs", with(tokens.join("\t")).as_bytes());
        let exact = |t: &&str| number(t).expect("a number");
        kept(
            &file,
            "D exponents",
            with(tokens.iter().map(|t| format!("{:e}", exact(t)).replace('e', "D")).collect::<Vec<_>>().join(" "))
                .as_bytes(),
        );
        kept(
            &file,
            "E exponents",
            with(tokens.iter().map(|t| format!("{:E}", exact(t))).collect::<Vec<_>>().join(" ")).as_bytes(),
        );
        kept(
            &file,
            "plus signs",
            with(
                tokens
                    .iter()
                    .map(|t| if t.starts_with('-') { (*t).to_owned() } else { format!("+{t}") })
                    .collect::<Vec<_>>()
                    .join(" "),
            )
            .as_bytes(),
        );
        let small = header.iter().map(|l| l.to_lowercase()).collect::<Vec<_>>().join("\n");
        kept(&file, "small letters", format!("{small}\n{}\n", tokens.join(" ")).as_bytes());
        kept(&file, "text behind", (with(tokens.join(" ")) + "END OF FILE\nprinted by a program, page 1\n").as_bytes());
    }
}

#[test]
fn lm_63_files_with_a_number_less_or_more_are_refused() {
    for file in sound(&[Format::Ies]) {
        let (header, tokens) = parts(&file.text);
        let head = header.join("\n");
        // The lamp and ballast lines and the first angles, then some of the rest.
        let places = (0..16.min(tokens.len())).chain((16..tokens.len()).step_by(1 + tokens.len() / 12));
        for at in places {
            let mut short = tokens.clone();
            short.remove(at);
            let mut long = tokens.clone();
            long.insert(at, tokens[at]);
            for (what, list) in [("without", short), ("twice", long)] {
                let text = format!("{head}\n{}\n", list.join(" "));
                assert!(read(text.as_bytes()).is_err(), "{}: number {} ({}) {what}", file.name, at + 1, tokens[at]);
            }
        }
        for (what, with) in [("NaN", "NaN"), ("infinity", "1e999"), ("a word", "abc"), ("nothing", ",,")] {
            let mut list = tokens.clone();
            let last = list.len() - 1;
            list[last] = with;
            let text = format!("{head}\n{}\n", list.join(" "));
            assert!(read(text.as_bytes()).is_err(), "{}: {what} as the last number", file.name);
        }
    }
}

#[test]
fn eulumdat_lines_may_be_dressed_up() {
    for file in sound(&[Format::Eulumdat]) {
        let all = lines(&file.text);
        let is_number = |l: &str| number(l.trim()).is_some();
        let each = |f: &dyn Fn(&str) -> String| all.iter().map(|l| f(l)).collect::<Vec<_>>().join("\r\n") + "\r\n";
        kept(
            &file,
            "decimal commas",
            each(&|l| if is_number(l) { l.replace('.', ",") } else { l.to_owned() }).as_bytes(),
        );
        kept(&file, "padded", each(&|l| format!("{l:<40}")).as_bytes());
        kept(&file, "doubled line ends", (all.join("\r\n\r\n") + "\r\n").as_bytes());
        kept(&file, "CR CR LF", (all.join("\r\r\n") + "\r\r\n").as_bytes());
        let exponents = |l: &str| match l.trim().parse::<f64>() {
            Ok(value) if l.contains('.') => format!("{value:e}").replace('e', "D"),
            _ => l.to_owned(),
        };
        kept(&file, "D exponents", each(&exponents).as_bytes());
        kept(&file, "a remark behind", (all.join("\n") + "\nexported by a program\n").as_bytes());
    }
}

#[test]
fn eulumdat_files_with_a_line_less_or_more_are_refused_or_the_same() {
    for file in sound(&[Format::Eulumdat]) {
        let all = lines(&file.text);
        let places = (0..60.min(all.len())).chain((60..all.len()).step_by(1 + all.len() / 12));
        for at in places {
            let mut short = all.clone();
            short.remove(at);
            let mut long = all.clone();
            long.insert(at, all[at]);
            for (what, list) in [("without", short), ("twice", long)] {
                if let Ok((flux, peak)) = read((list.join("\n") + "\n").as_bytes()) {
                    let same = (flux / file.flux - 1.0).abs() < 1e-9 && (peak / file.peak - 1.0).abs() < 1e-9;
                    assert!(same, "{}: line {} `{}` {what}: {flux} lm for {}", file.name, at + 1, all[at], file.flux);
                }
            }
        }
    }
}

/// Own files of `tests/data/lamps`: each was found by a fuzz target or a mutation above.
fn own(folder: &str) -> Vec<(String, Vec<u8>)> {
    let mut paths = Vec::new();
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/lamps").join(folder), &mut paths);
    paths.sort();
    paths.into_iter().map(|p| (p.display().to_string(), fs::read(&p).expect("opens"))).collect()
}

#[test]
fn what_was_found_reads_with_its_flux() {
    let found = own("valid");
    assert!(found.len() >= 2);
    for (name, bytes) in found {
        // 100 cd in all directions: 4π · 100 lm.
        let (flux, peak) = read(&bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!((flux / 1256.637 - 1.0).abs() < 1e-6 && (peak / 100.0 - 1.0).abs() < 1e-6, "{name}: {flux}, {peak}");
    }
}

#[test]
fn no_table_is_silently_dark() {
    let found = own("dark");
    assert!(found.len() >= 2);
    for (name, bytes) in found {
        let file = open(&bytes, &ReadOptions::default()).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(file.findings.iter().any(|f| f.code == "L111"), "{name}: {:?}", file.findings);
    }
}

#[test]
fn sets_of_lamps_are_alternatives() {
    let (_, bytes) = own("valid").into_iter().find(|(name, _)| name.ends_with("cr_cr_lf.ldt")).expect("a file");
    let text = String::from_utf8(bytes).expect("ASCII").replace("\r\r\n", "\n");
    // Twice the same set of one lamp of 1000 lm: the luminaire gives more than a set, but less than both.
    let set = "1\nLED\n1000\n\n\n10\n";
    let text = text.replace("\n1\n-1\nLED\n1256.637\n\n\n10\n", &format!("\n2\n{set}{set}")).replace("79.57747", "100");
    let file = open(text.as_bytes(), &ReadOptions::default()).expect("a file");
    assert!(file.findings.iter().any(|f| f.code == "L113"), "{:?}", file.findings);
    // 4π · 100 cd of 1000 lm.
    let ratio = photopic::luminaire::zonal::light_output_ratio(&file.value.luminaire).expect("lamps with a flux");
    assert!((ratio / (0.4 * std::f64::consts::PI) - 1.0).abs() < 1e-6, "{ratio}");
}
