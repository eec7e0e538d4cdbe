//! Exit codes, in one place.

/// The result was written, whatever it is.
pub(crate) const DONE: u8 = 0;
/// An input or the computation failed, or the result means nothing.
pub(crate) const FAILED: u8 = 1;
/// The command line is wrong.
pub(crate) const USAGE: u8 = 2;
/// With `--exit-code`: effects were found, or a figure misses its target.
pub(crate) const FOUND: u8 = 3;
/// With `--exit-code`: the residuals are unexplained.
pub(crate) const UNEXPLAINED: u8 = 4;
/// With `--exit-code`: the set-up is wrong.
pub(crate) const SETUP: u8 = 5;

/// With `--exit-code`: names are not settled.
pub(crate) const NOT_SETTLED: u8 = 6;

/// The same for a user, below the help of every command.
pub(crate) const HELP: &str = "\
Exit codes:
  0  the result was written, whatever it is
  1  an input or the computation failed, or the coefficients mean nothing
  2  the command line is wrong
  with --exit-code (diagnose, characterise) also
  3  diagnose: effects were found; characterise: a figure misses its target
  4  diagnose: the residuals are unexplained
  5  diagnose: the set-up is wrong
  6  diagnose: names are not settled (search cut, or the rest is not white)";
