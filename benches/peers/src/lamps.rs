//! LM-63 files in memory, parsed by photopic and by the crate `eulumdat`.

use std::hint::black_box;

use cpu_time::ThreadTime;
use photopic::luminaire::format::ies;

#[path = "../../samples/lamp.rs"]
mod lamp;

use lamp::file;

/// Time to measure for, s.
const AT_LEAST: f64 = 0.3;
/// Angles of the file: a fine goniometer's half space, 65 000 values.
const ANGLES: (i32, i32) = (181, 361);

/// `lm63-plain` has the numbers of ordinary files, `lm63-long` 17 digits. Prints CPU seconds for one pass, bytes in it and the mean value.
pub fn run(implementation: &str, task: &str) {
    let text = file(ANGLES.0, ANGLES.1, if task == "lm63-long" { 13 } else { 1 });
    match implementation {
        "photopic" => race(&text, |text| ies::parse(text.as_bytes()).expect("a file").value.candela),
        "eulumdat" => race(&text, |text| eulumdat::IesParser::parse(text).expect("a file").intensities.concat()),
        other => panic!("no lamps of `{other}`"),
    }
}

fn race(text: &str, parse: impl Fn(&str) -> Vec<f64>) {
    let values = parse(text);
    assert!(values.len() >= (ANGLES.0 * (ANGLES.1 - 1)) as usize, "{} values", values.len());
    let start = ThreadTime::now();
    let mut passes = 0;
    while passes == 0 || start.elapsed().as_secs_f64() < AT_LEAST {
        black_box(parse(black_box(text)));
        passes += 1;
    }
    let seconds = start.elapsed().as_secs_f64() / f64::from(passes);
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    println!("{{\"seconds\": {seconds}, \"spectra\": {}, \"mean\": {mean}}}", text.len());
}
