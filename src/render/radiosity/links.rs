//! The form factors of all elements.

use rayon::prelude::*;

use super::factor::{self, Exchange};
use super::patches::Patches;
use crate::render::scene::Scene;

/// The form factors of an element to those that it sees.
#[derive(Debug, Clone, Default)]
pub(super) struct Links {
    pub elements: Vec<u32>,
    pub factors: Vec<f64>,
}

/// The form factors of all elements: A_i F_ij is computed once for a pair. Nothing comes from a hidden patch.
pub(super) fn links(scene: &Scene, patches: &Patches) -> Vec<Links> {
    let all = &patches.all;
    let of = |i: usize| -> Vec<(usize, Exchange)> {
        (0..=i).filter_map(|j| Some((j, factor::exchange(scene, &all[i], &all[j])?))).collect()
    };
    // The later have more partners: handed out one by one.
    let pairs: Vec<_> = (0..all.len()).into_par_iter().with_max_len(1).map(of).collect();
    let mut links = vec![Links::default(); 2 * all.len()];
    for (i, partners) in pairs.into_iter().enumerate() {
        for (j, exchange) in partners {
            for (side_i, row) in exchange.iter().enumerate() {
                for (side_j, g) in row.iter().enumerate().filter(|(_, g)| **g > 0.0) {
                    let mut link = |a: usize, area: f64, b: usize| {
                        if all[b / 2].hidden {
                            return;
                        }
                        #[expect(clippy::cast_possible_truncation, reason = "twice the most patches")]
                        links[a].elements.push(b as u32);
                        links[a].factors.push(g / area);
                    };
                    link(2 * i + side_i, all[i].area, 2 * j + side_j);
                    if i != j {
                        link(2 * j + side_j, all[j].area, 2 * i + side_i);
                    }
                }
            }
        }
    }
    links
}
