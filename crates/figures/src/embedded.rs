//! The filter in a controller: instructions, code, memory and stack on an emulated Cortex-M4F, bits
//! equal to the host's, and single precision beside double.

mod c_interface;
mod emitted;
mod firmware;
mod precision;
mod target;

use crate::error::Error;
use crate::figure::Figure;

/// All figures. The small version replays a day in double precision instead of three, and fewer
/// records.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = match target::Tools::find() {
        Some(tools) => {
            let mut figures = firmware::figures(&tools, small)?;
            figures.extend(firmware::watch(&tools)?);
            figures.push(firmware::example(&tools)?);
            figures.extend(emitted::figures(&tools)?);
            figures.extend(c_interface::figures(Some(&tools), &firmware::on_host()?)?);
            figures
        }
        None => {
            let reason = "a tool is missing".to_owned();
            let mut figures = vec![Figure::note("on the target: not judged", reason)];
            figures.extend(c_interface::figures(None, &firmware::on_host()?)?);
            figures
        }
    };
    figures.extend(precision::figures(small)?);
    Ok(figures)
}
