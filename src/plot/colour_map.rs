//! Colours for values: the perceptually uniform maps *viridis*, *magma* and *inferno*.
//!
//! Every fifth of the 256 entries of the tables in matplotlib 3.11 (`_cm_listed.py`; S. van der Walt, N. Smith, E. Firing, 2015;
//! CC0), as sRGB bytes. Straight lines between them are within one level of the whole tables.

const STEPS: usize = 51;

/// A map from values to colours of evenly rising lightness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColourMap {
    /// Dark violet over green to yellow; also for eyes that do not tell red from green.
    #[default]
    Viridis,
    /// Black over violet to pale yellow.
    Magma,
    /// Black over red to pale yellow.
    Inferno,
}

impl ColourMap {
    /// The colour of a share from 0 (dark) to 1 (light); outside clamped.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the table and to bytes")]
    pub fn at(self, share: f64) -> [u8; 3] {
        let table = match self {
            Self::Viridis => &VIRIDIS,
            Self::Magma => &MAGMA,
            Self::Inferno => &INFERNO,
        };
        let at = share.clamp(0.0, 1.0) * STEPS as f64;
        let i = (at as usize).min(STEPS - 1);
        let t = at - i as f64;
        let (a, b) = (table[i], table[i + 1]);
        std::array::from_fn(|c| (f64::from(a[c]) + t * (f64::from(b[c]) - f64::from(a[c]))).round() as u8)
    }
}

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

#[rustfmt::skip]
const MAGMA: [[u8; 3]; STEPS + 1] = [
    [0, 0, 4], [2, 2, 11], [5, 4, 22], [9, 7, 32], [14, 11, 43], [20, 14, 54],
    [26, 16, 66], [33, 17, 78], [41, 17, 90], [49, 17, 101], [57, 15, 110], [66, 15, 117],
    [74, 16, 121], [82, 19, 124], [90, 22, 126], [98, 25, 128], [106, 28, 129], [114, 31, 129],
    [121, 34, 130], [129, 37, 129], [137, 40, 129], [145, 43, 129], [153, 45, 128], [161, 48, 126],
    [170, 51, 125], [178, 53, 123], [186, 56, 120], [194, 59, 117], [202, 62, 114], [210, 66, 111],
    [217, 70, 107], [224, 76, 103], [231, 82, 99], [236, 88, 96], [241, 96, 93], [244, 105, 92],
    [247, 114, 92], [249, 123, 93], [251, 133, 96], [252, 142, 100], [253, 152, 105], [254, 161, 110],
    [254, 170, 116], [254, 180, 123], [254, 189, 130], [254, 198, 138], [254, 207, 146], [254, 216, 154],
    [253, 226, 163], [253, 235, 172], [252, 244, 182], [252, 253, 191],
];

#[rustfmt::skip]
const INFERNO: [[u8; 3]; STEPS + 1] = [
    [0, 0, 4], [2, 2, 12], [5, 4, 23], [10, 7, 34], [16, 9, 45], [22, 11, 57],
    [30, 12, 69], [38, 12, 81], [47, 10, 91], [56, 9, 98], [64, 10, 103], [73, 11, 106],
    [81, 14, 108], [89, 16, 110], [97, 19, 110], [105, 22, 110], [113, 25, 110], [120, 28, 109],
    [128, 31, 108], [136, 34, 106], [144, 37, 104], [152, 39, 102], [160, 42, 99], [168, 46, 95],
    [176, 49, 91], [183, 53, 87], [191, 57, 82], [198, 61, 77], [204, 66, 72], [211, 71, 67],
    [217, 77, 61], [223, 83, 55], [228, 90, 49], [233, 97, 43], [237, 105, 37], [241, 113, 31],
    [244, 121, 24], [247, 130, 18], [249, 139, 11], [250, 148, 7], [251, 157, 7], [252, 166, 12],
    [252, 176, 20], [251, 186, 31], [250, 196, 42], [248, 205, 55], [246, 215, 70], [244, 225, 86],
    [242, 234, 105], [242, 242, 125], [245, 249, 146], [252, 255, 164],
];

/// The colour of a share from 0 (dark violet) to 1 (yellow); outside clamped.
pub(super) fn viridis(share: f64) -> [u8; 3] {
    ColourMap::Viridis.at(share)
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
        let of = |map: ColourMap| (0..=20).map(|i| lightness(map.at(f64::from(i) / 20.0))).collect::<Vec<f64>>();
        let all = of(ColourMap::Viridis);
        let mean = (all[20] - all[0]) / 20.0;
        // The authors made it even in CAM02-UCS, whose lightness is close to L*.
        assert!(all.windows(2).all(|w| (w[1] - w[0]) > 0.6 * mean && (w[1] - w[0]) < 1.4 * mean), "{all:?}");
        // The others begin at black, where the two part.
        for map in [ColourMap::Magma, ColourMap::Inferno] {
            assert!(of(map).windows(2).all(|w| w[1] > w[0]), "{map:?} {:?}", of(map));
        }
    }

    #[test]
    fn ends_and_beyond() {
        // First and last entry of matplotlib's tables: #440154, #FDE725; #000004, #FCFDBF; #000004, #FCFFA4.
        for (map, first, last) in [
            (ColourMap::Viridis, [0x44, 0x01, 0x54], [0xFD, 0xE7, 0x25]),
            (ColourMap::Magma, [0x00, 0x00, 0x04], [0xFC, 0xFD, 0xBF]),
            (ColourMap::Inferno, [0x00, 0x00, 0x04], [0xFC, 0xFF, 0xA4]),
        ] {
            assert_eq!((map.at(-1.0), map.at(2.0)), (first, last));
        }
    }
}
