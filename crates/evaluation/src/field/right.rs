//! Right answers, as data.

/// The answer that is right for a record, in names: the id of an effect of the catalogue or of its family
/// (`accel_i.noise`), which stands for its exact equivalents too; the kind of an error of the set-up (`latitude`);
/// `bench`, a refusal by the reader of the bench file; `several-platforms`; and `unlisted`, which is said by
/// residuals that are not white or a probability above a half of a cause outside of the catalogue.
#[derive(Clone, Copy)]
pub(super) struct Right {
    /// What the record has: each is told by a name of one of these lists. Nothing, if there are none.
    pub(super) each: &'static [Names],
    /// Names that tell all of it at once.
    pub(super) whole: Names,
    /// Names that are not false, but not the answer either.
    pub(super) near: Names,
    /// Names that may be told beside.
    pub(super) beside: Names,
    /// Whether it is enough that confidence sets hold it; otherwise findings have its names.
    pub(super) in_set: bool,
    /// Whether it may be left untold.
    pub(super) silent: Silent,
}

/// Records of which nothing need be told.
#[derive(Clone, Copy)]
pub(super) enum Silent {
    /// None.
    Never,
    /// Those that show less than [`VISIBLE`].
    Faint,
    /// All.
    Always,
}

/// Strength from which on a wrong number must be told: the root of twice the log-likelihood that it costs.
pub(super) const VISIBLE: f64 = 8.0;

pub(super) const UNLISTED: &str = "unlisted";
pub(super) const BENCH: &str = "bench";
pub(super) const SEVERAL: &str = "several-platforms";

/// Names of which one is enough.
pub(super) type Names = &'static [&'static str];

impl Right {
    /// Nothing is to be told.
    pub(super) const NOTHING: Self = Self {
        each: &[],
        whole: &[],
        near: &[],
        beside: &[],
        in_set: false,
        silent: Silent::Always,
    };

    /// One name of each list must be told.
    pub(super) const fn told(each: &'static [Names]) -> Self {
        Self {
            each,
            silent: Silent::Never,
            ..Self::NOTHING
        }
    }

    pub(super) const fn in_set(each: &'static [Names]) -> Self {
        Self {
            in_set: true,
            ..Self::told(each)
        }
    }

    pub(super) const fn silent(self, silent: Silent) -> Self {
        Self { silent, ..self }
    }

    pub(super) const fn near(self, near: Names) -> Self {
        Self { near, ..self }
    }

    pub(super) const fn beside(self, beside: Names) -> Self {
        Self { beside, ..self }
    }

    pub(super) const fn or_whole(self, whole: Names) -> Self {
        Self { whole, ..self }
    }

    /// The same in words.
    pub(super) fn words(&self) -> String {
        if self.each.is_empty() {
            return "nothing".to_owned();
        }
        let each: Vec<String> = self.each.iter().map(|names| names.join(" or ")).collect();
        let whole = self.whole.iter().map(|name| format!(", or {name}"));
        let whole: String = whole.collect();
        let place = if self.in_set { ", in a set" } else { "" };
        let silence = match self.silent {
            Silent::Never => String::new(),
            Silent::Faint => format!("; nothing below {VISIBLE} sigma"),
            Silent::Always => "; or nothing".to_owned(),
        };
        format!("{}{whole}{place}{silence}", each.join(", and "))
    }
}
