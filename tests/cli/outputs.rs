//! Outputs: files, devices, pictures, tables, manuals, what is said on standard error.

use std::fs;
use std::io::{Read, Write};
use std::process::Command as Process;

use predicates::prelude::*;
use predicates::str::{contains, is_empty};

use crate::{Folder, constant, json, office_led, photopic};

#[test]
fn an_output_file_holds_what_standard_output_would_and_nothing_else_is_left() {
    let folder = Folder::new().with("lamp.csv", fs::read(office_led()).expect("example"));
    for form in [&["--json"][..], &["--csv"], &[]] {
        let want =
            folder.run().args(["convert", "lamp.csv", "D65"]).args(form).assert().success().get_output().stdout.clone();
        folder.run().args(["convert", "lamp.csv", "D65", "-o", "out"]).args(form).assert().success().stdout(is_empty());
        assert_eq!(fs::read(folder.path("out")).expect("written"), want, "{form:?}");
        assert_eq!(folder.names(), ["lamp.csv", "out"]);
    }
    // `-o -` is standard output.
    folder.run().args(["convert", "D65", "-o", "-"]).assert().success().stdout(is_empty().not());
    assert_eq!(folder.names(), ["lamp.csv", "out"]);
}

#[test]
fn an_output_never_overwrites_an_input() {
    let lamp = fs::read(office_led()).expect("the example");
    let folder = Folder::new().with("lamp.csv", &lamp).with("other.svg", &lamp);
    for arguments in [
        &["convert", "lamp.csv", "-o", "lamp.csv"][..],
        &["convert", "D65", "lamp.csv", "-o", "./lamp.csv", "--json"],
        &["convert", "other.svg", "--plot", "other.svg"],
    ] {
        folder.run().args(arguments).assert().code(2).stderr(contains("overwrite"));
        assert_eq!(fs::read(folder.path("lamp.csv")).expect("there"), lamp, "{arguments:?}");
        assert_eq!(fs::read(folder.path("other.svg")).expect("there"), lamp, "{arguments:?}");
        assert_eq!(folder.names(), ["lamp.csv", "other.svg"]);
    }
}

#[cfg(unix)]
#[test]
fn an_output_never_overwrites_an_input_by_another_name() {
    let lamp = fs::read(office_led()).expect("the example");
    let folder = Folder::new().with("lamp.csv", &lamp);
    std::os::unix::fs::symlink("lamp.csv", folder.path("link.csv")).expect("linked");
    for arguments in [["convert", "lamp.csv", "-o", "link.csv"], ["convert", "link.csv", "-o", "lamp.csv"]] {
        folder.run().args(arguments).assert().code(2).stderr(contains("overwrite"));
        assert_eq!(fs::read(folder.path("lamp.csv")).expect("there"), lamp);
    }
}

#[test]
fn a_failure_leaves_no_half_written_file() {
    let folder = Folder::new().with("bad.csv", "wavelength,value\n400,x\n410,1\n");
    for arguments in [
        &["convert", "A", "-o", "out", "--to", "intensity"][..],
        &["convert", "A", "-o", "out", "--distance", "-1m"],
        &["convert", "A", "-o", "no-such-folder/out"],
        &["convert", "A", "--plot", "no-such-folder/x.svg"],
        &["convert", "bad.csv", "--plot", "x.svg"],
    ] {
        folder.run().args(arguments).assert().code(2);
        let left: Vec<String> = folder.names().into_iter().filter(|n| n.ends_with(".part") || n == "x.svg").collect();
        assert!(left.is_empty(), "{arguments:?}: {left:?}");
    }
}

#[test]
fn an_earlier_result_is_not_replaced_by_nothing() {
    let folder =
        Folder::new().with("bad.csv", "wavelength,value\n400,x\n410,1\n").with("out.txt", "an earlier result\n");
    folder.run().args(["convert", "bad.csv", "-o", "out.txt"]).assert().code(2);
    assert_eq!(fs::read_to_string(folder.path("out.txt")).expect("there"), "an earlier result\n");
}

#[cfg(unix)]
#[test]
fn an_output_that_is_no_regular_file_is_written_to_and_not_replaced() {
    use std::os::unix::fs::FileTypeExt;
    let folder = Folder::new();
    let pipe = folder.path("pipe");
    assert!(Process::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
    // Open at both ends, so that neither side can wait for ever.
    let mut held = fs::OpenOptions::new().read(true).write(true).open(&pipe).expect("opened");
    folder.run().args(["convert", "D65", "--csv", "--figures", "luminous", "-o", "pipe"]).assert().success();
    assert!(
        fs::metadata(&pipe).expect("there").file_type().is_fifo(),
        "the pipe was replaced by a file, as /dev/null would be"
    );
    held.write_all(b"end").expect("written");
    let mut start = [0_u8; 5];
    held.read_exact(&mut start).expect("read");
    assert_eq!(&start, b"path,");
}

#[test]
fn a_picture_and_the_results_do_not_share_a_file() {
    let folder = Folder::new();
    folder.run().args(["convert", "D65", "-o", "x.svg", "--plot", "x.svg"]).assert().code(2).stderr(contains("x.svg"));
}

#[test]
fn pictures_are_written_in_the_format_of_their_name() {
    let folder = Folder::new();
    let lamp = office_led();
    folder.run().arg("convert").arg(&lamp).args(["--plot", "x.svg", "--plot", "x.svg"]).assert().code(2);
    folder.run().arg("convert").arg(&lamp).args(["--plot", "x.svg"]).assert().success();
    let svg = fs::read_to_string(folder.path("x.svg")).expect("written");
    assert!(svg.contains("<svg") && svg.trim_end().ends_with("</svg>") && svg.len() > 10_000, "{}", svg.len());
    folder.run().arg("convert").arg(&lamp).args(["--plot", "X.PNG"]).assert().success();
    let png = fs::read(folder.path("X.PNG")).expect("written");
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n") && png.len() > 10_000, "{}", png.len());
    for kind in ["spectrum", "chromaticity", "chromaticity-xy", "tm30", "all"] {
        folder.run().arg("convert").arg(&lamp).args(["--plot", "k.svg", "--plot-kind", kind]).assert().success();
        assert!(fs::read_to_string(folder.path("k.svg")).expect("written").contains("<svg"), "{kind}");
    }
    let before = folder.names();
    folder
        .run()
        .arg("convert")
        .arg(&lamp)
        .args(["--plot", "x.gif"])
        .assert()
        .code(2)
        .stderr(contains(".svg").and(contains(".png")));
    assert_eq!(folder.names(), before);
}

#[test]
fn tables_print_their_provenance_and_their_numbers() {
    let list =
        String::from_utf8(photopic().arg("tables").assert().success().get_output().stdout.clone()).expect("UTF-8");
    for name in [
        "cie-1924-v",
        "cie-1951-v-prime",
        "cie-1931-2deg",
        "cie-1964-10deg",
        "cie-illuminants",
        "ies-ces99",
        "cie-s026",
    ] {
        assert!(list.contains(name), "{name}");
    }
    photopic().args(["tables", "cie-1924-v"]).assert().success().stdout(contains("10.25039").and(contains("sha256")));
    let csv = photopic().args(["tables", "cie-1924-v", "--csv"]).assert().success().get_output().stdout.clone();
    let text = String::from_utf8(csv).expect("UTF-8");
    assert!(text.lines().any(|l| l.starts_with("# licence: ")) && text.lines().any(|l| l.starts_with("# sha256: ")));
    assert!(text.lines().any(|l| l == "555,1" || l == "555,1.0"), "V(555 nm) = 1");
    // 471 wavelengths, 360 to 830 nm (CIE 018:2019).
    assert_eq!(text.lines().filter(|l| l.starts_with(|c: char| c.is_ascii_digit())).count(), 471);
    // What is printed is read again as a spectrum.
    let document = json(photopic().args(["convert", "-", "-q", "--figures", "luminous"]).write_stdin(text));
    assert_eq!(document["results"][0]["integration"]["samples"], 471);
}

#[test]
fn help_manual_and_completions_know_the_verbs() {
    photopic()
        .arg("--help")
        .assert()
        .success()
        .stdout(contains("convert").and(contains("tables")).and(contains("Exit codes")));
    let help = contains("--distance").and(contains("--scale-to")).and(contains("--mesopic-adaptation"));
    photopic().args(["convert", "--help"]).assert().success().stdout(help);
    photopic().arg("man").assert().success().stdout(contains(".TH").and(contains("convert")));
    photopic().args(["man", "convert"]).assert().success().stdout(contains(".TH").and(contains("\\-\\-distance")));
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        photopic()
            .args(["completions", shell])
            .assert()
            .success()
            .stdout(contains("photopic").and(contains("scale-to")));
    }
}

#[test]
fn what_goes_into_a_pipe_has_no_escape_sequences() {
    let folder = Folder::new().with("bad.csv", "wavelength,value\n400,x\n410,1\n");
    for arguments in [
        &["--help"][..],
        &["convert", "--help"],
        &["convert"],
        &["convert", "D65", "bad.csv"],
        &["convert", "A", "--nonsense"],
        &["tables"],
    ] {
        for no_color in [false, true] {
            let mut command = folder.run();
            command.args(arguments);
            if no_color {
                command.env("NO_COLOR", "1");
            }
            let out = command.output().expect("runs");
            assert!(!out.stdout.contains(&0x1b) && !out.stderr.contains(&0x1b), "{arguments:?}, NO_COLOR {no_color}");
        }
    }
}

#[test]
fn quiet_says_errors_only_and_verbose_says_more() {
    let folder = Folder::new().with("one.csv", constant());
    let said = |arguments: &[&str]| {
        let out = folder.run().args(["convert", "one.csv"]).args(arguments).output().expect("runs");
        String::from_utf8(out.stderr).expect("UTF-8")
    };
    assert_eq!(said(&["-q"]), "");
    let (usual, verbose) = (said(&[]), said(&["-v"]));
    assert!(usual.contains("warning ") && !usual.contains("info "), "{usual}");
    assert!(verbose.contains("info "), "{verbose}");
    folder.run().args(["convert", "one.csv", "-q", "-v"]).assert().code(2);
}
