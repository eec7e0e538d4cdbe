//! Pictures as files.

use std::path::Path;

use gyrocal_record::{Outputs, printable_path};
use gyrocal_report::Picture;
#[cfg(feature = "png")]
use miette::{IntoDiagnostic as _, WrapErr as _};

use crate::Failure;
use crate::outputs::make_folder;

/// The help of `--figures`.
pub(crate) const HELP: &str = if cfg!(feature = "png") {
    "Write pictures to this folder, as SVG and PNG"
} else {
    "Write pictures to this folder, as SVG; PNG needs a build with --features png"
};

/// File formats of the pictures.
const FORMS: &str = if cfg!(feature = "png") {
    "as SVG and PNG"
} else {
    "as SVG (PNG needs a build with --features png)"
};

/// Width of the PNGs, px: 1.25 times that of the SVGs, for sharp letters.
#[cfg(feature = "png")]
const WIDTH_PX: u32 = 1200;

/// A picture with the name of its files.
pub(crate) type Named = (String, Box<dyn Picture>);

/// Whether a file has the name of a picture.
pub(crate) fn is_picture(path: &Path) -> bool {
    path.extension()
        .is_some_and(|form| form == "svg" || form == "png")
}

/// Whether a folder holds pictures.
pub(crate) fn are_in(folder: &Path) -> bool {
    let files = folder.read_dir().into_iter().flatten().flatten();
    files.map(|file| file.path()).any(|path| is_picture(&path))
}

/// Stages the pictures of an input, to be committed with the other outputs; returns what there is in
/// the folder, for stdout.
pub(crate) fn stage(
    of: &Path,
    pictures: &[Named],
    folder: &Path,
    outputs: &mut Outputs,
) -> Result<String, Failure> {
    make_folder("--figures ", folder, outputs)?;
    let mut names = Vec::new();
    for (name, picture) in pictures {
        let svg = match picture.to_svg() {
            Ok(svg) => svg,
            Err(reason) => {
                tracing::warn!(%reason, "no picture {name} of {}", printable_path(of));
                continue;
            }
        };
        names.push(name.as_str());
        outputs.stage(&folder.join(name).with_extension("svg"), svg.as_bytes())?;
        #[cfg(feature = "png")]
        {
            let png = gyrocal_report::to_png(&svg, WIDTH_PX)
                .into_diagnostic()
                .wrap_err_with(|| format!("the picture {name} of {}", printable_path(of)))
                .map_err(Failure::Work)?;
            outputs.stage(&folder.join(name).with_extension("png"), &png)?;
        }
    }
    let count = match names.len() {
        1 => "one picture".to_owned(),
        count => format!("{count} pictures"),
    };
    Ok(format!("{count}, {FORMS}: {}", names.join(", ")))
}
