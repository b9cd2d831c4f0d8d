//! How far the light is followed.

/// After which vertices a path goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Follow {
    /// All: global illumination.
    #[default]
    All,
    /// Mirrors and glass only: direct light, seen also in reflections and through glass (Whitted's ray tracing, one branch drawn).
    Specular,
    /// None: direct light alone.
    Nothing,
}

/// What a path may do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Which vertices it is followed through.
    pub follow: Follow,
    /// The greatest number of edges from the instrument to the light; `None`: no path is cut, chance alone ends it.
    pub max_edges: Option<u32>,
    /// The edge from which on a path may be ended by chance.
    pub roulette_from: u32,
    /// Whether what glass and metal polarise is followed to the next glass; without it a pane at 75° is 3.5 % off.
    pub polarisation: bool,
    /// Whether anything can stand in the way of a light; without shadows a picture is a preview.
    pub shadows: bool,
    /// Whether a path carries one band, drawn anew for each, instead of all at once.
    pub single_band: bool,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            follow: Follow::All,
            max_edges: None,
            roulette_from: 4,
            polarisation: true,
            shadows: true,
            single_band: false,
        }
    }
}
