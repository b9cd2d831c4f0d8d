//! Tables, one after another, as columns over the bins that all of them measured.

use super::{Error, Grid, Training};
use crate::brdf::table::{HalfAngle, Resolution};

/// Columns of tables of one resolution.
#[derive(Debug, Clone, PartialEq)]
pub struct Collection {
    grid: Grid,
    columns: Vec<Vec<f32>>,
    /// Number of the table that each column comes from.
    tables: Vec<usize>,
}

impl Collection {
    /// An empty collection.
    #[must_use]
    pub fn new(resolution: Resolution) -> Self {
        Self { grid: Grid::new(resolution), columns: Vec::new(), tables: Vec::new() }
    }

    /// The bins that take part so far.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Takes the channels of a table as columns. Bins that it did not measure are dropped from all.
    ///
    /// # Errors
    /// [`Error::Resolution`].
    pub fn add(&mut self, table: &HalfAngle) -> Result<(), Error> {
        self.grid.check(table.resolution())?;
        let kept: Vec<bool> = self.grid.bins().iter().map(|b| !table.bin(*b)[0].is_nan()).collect();
        if kept.contains(&false) {
            self.grid.retain(&kept);
            for column in &mut self.columns {
                let mut keep = kept.iter();
                column.retain(|_| *keep.next().unwrap_or(&false));
            }
        }
        let number = self.tables();
        for channel in 0..table.channels().len() {
            self.columns.push(self.grid.column(table, channel)?);
            self.tables.push(number);
        }
        Ok(())
    }

    /// Number of tables so far.
    #[must_use]
    pub fn tables(&self) -> usize {
        self.tables.last().map_or(0, |t| t + 1)
    }

    /// The columns of the tables whose number modulo `folds` is not `fold`, and those of the others, which are held out.
    pub(super) fn split(&self, folds: usize, fold: usize) -> (Self, Vec<&[f32]>) {
        let (mut rest, mut held) =
            (Self { columns: Vec::new(), tables: Vec::new(), grid: self.grid.clone() }, Vec::new());
        for (column, &table) in self.columns.iter().zip(&self.tables) {
            if table % folds == fold {
                held.push(&column[..]);
            } else {
                rest.columns.push(column.clone());
                rest.tables.push(table);
            }
        }
        (rest, held)
    }

    /// Maps the columns for training.
    ///
    /// # Errors
    /// [`Error::TooFew`], [`Error::NothingInCommon`].
    pub fn train(self) -> Result<(Grid, Training), Error> {
        let weights = self.grid.weights();
        Ok((self.grid, Training::new(self.columns, weights)?))
    }
}
