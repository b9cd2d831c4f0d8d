//! `--settings`: a file with settings of the integration, as `trade spectrum --settings` writes it.

use std::fs;
use std::path::Path;

use serde::Deserialize;

use super::args::{Integration, InterpolationArg, RuleArg};
use crate::cli::Failure;
use crate::mistake::{self, Mistake};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    convert: toml::Spanned<Section>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Section {
    rule: Option<RuleArg>,
    range_nm: Option<[f64; 2]>,
    resample_nm: Option<f64>,
    interpolation: Option<InterpolationArg>,
    thin: Option<f64>,
}

/// Takes what the file says where the command line says nothing.
pub(super) fn apply(path: &Path, integration: &mut Integration) -> Result<(), Failure> {
    let place = path.display();
    let text = fs::read_to_string(path)
        .map_err(|e| Failure::Message(format!("{place}: cannot be read: {e}; expected settings (TOML)")))?;
    let at = |m: Mistake| Failure::Message(format!("{place}:{m}"));
    let File { convert } = mistake::parse(&text).map_err(at)?;
    let Section { rule, range_nm, resample_nm, interpolation, thin } = convert.get_ref();
    let wrong = |message: &str| Err(at(Mistake::at(&text, &convert.span(), message)));
    if range_nm.is_some_and(|[low, high]| !(0.0 < low && low < high)) {
        return wrong("`range_nm` is no range; expected two positive wavelengths, the shorter first");
    }
    if resample_nm.is_some_and(|step| step <= 0.0) {
        return wrong("`resample_nm` is not positive; expected a step in nm");
    }
    if interpolation.is_some() && resample_nm.is_none() {
        return wrong("`interpolation` without `resample_nm`; expected both or none");
    }
    if resample_nm.is_some() && thin.is_some() {
        return wrong("`resample_nm` and `thin`; expected one or the other");
    }
    if thin.is_some_and(|share| !(0.0..1.0).contains(&share)) {
        return wrong("`thin` is no share; expected a number from 0 to below 1");
    }
    integration.rule = integration.rule.or(*rule);
    integration.range = integration.range.or(range_nm.map(|[low, high]| (low, high)));
    if integration.resample.is_none() && integration.thin.is_none() {
        integration.resample = *resample_nm;
        integration.interpolation = interpolation.unwrap_or(integration.interpolation);
        integration.thin = *thin;
    }
    Ok(())
}
