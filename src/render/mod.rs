//! Light transport: a scene of shapes, lights and materials in; per-wavelength radiance and the readings of virtual
//! instruments with their standard errors out.
//!
//! Conventions of this module, beyond those of [`crate::geometry`]:
//!
//! - Lengths in metres, positions and directions in world coordinates (right-handed) unless a name says `local`. All geometry is `f64`.
//! - A spectral value is a slice with one element per **band** ([`bands::Bands`]), in SI: radiance W/(m²·sr·nm) for a band that
//!   samples a density, W/(m²·sr) for a band that is a line. One path carries all bands at once; nothing allocates per sample.
//! - Directions in a surface's local frame (`material`) point away from it; z < 0 is the inside, z > 0 the side of the geometric normal.
//! - Random numbers come from counters ([`sampler`]): any sample of any pixel is the same on any machine, in any order.
//!
//! | file | what it is |
//! |---|---|
//! | [`bands`] | the wavelengths that a render carries |
//! | [`ray`] | rays, crossings, surface points |
//! | [`shape`] | closed-form shapes and meshes: crossing, area, sampling |
//! | [`form_factor`] | form factors in closed form |
//! | [`light`] | what lights the scene and is no shape: points, spots, luminaires, skies, pictures |
//! | [`material`] | scattering at a surface, reflection and transmission |
//! | [`emission`] | what a surface emits |
//! | [`accelerate`], [`tree`] | all surfaces, and the search for the one that a ray meets |
//! | [`mesh`], [`placed`] | meshes of triangles, and where they stand |
//! | [`format`](mod@format) | files of meshes |
//! | [`description`] | scenes in TOML |
//! | [`scene`] | surfaces, materials and lights together |
//! | [`enclosure`] | closed spaces that keep all light |
//! | [`sampler`] | well-spread random numbers |
//! | [`sensor`] | cameras, and what meters make of the light around them |
//! | [`integrator`] | solvers |
//! | [`guiding`] | what guides the paths of a picture |
//! | [`radiosity`] | the light of diffuse scenes, without random numbers |
//! | [`estimate`], [`measure`], [`noise`] | readings with their standard errors, and the noise of pictures |
//! | [`audit`] | where the energy goes, and what readings lose |
//! | [`gonioreflectometer`] | the BRDF of a sample |
//! | [`light_map`] | where the points of a grid are |
//! | [`goniophotometer`] | the intensities of all that shines, and its flux |

pub mod accelerate;
pub mod audit;
pub mod bands;
pub mod build;
mod corners;
pub mod denoise;
pub mod description;
pub mod emission;
pub mod enclosure;
pub mod estimate;
pub mod film;
pub mod form_factor;
pub mod format;
pub mod goniophotometer;
pub mod gonioreflectometer;
pub mod guiding;
mod hierarchy;
pub mod integrator;
pub mod lanes;
pub mod light;
pub mod light_map;
pub mod material;
pub mod measure;
pub mod mesh;
pub mod noise;
mod packets;
pub mod placed;
pub mod radiosity;
pub mod ray;
pub mod reading;
pub mod sampler;
mod scatter;
pub mod scene;
pub mod sensor;
pub mod shape;
pub mod spool;
pub mod steps;
pub mod tree;
mod trial;
