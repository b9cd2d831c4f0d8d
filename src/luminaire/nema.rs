//! NEMA types of floodlights.

use super::beam::{Definition, FIELD_FRACTION, angles};
use super::distribution::{Distribution, System};

/// Upper ends of the field angles of Types 1 to 6, degrees; Type 1 begins at 10°, Type 7 has no upper end.
///
/// NEMA FA 1-1973 (in IES LM-35-02 and RP-6): 10–18, 18–29, 29–46, 46–70, 70–100, 100–130, 130 and more.
const UPPER_DEG: [f64; 6] = [18.0, 29.0, 46.0, 70.0, 100.0, 130.0];

/// The NEMA type, 1 to 7, of a field angle in degrees; narrower than Type 1 counts as 1.
#[must_use]
pub fn nema_type(field_angle_deg: f64) -> u8 {
    1 + UPPER_DEG.iter().filter(|upper| field_angle_deg >= **upper).count() as u8
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
    fn limits_belong_to_the_wider_type() {
        for (angle, kind) in [(8.0, 1), (17.9, 1), (18.0, 2), (45.0, 3), (46.0, 4), (99.0, 5), (129.9, 6), (130.0, 7)] {
            assert_eq!(nema_type(angle), kind, "{angle}°");
        }
    }
}
