//! NEMA types of floodlights.

use super::beam::{Definition, FIELD_FRACTION, angles};
use super::distribution::{Distribution, System};

/// Upper ends of the field angles of Types 1 to 6, degrees, which belong to them; Type 1 begins at 10°, Type 7 has no upper end.
///
/// NEMA FA 1 (in IES LM-35-02): 10–18, more than 18 to 29, to 46, to 70, to 100, to 130, more than 130. Makers' and programs' tables print
/// the open lower ends (OxyTech's guide to its PhotoView; Hubbell's table of beam spreads).
const UPPER_DEG: [f64; 6] = [18.0, 29.0, 46.0, 70.0, 100.0, 130.0];

/// The NEMA type, 1 to 7, of a field angle in degrees; narrower than Type 1 counts as 1.
#[must_use]
pub fn nema_type(field_angle_deg: f64) -> u8 {
    1 + UPPER_DEG.iter().filter(|upper| field_angle_deg > **upper).count() as u8
}

/// NEMA types of a floodlight, horizontal × vertical: its field angles between the outermost directions with a tenth of the
/// maximum. `None` for Type C tables, which are not those of aimed floodlights, and where a plane through the axis stays
/// below a tenth.
#[must_use]
pub fn nema_types(distribution: &Distribution) -> Option<(u8, u8)> {
    if distribution.system() == System::TypeC {
        return None;
    }
    let field = angles(distribution, FIELD_FRACTION, Definition::Outermost);
    Some((nema_type(field.c0_c180?), nema_type(field.c90_c270?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_belong_to_the_narrower_type() {
        // The last pair is OxyTech's example: field angles of 113° × 97.7° make 6 × 5.
        let printed = [(8.0, 1), (18.0, 1), (18.1, 2), (46.0, 3), (70.0, 4), (100.0, 5), (130.0, 6), (130.1, 7)];
        for (angle, kind) in printed.into_iter().chain([(113.0, 6), (97.7, 5)]) {
            assert_eq!(nema_type(angle), kind, "{angle}°");
        }
    }
}
