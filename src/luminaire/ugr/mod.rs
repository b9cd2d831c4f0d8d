//! The UGR table of a luminaire.

mod position;

use glam::DVec3;

use super::distribution::Distribution;
use super::luminance::{opening, projected_area_m2};
use super::model::{Body, Luminaire};
use super::room::{Reflectances, Room};
use super::unavailable::Unavailable;
use super::zonal::mean_table;

pub use position::position_index;

/// One room of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UgrRow {
    /// Extent across the line of sight, in units of H.
    pub room_x_h: u32,
    /// Extent along the line of sight, in units of H.
    pub room_y_h: u32,
    /// UGR seen along C0 (across the luminaire's length) for the five [`REFLECTANCES`]; `None` where no luminaire dazzles.
    pub crosswise: [Option<f64>; 5],
    /// UGR seen along C90.
    pub endwise: [Option<f64>; 5],
}

/// Height H of the luminaires above the eyes, m (CIE 190:2010 4.2: eyes at 1.2 m).
pub const HEIGHT_M: f64 = 2.0;

/// Spacing of the luminaires over H of the usual table.
pub const SPACING_TO_HEIGHT: f64 = 0.25;

/// Spacing over H for which CIE 190 gives the flux that reaches the reference plane directly, whatever the table's own spacing.
const DIRECT_SPACING_TO_HEIGHT: f64 = 1.0;

/// The rooms, x × y in units of H (CIE 190:2010, table 3).
pub const ROOMS: [(u32, u32); 19] = [
    (2, 2),
    (2, 3),
    (2, 4),
    (2, 6),
    (2, 8),
    (2, 12),
    (4, 2),
    (4, 3),
    (4, 4),
    (4, 6),
    (4, 8),
    (4, 12),
    (8, 4),
    (8, 6),
    (8, 8),
    (8, 12),
    (12, 4),
    (12, 6),
    (12, 8),
];

/// Reflectances of ceiling, walls and reference plane of the columns.
pub const REFLECTANCES: [(f64, f64, f64); 5] =
    [(0.7, 0.5, 0.2), (0.7, 0.3, 0.2), (0.5, 0.5, 0.2), (0.5, 0.3, 0.2), (0.3, 0.3, 0.2)];

/// The corrected UGR table: 19 rooms, five sets of reflectances, seen crosswise and endwise, for the luminaire's own flux and
/// S/H = 0.25.
///
/// ```text
/// UGR = 8 lg( 0.25/L_b Σ L² ω/p² ),   L² ω = I²/(A r²)
/// L_b = N/(π A_w) (Φ_DF F_T,FW + Φ_DW (F_T,WW − 1) + Φ_C F_T,CW)
/// ```
///
/// The observer stands at the middle of a wall and looks along y; luminaires form a regular array, half a spacing from the
/// walls. A is the opening's projected area and I the intensity towards the eye, p the position index of CIE 117 table 4.1
/// ([`position_index`]; luminaires outside that table are left out). The background luminance is the mean indirect luminance
/// of the walls between eye level and luminaires: flux first received by reference plane (Φ_DF), walls (Φ_DW) and ceiling (Φ_C) per
/// luminaire, from the intensities at 5°, 15° … 175° averaged over C, times transfer factors of three diffuse surfaces.
///
/// A luminaire that is not symmetric to both principal planes has its C0 (C90) towards the observer.
///
/// # Errors
/// [`Unavailable::NotTypeC`], [`Unavailable::NotLuminous`], [`Unavailable::NoOpening`]; [`Unavailable::Dark`] where there is no flux.
///
/// # Reference
/// CIE 117:1995; CIE 190:2010, 4.
pub fn ugr_table(luminaire: &Luminaire) -> Result<Vec<UgrRow>, Unavailable> {
    ugr_table_spaced(luminaire, SPACING_TO_HEIGHT)
}

/// [`ugr_table`] for another spacing over H; CIE 190's own examples have 1.
///
/// # Errors
/// As [`ugr_table`].
///
/// # Panics
/// Where the spacing is not positive.
pub fn ugr_table_spaced(luminaire: &Luminaire, spacing_to_height: f64) -> Result<Vec<UgrRow>, Unavailable> {
    assert!(spacing_to_height > 0.0, "luminaires stand apart");
    let body = opening(luminaire)?;
    let flux = Flux::new(&luminaire.distribution)?;
    let row = |(x, y): (u32, u32)| {
        let room = Room { x_m: f64::from(x) * HEIGHT_M, y_m: f64::from(y) * HEIGHT_M, height_m: HEIGHT_M };
        let array = Array::new(&room, spacing_to_height * HEIGHT_M);
        let background = flux.wall_luminances(&room, array.count);
        let [crosswise, endwise] = [0.0, 90.0].map(|towards_eye_c_deg| {
            let glare = array.glare(&luminaire.distribution, body, towards_eye_c_deg);
            let lit = |luminance: &f64| glare > 0.0 && *luminance > 0.0;
            background.map(|l| Some(l).filter(lit).map(|l| 8.0 * (0.25 / l * glare).log10()))
        });
        UgrRow { room_x_h: x, room_y_h: y, crosswise, endwise }
    };
    Ok(ROOMS.into_iter().map(row).collect())
}

/// Flux of one luminaire by 10° zones of γ, each from the mean intensity at its middle (CIE 190:2010 4.2), lm.
struct Flux {
    zones: [f64; 18],
}

impl Flux {
    fn new(distribution: &Distribution) -> Result<Self, Unavailable> {
        let mean = mean_table(distribution)?;
        let edge = |i: usize| (10.0 * i as f64).to_radians().cos();
        let zone = |i: usize| std::f64::consts::TAU * (edge(i) - edge(i + 1)) * mean.zonal_mean(10.0 * i as f64 + 5.0);
        let zones: [f64; 18] = std::array::from_fn(zone);
        if zones.iter().sum::<f64>() > 0.0 { Ok(Self { zones }) } else { Err(Unavailable::Dark) }
    }

    /// Mean indirect luminance of the walls for each set of reflectances, cd/m².
    fn wall_luminances(&self, room: &Room, count: u32) -> [f64; 5] {
        let (below, above) = self.zones.split_at(9);
        let shares = room.direct_shares(DIRECT_SPACING_TO_HEIGHT * HEIGHT_M);
        let floor: f64 = shares.iter().zip(below).map(|(share, flux)| share * flux).sum();
        let first = DVec3::new(above.iter().sum(), below.iter().sum::<f64>() - floor, floor);
        REFLECTANCES.map(|(ceiling, walls, floor)| {
            let transfer = room.wall_transfer(Reflectances { ceiling, walls, floor });
            f64::from(count) / room.wall_area_m2() * first.dot(transfer) / std::f64::consts::PI
        })
    }
}

/// The luminaires before the observer.
struct Array {
    /// All of them.
    count: u32,
    /// Those within the position index: place to the right of the line of sight, ahead along it, m, and p.
    seen: Vec<(f64, f64, f64)>,
}

impl Array {
    fn new(room: &Room, spacing_m: f64) -> Self {
        let places = |extent: f64| {
            let count = (extent / spacing_m).round().max(1.0);
            (0..count as u32).map(move |i| (f64::from(i) + 0.5) * extent / count)
        };
        let (mut count, mut seen) = (0, Vec::new());
        for ahead in places(room.y_m) {
            for x in places(room.x_m) {
                count += 1;
                let aside = x - 0.5 * room.x_m;
                if let Some(p) = position_index(aside.abs() / ahead, room.height_m / ahead) {
                    seen.push((aside, ahead, p));
                }
            }
        }
        Self { count, seen }
    }

    /// Σ L² ω/p², luminaires with the C-plane given towards the observer's wall.
    fn glare(&self, distribution: &Distribution, body: &Body, towards_eye_c_deg: f64) -> f64 {
        let term = |(aside, ahead, p): &(f64, f64, f64)| {
            let flat = aside.hypot(*ahead);
            let c_deg = towards_eye_c_deg + aside.atan2(*ahead).to_degrees();
            let gamma_deg = flat.atan2(HEIGHT_M).to_degrees();
            let intensity = distribution.at(c_deg, gamma_deg).max(0.0);
            let area = projected_area_m2(body, c_deg, gamma_deg);
            if area > 0.0 { intensity * intensity / (area * (flat * flat + HEIGHT_M * HEIGHT_M) * p * p) } else { 0.0 }
        };
        self.seen.iter().map(term).sum()
    }
}
