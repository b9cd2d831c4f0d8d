//! UGR tables against those of Relux: within 0.4 on every cell given.

mod common;

use std::fs;

use photopic::luminaire::format;
use photopic::luminaire::ugr::{ROOMS, ugr_table};

/// Relux and DIALux differ from each other by up to 0.8; the task's bound against Relux is half of that.
const TOLERANCE: f64 = 0.4;

#[test]
fn every_cell_is_near_that_of_relux() {
    let Some(folder) = common::shared("luminaires") else { return };
    let mut worst = 0.0_f64;
    let mut tables = 0;
    for number in 1..=99 {
        let path = folder.join(format!("ugr/ugr_table_{number:02}_Relux.csv"));
        let Ok(text) = fs::read_to_string(&path) else { continue };
        let file = folder.join(format!("files/123VincentB+eulumdat-ugr/data/input/sample_{number:02}.ldt"));
        let bytes = fs::read(&file).expect("the table's luminaire");
        let lamp =
            format::read(&bytes, &Default::default()).unwrap_or_else(|e| panic!("{}: {e}", file.display())).value;
        let table = ugr_table(&lamp).expect("a luminaire with an opening");
        assert_eq!((table.len(), text.lines().count()), (ROOMS.len(), ROOMS.len()), "{}", path.display());
        let (mut sum, mut low, mut high, mut cells) = (0.0, f64::MAX, f64::MIN, 0);
        for (row, line) in table.iter().zip(text.lines()) {
            let got = row.crosswise.iter().chain(&row.endwise);
            for (value, cell) in got.zip(line.split(',').map(str::trim)) {
                let value = value.expect("a luminaire that is seen");
                let place = format!("{number:02}: {}H × {}H: {value} against {cell}", row.room_x_h, row.room_y_h);
                if let Some(bound) = cell.strip_prefix('<') {
                    assert!(value < bound.parse().expect("a number"), "{place}");
                    continue;
                }
                let difference = value - cell.parse::<f64>().expect("a number");
                (sum, low, high, cells) = (sum + difference, low.min(difference), high.max(difference), cells + 1);
                assert!(difference.abs() <= TOLERANCE, "{place}");
            }
        }
        eprintln!("table {number:02}: {cells} cells, mean {:+.3}, {low:+.3} to {high:+.3}", sum / f64::from(cells));
        worst = worst.max(high.max(-low));
        tables += 1;
    }
    eprintln!("{tables} tables, worst difference {worst:.3}");
    assert!(tables > 0);
}
