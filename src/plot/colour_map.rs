//! Colours for values: the perceptually uniform map *viridis*.
//!
//! Every fifth of the 256 entries of `viridis` in matplotlib 3.11 (`_cm_listed.py`; S. van der Walt, N. Smith, E. Firing, 2015;
//! CC0), as sRGB bytes. Straight lines between them are within one level of the whole table.

const STEPS: usize = 51;

#[rustfmt::skip]
const VIRIDIS: [[u8; 3]; STEPS + 1] = [
    [68, 1, 84], [70, 8, 92], [71, 16, 99], [72, 23, 105], [72, 29, 111], [72, 36, 117],
    [71, 42, 122], [70, 48, 126], [69, 55, 129], [67, 61, 132], [65, 66, 135], [63, 72, 137],
    [61, 78, 138], [58, 83, 139], [56, 89, 140], [53, 94, 141], [51, 99, 141], [49, 104, 142],
    [46, 109, 142], [44, 113, 142], [42, 118, 142], [41, 123, 142], [39, 128, 142], [37, 132, 142],
    [35, 137, 142], [33, 142, 141], [32, 146, 140], [31, 151, 139], [30, 156, 137], [31, 161, 136],
    [33, 165, 133], [36, 170, 131], [40, 174, 128], [46, 179, 124], [53, 183, 121], [61, 188, 116],
    [70, 192, 111], [80, 196, 106], [90, 200, 100], [101, 203, 94], [112, 207, 87], [124, 210, 80],
    [137, 213, 72], [149, 216, 64], [162, 218, 55], [176, 221, 47], [189, 223, 38], [202, 225, 31],
    [216, 226, 25], [229, 228, 25], [241, 229, 29], [253, 231, 37],
];

/// The colour of a share from 0 (dark violet) to 1 (yellow); outside clamped.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the table and to bytes")]
pub(super) fn viridis(share: f64) -> [u8; 3] {
    let at = share.clamp(0.0, 1.0) * STEPS as f64;
    let i = (at as usize).min(STEPS - 1);
    let t = at - i as f64;
    let (a, b) = (VIRIDIS[i], VIRIDIS[i + 1]);
    std::array::from_fn(|c| (f64::from(a[c]) + t * (f64::from(b[c]) - f64::from(a[c]))).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE 1976 lightness of an sRGB colour (IEC 61966-2-1, CIE 15).
    fn lightness(rgb: [u8; 3]) -> f64 {
        let linear = rgb
            .map(|v| f64::from(v) / 255.0)
            .map(|v| if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) });
        let y = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
        116.0 * y.cbrt() - 16.0
    }

    #[test]
    fn lightness_climbs_evenly() {
        let all: Vec<f64> = (0..=20).map(|i| lightness(viridis(f64::from(i) / 20.0))).collect();
        let mean = (all[20] - all[0]) / 20.0;
        // The authors made it even in CAM02-UCS, whose lightness is close to L*.
        assert!(all.windows(2).all(|w| (w[1] - w[0]) > 0.6 * mean && (w[1] - w[0]) < 1.4 * mean), "{all:?}");
    }

    #[test]
    fn ends_and_beyond() {
        // First and last entry of matplotlib's table: #440154, #FDE725.
        assert_eq!((viridis(-1.0), viridis(2.0)), ([0x44, 0x01, 0x54], [0xFD, 0xE7, 0x25]));
    }
}
