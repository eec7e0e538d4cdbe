//! Effects by test statistic.

use plotters::style::RGBColor;

use crate::axis::{Axis, Span};
use crate::canvas::{Align, Canvas, Lettering, Stroke};
use crate::check;
use crate::error::Error;
use crate::number::{count, percent, short};
use crate::page::{Key, page};
use crate::panel::{Panel, Surround};
use crate::picture::Picture;
use crate::style::{
    BELOW, BLACK, BODY, GREY, INK, MARGIN, ORANGE, SMALL, THIN, VERMILION, WHITE, WIDTH,
};
use crate::text;
use crate::trace::Frame;

/// Bars of a test statistic by effect, in groups: each named effect with its rivals, and the
/// rest; with the threshold of the family.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranking {
    /// What is seen.
    pub title: String,
    /// More words, or none.
    pub subtitle: String,
    /// Name of the statistic: `|z|`.
    pub statistic: String,
    /// What the largest statistic of a clean record seldom passes.
    pub threshold: f64,
    /// Probability that any effect of a clean record passes the threshold.
    pub false_alarm_probability: f64,
    /// Number of effects that were tested.
    pub tested: usize,
    /// Groups from top to bottom.
    pub groups: Vec<RankingGroup>,
    /// Effects that are not shown.
    pub omitted: Option<Omitted>,
}

/// Bars that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct RankingGroup {
    /// What they have in common: `finding 1: cannot be told apart at 95%`.
    pub label: String,
    /// The bars from top to bottom.
    pub effects: Vec<RankedEffect>,
}

/// One bar.
#[derive(Clone, Debug, PartialEq)]
pub struct RankedEffect {
    /// Id of the effect: `gyro_y.g_z`.
    pub effect: String,
    /// Its statistic; nan if it could not be tested.
    pub statistic: f64,
    /// What it is in the answer.
    pub role: Role,
    /// Words beside the bar, or none: `3.6 nats behind`.
    pub note: String,
}

/// What an effect is in the answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Named as the cause.
    Named,
    /// In the set of causes that the data do not tell apart from the named one.
    Rival,
    /// Neither.
    Other,
}

/// Effects left out of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Omitted {
    /// How many.
    pub effects: usize,
    /// The largest statistic among them.
    pub largest: f64,
}

const BAR_PITCH: f64 = 19.0;
const GROUP_HEAD: f64 = 22.0;
const GROUP_GAP: f64 = 6.0;

impl Role {
    const ALL: [Self; 3] = [Self::Named, Self::Rival, Self::Other];

    fn colour(self) -> RGBColor {
        match self {
            Self::Named => VERMILION,
            Self::Rival => ORANGE,
            Self::Other => GREY,
        }
    }

    fn label(self) -> &'static str {
        match self {
            Self::Named => "named",
            Self::Rival => "rival, not told apart from the named one",
            Self::Other => "not named",
        }
    }
}

impl Picture for Ranking {
    fn to_svg(&self) -> Result<String, Error> {
        self.check()?;
        let effects: usize = self.groups.iter().map(|group| group.effects.len()).sum();
        let groups = self.groups.len() as f64;
        let bars = BAR_PITCH * effects as f64 + (GROUP_HEAD + GROUP_GAP) * groups;
        let omitted = if self.omitted.is_some() {
            BAR_PITCH
        } else {
            0.0
        };
        page(
            &self.title,
            &self.subtitle,
            &self.keys(),
            bars + omitted + BELOW,
            |canvas, body| self.draw(canvas, body, omitted),
        )
    }
}

impl Ranking {
    fn check(&self) -> Result<(), Error> {
        check::some("the list of groups of effects", &self.groups)?;
        check::positive("the threshold of the statistic", self.threshold)?;
        for effect in self.effects() {
            let what = || format!("the statistic of {}", effect.effect);
            check::not_infinite(what, &[effect.statistic])?;
        }
        Ok(())
    }

    fn effects(&self) -> impl Iterator<Item = &RankedEffect> {
        self.groups.iter().flat_map(|group| &group.effects)
    }

    fn keys(&self) -> Vec<Key> {
        let mut keys: Vec<Key> = Role::ALL
            .into_iter()
            .filter(|role| self.effects().any(|effect| effect.role == *role))
            .map(|role| Key::area(role.colour(), 1.0, role.label()))
            .collect();
        let threshold = format!(
            "threshold {}: a clean record passes it with any of {} effects with probability {}",
            short(self.threshold, 3),
            count(self.tested),
            percent(self.false_alarm_probability)
        );
        keys.push(Key::line(Stroke::dashed(BLACK, THIN), threshold));
        keys
    }

    fn draw(&self, canvas: &mut Canvas<'_>, body: Frame, omitted: f64) -> Result<(), Error> {
        let widths = self
            .effects()
            .map(|e| text::width_px(&e.effect, BODY, true));
        let names = widths.fold(60.0, f64::max).min(0.4 * body.width());
        let statistics = self.effects().map(|effect| effect.statistic);
        let most = Span::of(statistics.chain([1.15 * self.threshold]));
        let most = most.map_or(1.0, |span| span.hi);
        let left = body.left + names + 14.0;
        // As wide as the words beside the bars allow.
        let widths = self.effects().map(|effect| {
            let beside = text::width_px(&effect.beside(), SMALL, false);
            let part = (effect.statistic.max(0.0) / (1.02 * most)).max(1e-3);
            (body.right - left - beside - 8.0) / part
        });
        let width = widths.fold(body.right - left, f64::min);
        let frame = Frame {
            left,
            top: body.top,
            right: left + width.max(0.3 * (body.right - left)),
            bottom: body.bottom - BELOW - omitted,
        };
        let abscissa = Span {
            lo: 0.0,
            hi: 1.02 * most,
        };
        let panel = Panel {
            frame,
            x: Axis::linear(abscissa, &self.statistic, "", 8),
            y: Axis::named(Span { lo: 0.0, hi: 1.0 }, Vec::new(), ""),
        };
        if let Some(omitted) = self.omitted {
            let words = format!(
                "{} more effects are not shown; the largest {} among them is {}",
                count(omitted.effects),
                self.statistic,
                short(omitted.largest, 2)
            );
            let place = (body.left, body.bottom - 8.0);
            let lettering = Lettering::new(SMALL, Align::Start).colour(INK);
            canvas.text(&words, place, lettering)?;
        }
        let surround = Surround {
            name: "",
            note: "",
            abscissa: true,
            ordinate_title: false,
        };
        panel.surround(canvas, surround)?;
        for (effect, y) in self.rows(body.top) {
            panel.bar(canvas, effect, y)?;
        }
        panel.upright(canvas, self.threshold, Stroke::dashed(BLACK, THIN))?;
        for (effect, y) in self.rows(body.top) {
            panel.words(canvas, effect, y, names)?;
        }
        self.heads(canvas, body, left)
    }

    /// The effects with the heights of their middles.
    fn rows(&self, top: f64) -> Vec<(&RankedEffect, f64)> {
        let mut rows = Vec::new();
        let mut y = top;
        for group in &self.groups {
            y += GROUP_HEAD;
            for effect in &group.effects {
                rows.push((effect, y + 0.5 * BAR_PITCH));
                y += BAR_PITCH;
            }
            y += GROUP_GAP;
        }
        rows
    }

    fn heads(&self, canvas: &mut Canvas<'_>, body: Frame, axis: f64) -> Result<(), Error> {
        let mut y = body.top;
        for group in &self.groups {
            let head = text::fit(&group.label, BODY, true, body.width());
            // A white ground keeps axis, grid and threshold out of the letters.
            let right = body.left + text::width_px(&head, BODY, true) + 6.0;
            if right > axis {
                canvas.rect((body.left, y), (right, y + GROUP_HEAD), WHITE, 1.0)?;
            }
            let lettering = Lettering::new(BODY, Align::Start).bold().colour(INK);
            canvas.text(&head, (body.left, y + 0.5 * GROUP_HEAD), lettering)?;
            y += GROUP_HEAD + BAR_PITCH * group.effects.len() as f64 + GROUP_GAP;
        }
        Ok(())
    }
}

impl Panel {
    fn bar(&self, canvas: &mut Canvas<'_>, effect: &RankedEffect, y: f64) -> Result<(), Error> {
        let half = 0.5 * BAR_PITCH - 3.5;
        let foot = (self.frame.left, y - half);
        let tip = (self.tip(effect), y + half);
        canvas.rect(foot, tip, effect.role.colour(), 1.0)
    }

    fn words(
        &self,
        canvas: &mut Canvas<'_>,
        effect: &RankedEffect,
        y: f64,
        names: f64,
    ) -> Result<(), Error> {
        let named = effect.role == Role::Named;
        let mut lettering = Lettering::new(BODY, Align::End);
        lettering.bold = named;
        let name = text::fit(&effect.effect, BODY, named, names);
        canvas.text(&name, (self.frame.left - 8.0, y), lettering)?;
        let start = self.tip(effect) + 6.0;
        let beside = text::fit(&effect.beside(), SMALL, false, WIDTH - MARGIN - start);
        let end = start + text::width_px(&beside, SMALL, false);
        canvas.rect((start - 2.0, y - 6.0), (end + 2.0, y + 6.0), WHITE, 1.0)?;
        let lettering = Lettering::new(SMALL, Align::Start).colour(INK);
        canvas.text(&beside, (start, y), lettering)
    }

    /// Where the bar of an effect ends, px.
    fn tip(&self, effect: &RankedEffect) -> f64 {
        // Not a number, of an effect that could not be tested, is no bar.
        self.place(effect.statistic.max(0.0), 0.0).0
    }
}

impl RankedEffect {
    fn beside(&self) -> String {
        let value = if self.statistic.is_nan() {
            "not tested".to_owned()
        } else {
            format!("{:.1}", self.statistic).replace('-', "−")
        };
        if self.note.is_empty() {
            value
        } else {
            format!("{value}, {}", self.note)
        }
    }
}
