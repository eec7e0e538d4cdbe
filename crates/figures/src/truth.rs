//! What the diagnosis says that is not so, over records of the independent simulator with fresh
//! seeds.

mod setup;

use crate::error::Error;
use crate::figure::Figure;

/// All figures of the topic.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    setup::figures(small)
}
