//! The catalogue of effects as a page, docs/catalogue.md, with a picture of each signature.

mod entries;
mod signature;

use std::path::PathBuf;

use gyrocal::{EFFECTS, Effect};
use gyrocal_report::write_svg;

use crate::harness::{Context, Error, Figure};
use crate::page;
use crate::values::Values;

/// Template of the page.
pub(crate) const TEMPLATE: &str = include_str!("catalogue/page.md");

const TOPIC: &str = "diagnosis --part catalogue";

/// All figures of the part; with leave to write page and pictures are renewed instead of compared.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let (write, families) = (context.write, families());
    let mut values = Values::default();
    signature::describe(&mut values)?;
    values.put("count", EFFECTS.len().to_string());
    let tested = EFFECTS.iter().filter(|effect| effect.default_search);
    values.put("tested", tested.count().to_string());
    values.put("families", families.len().to_string());
    values.put("entries", entries::of(&families));
    let text = page::fill(TEMPLATE, &values)?;
    let path = page::docs().join("catalogue.md");
    let mut same = page::renewed(&path, &text, TOPIC, write)?;
    let mut drawn = 0;
    for effect in families {
        let Some(picture) = signature::picture(effect)? else {
            continue;
        };
        drawn += 1;
        let path = picture_path(effect);
        if write {
            write_svg(&picture, &path)?;
        } else {
            same &= path.is_file();
        }
    }
    let note = Figure::note("signatures drawn", drawn.to_string());
    let current = Figure::truth(
        "docs/catalogue.md is the catalogue, with its pictures",
        same,
    );
    Ok(vec![note, current])
}

/// The first effect of each family, in the order of the catalogue.
fn families() -> Vec<&'static Effect> {
    let mut first: Vec<&Effect> = Vec::new();
    for effect in &EFFECTS {
        if !first.iter().any(|known| known.family == effect.family) {
            first.push(effect);
        }
    }
    first
}

fn picture_path(effect: &Effect) -> PathBuf {
    page::docs()
        .join("pictures/catalogue")
        .join(format!("{}.svg", effect.family))
}
