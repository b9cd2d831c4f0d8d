//! `lamp convert` from the command line: formats, folders, standard input and output, and what is refused.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use assert_cmd::assert::Assert;

/// A lamp without symmetry, 2 × 3 planes and rows.
const LAMP: &str = "IESNA:LM-63-2002\n[TEST] 1\n[TESTLAB] none\n[ISSUEDATE] 2026\n[MANUFAC] ours\nTILT=NONE\n\
                    1 -1 1 3 3 1 2 0.2 0.6 0\n1 1 10\n0 45 90\n0 120 360\n100 80 10\n100 50 20\n100 80 10\n";

fn convert(folder: &Path, arguments: &[&str]) -> Assert {
    let mut command = Command::new(env!("CARGO_BIN_EXE_photopic"));
    command.current_dir(folder).args(["lamp", "convert"]).args(arguments).write_stdin(LAMP).assert()
}

fn said(assert: &Assert) -> String {
    String::from_utf8_lossy(&assert.get_output().stderr).into_owned()
}

fn folder_with(names: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for name in names {
        fs::write(folder.path().join(name), LAMP).expect("written");
    }
    folder
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn the_ending_says_the_format_and_companions_lie_beside() {
    let folder = folder_with(&["a.ies"]);
    for output in ["o.LDT", "o.xml", "o.csv", "o.rad", "p.pbrt", "e.exr", "o.ies"] {
        convert(folder.path(), &["a.ies", "-o", output, "--pixels", "8"]).success();
    }
    convert(folder.path(), &["a.ies", "-o", "m.xml", "--to", "mitsuba", "--pixels", "8"]).success();
    let faces = ["m-c0.exr", "m-c180.exr", "m-c270.exr", "m-c90.exr", "m-down.exr", "m.xml"];
    let others = ["o.LDT", "o.csv", "o.dat", "o.ies", "o.rad", "o.xml", "p.exr", "p.pbrt"];
    assert_eq!(names(folder.path()), [&["a.ies", "e.exr"][..], &faces, &others].concat());
}

#[test]
fn many_go_into_a_folder_and_a_bad_one_is_reported_in_its_place() {
    let folder = folder_with(&["a.ies", "b.ies", "d.ies"]);
    fs::write(folder.path().join("c.ies"), LAMP.replace("100 80 10", "100 NaN 10")).expect("written");
    fs::write(folder.path().join("w.ies"), LAMP.replace("IESNA:LM-63-2002", "IESNA:LM-63-2012")).expect("written");
    let inputs = ["w.ies", "c.ies", "a.ies", "no.ies", "b.ies"];
    let assert = convert(folder.path(), &[&inputs[..], &["-o", "out/", "--to", "rad"]].concat()).code(2);
    assert_eq!(names(&folder.path().join("out")), ["a.dat", "a.rad", "b.dat", "b.rad", "w.dat", "w.rad"]);
    let starts: Vec<String> =
        said(&assert).lines().map(|l| l.split(':').next().unwrap_or_default().to_owned()).collect();
    assert_eq!(starts, ["w.ies", "c.ies", "no.ies"], "{}", said(&assert));
    // An existing folder needs no slash; one output for many inputs is none.
    convert(folder.path(), &["a.ies", "b.ies", "-o", "out", "--to", "csv"]).success();
    assert!(folder.path().join("out/b.csv").exists());
    convert(folder.path(), &["a.ies", "b.ies", "-o", "x.csv"]).code(2);
    assert!(!folder.path().join("x.csv").exists());
}

#[test]
fn two_inputs_of_one_name_are_not_written_over_one_another() {
    let folder = folder_with(&["a.ies"]);
    fs::create_dir(folder.path().join("sub")).expect("a folder");
    fs::write(folder.path().join("sub/A.ies"), LAMP.replace("ours", "theirs")).expect("written");
    let assert = convert(folder.path(), &["a.ies", "sub/A.ies", "a.ies", "-o", "out/", "--to", "csv"]).code(2);
    assert_eq!(names(&folder.path().join("out")), ["a.csv"]);
    assert!(fs::read_to_string(folder.path().join("out/a.csv")).expect("text").contains("ours"));
    assert!(said(&assert).contains("sub/A.ies: would be written to the same file as a.ies"), "{}", said(&assert));
}

#[test]
fn inputs_are_never_overwritten() {
    let folder = folder_with(&["a.ies", "b.ies"]);
    for arguments in [&["a.ies", "-o", "a.ies"][..], &["b.ies", "a.ies", "-o", ".", "--to", "ies"]] {
        convert(folder.path(), arguments).code(2);
        assert_eq!(fs::read_to_string(folder.path().join("a.ies")).expect("text"), LAMP);
    }
    // Nor by a companion file.
    fs::rename(folder.path().join("a.ies"), folder.path().join("a.dat")).expect("renamed");
    convert(folder.path(), &["a.dat", "-o", "a.rad"]).code(2);
    assert_eq!(fs::read_to_string(folder.path().join("a.dat")).expect("text"), LAMP);
    assert!(!folder.path().join("a.rad").exists());
    convert(folder.path(), &["b.ies", "-o", "b.dat", "--to", "rad"]).code(2);
    assert!(!folder.path().join("b.dat").exists());
}

#[test]
fn files_that_belong_together_are_written_all_or_none() {
    let folder = folder_with(&["a.ies"]);
    fs::create_dir(folder.path().join("o.dat")).expect("a folder");
    let assert = convert(folder.path(), &["a.ies", "-o", "o.rad"]).code(2);
    assert!(said(&assert).contains("o.dat: is a folder"), "{}", said(&assert));
    assert_eq!(names(folder.path()), ["a.ies", "o.dat"]);
}

#[test]
fn a_dash_is_standard_input_and_output() {
    let folder = folder_with(&[]);
    let assert = convert(folder.path(), &["-", "-o", "-", "--to", "csv"]).success();
    let text = String::from_utf8_lossy(&assert.get_output().stdout).into_owned();
    assert!(text.contains("\ngamma_deg,0,120,360\n0,100,100,100\n"), "{text}");
    let assert = convert(folder.path(), &["-", "-o", "-", "--to", "exr", "--pixels", "8"]).success();
    assert_eq!(assert.get_output().stdout[..4], 20_000_630_u32.to_le_bytes());
    let several = convert(folder.path(), &["-", "-o", "-", "--to", "pbrt"]).code(2);
    assert!(said(&several).contains("standard output holds one file"), "{}", said(&several));
    convert(folder.path(), &["-", "-o", "out/", "--to", "ies"]).success();
    assert!(folder.path().join("out/stdin.ies").exists());
}

#[test]
fn what_was_written_and_what_was_lost_is_said() {
    let folder = folder_with(&["a.ies"]);
    let assert = convert(folder.path(), &["-v", "a.ies", "-o", "a.ldt"]).success();
    let words = said(&assert);
    assert!(words.contains("L510") && words.contains("not turned by 90°"), "{words}");
    assert!(words.contains("EULUMDAT calls the extent along C0–C180 width"), "{words}");
    let back = said(&convert(folder.path(), &["-v", "a.ldt", "-o", "b.ies", "--lm63", "1995"]).success());
    assert!(back.contains("written as LM-63-1995, absolute photometry"), "{back}");
    assert!(back.contains("LM-63 calls the extent along C0–C180 length"), "{back}");
    // The same body along the same planes: 0.6 m along C0 as before.
    let text = fs::read_to_string(folder.path().join("b.ies")).expect("text");
    assert!(text.contains(" 1 2 0.2 0.6 0"), "{text}");
    let same = said(&convert(folder.path(), &["-v", "a.ies", "-o", "c.ies"]).success());
    assert!(same.contains("L510") && !same.contains("90°"), "{same}");
    let rad = said(&convert(folder.path(), &["-v", "a.ies", "-o", "a.rad"]).success());
    assert!(rad.contains("a.ies: info L501: Radiance cannot carry"), "{rad}");
}

#[test]
fn what_cannot_be_is_refused_with_words() {
    let folder = folder_with(&["a.ies"]);
    for (arguments, words) in [
        (&["a.ies", "-o", "a.pdf"][..], "--to FORMAT"),
        (&["a.ies", "-o", "-"], "--to FORMAT"),
        (&["a.ies", "-o", "a.exr", "--pixels", "4"], "expected 8 to 8192"),
        (&["a.ies", "-o", "a\"b.rad"], "without quotation marks"),
        (&["a.ies", "-o", "no/such/a.csv"], "cannot be written"),
        (&["a.ies"], "--output"),
        (&["-o", "a.csv"], "FILE"),
    ] {
        let assert = convert(folder.path(), arguments).code(2);
        assert!(said(&assert).contains(words), "{arguments:?}: {}", said(&assert));
    }
    assert_eq!(names(folder.path()), ["a.ies"]);
}
