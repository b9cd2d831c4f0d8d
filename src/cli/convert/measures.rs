//! Lengths, areas, angles and times on the command line: a number with its unit, which is never guessed.

use crate::photometry::transfer::Shape;

/// Splits `2.5 m` into number and unit.
fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let end = (1..=text.len())
        .rev()
        .find(|&i| text.is_char_boundary(i) && text[..i].trim_end().parse::<f64>().is_ok_and(f64::is_finite))?;
    Some((text[..end].trim_end().parse().ok()?, text[end..].trim()))
}

fn measure(text: &str, what: &str, example: &str, factor: impl Fn(&str) -> Option<f64>) -> Result<f64, String> {
    split(text)
        .and_then(|(number, unit)| Some(number * factor(unit)?))
        .ok_or_else(|| format!("`{text}` is no {what}; expected a number with its unit, such as {example}"))
}

fn metres(unit: &str) -> Option<f64> {
    Some(match unit {
        "m" => 1.0,
        "cm" => 1e-2,
        "mm" => 1e-3,
        "um" | "µm" | "μm" => 1e-6,
        "km" => 1e3,
        // Exact since 1959.
        "in" => 0.0254,
        "ft" => 0.3048,
        _ => return None,
    })
}

/// A length in m.
pub(in crate::cli) fn length(text: &str) -> Result<f64, String> {
    measure(text, "length", "2m, 30cm or 10ft", metres)
}

/// A share below 1, per cent or a fraction.
pub(super) fn share(text: &str) -> Result<f64, String> {
    let share = split(text).and_then(|(number, unit)| match unit {
        "%" => Some(number / 100.0),
        "" => Some(number),
        _ => None,
    });
    let share = share.filter(|s| (0.0..1.0).contains(s));
    share.ok_or_else(|| format!("`{text}` is no share; expected 0.1% or a fraction from 0 to below 1"))
}

/// An area in m².
pub(super) fn area(text: &str) -> Result<f64, String> {
    measure(text, "area", "1cm2, 0.5m2 or 1ft2", |unit| {
        let plain = unit.replace(['^', ' '], "").replace('²', "2");
        metres(plain.strip_suffix('2')?).map(|m| m * m)
    })
}

/// An angle in rad.
pub(super) fn angle(text: &str) -> Result<f64, String> {
    measure(text, "angle", "30deg or 0.5rad", |unit| match unit {
        "deg" | "°" => Some(std::f64::consts::PI / 180.0),
        "rad" => Some(1.0),
        "mrad" => Some(1e-3),
        _ => None,
    })
}

/// A solid angle in sr.
pub(super) fn solid_angle(text: &str) -> Result<f64, String> {
    measure(text, "solid angle", "0.1sr", |unit| match unit {
        "sr" => Some(1.0),
        "msr" => Some(1e-3),
        _ => None,
    })
}

/// A time in s.
pub(super) fn time(text: &str) -> Result<f64, String> {
    measure(text, "time", "10s, 5ms or 8h", |unit| match unit {
        "s" => Some(1.0),
        "ms" => Some(1e-3),
        "us" | "µs" | "μs" => Some(1e-6),
        "ns" => Some(1e-9),
        "min" => Some(60.0),
        "h" => Some(3600.0),
        _ => None,
    })
}

/// `380-780` or `380..780` in nm.
pub(in crate::cli) fn range_nm(text: &str) -> Result<(f64, f64), String> {
    let plain = text.trim().trim_end_matches("nm").trim();
    let parts = plain.split_once("..").or_else(|| plain.split_once(['-', '–', ':']));
    parts
        .and_then(|(a, b)| Some((a.trim().parse::<f64>().ok()?, b.trim().parse::<f64>().ok()?)))
        .filter(|(a, b)| *a >= 0.0 && b > a && b.is_finite())
        .ok_or_else(|| format!("`{text}` is no range of wavelengths; expected two in nm, ascending, such as 380-780"))
}

/// `x,y` chromaticity.
pub(super) fn xy(text: &str) -> Result<[f64; 2], String> {
    text.split_once(',')
        .and_then(|(a, b)| Some([a.trim().parse::<f64>().ok()?, b.trim().parse::<f64>().ok()?]))
        .filter(|[x, y]| *x >= 0.0 && *y > 0.0 && x + y <= 1.0)
        .ok_or_else(|| format!("`{text}` is no chromaticity; expected x,y such as 0.3127,0.3290"))
}

/// `sphere:10cm`, `disk:5cm`, `rect:60cm x 60cm`, `triangle:10cm x 20cm`.
pub(super) fn shape(text: &str) -> Result<Shape, String> {
    let bad = || {
        format!(
            "`{text}` is no source; expected sphere:RADIUS, disk:RADIUS, rect:WIDTHxHEIGHT or triangle:BASExHEIGHT, such as disk:5cm or rect:60cmx60cm"
        )
    };
    let (kind, sizes) = text.split_once(':').ok_or_else(bad)?;
    let positive = |text: &str| length(text).ok().filter(|v| *v > 0.0);
    let two = || sizes.split_once(['x', '×']).and_then(|(a, b)| Some((positive(a)?, positive(b)?)));
    let shape = match kind.trim().to_lowercase().as_str() {
        "sphere" => positive(sizes).map(|radius_m| Shape::Sphere { radius_m }),
        "disk" | "disc" => positive(sizes).map(|radius_m| Shape::Disk { radius_m }),
        "rect" | "rectangle" => two().map(|(width_m, height_m)| Shape::Rectangle { width_m, height_m }),
        "triangle" => two().map(|(base_m, height_m)| Shape::Triangle { base_m, height_m }),
        _ => None,
    };
    shape.ok_or_else(bad)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_have_units() {
        assert_eq!(length("2m"), Ok(2.0));
        assert_eq!(length("30 cm"), Ok(0.3));
        assert_eq!(area("10 mm²").map(|v| (v * 1e12).round()), Ok(1e7));
        assert_eq!(angle("180deg"), Ok(std::f64::consts::PI));
        assert_eq!(time("1.5e-3s"), Ok(0.0015));
        assert_eq!(range_nm("380-780nm"), Ok((380.0, 780.0)));
        assert_eq!(xy("0.3127, 0.329"), Ok([0.3127, 0.329]));
        assert_eq!(shape("rect:60cm x 0.5m"), Ok(Shape::Rectangle { width_m: 0.6, height_m: 0.5 }));
        for text in ["2", "", "m", "2 parsec", "NaN m", "infm"] {
            assert!(length(text).is_err(), "{text}");
        }
        assert!(
            area("2m").is_err() && angle("30").is_err() && range_nm("780-380").is_err() && shape("disk:0m").is_err()
        );
    }
}
