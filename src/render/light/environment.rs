//! Surroundings: radiance by direction, constant or from a picture.
//!
//! ```text
//! L_b(ω) = Σ_c k_c(pixel of ω) S_c,b
//! ```
//!
//! A picture holds a few coefficients k per pixel in single precision, and each of its channels stands for a spectrum S_c (radiance
//! per band for a coefficient of 1): three floats a pixel for an RGB picture, whose primaries' spectra the caller chooses; as many as
//! it has bands for a spectral one. Pixels are constant (nearest neighbour): what is drawn, what a ray meets and the flux are then
//! the same function, exactly. A cell of the tables for drawing costs another 8 bytes a pixel.
//!
//! Parameters: the picture with its [`Projection`]; a turn from the picture's frame to the world; the scene's bounding sphere.
//!
//! Directions are drawn in proportion to the pixel's solid angle times its coefficients' magnitude in all bands, and within a pixel
//! uniformly (equirectangular: in solid angle; discs: in area of the picture, which is the same but for the equidistant fisheye).
//! ∫ pdf dω is 1 less the part of the pixels at the rim of a disc that lies beyond it, draws of which give nothing.
//!
//! Limits: no interpolation. Beyond the rim of a fisheye picture there is no light. Negative coefficients (colours beyond the
//! primaries) are kept, and may make a band negative. The flux of pixels that a rim cuts is summed over 8 × 8 points.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec2, DVec3};

use super::bounding::BoundingSphere;
use super::cells::Cells;
use super::projection::Projection;
use super::{Error, Light, add, within};
use crate::render::ray::{Ray, Towards};

/// A picture as coefficients of a few spectra.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Pixels along a row.
    pub width: usize,
    /// Rows, from the top.
    pub height: usize,
    /// How it shows the directions.
    pub projection: Projection,
    /// Coefficients, row by row, the channels of a pixel side by side.
    pub coefficients: Vec<f32>,
    /// For each channel the radiance per band of a coefficient of 1, W/(m²·sr·nm) or W/(m²·sr).
    pub spectra: Vec<Vec<f64>>,
}

/// Surroundings as a light.
#[derive(Debug, Clone, PartialEq)]
pub struct Environment {
    picture: Picture,
    to_world: DMat3,
    cells: Cells,
    /// ∫ L dω per band.
    integral: Box<[f64]>,
    /// Bound on ∫ |L| dω over all bands.
    bound: f64,
    scene: BoundingSphere,
}

/// Points along each side of a pixel that the rim cuts.
const RIM_POINTS: usize = 8;

impl Environment {
    /// A radiance per band that is the same from everywhere.
    ///
    /// # Errors
    /// [`Error::Value`].
    pub fn constant(radiance: &[f64], scene: BoundingSphere) -> Result<Self, Error> {
        let picture = Picture {
            width: 1,
            height: 1,
            projection: Projection::Equirectangular,
            coefficients: vec![1.0],
            spectra: vec![super::sound("a radiance (W/(m2 sr nm))", radiance)?.into_vec()],
        };
        Self::new(picture, DMat3::IDENTITY, scene)
    }

    /// A picture, turned from its frame to the world (a rotation).
    ///
    /// # Errors
    /// [`Error::Count`] where picture, channels and bands do not fit (a disc needs a square); [`Error::Value`] for what is not
    /// finite, a field beyond its range, or a matrix that is no rotation.
    pub fn new(picture: Picture, to_world: DMat3, scene: BoundingSphere) -> Result<Self, Error> {
        check(&picture, &to_world)?;
        let Picture { width, height, ref spectra, .. } = picture;
        let channels = spectra.len();
        // A bound on what a channel's coefficient of 1 gives in all bands together.
        let magnitude: Vec<f64> = spectra.iter().map(|s| s.iter().map(|v| v.abs()).sum()).collect();
        let (mut weights, mut sums) = (Vec::with_capacity(width * height), vec![0.0; channels]);
        let mut bound = 0.0;
        for (i, pixel) in picture.coefficients.chunks_exact(channels).enumerate() {
            let (solid_angle, most) = picture.solid_angle(i / width, i % width);
            let sum: f64 = pixel.iter().zip(&magnitude).map(|(k, m)| f64::from(k.abs()) * m).sum();
            weights.push(sum * most);
            bound += sum * most;
            for (sum, k) in sums.iter_mut().zip(pixel) {
                *sum += f64::from(*k) * solid_angle;
            }
        }
        let mut integral = vec![0.0; spectra[0].len()].into_boxed_slice();
        for (sum, spectrum) in sums.iter().zip(spectra) {
            add(&mut integral, spectrum, *sum);
        }
        let bound = within("a sum over the picture", bound, bound >= 0.0, "a finite sum")?;
        Ok(Self { cells: Cells::new(width, weights), picture, to_world, integral, bound, scene })
    }

    /// A direction in the picture's frame, its pixel and its density, 1/sr.
    fn draw(&self, u: [f64; 2]) -> Option<(DVec3, [usize; 2], f64)> {
        let drawn = self.cells.draw(u)?;
        let pixel = [drawn.row, drawn.column];
        let direction = self.picture.direction(pixel, drawn.place)?;
        let pdf = drawn.probability * self.picture.pixels_per_solid_angle(drawn.row, direction);
        pdf.is_finite().then_some((direction, pixel, pdf))
    }

    /// Adds a factor times the radiance of a pixel.
    fn add_pixel(&self, [row, column]: [usize; 2], factor: f64, out: &mut [f64]) {
        let channels = self.picture.spectra.len();
        let first = (row * self.picture.width + column) * channels;
        for (k, spectrum) in self.picture.coefficients[first..first + channels].iter().zip(&self.picture.spectra) {
            add(out, spectrum, factor * f64::from(*k));
        }
    }

    /// The pixel that a direction of the world falls into, and the direction in the picture's frame.
    fn pixel(&self, direction: DVec3) -> Option<([usize; 2], DVec3)> {
        let local = self.to_world.transpose() * direction;
        Some((self.picture.pixel(local)?, local))
    }
}

impl Picture {
    /// The same in all directions.
    fn is_uniform(&self) -> bool {
        self.projection == Projection::Equirectangular && self.width * self.height == 1
    }

    fn pixel(&self, local: DVec3) -> Option<[usize; 2]> {
        if self.is_uniform() {
            return Some([0, 0]);
        }
        let place = self.projection.place(local)?;
        let index = |x: f64, n: usize| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the picture")]
            let index = (x * n as f64) as usize;
            index.min(n - 1)
        };
        Some([index(place.y, self.height), index(place.x, self.width)])
    }

    /// The direction of a place in a pixel; `None` beyond the rim.
    fn direction(&self, [row, column]: [usize; 2], [along, across]: [f64; 2]) -> Option<DVec3> {
        let x = (column as f64 + along) / self.width as f64;
        let y = match self.projection {
            // Even in solid angle: sin²(θ/2) runs evenly.
            Projection::Equirectangular => {
                let [low, high] = [row, row + 1].map(|i| self.half_sine_squared(i));
                (2.0 / PI * (low + across * (high - low)).sqrt().asin()).min(1.0)
            }
            _ => (row as f64 + across) / self.height as f64,
        };
        self.projection.direction(DVec2::new(x, y))
    }

    /// sin²(θ/2) at the upper edge of a row of an equirectangular picture.
    fn half_sine_squared(&self, row: usize) -> f64 {
        (0.5 * PI * row as f64 / self.height as f64).sin().powi(2)
    }

    /// Density within a pixel of its draws, per solid angle, at a direction in it.
    fn pixels_per_solid_angle(&self, row: usize, local: DVec3) -> f64 {
        match self.projection {
            Projection::Equirectangular => 1.0 / self.row_pixel_solid_angle(row),
            disc => (self.width * self.height) as f64 * disc.area_per_solid_angle(local),
        }
    }

    /// Solid angle of a pixel in a row of an equirectangular picture: 2π (cos θ₀ − cos θ₁)/width.
    fn row_pixel_solid_angle(&self, row: usize) -> f64 {
        2.0 * TAU * (self.half_sine_squared(row + 1) - self.half_sine_squared(row)) / self.width as f64
    }

    /// Solid angle of a pixel, and what it would be without the rim that cuts it (0 where it lies beyond), sr.
    fn solid_angle(&self, row: usize, column: usize) -> (f64, f64) {
        if self.projection == Projection::Equirectangular {
            let whole = self.row_pixel_solid_angle(row);
            return (whole, whole);
        }
        let at = |along: f64, across: f64| {
            let direction = self.direction([row, column], [along, across]);
            direction.map_or(0.0, |d| 1.0 / self.pixels_per_solid_angle(row, d))
        };
        let from_middle = |i: usize, n: usize| ((2 * i + 1) as f64 / n as f64 - 1.0).abs();
        let r = from_middle(column, self.width).hypot(from_middle(row, self.height));
        // Half of the diagonal of a pixel, on the disc of radius 1.
        if (r - 1.0).abs() > std::f64::consts::SQRT_2 / self.width as f64 {
            let whole = at(0.5, 0.5);
            return (whole, whole);
        }
        let net = |i: usize| (i as f64 + 0.5) / RIM_POINTS as f64;
        let points = (0..RIM_POINTS).flat_map(|i| (0..RIM_POINTS).map(move |j| (net(i), net(j))));
        let (mut sum, mut most) = (0.0, 0.0_f64);
        for (along, across) in points {
            let value = at(along, across);
            sum += value;
            most = most.max(value);
        }
        // The rim may clip a corner between the points of the net.
        let nominal = 1.0 / ((self.width * self.height) as f64 * self.projection.area_per_solid_angle(DVec3::X));
        (sum / (RIM_POINTS * RIM_POINTS) as f64, if most > 0.0 { most } else { nominal })
    }
}

fn check(picture: &Picture, to_world: &DMat3) -> Result<(), Error> {
    let Picture { width, height, projection, coefficients, spectra } = picture;
    let count = |what, found, expected| Err(Error::Count { what, found, expected });
    if *width == 0 || *height == 0 || spectra.is_empty() {
        return count("pixels or channels of a picture", 0, 1);
    }
    if let Some(h) = projection.half_field_rad() {
        within("a half-angle of the field (rad)", h, h > 0.0 && h <= PI, "above 0 to π")?;
        if width != height {
            return count("columns of a picture with a disc", *width, *height);
        }
    }
    if coefficients.len() != width * height * spectra.len() {
        return count("coefficients of a picture", coefficients.len(), width * height * spectra.len());
    }
    if let Some(other) = spectra.iter().find(|s| s.len() != spectra[0].len()) {
        return count("bands of a channel's spectrum", other.len(), spectra[0].len());
    }
    if let Some(found) = coefficients.iter().find(|k| !k.is_finite()) {
        return Err(Error::Value { what: "a pixel", found: f64::from(*found), expected: "finite values" });
    }
    if let Some(found) = spectra.iter().flatten().find(|v| !v.is_finite()) {
        return Err(Error::Value { what: "a channel's spectrum", found: *found, expected: "finite values" });
    }
    let off =
        (*to_world * to_world.transpose() - DMat3::IDENTITY).to_cols_array().into_iter().map(f64::abs).sum::<f64>()
            + (to_world.determinant() - 1.0).abs();
    within("a deviation of the turn from a rotation", off, off < 1e-9, "a rotation").map(|_| ())
}

impl Light for Environment {
    fn sample_towards(&self, _: DVec3, [u, v, _]: [f64; 3], arriving: &mut [f64]) -> Option<Towards> {
        let (local, pixel, pdf) = self.draw([u, v])?;
        arriving.fill(0.0);
        self.add_pixel(pixel, 1.0, arriving);
        Some(Towards { direction: self.to_world * local, distance: f64::INFINITY, pdf, delta: false })
    }

    fn pdf_towards(&self, _: DVec3, direction: DVec3) -> f64 {
        self.pixel(direction).map_or(0.0, |([row, column], local)| {
            self.cells.probability(row, column) * self.picture.pixels_per_solid_angle(row, local)
        })
    }

    fn add_radiance(&self, direction: DVec3, radiance: &mut [f64]) {
        if let Some((pixel, _)) = self.pixel(direction) {
            self.add_pixel(pixel, 1.0, radiance);
        }
    }

    fn emit(&self, [u, v, s, t, _]: [f64; 5], flux: &mut [f64]) -> Option<Ray> {
        let (local, pixel, pdf) = self.draw([u, v])?;
        flux.fill(0.0);
        self.add_pixel(pixel, self.scene.cross_section() / pdf, flux);
        Some(self.scene.ray_from(self.to_world * local, [s, t]))
    }

    fn emission_density(&self, from: DVec3, direction: DVec3, _: f64) -> f64 {
        self.pdf_towards(from, direction) * self.scene.density_at(from, direction)
    }

    fn flux(&self, flux: &mut [f64]) {
        super::write(flux, &self.integral, self.scene.cross_section());
    }

    fn is_uniform(&self) -> bool {
        self.picture.is_uniform()
    }

    fn importance(&self, _: DVec3) -> f64 {
        self.bound
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::super::check;
    use super::*;
    use crate::math::random::Stream;
    use crate::math::sampling::cone;

    fn scene() -> BoundingSphere {
        BoundingSphere::new(DVec3::new(1.0, 2.0, 3.0), 0.5).expect("a sphere")
    }

    fn turned() -> DMat3 {
        DMat3::from_axis_angle(DVec3::new(1.0, 2.0, -2.0) / 3.0, 0.7)
    }

    /// Three channels, dark and bright pixels side by side.
    fn picture(projection: Projection, width: usize, height: usize) -> Picture {
        let mut stream = Stream::new(8, width as u64);
        let coefficients = (0..width * height * 3).map(|_| (8.0 * stream.uniform() - 4.0).exp() as f32).collect();
        let spectra = vec![vec![1.0, 0.1], vec![0.5, 0.7], vec![0.0, 2.0]];
        Picture { width, height, projection, coefficients, spectra }
    }

    /// A constant radiance L makes E = πL on any surface and 4π·πR² L through the sphere.
    #[test]
    fn a_constant_one_is_the_furnace() {
        let light = Environment::constant(&[3.0, 5.0], scene()).expect("a light");
        check::density(&light, DVec3::ZERO, DVec3::Z, 2.0, 4);
        check::irradiance(&light, DVec3::ZERO, DVec3::new(0.6, 0.0, 0.8), 3.0 * PI);
        check::emission(&light, 2);
        let mut flux = [0.0; 2];
        light.flux(&mut flux);
        assert!((flux[1] / (5.0 * 4.0 * PI * PI * 0.25) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn draws_follow_their_density_in_every_projection() {
        for (projection, width, height) in [
            (Projection::Equirectangular, 16, 8),
            (Projection::Equirectangular, 5, 9),
            (Projection::MirrorBall, 40, 40),
            (Projection::HEMISPHERE, 40, 40),
            (Projection::Equidistant { half_field_rad: 2.2 }, 40, 40),
            (Projection::Equisolid { half_field_rad: FRAC_PI_2 }, 40, 40),
        ] {
            let light = Environment::new(picture(projection, width, height), turned(), scene()).expect("a light");
            check::emission(&light, 2);
            if projection == Projection::Equirectangular {
                check::density(&light, DVec3::ZERO, turned() * DVec3::Z, 2.0, 60);
            }
        }
        // Discs without a rim in the way: pixels beyond it are black, those that it cuts too.
        for projection in
            [Projection::MirrorBall, Projection::HEMISPHERE, Projection::Equidistant { half_field_rad: 2.2 }]
        {
            let mut picture = picture(projection, 30, 30);
            for (i, pixel) in picture.coefficients.chunks_exact_mut(3).enumerate() {
                let p = DVec2::new((i % 30) as f64 - 14.5, (i / 30) as f64 - 14.5).length() / 15.0;
                if p > 0.9 {
                    pixel.fill(0.0);
                }
            }
            let light = Environment::new(picture, turned(), scene()).expect("a light");
            check::density(&light, DVec3::ZERO, turned() * DVec3::X, 2.0, 60);
        }
    }

    /// A picture of L = 2 in every pixel is the constant one wherever it reaches: E = 2π sin²h on a surface that faces a field of
    /// half-angle h.
    #[test]
    fn uniform_pictures_make_the_irradiance_of_their_field() {
        for (projection, expected) in [
            (Projection::Equirectangular, TAU),
            (Projection::MirrorBall, TAU),
            (Projection::HEMISPHERE, TAU),
            (Projection::Equidistant { half_field_rad: 1.0 }, TAU * 1.0_f64.sin().powi(2)),
            (Projection::Equisolid { half_field_rad: 0.5 }, TAU * 0.5_f64.sin().powi(2)),
        ] {
            let coefficients = vec![1.0; 64 * 64];
            let picture = Picture { width: 64, height: 64, projection, coefficients, spectra: vec![vec![2.0, 1.0]] };
            let light = Environment::new(picture, turned(), scene()).expect("a light");
            check::irradiance(&light, DVec3::ZERO, turned() * DVec3::X, expected);
            // Flux: the solid angle, to what 8 × 8 points resolve of the rim.
            let mut flux = [0.0; 2];
            light.flux(&mut flux);
            let h = projection.half_field_rad().unwrap_or(PI);
            let whole = 2.0 * 4.0 * PI * (0.5 * h).sin().powi(2) * PI * 0.25;
            assert!((flux[0] / whole - 1.0).abs() < 1e-3, "{projection:?}: {flux:?} {whole}");
        }
    }

    #[test]
    fn every_projection_of_the_same_sky_lights_alike() {
        let sky = |d: DVec3| 1.0 + 0.5 * d.x + 0.3 * d.y * d.z;
        let normal = DVec3::new(0.36, 0.48, 0.8);
        let mut seen = Vec::new();
        for (projection, width, height) in [(Projection::Equirectangular, 200, 100), (Projection::MirrorBall, 200, 200)]
        {
            let mut picture = picture(projection, width, height);
            picture.spectra = vec![vec![1.0]];
            let at = |i: usize| [((i % width) as f64 + 0.5) / width as f64, ((i / width) as f64 + 0.5) / height as f64];
            picture.coefficients = (0..width * height)
                .map(|i| projection.direction(DVec2::from_array(at(i))).map_or(0.0, |d| sky(turned() * d) as f32))
                .collect();
            let light = Environment::new(picture, turned(), scene()).expect("a light");
            let mut radiance = [0.0];
            light.add_radiance(normal, &mut radiance);
            // Nearest neighbour: half a pixel of 1.8° (at most 7° by the ball's rim, far from this direction) times the slope.
            assert!((radiance[0] - sky(normal)).abs() < 0.05, "{projection:?}: {radiance:?} {}", sky(normal));
            seen.push(light);
        }
        // E = π (1 + 2/3 · 0.5 n_x + ...): ∫ (a·ω)(n·ω)⁺ dω = 2π/3 a·n; of the quadratic term y z: π/4 n_y n_z.
        let expected = PI * (1.0 + 2.0 / 3.0 * 0.5 * normal.x + 0.25 * 0.3 * normal.y * normal.z);
        for light in seen {
            let mut stream = Stream::new(3, 3);
            let n = 100_000;
            let (mut sum, mut squares) = (0.0, 0.0);
            for _ in 0..n {
                let mut arriving = [0.0];
                let e = light
                    .sample_towards(DVec3::ZERO, stream.uniforms(), &mut arriving)
                    .map_or(0.0, |t| arriving[0] * t.direction.dot(normal).max(0.0) / t.pdf);
                (sum, squares) = (sum + e, squares + e * e);
            }
            let mean = sum / f64::from(n);
            let error = ((squares / f64::from(n) - mean * mean) / f64::from(n)).sqrt();
            // The pixels of the ball that the rim cuts and whose middle lies beyond are dark here: 4/200 of them by half.
            assert!((mean - expected).abs() < 4.5 * error + 0.005 * expected, "{mean} ± {error}, {expected}");
        }
    }

    #[test]
    fn numbers_stay_finite_and_negative_colours_are_kept() {
        let mut picture = picture(Projection::Equirectangular, 4, 2);
        picture.coefficients[0] = -1e30;
        picture.coefficients[3] = f32::MIN_POSITIVE;
        let light = Environment::new(picture.clone(), DMat3::IDENTITY, scene()).expect("a light");
        let mut stream = Stream::new(4, 4);
        for _ in 0..1000 {
            let mut arriving = [0.0; 2];
            let t = light.sample_towards(DVec3::ZERO, stream.uniforms(), &mut arriving).expect("light");
            assert!(arriving.iter().all(|v| v.is_finite()) && t.pdf.is_finite() && t.pdf > 0.0);
            assert!(light.pdf_towards(DVec3::ZERO, cone(stream.uniforms(), 2.0)).is_finite());
        }
        for pole in [DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::NEG_X] {
            assert!(light.pdf_towards(DVec3::ZERO, pole).is_finite());
        }
        let refused = |change: &dyn Fn(&mut Picture)| {
            let mut picture = picture.clone();
            change(&mut picture);
            Environment::new(picture, DMat3::IDENTITY, scene()).is_err()
        };
        assert!(refused(&|p| p.coefficients[1] = f32::NAN) && refused(&|p| p.width = 5));
        assert!(refused(&|p| p.projection = Projection::MirrorBall) && refused(&|p| p.spectra[1].truncate(1)));
        assert!(Environment::new(picture.clone(), 2.0 * DMat3::IDENTITY, scene()).is_err());
        assert!(Environment::new(picture, DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0)), scene()).is_err());
    }
}
