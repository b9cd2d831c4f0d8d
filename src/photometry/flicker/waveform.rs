//! Light over time, and the delimited text that oscilloscopes and flicker meters write of it.

use crate::finding::Finding;
use crate::mistake::Mistake;

/// A time may be so many steps off an even spacing: what printed digits make of it.
const UNEVEN: f64 = 0.5;

/// Samples of light at even steps of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Waveform {
    /// Samples per second.
    pub rate_hz: f64,
    /// The samples, in any unit that is proportional to light.
    pub values: Vec<f64>,
}

/// The waveforms of a file: name of the column and samples.
pub type Named = Vec<(String, Waveform)>;

/// Reads delimited text of one column of time and one or several of light; with `rate_hz` all columns are of light.
///
/// Lines above the first row of numbers are headings, of which the last names the columns; lines with `#` count for nothing. Time is in the unit
/// of its heading (s, ms, us, µs), by convention in seconds (finding F005). Commas, semicolons, tabulators or blanks separate; beside
/// semicolons a comma is a decimal mark.
///
/// # Errors
/// A mistake with its line and column: cells that are no numbers, rows of other lengths, times that do not go up evenly.
pub fn parse(text: &str, rate_hz: Option<f64>) -> Result<(Named, Vec<Finding>), Mistake> {
    let mut heading = String::new();
    let mut separator = None;
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut first_line = 1;
    for (number, line) in (1..).zip(text.lines()) {
        if line.trim().is_empty() || line.trim_start().starts_with('#') {
            continue;
        }
        let kind = separator.unwrap_or_else(|| separator_of(line));
        let cells = split(line, kind);
        let numbers: Vec<Option<f64>> = cells.iter().map(|c| value(c.1, kind)).collect();
        if columns.is_empty() {
            if numbers.iter().any(Option::is_none) {
                heading = line.to_owned();
                continue;
            }
            separator = Some(kind);
            first_line = number;
            columns = vec![Vec::new(); numbers.len()];
        }
        if numbers.len() != columns.len() {
            let message = format!("found {} cells; expected {} as in line {first_line}", numbers.len(), columns.len());
            return Err(Mistake { line: number, column: 1, message });
        }
        for (column, (found, (at, cell))) in columns.iter_mut().zip(numbers.iter().zip(&cells)) {
            let wrong =
                || Mistake { line: number, column: *at, message: format!("found `{cell}`; expected a finite number") };
            column.push(found.ok_or_else(wrong)?);
        }
    }
    let whole = |message: String| Mistake { line: 1, column: 1, message };
    if columns.is_empty() {
        return Err(whole("found no row of numbers; expected time and light".into()));
    }
    let kind = separator.unwrap_or(',');
    let named: Vec<&str> = split(&heading, kind).into_iter().map(|c| c.1).collect();
    let headed = named.len() == columns.len();
    let name = |i: usize| if headed { named[i].trim_matches('"').to_owned() } else { format!("column {}", i + 1) };
    let mut findings = Vec::new();
    let (rate, lights) = match rate_hz {
        Some(rate) => (rate, 0..columns.len()),
        None if columns.len() < 2 => {
            return Err(whole("found one column; expected time and light, or the sampling rate (--rate)".into()));
        }
        None => {
            let unit = if headed { unit_s(named[0]) } else { None };
            if unit.is_none() {
                findings.push(Finding::info("F005", "the file states no unit of time; seconds taken by convention"));
            }
            (rate_of(&columns[0], first_line)? / unit.unwrap_or(1.0), 1..columns.len())
        }
    };
    let mut out = Vec::new();
    for i in lights {
        out.push((name(i), Waveform { rate_hz: rate, values: std::mem::take(&mut columns[i]) }));
    }
    Ok((out, findings))
}

/// What separates the cells of a line; a blank stands for any number of them.
fn separator_of(line: &str) -> char {
    ['\t', ';', ','].into_iter().find(|c| line.contains(*c)).unwrap_or(' ')
}

/// Cells with the column, in characters from 1, in which each begins.
fn split(line: &str, separator: char) -> Vec<(u64, &str)> {
    if separator == ' ' {
        let place = |cell: &str| line[..cell.as_ptr() as usize - line.as_ptr() as usize].chars().count() as u64 + 1;
        return line.split_whitespace().map(|c| (place(c), c)).collect();
    }
    let mut column = 1;
    let mut out: Vec<(u64, &str)> = Vec::new();
    for cell in line.split(separator) {
        out.push((column, cell.trim()));
        column += cell.chars().count() as u64 + 1;
    }
    // A separator at the end of a line ends the line.
    if out.len() > 1 && out.last().is_some_and(|c| c.1.is_empty()) {
        out.pop();
    }
    out
}

fn value(cell: &str, separator: char) -> Option<f64> {
    let plain = cell.trim_matches('"');
    let parsed = if separator == ',' { plain.parse::<f64>() } else { plain.replace(',', ".").parse::<f64>() };
    parsed.ok().filter(|v| v.is_finite())
}

/// The unit that a heading states for time, in seconds.
fn unit_s(heading: &str) -> Option<f64> {
    let lower = heading.to_lowercase();
    let word = lower.rsplit(|c: char| !(c.is_alphabetic() || c == 'µ' || c == 'μ')).find(|w| !w.is_empty())?;
    match word {
        "s" | "sec" | "second" | "seconds" => Some(1.0),
        "ms" | "milliseconds" => Some(1e-3),
        "us" | "µs" | "μs" | "microseconds" => Some(1e-6),
        _ => None,
    }
}

/// Samples per unit of time.
fn rate_of(times: &[f64], first_line: u64) -> Result<f64, Mistake> {
    let (n, first) = (times.len(), times[0]);
    let step = (times[n - 1] - first) / (n.max(2) - 1) as f64;
    let off = |i: usize| (times[i] - first - step * i as f64).abs() > UNEVEN * step;
    if n < 2 || step.is_nan() || step <= 0.0 {
        let message = "found times that do not go up; expected even steps of time in the first column".into();
        return Err(Mistake { line: first_line, column: 1, message });
    }
    if let Some(i) = (0..n).find(|i| off(*i)) {
        let message = format!(
            "found time {} in row {}; expected even steps of {step} from {first}, which samples of a spectrum need",
            times[i],
            i + 1
        );
        return Err(Mistake { line: first_line + i as u64, column: 1, message });
    }
    Ok(1.0 / step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_has_the_unit_of_its_heading() {
        let read = |text: &str| parse(text, None).expect("a waveform");
        let (all, findings) = read("scope\ntime [ms],lamp 1,lamp 2\n0,1,2\n0.5,3,4\n1.0,5,6\n");
        assert!(findings.is_empty() && all.len() == 2);
        assert_eq!(all[0], ("lamp 1".to_owned(), Waveform { rate_hz: 2000.0, values: vec![1.0, 3.0, 5.0] }));
        let (all, findings) = read("0;1,5\n0,1;2,5\n0,2;3,5\n");
        assert_eq!(findings.iter().map(|f| f.code).collect::<Vec<_>>(), ["F005"]);
        assert!((all[0].1.rate_hz - 10.0).abs() < 1e-12 && all[0].1.values == [1.5, 2.5, 3.5]);
        let (all, _) = parse("light\n1\n2\n3\n", Some(500.0)).expect("a column");
        assert_eq!(all[0], ("light".to_owned(), Waveform { rate_hz: 500.0, values: vec![1.0, 2.0, 3.0] }));
    }

    #[test]
    fn mistakes_have_their_place() {
        let message = |text: &str| parse(text, None).expect_err(text).to_string();
        assert!(message("t,y\n0,1\n1,x\n").starts_with("3:3: found `x`"));
        assert!(message("t,y\n0,1\n1\n").starts_with("3:1: found 1 cells; expected 2 as in line 2"));
        assert!(message("t,y\n0,1\n1,2\n5,3\n").starts_with("3:1: found time 1 in row 2; expected even steps"));
        assert!(message("t,y\n1,1\n0,2\n").starts_with("2:1: found times that do not go up"));
        assert!(message("y\n1\n2\n").starts_with("1:1: found one column"));
        assert!(message("").starts_with("1:1: found no row"));
    }
}
