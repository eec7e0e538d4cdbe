//! The filter in a controller: instructions, code, memory and stack on an emulated Cortex-M4F, bits
//! equal to the host's, and single precision beside double.

mod c_interface;
mod emitted;
mod firmware;
mod precision;
mod target;

use crate::harness::{Context, Error, Figure, Size};

/// The record that the firmware replays.
const RECORD: &str = "examples/data/three_days.csv";

/// All figures of the part. The small version replays a day in double precision instead of three, and fewer
/// records; a number of records is of those of single precision alone.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = precision::figures(context)?;
    if matches!(context.size, Size::Most(_)) {
        return Ok(figures);
    }
    let tools = target::Tools::find();
    if let Some(tools) = &tools {
        figures.extend(firmware::figures(tools, context.is_small())?);
        figures.extend(emitted::figures(tools)?);
    } else {
        let reason = "a tool is missing".to_owned();
        figures.push(Figure::note("on the target: not judged", reason));
    }
    figures.extend(c_interface::figures(tools.as_ref(), &firmware::on_host()?)?);
    Ok(figures)
}
