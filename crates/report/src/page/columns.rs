//! Columns of numbers for the script: 32-bit floats in base64, each stored once.

use std::collections::HashMap;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

/// The columns of a page.
#[derive(Default)]
pub(super) struct Columns {
    /// All columns in base64, in their order.
    pub(super) encoded: Vec<String>,
    places: HashMap<String, usize>,
}

impl Columns {
    /// Stores a column; returns its number.
    pub(super) fn add(&mut self, values: impl Iterator<Item = f64>) -> usize {
        // A page is a picture: seven digits are finer than its pixels, at any zoom that shows rows.
        let bytes: Vec<u8> = values
            .flat_map(|value| (value as f32).to_le_bytes())
            .collect();
        let text = STANDARD.encode(bytes);
        if let Some(place) = self.places.get(&text) {
            return *place;
        }
        let place = self.encoded.len();
        self.places.insert(text.clone(), place);
        self.encoded.push(text);
        place
    }
}
