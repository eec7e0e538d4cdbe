//! Truth of the diagnosis outside of the population that its constants were tuned on.

pub(crate) mod causes;
mod drawn;
pub(crate) mod hostile;
mod judged;
pub(crate) mod noise;
pub(crate) mod outside;
pub(crate) mod setup;
pub(crate) mod shapes;
pub(crate) mod together;
