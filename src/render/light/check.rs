//! What every light's tests share: draws are distributed as the density says, their mean is the flux or the irradiance.
//!
//! Statistical bounds are 4.5 standard deviations: 7e-6 for one comparison. Seeds are fixed.

use std::f64::consts::TAU;

use glam::DVec3;

use super::Light;
use crate::geometry::direction::tangents;
use crate::math::random::Stream;

const SAMPLES: u32 = 200_000;
const DEVIATIONS: f64 = 4.5;
/// Cells in 1 − cos and in azimuth.
const CELLS: [usize; 2] = [8, 12];

/// The irradiance of a Dirac light on a surface, per band; two bands are room enough for all tests.
pub(super) fn irradiance_at(light: &dyn Light, from: DVec3, normal: DVec3) -> [f64; 2] {
    let mut arriving = [0.0; 2];
    match light.sample_towards(from, [0.5; 3], &mut arriving) {
        Some(towards) => {
            assert!(towards.delta && towards.pdf == 1.0 && (towards.direction.length() - 1.0).abs() < 1e-14);
            arriving.map(|e| e * towards.direction.dot(normal).max(0.0))
        }
        None => [0.0; 2],
    }
}

/// Mean and standard error of a figure of many draws.
fn mean(count: u32, mut draw: impl FnMut() -> f64) -> (f64, f64) {
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..count {
        let x = draw();
        assert!(x.is_finite(), "a draw of {x}");
        sum += x;
        squares += x * x;
    }
    let (n, mean) = (f64::from(count), sum / f64::from(count));
    (mean, ((squares / n - mean * mean).max(0.0) / n).sqrt())
}

/// Rays are unit and carry, in the mean, the flux of every band.
pub(super) fn emission(light: &dyn Light, bands: usize) {
    let (mut drawn, mut whole) = (vec![0.0; bands], vec![0.0; bands]);
    light.flux(&mut whole);
    for (band, flux) in whole.into_iter().enumerate() {
        let mut stream = Stream::new(11, band as u64);
        let (mean, error) = mean(SAMPLES, || match light.emit(stream.uniforms(), &mut drawn) {
            Some(ray) => {
                assert!((ray.direction.length() - 1.0).abs() < 1e-12 && ray.origin.is_finite(), "{ray:?}");
                drawn[band]
            }
            None => 0.0,
        });
        assert!((mean - flux).abs() <= DEVIATIONS * error + 1e-9 * flux, "band {band}: {mean} ± {error}, {flux}");
    }
}

/// What a point light emits into each of many cells of the sphere is the integral of its intensity (of the first band).
pub(super) fn emitted_intensity(light: &dyn Light, origin: DVec3, intensity: impl Fn(DVec3) -> f64) {
    let [rows, columns] = CELLS;
    let mut sums = vec![(0.0, 0.0); rows * columns];
    let mut stream = Stream::new(12, 0);
    let mut flux = [0.0; 2];
    for _ in 0..SAMPLES {
        let Some(ray) = light.emit(stream.uniforms(), &mut flux) else { continue };
        assert_eq!(ray.origin, origin);
        let sum = &mut sums[cell_of(ray.direction, DVec3::Z, 2.0).expect("on the sphere")];
        *sum = (sum.0 + flux[0], sum.1 + flux[0] * flux[0]);
    }
    let n = f64::from(SAMPLES);
    light.flux(&mut flux);
    for (i, (sum, squares)) in sums.into_iter().enumerate() {
        let (mean, error) = (sum / n, ((squares - sum * sum / n) / (n * n)).max(0.0).sqrt());
        let (expected, quadrature) = over_cell(i, DVec3::Z, 2.0, &intensity);
        // Where few rays or none came, their own scatter says nothing: that of as many rays of equal flux, and one ray.
        let error = error.max((expected * flux[0] / n).sqrt()) + flux[0] / n;
        assert!(
            (mean - expected).abs() <= DEVIATIONS * error + quadrature + 1e-12,
            "cell {i}: {mean} ± {error}, {expected} ± {quadrature}"
        );
    }
}

/// Draws of [`Light::sample_towards`] from a point make the irradiance (of the first band) on a surface of that normal.
pub(super) fn irradiance(light: &dyn Light, from: DVec3, normal: DVec3, expected: f64) {
    let mut arriving = [0.0; 2];
    let mut stream = Stream::new(13, 0);
    let (mean, error) = mean(SAMPLES, || match light.sample_towards(from, stream.uniforms(), &mut arriving) {
        Some(t) => arriving[0] * t.direction.dot(normal).max(0.0) / t.pdf,
        None => 0.0,
    });
    assert!((mean - expected).abs() <= DEVIATIONS * error + 1e-6 * expected, "{mean} ± {error}, {expected}");
}

/// χ² of the draws within a cone about an axis (1 − cos its half-angle), outside of which nothing may be drawn; the density
/// integrates to one, says of a drawn direction what the draw said, and so does the radiance. `fineness` is the number of points along
/// each side of a cell at which the density is taken.
pub(super) fn density(light: &dyn Light, from: DVec3, axis: DVec3, depth: f64, fineness: usize) {
    let cells = CELLS[0] * CELLS[1];
    let mut counts = vec![0_u32; cells];
    let mut stream = Stream::new(14, fineness as u64);
    let (mut arriving, mut seen) = ([0.0; 2], [0.0; 2]);
    let mut strayed = 0_u32;
    for _ in 0..SAMPLES {
        let Some(t) = light.sample_towards(from, stream.uniforms(), &mut arriving) else { continue };
        assert!(!t.delta && (t.direction.length() - 1.0).abs() < 1e-12, "{t:?}");
        seen.fill(0.0);
        light.add_radiance(t.direction, &mut seen);
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(b.abs());
        let pdf = light.pdf_towards(from, t.direction);
        // Rounding may put a direction over the border of a piece of a density.
        strayed += u32::from(!same(pdf, t.pdf) || !same(seen[0], arriving[0]) || !same(seen[1], arriving[1]));
        if let Some(cell) = cell_of(t.direction, axis, depth) {
            counts[cell] += 1;
        }
    }
    assert!(strayed <= 3, "{strayed} draws with another density or radiance than said");
    let (mut chi2, mut freedom, mut total, mut drawn) = (0.0, -1.0, 0.0, 0);
    let (mut pool, mut uncertain) = ((0.0, 0.0), 0.0);
    for (i, count) in counts.into_iter().enumerate() {
        let (share, error) = over_cell_with(i, axis, depth, fineness, &|d| light.pdf_towards(from, d));
        total += share;
        uncertain += error;
        drawn += count;
        pool = (pool.0 + share * f64::from(SAMPLES), pool.1 + f64::from(count));
        if pool.0 >= 10.0 {
            chi2 += (pool.1 - pool.0) * (pool.1 - pool.0) / pool.0;
            freedom += 1.0;
            pool = (0.0, 0.0);
        }
    }
    assert!((total - 1.0).abs() < 1e-3 + uncertain, "the density integrates to {total} ± {uncertain}");
    assert!(f64::from(SAMPLES - drawn) <= 1e-3 * f64::from(SAMPLES), "{drawn} of {SAMPLES} draws are in the cone");
    if freedom > 0.0 {
        // Wilson & Hilferty 1931: the cube root of χ² is nearly normal.
        let spread = 2.0 / (9.0 * freedom);
        let z = ((chi2 / freedom).cbrt() - (1.0 - spread)) / f64::sqrt(spread);
        assert!(z < DEVIATIONS, "χ² {chi2} of {freedom}: {z} standard deviations");
    }
}

/// The cell of a direction within a cone about an axis; `None` beyond it.
fn cell_of(direction: DVec3, axis: DVec3, depth: f64) -> Option<usize> {
    let (x, y) = tangents(axis);
    // 1 − cos by the chord.
    let along = 0.5 * direction.distance_squared(axis) / depth;
    let turn = direction.dot(y).atan2(direction.dot(x)) / TAU;
    let index = |x: f64, n: usize| ((x * n as f64) as usize).min(n - 1);
    (along <= 1.0 + 1e-9).then(|| index(along, CELLS[0]) * CELLS[1] + index(turn.rem_euclid(1.0), CELLS[1]))
}

/// ∫ f dω over a cell, and a bound on what the midpoint net errs.
fn over_cell(cell: usize, axis: DVec3, depth: f64, f: &impl Fn(DVec3) -> f64) -> (f64, f64) {
    over_cell_with(cell, axis, depth, 40, f)
}

/// The same with a net of so many points along each side. The bound counts half of each jump between neighbours, the edges that a net
/// cuts through; what smooth functions err is far below the scatter of the draws.
fn over_cell_with(cell: usize, axis: DVec3, depth: f64, n: usize, f: &impl Fn(DVec3) -> f64) -> (f64, f64) {
    let (x, y) = tangents(axis);
    let (row, column) = ((cell / CELLS[1]) as f64, (cell % CELLS[1]) as f64);
    let at = |i: usize| (i as f64 + 0.5) / n as f64;
    let mut values = Vec::with_capacity(n * n);
    for i in 0..n {
        let drop = depth * (row + at(i)) / CELLS[0] as f64;
        let sin = (drop * (2.0 - drop)).max(0.0).sqrt();
        for j in 0..n {
            let (s, c) = (TAU * (column + at(j)) / CELLS[1] as f64).sin_cos();
            values.push(f((sin * c * x + sin * s * y + (1.0 - drop) * axis).normalize()));
        }
    }
    let most = values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let jump = |a: f64, b: f64| if (a - b).abs() > 0.1 * most { 0.5 * (a - b).abs() } else { 0.0 };
    let along = values.chunks_exact(n).flat_map(|row| row.windows(2)).map(|w| jump(w[0], w[1]));
    let across = values.iter().zip(&values[n..]).map(|(a, b)| jump(*a, *b));
    let area = TAU * depth / (CELLS[0] * CELLS[1] * n * n) as f64;
    (values.iter().sum::<f64>() * area, along.chain(across).sum::<f64>() * area)
}
