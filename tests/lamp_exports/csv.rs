//! The table as CSV, read as pandas would: comment lines, a header of planes, γ as the first column.

use photopic::luminaire::export::csv::write;
use photopic::luminaire::{Distribution, Symmetry, System};

use super::lamp::{lamp, tables, type_b};

/// Comments, name of the first column, planes, rows and values plane by plane.
fn read(distribution: &Distribution) -> (String, String, Vec<f64>, Vec<f64>, Vec<f64>) {
    let files = write(&lamp(distribution.clone())).expect("exported").value;
    let text = String::from_utf8(files[0].bytes.clone()).expect("text");
    let comments = text.lines().take_while(|l| l.starts_with('#')).collect::<Vec<_>>().join("\n");
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
    let header = reader.headers().expect("a header").clone();
    let number = |w: &str| w.parse::<f64>().expect("a number");
    let planes: Vec<f64> = header.iter().skip(1).map(number).collect();
    let (mut rows, mut by_row) = (Vec::new(), Vec::new());
    for record in reader.records() {
        let record = record.expect("as many cells as planes");
        rows.push(number(&record[0]));
        by_row.push(record.iter().skip(1).map(number).collect::<Vec<f64>>());
    }
    let values = (0..planes.len()).flat_map(|i| by_row.iter().map(move |row| row[i])).collect();
    (comments, header[0].to_owned(), planes, rows, values)
}

#[test]
fn the_table_comes_back_whole() {
    for d in tables() {
        let (comments, corner, planes, rows, values) = read(&d);
        assert_eq!(corner, "gamma_deg");
        assert_eq!(rows, d.vertical_deg());
        // Every plane of the lamp is there, digit for digit.
        for (i, plane) in d.horizontal_deg().iter().enumerate() {
            let column = planes.iter().position(|p| p == plane).expect("the plane");
            assert_eq!(&values[column * rows.len()..(column + 1) * rows.len()], d.plane(i));
        }
        let rotational = d.symmetry() == Symmetry::Rotational;
        let symmetry = if rotational { Symmetry::Rotational } else { Symmetry::None };
        assert!(rotational || (planes[0], planes.last()) == (0.0, Some(&360.0)), "{planes:?}");
        let back = Distribution::new(System::TypeC, symmetry, planes, rows, values).expect("a table");
        assert!((back.total_flux() / d.total_flux() - 1.0).abs() < 1e-13);
        for words in ["cd", "photometric type: C", "symmetry: ", "+x is C0", "linear in both angles"] {
            assert!(comments.contains(words), "{words}: {comments}");
        }
    }
}

#[test]
fn type_b_keeps_its_own_angles() {
    let d = type_b();
    let (comments, corner, planes, rows, values) = read(&d);
    assert_eq!(
        (corner.as_str(), planes.as_slice(), rows.as_slice()),
        ("vertical_deg", d.horizontal_deg(), d.vertical_deg())
    );
    assert_eq!(values, d.values());
    assert!(comments.contains("photometric type: B"), "{comments}");
}
