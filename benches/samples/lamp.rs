//! LM-63 files as long as wanted, for the benchmarks of the readers.

/// A file of 721 × 1441 angles, 6 MB and more.
pub fn big(digits: usize) -> String {
    file(721, 1441, digits)
}

/// A file of `rows` × `planes` angles with so many decimals.
pub fn file(rows: i32, planes: i32, digits: usize) -> String {
    let mut out = format!(
        "IESNA:LM-63-2002\r\n[TEST] bench\r\n[TESTLAB] none\r\n[ISSUEDATE] 2025\r\n[MANUFAC] none\r\nTILT=NONE\r\n1 -1 1 {rows} {planes} 1 2 .5 .5 0\r\n1 1 100\r\n"
    );
    let mut list = |values: &mut dyn Iterator<Item = String>| {
        for (i, value) in values.enumerate() {
            out.push_str(&value);
            out.push_str(if i % 20 == 19 { "\r\n" } else { " " });
        }
        out.push_str("\r\n");
    };
    let (down, around) = (180.0 / f64::from(rows - 1), 360.0 / f64::from(planes - 1));
    list(&mut (0..rows).map(|v| format!("{}", f64::from(v) * down)));
    list(&mut (0..planes).map(|h| format!("{}", f64::from(h) * around)));
    for plane in 0..planes {
        let swing = 1.0 + 0.1 * (f64::from(plane) * around).to_radians().sin();
        list(&mut (0..rows).map(|row| {
            let v = 12_345.678 * swing * (0.5 + 0.5 * (f64::from(row) * down).to_radians().cos()).powi(3);
            format!("{v:.digits$}")
        }));
    }
    out
}
