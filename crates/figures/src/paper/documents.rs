//! Page and pictures under `docs`.

use std::path::PathBuf;

use gyrocal_report::{to_png, write_svg};

use super::Error;
use super::curves::Named;
use crate::page::{docs, is_committed};

/// Command that renews them.
const TOPIC: &str = "calibration --part paper";

/// Width of the pictures as PNG, px.
const PNG_WIDTH_PX: u32 = 1440;

/// Committed files under `docs`.
pub(super) struct Documents {
    pub(super) page: String,
    pub(super) pictures: Vec<Named>,
}

impl Documents {
    pub(super) fn write(&self) -> Result<(), Error> {
        gyrocal_record::write_whole(&page_path(), self.page.as_bytes())?;
        for (stem, picture) in &self.pictures {
            let path = picture_path(stem);
            write_svg(picture.as_ref(), &path)?;
            let png = to_png(&picture.to_svg()?, PNG_WIDTH_PX)?;
            gyrocal_record::write_whole(&path.with_extension("png"), &png)?;
        }
        Ok(())
    }

    /// `true` if the committed files equal the measurement, numbers within their last printed digit. A
    /// PNG only has to exist: it is written together with its SVG.
    pub(super) fn are_committed(&self) -> Result<bool, Error> {
        let mut same = is_committed(&page_path(), &self.page, TOPIC)?;
        for (stem, picture) in &self.pictures {
            let path = picture_path(stem);
            same &= is_committed(&path, &picture.to_svg()?, TOPIC)?;
            same &= path.with_extension("png").is_file();
        }
        Ok(same)
    }
}

fn page_path() -> PathBuf {
    docs().join("paper.md")
}

fn picture_path(stem: &str) -> PathBuf {
    docs()
        .join("pictures/paper")
        .join(stem)
        .with_extension("svg")
}
