//! Operating characteristics of the diagnosis.

mod bank;
mod beyond;
mod case;
mod cell;
mod draw;
mod error;
mod judge;
mod methods;
mod plant;
mod population;
mod signature;

pub use bank::Bank;
pub use case::{Case, FoundCase, HiddenCase, MethodCase, same};
pub use cell::Cell;
pub use draw::Draw;
pub use error::CharacteriseError;
pub use methods::{Called, Method};
pub use plant::{Planted, fitted, plant, searched, shape};
pub use population::scenario;
pub use signature::{Columns, Signature};
