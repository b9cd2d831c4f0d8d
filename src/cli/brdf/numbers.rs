//! Numbers from the command line: lists, numbers of bins, and angles within their range.

use std::str::FromStr;

use crate::brdf::table::Resolution;
use crate::cli::Failure;

/// Lobes in one drawing at most.
const MOST_LOBES: usize = 6;

/// Refuses what is no angle to the normal, up to the horizon; `option` is its name without the dashes.
pub(super) fn check_theta(option: &str, theta_deg: f64) -> Result<(), Failure> {
    within(option, theta_deg, (0.0..=90.0).contains(&theta_deg), "0 to 90 degrees from the normal")
}

/// The same where the horizon has no values.
pub(super) fn check_theta_above(option: &str, theta_deg: f64) -> Result<(), Failure> {
    within(option, theta_deg, (0.0..90.0).contains(&theta_deg), "0 to below 90 degrees from the normal")
}

/// Refuses a cone that is wider than the hemisphere, or has no width.
pub(super) fn check_half_angle(option: &str, angle_deg: f64) -> Result<(), Failure> {
    within(option, angle_deg, (0.001..=90.0).contains(&angle_deg), "0.001 to 90 degrees")
}

/// Refuses more angles of incidence than a drawing has colours for, or those without a lobe.
pub(super) fn check_lobes(thetas_deg: &Numbers) -> Result<(), Failure> {
    let count = thetas_deg.0.len();
    if count > MOST_LOBES {
        return Err(Failure::Message(format!("--theta-i has {count} angles; expected 1 to {MOST_LOBES}")));
    }
    thetas_deg.0.iter().try_for_each(|theta| check_theta_above("theta-i", *theta))
}

fn within(option: &str, value: f64, sound: bool, expected: &str) -> Result<(), Failure> {
    if sound { Ok(()) } else { Err(Failure::Message(format!("--{option} is {value}; expected {expected}"))) }
}

/// A list of numbers: `0,30,60` or `0:80:10`.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::cli) struct Numbers(pub Vec<f64>);

/// Most numbers that a range may have.
const MOST: f64 = 100_000.0;

impl FromStr for Numbers {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |s: &str| {
            let parsed = s.trim().parse::<f64>().ok().filter(|v| v.is_finite());
            parsed.ok_or_else(|| format!("found `{s}`; expected a number, a list `0,30,60` or a range `0:80:10`"))
        };
        let mut out = Vec::new();
        for item in text.split(',') {
            match item.split(':').collect::<Vec<_>>()[..] {
                [one] => out.push(number(one)?),
                [low, high, step] => {
                    let (low, high, step) = (number(low)?, number(high)?, number(step)?);
                    let steps = ((high - low) / step + 1e-9).floor();
                    if !(0.0..MOST).contains(&steps) {
                        return Err(format!("found `{item}`; expected a range from low to high by a step above 0"));
                    }
                    let mut i = 0.0;
                    while i <= steps {
                        out.push(low + i * step);
                        i += 1.0;
                    }
                }
                _ => return Err(format!("found `{item}`; expected a range `low:high:step`")),
            }
        }
        Ok(Self(out))
    }
}

/// Numbers of bins as a user writes them: `90x90x180`.
#[derive(Debug, Clone, Copy)]
pub(in crate::cli) struct Bins(pub Resolution);

impl FromStr for Bins {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<usize>> = text.split(['x', '×', ',']).map(|n| n.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[theta_h @ 1..=180, theta_d @ 1..=180, phi_d @ 1..=360]) => {
                Ok(Self(Resolution { theta_h, theta_d, phi_d }))
            }
            _ => Err(format!("found `{text}`; expected bins in θh, θd and φd such as 90x90x180, at most 180x180x360")),
        }
    }
}
