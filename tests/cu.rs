//! Coefficients of utilisation against the tables of Photometric Toolbox: every cell, after rounding to per cent.

mod common;

use std::fs;

use photopic::luminaire::cu::cu_table;
use photopic::luminaire::format;

#[test]
fn every_cell_is_the_printed_one() {
    let Some(folder) = common::shared("luminaires") else { return };
    let text = fs::read_to_string(folder.join("cu/tables.txt")).expect("the tables");
    let mut tables: Vec<(String, Vec<Vec<f64>>)> = Vec::new();
    for line in text.lines() {
        let number = line.strip_prefix('#').map(str::trim).filter(|n| n.parse::<u32>().is_ok());
        if let Some(number) = number {
            tables.push((number.to_owned(), Vec::new()));
        } else if !line.starts_with('#') && !line.trim().is_empty() {
            let cells = line.split_whitespace().map(|c| c.parse().expect("per cent")).collect();
            tables.last_mut().expect("a table begun").1.push(cells);
        }
    }
    assert!(!tables.is_empty());
    for (number, rows) in tables {
        let file = format!("files/echowuzangye+CU-calculations-based-on-IES-file/ies/{number}.IES");
        let bytes = fs::read(folder.join(&file)).expect("a listed file");
        let lamp = format::read(&bytes, &Default::default()).unwrap_or_else(|e| panic!("{file}: {e}")).value;
        let table = cu_table(&lamp).expect("a lit Type C luminaire");
        assert_eq!((table.len(), rows.len()), (11, 11), "{file}");
        for (got, expected) in table.iter().zip(rows) {
            let rounded = got.cu_percent.map(f64::round);
            assert_eq!(rounded.as_slice(), expected, "{file}, RCR {}: {:?}", got.rcr, got.cu_percent);
        }
    }
}
