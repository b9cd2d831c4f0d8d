//! Lists of light directions: read, and compared with what photographs show.

use glam::{DMat3, DVec3};
use nalgebra::Matrix3;

use super::angle_deg;
use crate::mistake::Mistake;

/// A listed light.
#[derive(Debug, Clone, PartialEq)]
pub struct Listed {
    /// Its name, where the list has names.
    pub name: Option<String>,
    /// Towards it, of any length.
    pub direction: DVec3,
}

/// Reads a list: three numbers a row, or a name and three numbers; separated by commas, semicolons or blanks. A header may name the columns
/// `x`, `y`, `z` or `Lx`, `Ly`, `Lz` and `name`, `light` or `i`; other columns are passed over. Empty lines, comments (`#`) and a first line
/// with the count alone are too.
///
/// # Errors
/// What was found where, for a row that has no direction in it.
pub fn parse(text: &str) -> Result<Vec<Listed>, Mistake> {
    let mut columns: Option<([usize; 3], Option<usize>)> = None;
    let mut out = Vec::new();
    for (n, line) in text.lines().enumerate() {
        let line = line.trim_start_matches('\u{feff}').trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let cells: Vec<&str> = if line.contains([',', ';']) {
            line.split([',', ';']).map(str::trim).collect()
        } else {
            line.split_whitespace().collect()
        };
        let wrong = |found: String| Mistake {
            line: n as u64 + 1,
            column: 1,
            message: format!("found {found}; expected a direction: three numbers, or a name and three"),
        };
        if out.is_empty() && columns.is_none() {
            let place = |names: &[&str]| cells.iter().position(|c| names.iter().any(|n| c.eq_ignore_ascii_case(n)));
            if let (Some(x), Some(y), Some(z)) = (place(&["x", "Lx"]), place(&["y", "Ly"]), place(&["z", "Lz"])) {
                columns = Some(([x, y, z], place(&["name", "light", "i"])));
                continue;
            }
            if cells.len() == 1 && cells[0].parse::<u32>().is_ok() {
                continue;
            }
        }
        let (places, name) = columns.unwrap_or(match cells.len() {
            4 => ([1, 2, 3], Some(0)),
            _ => ([0, 1, 2], None),
        });
        if columns.is_none() && !matches!(cells.len(), 3 | 4) {
            return Err(wrong(format!("{} fields", cells.len())));
        }
        let mut direction = [0.0; 3];
        for (value, place) in direction.iter_mut().zip(places) {
            let cell = cells.get(place).copied().unwrap_or_default();
            let number = cell.parse::<f64>().ok().filter(|v| v.is_finite());
            *value = number.ok_or_else(|| wrong(format!("`{cell}`")))?;
        }
        let direction = DVec3::from_array(direction);
        if direction == DVec3::ZERO {
            return Err(wrong("a direction of no length".to_owned()));
        }
        out.push(Listed { name: name.and_then(|i| cells.get(i)).map(|n| (*n).to_owned()), direction });
    }
    if out.is_empty() {
        return Err(Mistake {
            line: 1,
            column: 1,
            message: "found no light; expected a direction per line".to_owned(),
        });
    }
    Ok(out)
}

/// How far two sets of directions are apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Angle of each pair, degrees.
    pub angles_deg: Vec<f64>,
    /// The one rotation that brings them nearest, degrees: what a turned camera would explain.
    pub rotation_deg: f64,
    /// Angle of each pair after it, degrees.
    pub turned_deg: Vec<f64>,
    /// Whether a mirrored axis brings them nearer still, and which (`x`, `y`, `z`): another handedness.
    pub mirrored: Option<char>,
}

/// Compares pairs of directions, in their order: those of a list and those found.
#[must_use]
pub fn compare(listed: &[DVec3], found: &[DVec3]) -> Difference {
    let angles =
        |turn: &DMat3| -> Vec<f64> { listed.iter().zip(found).map(|(l, f)| angle_deg(*turn * *l, *f)).collect() };
    let rotation = rotation(listed, found);
    let angles_deg = angles(&DMat3::IDENTITY);
    let rms = |all: &[f64]| (all.iter().map(|a| a * a).sum::<f64>() / all.len().max(1) as f64).sqrt();
    let mirrors =
        [('x', DVec3::new(-1.0, 1.0, 1.0)), ('y', DVec3::new(1.0, -1.0, 1.0)), ('z', DVec3::new(1.0, 1.0, -1.0))];
    // Only what explains nearly all is told.
    let mirrored = mirrors.into_iter().find(|(_, m)| rms(&angles(&DMat3::from_diagonal(*m))) < 0.3 * rms(&angles_deg));
    let trace = rotation.x_axis.x + rotation.y_axis.y + rotation.z_axis.z;
    let skew = DVec3::new(
        rotation.y_axis.z - rotation.z_axis.y,
        rotation.z_axis.x - rotation.x_axis.z,
        rotation.x_axis.y - rotation.y_axis.x,
    );
    Difference {
        rotation_deg: skew.length().atan2(trace - 1.0).to_degrees(),
        turned_deg: angles(&rotation),
        angles_deg,
        mirrored: mirrored.map(|(axis, _)| axis),
    }
}

/// The rotation R of least Σ |R a − b|² over unit directions (Kabsch 1976).
fn rotation(from: &[DVec3], to: &[DVec3]) -> DMat3 {
    let mut sum = DMat3::ZERO;
    for (a, b) in from.iter().zip(to).map(|(a, b)| (a.normalize(), b.normalize())) {
        sum += DMat3::from_cols(b * a.x, b * a.y, b * a.z);
    }
    let svd = Matrix3::from_column_slice(&sum.to_cols_array()).svd(true, true);
    let (Some(u), Some(v)) = (svd.u, svd.v_t) else { return DMat3::IDENTITY };
    let mut flip = Matrix3::identity();
    let least = svd.singular_values.imin();
    flip[(least, least)] = (u.determinant() * v.determinant()).signum();
    let columns: Vec<f64> = (u * flip * v).iter().copied().collect();
    DMat3::from_cols_slice(&columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_all_kinds_are_read() {
        let expected = [DVec3::new(0.1, 0.2, 0.9), DVec3::new(-0.3, 0.0, 1.0)];
        for text in [
            "2\n0.1 0.2 0.9\n-0.3 0 1\n",
            "x,y,z\n0.1,0.2,0.9\n-0.3,0,1\n",
            "i,Lx,Ly,Lz,angle\na,0.1,0.2,0.9,7\nb,-0.3,0,1,8\n",
            "# mine\na;0.1;0.2;0.9\n\nb;-0.3;0;1",
        ] {
            let all = parse(text).unwrap();
            assert_eq!(all.iter().map(|l| l.direction).collect::<Vec<_>>(), expected, "{text}");
        }
        assert_eq!(parse("a 1 0 0").unwrap()[0].name.as_deref(), Some("a"));
        let told = |text: &str| parse(text).map_err(|e| (e.line, e.message)).unwrap_err();
        assert!(told("1 2 3\n1 2").1.starts_with("found 2 fields") && told("1 2 3\n1 2").0 == 2);
        assert!(told("1 2 x").1.starts_with("found `x`"));
        assert!(told("0 0 0").1.starts_with("found a direction of no length"));
        assert!(told("").1.starts_with("found no light"));
    }

    #[test]
    fn a_turned_list_and_a_mirrored_one_are_told_from_a_wrong_one() {
        let found = [DVec3::new(0.3, 0.2, 0.9), DVec3::new(-0.4, 0.1, 0.8), DVec3::new(0.1, -0.5, 0.7)];
        let turned = found.map(|d| DMat3::from_rotation_y(4_f64.to_radians()) * d);
        let d = compare(&turned, &found);
        assert!((d.rotation_deg - 4.0).abs() < 1e-9 && d.turned_deg.iter().all(|a| *a < 1e-6), "{d:?}");
        assert_eq!(compare(&found.map(|d| d * DVec3::new(1.0, -1.0, 1.0)), &found).mirrored, Some('y'));
        let same = compare(&found, &found);
        assert!(same.mirrored.is_none() && same.angles_deg.iter().all(|a| *a < 1e-6));
    }
}
