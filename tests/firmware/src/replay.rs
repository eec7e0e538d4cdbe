use gyrocal::{Discretisation, FilterSettings, InitialAttitude, Integration, SavedNumber, Site};

use crate::filter::Filter;
use crate::record::Number;

/// Settings of the record, with the given rule of integration.
#[must_use]
pub fn settings(integration: Integration) -> FilterSettings<Number> {
    FilterSettings {
        discretisation: Discretisation {
            integration,
            ..Discretisation::default()
        },
        ..FilterSettings::at_site(Site::at_latitude_deg(48.2))
    }
}

/// Prior of the attitude in the record's bench description.
#[must_use]
pub fn attitude() -> InitialAttitude<Number> {
    let radians = |degrees: f64| degrees.to_radians() as Number;
    InitialAttitude::Angles {
        angles_rad: [radians(12.0), radians(-25.0), radians(40.0)],
        sigma_rad: [radians(0.01); 3],
    }
}

/// Bits of many numbers in 64 (FNV-1a).
pub struct Digest(pub u64);

impl Default for Digest {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Digest {
    /// Adds the bits of a number.
    pub fn add(&mut self, number: Number) {
        for byte in number.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    /// Adds coefficients and sigmas of a filter, and the NIS of its last step.
    pub fn add_step(&mut self, filter: &Filter, nis: Number) {
        for number in Report::of(filter, nis).numbers {
            self.add(number);
        }
    }
}

/// Coefficients, their sigmas and the NIS of the last step.
pub struct Report {
    /// In this order.
    pub numbers: [Number; 19],
}

impl Report {
    /// That of a filter.
    #[must_use]
    pub fn of(filter: &Filter, nis: Number) -> Self {
        let mut numbers = [nis; 19];
        let from = filter.estimates();
        for (place, number) in numbers.iter_mut().zip(from.as_flattened()) {
            *place = *number;
        }
        Self { numbers }
    }

    /// The bits of the numbers.
    pub fn bits(&self) -> impl Iterator<Item = u64> {
        self.numbers.iter().map(|number| {
            let mut bytes = [0; 8];
            number.write(&mut bytes);
            u64::from_le_bytes(bytes)
        })
    }
}
