//! The C interface.

use super::target::Tools;
use crate::error::Error;
use crate::figure::Figure;

pub(super) fn figures(_tools: Option<&Tools>) -> Result<Vec<Figure>, Error> {
    Ok(Vec::new())
}
