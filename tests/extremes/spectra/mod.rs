//! The ends of what a spectrum can be: lines of no width, blackbodies of 1 K and of 10⁹ K, values near the ends of a double,
//! nothing at all, noise, half a spectrum.

mod blackbodies;
mod degenerate;
mod lines;
mod noise;
mod range;
mod refused;
mod scale;
mod step;
