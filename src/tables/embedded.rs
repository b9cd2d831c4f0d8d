//! The files of `data/` that are compiled in.

/// `data/MANIFEST.toml`.
pub(super) const MANIFEST: &str = include_str!("../../data/MANIFEST.toml");

/// The text of a file, by its path below `data/`.
pub(super) fn file(path: &str) -> Option<&'static str> {
    FILES.iter().find(|(name, _)| *name == path).map(|(_, text)| *text)
}

macro_rules! files {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!(concat!("../../data/", $path)))),*]
    };
}

const FILES: &[(&str, &str)] = files![
    "ansi/c78_377.csv",
    "cie/daylight_s0_s1_s2.csv",
    "cie/illuminant_a.csv",
    "cie/illuminant_b.csv",
    "cie/illuminant_d50.csv",
    "cie/illuminant_d65.csv",
    "cie/illuminants_5nm.csv",
    "cie/illuminants_fl_hp_led.csv",
    "cie/l41.csv",
    "cie/position_index.csv",
    "cie/s026_alpha_opic.csv",
    "cie/tcs01_14.csv",
    "cie/v10_1964.csv",
    "cie/v_1924.csv",
    "cie/v_f_2008_10deg.csv",
    "cie/v_f_2008_2deg.csv",
    "cie/v_prime_1951.csv",
    "cie/xyz_1931_2deg.csv",
    "cie/xyz_1964_10deg.csv",
    "cie/xyz_2015_10deg.csv",
    "cie/xyz_2015_2deg.csv",
    "cvrl/lms_stockman_sharpe_10deg.csv",
    "cvrl/lms_stockman_sharpe_2deg.csv",
    "cvrl/v_judd_1951.csv",
    "cvrl/v_judd_vos_1978.csv",
    "icnirp/actinic_uv_hazard.csv",
    "icnirp/blue_light_hazard.csv",
    "icnirp/retinal_thermal_hazard.csv",
    "iec/60081.csv",
    "ies/ces99_1nm.csv",
    "mccree/rqe_1972.csv",
    "nist/lines.csv",
    "refractive/ag.csv",
    "refractive/al.csv",
    "refractive/au.csv",
    "refractive/cu.csv",
];
