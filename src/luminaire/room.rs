//! Light in an empty rectangular room: what a luminaire sends directly to the floor, and what the walls get after reflection.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

/// A room's part between the plane of the luminaires and the reference plane, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Room {
    /// Extent across the line of sight.
    pub(super) x_m: f64,
    /// Extent along the line of sight.
    pub(super) y_m: f64,
    /// Height between the planes.
    pub(super) height_m: f64,
}

/// Reflectances of ceiling, walls and reference plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reflectances {
    pub(super) ceiling: f64,
    pub(super) walls: f64,
    pub(super) floor: f64,
}

/// Steps of azimuth in which the floor's edge is followed.
const AZIMUTH_STEPS: u32 = 360;

impl Room {
    /// Area of the walls between the planes, m².
    pub(super) fn wall_area_m2(&self) -> f64 {
        2.0 * self.height_m * (self.x_m + self.y_m)
    }

    /// Share of the light in each 10° zone of γ (0–10° … 80–90°) that reaches the reference plane directly, averaged over a
    /// regular array of luminaires with about the spacing given, half a spacing from the walls, each taken as rotationally
    /// symmetric with an even intensity within the zone.
    ///
    /// CIE 190:2010 4.2 tabulates a fit of these shares in four bands for S/H = 1 (geometric multipliers F_GL); here they are
    /// computed.
    pub(super) fn direct_shares(&self, spacing_m: f64) -> [f64; 9] {
        let places = |extent: f64| {
            let count = (extent / spacing_m).round().max(1.0);
            (0..count as u32).map(move |i| (f64::from(i) + 0.5) * extent / count)
        };
        let edges: [f64; 10] = std::array::from_fn(|i| (10.0 * i as f64).to_radians().cos());
        let mut shares = [0.0; 9];
        let mut rays = 0_u32;
        for x in places(self.x_m) {
            for y in places(self.y_m) {
                for step in 0..AZIMUTH_STEPS {
                    let azimuth = (f64::from(step) + 0.5) * 2.0 * PI / f64::from(AZIMUTH_STEPS);
                    let cut = cosine_of_edge(self, (x, y), azimuth);
                    for (share, edge) in shares.iter_mut().zip(edges.windows(2)) {
                        *share += ((edge[0] - cut) / (edge[0] - edge[1])).clamp(0.0, 1.0);
                    }
                    rays += 1;
                }
            }
        }
        shares.map(|s| s / f64::from(rays))
    }

    /// Mean indirect illuminance of the walls per flux that first falls on the ceiling, the walls and the reference plane, times the
    /// wall area: the transfer factors F_T,CW, F_T,WW − 1 and F_T,FW of CIE 190:2010, table 5.
    ///
    /// Three diffuse surfaces exchange light: `E = E₀ + F ρ E` with the form factors of the closed room.
    pub(super) fn wall_transfer(&self, reflectances: Reflectances) -> DVec3 {
        let (plane, walls) = (self.x_m * self.y_m, self.wall_area_m2());
        let across = opposite_rectangles(self.x_m / self.height_m, self.y_m / self.height_m);
        let from_plane_to_walls = 1.0 - across;
        let from_walls_to_plane = from_plane_to_walls * plane / walls;
        let among_walls = 1.0 - 2.0 * from_walls_to_plane;
        let Reflectances { ceiling, walls: rho_walls, floor } = reflectances;
        // Columns: light from the ceiling, the walls, the floor; rows: to them.
        let exchange = DMat3::from_cols(
            ceiling * DVec3::new(0.0, from_walls_to_plane, across),
            rho_walls * DVec3::new(from_plane_to_walls, among_walls, from_plane_to_walls),
            floor * DVec3::new(across, from_walls_to_plane, 0.0),
        );
        let answer = (DMat3::IDENTITY - exchange).inverse();
        let total = DVec3::new(answer.x_axis.y / plane, answer.y_axis.y / walls, answer.z_axis.y / plane) * walls;
        total - DVec3::Y
    }
}

/// Cosine of γ of the floor's edge, seen from a luminaire towards an azimuth.
fn cosine_of_edge(room: &Room, (x, y): (f64, f64), azimuth: f64) -> f64 {
    let (sin, cos) = azimuth.sin_cos();
    let reach = |place: f64, extent: f64, d: f64| if d > 0.0 { (extent - place) / d } else { place / -d };
    let distance = reach(x, room.x_m, cos).min(reach(y, room.y_m, sin));
    room.height_m / room.height_m.hypot(distance)
}

/// Form factor between equal parallel rectangles facing each other, sides a and b in units of their distance
/// (Siegel and Howell, configuration 4).
fn opposite_rectangles(a: f64, b: f64) -> f64 {
    let (ra, rb) = (1f64.hypot(a), 1f64.hypot(b));
    let logarithm = (ra * rb / (1.0 + a * a + b * b).sqrt()).ln();
    let arcs = a * rb * (a / rb).atan() + b * ra * (b / ra).atan() - a * a.atan() - b * b.atan();
    2.0 / (PI * a * b) * (logarithm + arcs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn room(x: f64, y: f64) -> Room {
        Room { x_m: 2.0 * x, y_m: 2.0 * y, height_m: 2.0 }
    }

    #[test]
    fn cubes_exchange_a_fifth() {
        // Opposite faces of a cube: 0.199825 (any heat-transfer handbook).
        assert!((opposite_rectangles(1.0, 1.0) - 0.199_825).abs() < 5e-7);
    }

    #[test]
    fn transfer_factors_are_those_of_cie_190_table_5() {
        // (room, reflectances) and F_T,CW, F_T,WW − 1, F_T,FW as printed, to three decimals.
        let cases = [
            ((2.0, 2.0), (0.7, 0.5), [0.646, 0.422, 0.220]),
            ((4.0, 8.0), (0.7, 0.5), [0.307, 0.211, 0.115]),
            ((4.0, 8.0), (0.3, 0.3), [0.114, 0.092, 0.081]),
            ((12.0, 8.0), (0.5, 0.3), [0.120, 0.067, 0.058]),
        ];
        for ((x, y), (ceiling, walls), printed) in cases {
            let got = room(x, y).wall_transfer(Reflectances { ceiling, walls, floor: 0.2 }).to_array();
            for (a, b) in got.iter().zip(printed) {
                assert!((a - b).abs() < 6e-4, "{x}H × {y}H: {got:?} against {printed:?}");
            }
        }
    }

    #[test]
    fn light_straight_down_reaches_the_floor() {
        let shares = room(2.0, 3.0).direct_shares(2.0);
        assert!(shares[0] > 1.0 - 1e-12 && shares[8] < 0.01);
        assert!(shares.windows(2).all(|w| w[0] >= w[1] - 1e-12), "{shares:?}");
    }
}
