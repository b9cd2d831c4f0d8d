//! The bins of MERL tables, and their files.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;
use photopic::brdf::coordinates::HalfDiff;
use photopic::brdf::format::{Format, detect, merl};
use photopic::brdf::table::{Channel, HalfAngle, Known, Resolution, Table};
use photopic::geometry::direction::from_angles;
use photopic::math::random::Stream;

use super::codes;

fn numbered(resolution: Resolution) -> HalfAngle {
    let values = (0..3 * resolution.bins()).map(|i| i as f32).collect();
    HalfAngle::new(resolution, Channel::rgb(), values).expect("a table")
}

/// Positions in units of bins by the definition of the format, through arc functions.
fn places(resolution: Resolution, i: DVec3, o: DVec3) -> [f64; 3] {
    let a = HalfDiff::new(i, o);
    [
        (a.theta_h / FRAC_PI_2).sqrt() * resolution.theta_h as f64,
        a.theta_d / FRAC_PI_2 * resolution.theta_d as f64,
        a.phi_d.rem_euclid(PI) / PI * resolution.phi_d as f64,
    ]
}

#[test]
fn bins_are_those_of_the_exact_angles() {
    // 400 000 random pairs, grazing ones and nearly mirrored ones among them. A pair may go to the neighbour only where its
    // place is within rounding (1e-9 of a bin) of the border.
    for resolution in [
        Resolution::MERL,
        Resolution { theta_h: 45, theta_d: 45, phi_d: 36 },
        Resolution { theta_h: 180, theta_d: 180, phi_d: 360 },
    ] {
        let table = numbered(resolution);
        let mut random = Stream::new(5, 0);
        let mut at_borders = 0;
        for n in 0..400_000 {
            let [a, b, c, d] = random.uniforms();
            let i = from_angles(a.sqrt() * FRAC_PI_2, b * TAU);
            let o = match n % 4 {
                0 => {
                    (DVec3::new(-i.x, -i.y, i.z) + 10.0_f64.powf(-12.0 * d) * from_angles(c * PI, b * 9.0)).normalize()
                }
                1 => from_angles((1.0 - c.powi(8)) * FRAC_PI_2, d * TAU),
                _ => from_angles(c.sqrt() * FRAC_PI_2, d * TAU),
            };
            if i.z <= 0.0 || o.z <= 0.0 {
                continue;
            }
            let place = places(resolution, i, o);
            let bin = table.bin_of(i, o);
            let found = [
                bin / resolution.phi_d / resolution.theta_d,
                bin / resolution.phi_d % resolution.theta_d,
                bin % resolution.phi_d,
            ];
            let sizes = [resolution.theta_h, resolution.theta_d, resolution.phi_d];
            for k in 0..3 {
                let expected = (place[k].floor() as usize).min(sizes[k] - 1);
                if found[k] != expected {
                    at_borders += 1;
                    // The azimuth of a pair close to a pole has the precision of its small components.
                    let poles = if k == 2 { 1e-15 / (place[0].powi(2).min(place[1]) * 1e-4).max(1e-15) } else { 0.0 };
                    let off = (place[k] - place[k].round()).abs();
                    assert!(off < 1e-9 + 1e3 * poles, "{k}: {found:?} at {place:?} for {i} {o}");
                }
            }
        }
        assert!(at_borders < 400, "{at_borders} of 400 000 pairs fall on the other side of a border");
    }
}

#[test]
fn poles_are_in_the_first_bins() {
    let table = numbered(Resolution::MERL);
    // ω_i = ω_o: no azimuth about the half vector, which counts as 0; both along the normal: no angle at all.
    assert_eq!(table.bin_of(DVec3::Z, DVec3::Z), 0);
    let grazing = from_angles(1.57, 0.3);
    assert_eq!(table.bin_of(grazing, grazing), 89 * 90 * 180);
}

#[test]
fn centres_are_in_their_bins() {
    let table = numbered(Resolution::MERL);
    for bin in (0..Resolution::MERL.bins()).step_by(7) {
        let (i, o) = Resolution::MERL.centre(bin).directions();
        if i.z > 0.0 && o.z > 0.0 {
            assert_eq!(table.bin_of(i, o), bin);
            // Reciprocity is built in.
            assert_eq!(table.bin_of(o, i), bin);
        }
    }
}

/// A file as the format describes it: red, green and blue planes of doubles after three numbers of bins.
fn file(resolution: [u32; 3], value: impl Fn(usize, usize) -> f64) -> Vec<u8> {
    let bins: u32 = resolution.iter().product();
    let mut out: Vec<u8> = resolution.iter().flat_map(|n| n.to_le_bytes()).collect();
    for channel in 0..3 {
        (0..bins as usize).for_each(|bin| out.extend_from_slice(&value(channel, bin).to_le_bytes()));
    }
    out
}

#[test]
fn scale_factors_and_missing_bins_are_the_published_ones() {
    let bytes = file([4, 3, 2], |channel, bin| if bin == 7 { -1.0 } else { 1500.0 * (channel + 1) as f64 });
    assert_eq!(detect(&bytes), Some(Format::Merl));
    let read = merl::parse(&bytes).expect("a table");
    assert_eq!(codes(&read.findings), ["B104"]);
    assert_eq!(read.value.coverage(), (24, 1));
    // 1/1500, 1.15/1500 and 1.66/1500 of 1500, 3000, 4500.
    for (v, expected) in read.value.bin(0).iter().zip([1.0, 2.3, 4.98]) {
        assert!((f64::from(*v) - expected).abs() < 6e-8 * expected, "{v} {expected}");
    }
    assert!(read.value.bin(7).iter().all(|v| v.is_nan()));
    // What was read is written, and read the same.
    let written = merl::write(&read.value).expect("three channels");
    assert_eq!(written.len(), bytes.len());
    let again = merl::parse(&written).expect("our own file").value;
    for bin in 0..24 {
        assert!(bin == 7 || again.bin(bin) == read.value.bin(bin), "{bin}");
    }
    assert_eq!(merl::write(&again), Some(written));
}

#[test]
fn a_missing_bin_is_inferred_or_missing_never_zero() {
    let resolution = Resolution { theta_h: 2, theta_d: 3, phi_d: 1 };
    // Of θ_h < 22.5° nothing is known but the bin of 30° ≤ θ_d < 60°; of larger θ_h nothing.
    let values = vec![f32::NAN, 2.0, f32::NAN, f32::NAN, f32::NAN, f32::NAN];
    let table =
        Table::HalfAngle(HalfAngle::new(resolution, vec![Channel::Wavelength(550.0)], values).expect("a table"));
    let mut v = [0.0];
    let mirror = |t: f64| (from_angles(t, 0.0), from_angles(t, PI));
    let mut at = |(i, o): (DVec3, DVec3)| (table.value(i, o, &mut v), v[0]);
    assert_eq!(at(mirror(0.8)), (Known::Measured, 2.0));
    assert_eq!(at(mirror(0.1)), (Known::Inferred, 2.0));
    assert_eq!(at(mirror(1.4)), (Known::Inferred, 2.0));
    let (known, value) = at((from_angles(1.0, 0.0), from_angles(1.0, 0.0)));
    assert!(known == Known::Missing && value.is_nan());
}
