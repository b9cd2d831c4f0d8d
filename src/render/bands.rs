//! The wavelengths that a render carries.

/// What a band's value is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Width {
    /// A node of a quadrature over a density: the band stands for so many nanometres.
    Density {
        /// The weight of the node, nm.
        nm: f64,
    },
    /// A spectral line, whose value is a whole amount.
    Line,
}

/// The bands of a render, ascending wavelengths.
#[derive(Debug, Clone, PartialEq)]
pub struct Bands {
    wavelengths_nm: Vec<f64>,
    widths: Vec<Width>,
}

impl Bands {
    /// Nodes of a density at the midpoints of `count` equal parts of a range.
    ///
    /// # Panics
    /// For an empty range or no band.
    #[must_use]
    pub fn midpoints(low_nm: f64, high_nm: f64, count: usize) -> Self {
        assert!(low_nm < high_nm && count > 0, "a range of wavelengths and at least one band");
        #[expect(clippy::cast_precision_loss, reason = "a number of bands")]
        let step = (high_nm - low_nm) / count as f64;
        #[expect(clippy::cast_precision_loss, reason = "a number of bands")]
        let wavelengths_nm = (0..count).map(|i| low_nm + (i as f64 + 0.5) * step).collect();
        Self { wavelengths_nm, widths: vec![Width::Density { nm: step }; count] }
    }

    /// Wavelengths, nm.
    #[must_use]
    pub fn wavelengths_nm(&self) -> &[f64] {
        &self.wavelengths_nm
    }

    /// What each band's value is.
    #[must_use]
    pub fn widths(&self) -> &[Width] {
        &self.widths
    }

    /// The number of bands.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "there is always one band")]
    pub fn len(&self) -> usize {
        self.wavelengths_nm.len()
    }
}
