//! The nearest of many points in up to six dimensions.

/// Coordinates of a point; those that a table does not need are 0.
pub(super) type Key = [f64; 6];

/// Points in the order of a balanced tree: the middle of each range splits it along one axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct KdTree {
    /// Indices into the points as they were given.
    order: Vec<u32>,
    keys: Vec<Key>,
}

impl KdTree {
    /// A tree of finite points, less than 2³² of them.
    pub(super) fn new(keys: Vec<Key>) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "less than 2³² points, by contract")]
        let mut order: Vec<u32> = (0..keys.len() as u32).collect();
        arrange(&mut order, &keys, 0);
        let keys = order.iter().map(|&i| keys[i as usize]).collect();
        Self { order, keys }
    }

    /// The nearest points, nearest first, as squared distance and index; fewer where the tree has fewer.
    pub(super) fn nearest<const N: usize>(&self, key: &Key) -> Nearest<N> {
        let mut found = Nearest { entries: [(f64::INFINITY, u32::MAX); N], count: 0 };
        self.search(key, 0, self.order.len(), 0, &mut found);
        found
    }

    fn search<const N: usize>(&self, key: &Key, from: usize, to: usize, axis: usize, found: &mut Nearest<N>) {
        if from >= to {
            return;
        }
        let middle = from + (to - from) / 2;
        let here = &self.keys[middle];
        found.offer(squared_distance(key, here), self.order[middle]);
        let off = key[axis] - here[axis];
        let next = (axis + 1) % key.len();
        let (near, far) =
            if off < 0.0 { ((from, middle), (middle + 1, to)) } else { ((middle + 1, to), (from, middle)) };
        self.search(key, near.0, near.1, next, found);
        if off * off <= found.worst() {
            self.search(key, far.0, far.1, next, found);
        }
    }
}

/// Puts the median along `axis` into the middle and does the same with both halves along the next axis.
fn arrange(order: &mut [u32], keys: &[Key], axis: usize) {
    if order.len() < 2 {
        return;
    }
    let middle = order.len() / 2;
    order.select_nth_unstable_by(middle, |&a, &b| keys[a as usize][axis].total_cmp(&keys[b as usize][axis]));
    let next = (axis + 1) % keys[0].len();
    let (low, high) = order.split_at_mut(middle);
    arrange(low, keys, next);
    arrange(&mut high[1..], keys, next);
}

fn squared_distance(a: &Key, b: &Key) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// The nearest points met so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest<const N: usize> {
    entries: [(f64, u32); N],
    count: usize,
}

impl<const N: usize> Nearest<N> {
    fn offer(&mut self, distance: f64, index: u32) {
        if distance >= self.worst() {
            return;
        }
        let at = self.entries[..self.count].partition_point(|e| e.0 <= distance);
        self.count = (self.count + 1).min(N);
        self.entries[at..self.count].rotate_right(1);
        self.entries[at] = (distance, index);
    }

    fn worst(&self) -> f64 {
        if self.count < N { f64::INFINITY } else { self.entries[N - 1].0 }
    }

    /// Squared distances and indices, nearest first.
    pub(super) fn entries(&self) -> &[(f64, u32)] {
        &self.entries[..self.count]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn finds_what_a_search_through_all_finds(points in prop::collection::vec(prop::array::uniform3(-4..4_i8), 1..60),
                                                 at in prop::array::uniform3(-5.0..5.0)) {
            let key = |p: [f64; 3]| [p[0], p[1], p[2], 0.0, 0.0, 0.0];
            let keys: Vec<Key> = points.iter().map(|p| key(p.map(f64::from))).collect();
            let at = key(at);
            let mut expected: Vec<f64> = keys.iter().map(|k| squared_distance(&at, k)).collect();
            expected.sort_by(f64::total_cmp);
            expected.truncate(4);
            let found = KdTree::new(keys.clone()).nearest::<4>(&at);
            let distances: Vec<f64> = found.entries().iter().map(|e| e.0).collect();
            prop_assert_eq!(distances, expected);
            for (d, i) in found.entries() {
                prop_assert_eq!(*d, squared_distance(&at, &keys[*i as usize]));
            }
        }
    }
}
