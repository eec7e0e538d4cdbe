//! The catalogue of effects as a page, docs/catalogue.md, with a picture of each signature.

mod entries;
mod signature;

use gyrocal::{EFFECTS, Effect};
use gyrocal_report::write_svg;

use crate::harness::{Context, Error, Figure};
use crate::page;
use crate::values::Values;

/// Template of the page.
pub(crate) const TEMPLATE: &str = include_str!("catalogue/page.md");

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
    let topic = "diagnosis --part catalogue";
    let mut same = page::filled("catalogue.md", TEMPLATE, &values, topic, write)?;
    let mut drawn = 0;
    for effect in families {
        let Some(picture) = signature::picture(effect)? else {
            continue;
        };
        drawn += 1;
        let pictures = page::docs().join("pictures/catalogue");
        let path = pictures.join(format!("{}.svg", effect.family));
        if write {
            write_svg(&picture, &path)?;
        }
        same &= path.is_file();
    }
    let note = Figure::note("signatures drawn", drawn.to_string());
    let name = "docs/catalogue.md is the catalogue, with its pictures";
    Ok(vec![note, Figure::truth(name, same)])
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
