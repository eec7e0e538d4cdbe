//! What a build costs.
use super::Error;
use crate::figure::Figure;
pub(crate) fn figures() -> Result<Vec<Figure>, Error> { Ok(Vec::new()) }
