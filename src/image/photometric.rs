//! The photometric planes of any image: weighted from its bands or colours, or found in it.

use super::converted::Converted;
use super::description::{Description, Meaning};
use super::error::Error;
use super::plan::{Plan, PlanError, Settings};
use super::source::{Region, Source};
use super::target::Target;
use crate::colorimetry::Observer;
use crate::finding::{Checked, Finding};
use crate::photometry::luminous::Efficiency;
use crate::spectrum::Quantity;

/// How the photopic quantity, or X, Y and Z, of an image are come by.
#[derive(Debug, Clone, PartialEq)]
pub struct Photometric {
    way: Way,
    quantity: Option<Quantity>,
    unit: String,
}

#[derive(Debug, Clone, PartialEq)]
enum Way {
    /// From bands or colours.
    Planned(Box<Plan>),
    /// These channels hold it.
    Found { channels: Vec<usize>, description: Box<Description> },
}

impl Photometric {
    /// The photopic quantity: luminance, illuminance …
    ///
    /// It is weighted from the bands where there are any; else a photopic channel, Y of X, Y, Z, or a single channel is taken as
    /// it is; else it is what [`Plan`] makes of the image's colours.
    ///
    /// # Errors
    /// [`PlanError`].
    pub fn luminance(
        image: &Description,
        efficiency: Efficiency,
        settings: &Settings,
    ) -> Result<Checked<Self>, PlanError> {
        let found = || {
            let luminous = |i: &usize| quantity_of(&image.channels[*i].unit).is_some();
            let single = (image.channels.len() == 1).then_some(0);
            let channel = image.find(Meaning::Photopic).or_else(|| image.find(Meaning::Tristimulus(1)));
            channel.or_else(|| (0..image.channels.len()).find(luminous)).or(single).map(|i| vec![i])
        };
        Self::new(image, found, &Target::Luminance(efficiency), settings)
    }

    /// X, Y and Z, by the same rules.
    ///
    /// # Errors
    /// [`PlanError`].
    pub fn xyz(image: &Description, observer: Observer, settings: &Settings) -> Result<Checked<Self>, PlanError> {
        let found = || (0..3).map(|k| image.find(Meaning::Tristimulus(k))).collect();
        Self::new(image, found, &Target::Xyz(observer), settings)
    }

    fn new(
        image: &Description,
        found: impl Fn() -> Option<Vec<usize>>,
        target: &Target,
        settings: &Settings,
    ) -> Result<Checked<Self>, PlanError> {
        if image.bands().is_empty()
            && let Some(channels) = found()
        {
            let planes = channels.iter().map(|c| image.channels[*c].clone()).collect();
            let description = Description::planes(image.width, image.height, planes);
            return Ok(Checked::clean(Self::of_way(&description, |d| Way::Found {
                channels,
                description: Box::new(d.clone()),
            })));
        }
        let plan = Plan::new(image, target, settings)?;
        Ok(plan.map(|plan| Self::of_way(&plan.description().clone(), |_| Way::Planned(Box::new(plan)))))
    }

    fn of_way(description: &Description, way: impl FnOnce(&Description) -> Way) -> Self {
        let unit = description.channels[0].unit.replace("m2", "m²");
        Self { way: way(description), quantity: quantity_of(&unit), unit }
    }

    /// The quantity whose photopic counterpart the planes are; `None` where they are relative.
    #[must_use]
    pub fn quantity(&self) -> Option<Quantity> {
        self.quantity
    }

    /// Unit of the planes as printed; empty where they are relative.
    #[must_use]
    pub fn unit(&self) -> &str {
        &self.unit
    }

    /// The planes of an image: the one that this was made for.
    pub fn of<'a, S: Source + 'a>(&'a self, source: S) -> Box<dyn Source + 'a> {
        match &self.way {
            Way::Planned(plan) => Box::new(Converted::new(source, (**plan).clone())),
            Way::Found { channels, description } => Box::new(Picked { source, channels, description }),
        }
    }
}

/// The quantity of a luminous unit.
fn quantity_of(unit: &str) -> Option<Quantity> {
    let unit = unit.replace("m2", "m²");
    Quantity::ABSOLUTE.into_iter().find(|q| q.luminous_unit() == unit)
}

/// Some channels of an image.
struct Picked<'a, S> {
    source: S,
    channels: &'a [usize],
    description: &'a Description,
}

impl<S: Source> Source for Picked<'_, S> {
    fn description(&self) -> &Description {
        self.description
    }

    fn block(&self) -> (usize, usize) {
        self.source.block()
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        let channels: Vec<usize> = channels.iter().map(|c| self.channels[*c]).collect();
        self.source.read(region, &channels, out)
    }

    fn findings(&self) -> Vec<Finding> {
        self.source.findings()
    }
}
