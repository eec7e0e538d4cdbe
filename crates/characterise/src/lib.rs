//! Operating characteristics of the diagnosis.

mod bank;
mod draw;
mod error;
mod plant;
mod population;
mod signature;

pub use bank::Bank;
pub use draw::Draw;
pub use error::CharacteriseError;
pub use plant::{Planted, fitted, plant, searched, shape};
pub use population::scenario;
pub use signature::{Columns, Signature};
