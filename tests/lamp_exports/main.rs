//! Lamps exported to other programs: each file is read back by a small reader of its own, written from the target's published
//! rules, and compared with the lamp in many directions. The lamp is alike in no two directions, so that a turn or a mirror shows.

mod command;
mod csv;
mod equirectangular;
mod lamp;
mod mitsuba;
mod pbrt;
mod radiance;
