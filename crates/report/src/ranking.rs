//! Effects by test statistic.

use crate::axes::{Axes, Labels};
use crate::axis::Axis;
use crate::canvas::{Align, Canvas, LineStyle, TextStyle};
use crate::check;
use crate::error::Error;
use crate::figure::{Legend, figure};
use crate::geometry::Rect;
use crate::number::{count, percent, short};
use crate::picture::Picture;
use crate::span::Span;
use crate::style::{
    BELOW, BLACK, BODY, Colour, GREY, INK, MARGIN, ORANGE, SMALL, THIN, VERMILION, WHITE, WIDTH,
};
use crate::text;

/// Bars of a test statistic by effect, in groups: each reported effect with its alternatives, and
/// the rest; with the detection threshold.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranking {
    /// Main statement of the picture.
    pub title: String,
    /// Further description; may be empty.
    pub subtitle: String,
    /// Name of the statistic: `|z|`.
    pub statistic: String,
    /// Detection threshold of the largest statistic.
    pub threshold: f64,
    /// Probability that any effect exceeds the threshold in a record without effects.
    pub false_alarm_probability: f64,
    /// Number of effects that were tested.
    pub tested: usize,
    /// Groups from top to bottom.
    pub groups: Vec<RankingGroup>,
    /// Effects that are not shown.
    pub omitted: Option<Omitted>,
}

/// A group of bars.
#[derive(Clone, Debug, PartialEq)]
pub struct RankingGroup {
    /// Heading of the group: `finding 1, 95% confidence set`.
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
    /// Its role in the result.
    pub role: Role,
    /// Text beside the bar; may be empty: `log likelihood lower by 3.6 nats`.
    pub note: String,
}

/// The role of an effect in the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Reported as detected.
    Reported,
    /// An alternative to a reported effect: in its confidence set, or exactly equivalent.
    Alternative,
    /// Neither.
    Other,
}

/// Effects left out of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Omitted {
    /// Number of effects.
    pub effects: usize,
    /// The largest statistic among them.
    pub largest: f64,
}

/// Height of a bar with its gap, of the heading of a group, and of the gap after a group, px.
const BAR_PITCH: f64 = 19.0;
const GROUP_HEAD: f64 = 22.0;
const GROUP_GAP: f64 = 6.0;

impl Role {
    const ALL: [Self; 3] = [Self::Reported, Self::Alternative, Self::Other];

    fn colour(self) -> Colour {
        match self {
            Self::Reported => VERMILION,
            Self::Alternative => ORANGE,
            Self::Other => GREY,
        }
    }

    fn label(self) -> &'static str {
        match self {
            Self::Reported => "reported",
            Self::Alternative => "alternative, not distinguishable from the reported effect",
            Self::Other => "not reported",
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
        Ok(figure(
            &self.title,
            &self.subtitle,
            &self.legend(),
            bars + omitted + BELOW,
            |canvas, body| self.draw(canvas, body, omitted),
        ))
    }
}

impl Ranking {
    fn check(&self) -> Result<(), Error> {
        check::non_empty("the list of groups of effects", &self.groups)?;
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

    fn legend(&self) -> Vec<Legend> {
        let mut legend: Vec<Legend> = Role::ALL
            .into_iter()
            .filter(|role| self.effects().any(|effect| effect.role == *role))
            .map(|role| Legend::area(role.colour(), 1.0, role.label()))
            .collect();
        let threshold = format!(
            "detection threshold {} (false-alarm probability {} over {} effects)",
            short(self.threshold, 3),
            percent(self.false_alarm_probability),
            count(self.tested)
        );
        legend.push(Legend::line(LineStyle::dashed(BLACK, THIN), threshold));
        legend
    }

    fn draw(&self, canvas: &mut Canvas, body: Rect, omitted_px: f64) {
        let widths = self.effects();
        let widths = widths.map(|effect| text::width_px(&effect.effect, BODY, true));
        let names_px = widths.fold(60.0, f64::max).min(0.4 * body.width());
        let axes = self.axes(body, body.left + names_px + 14.0, omitted_px);
        if let Some(omitted) = self.omitted {
            let words = format!(
                "{} more effects are not shown; the largest {} among them is {}",
                count(omitted.effects),
                self.statistic,
                short(omitted.largest, 2)
            );
            let style = TextStyle::new(SMALL, Align::Start).colour(INK);
            canvas.text(&words, (body.left, body.bottom - 8.0), style);
        }
        let labels = Labels {
            name: "",
            note: "",
            abscissa: true,
            ordinate_title: false,
        };
        axes.draw(canvas, labels, true, |axes, canvas| {
            for (effect, y) in self.rows(body.top) {
                effect.draw_bar(canvas, axes, y);
            }
            axes.vertical_line(canvas, self.threshold, LineStyle::dashed(BLACK, THIN));
            for (effect, y) in self.rows(body.top) {
                effect.draw_text(canvas, axes, y, names_px);
            }
        });
        self.draw_headings(canvas, body, axes.frame.left);
    }

    /// Axes as wide as the text beside the bars allows.
    fn axes(&self, body: Rect, left: f64, omitted_px: f64) -> Axes {
        let statistics = self.effects().map(|effect| effect.statistic);
        let most = Span::of(statistics.chain([1.15 * self.threshold]));
        let most = most.map_or(1.0, |span| span.hi);
        let widths = self.effects().map(|effect| {
            let beside = text::width_px(&effect.beside(), SMALL, false);
            let part = (effect.statistic.max(0.0) / (1.02 * most)).max(1e-3);
            (body.right - left - beside - 8.0) / part
        });
        let width = widths.fold(body.right - left, f64::min);
        let abscissa = Span {
            lo: 0.0,
            hi: 1.02 * most,
        };
        Axes {
            frame: Rect {
                left,
                top: body.top,
                right: left + width.max(0.3 * (body.right - left)),
                bottom: body.bottom - BELOW - omitted_px,
            },
            x: Axis::linear(abscissa, &self.statistic, "", 8),
            y: Axis::named(Span { lo: 0.0, hi: 1.0 }, Vec::new(), ""),
        }
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

    fn draw_headings(&self, canvas: &mut Canvas, body: Rect, axis: f64) {
        let mut y = body.top;
        for group in &self.groups {
            let heading = text::fit(&group.label, BODY, true, body.width());
            // A white ground keeps axis, grid and threshold out of the letters.
            let right = body.left + text::width_px(&heading, BODY, true) + 6.0;
            if right > axis {
                canvas.rect((body.left, y), (right, y + GROUP_HEAD), WHITE, 1.0);
            }
            let style = TextStyle::new(BODY, Align::Start).bold().colour(INK);
            canvas.text(&heading, (body.left, y + 0.5 * GROUP_HEAD), style);
            y += GROUP_HEAD + BAR_PITCH * group.effects.len() as f64 + GROUP_GAP;
        }
    }
}

impl RankedEffect {
    fn draw_bar(&self, canvas: &mut Canvas, axes: &Axes, y: f64) {
        let half = 0.5 * BAR_PITCH - 3.5;
        let foot = (axes.frame.left, y - half);
        let tip = (self.tip(axes), y + half);
        canvas.rect(foot, tip, self.role.colour(), 1.0);
    }

    /// The name left of the axis, and statistic and note right of the bar.
    fn draw_text(&self, canvas: &mut Canvas, axes: &Axes, y: f64, names_px: f64) {
        let mut style = TextStyle::new(BODY, Align::End);
        style.bold = self.role == Role::Reported;
        let name = text::fit(&self.effect, BODY, style.bold, names_px);
        canvas.text(&name, (axes.frame.left - 8.0, y), style);
        let start = self.tip(axes) + 6.0;
        let beside = text::fit(&self.beside(), SMALL, false, WIDTH - MARGIN - start);
        let end = start + text::width_px(&beside, SMALL, false);
        canvas.rect((start - 2.0, y - 6.0), (end + 2.0, y + 6.0), WHITE, 1.0);
        let style = TextStyle::new(SMALL, Align::Start).colour(INK);
        canvas.text(&beside, (start, y), style);
    }

    /// The right end of the bar, px; an effect that could not be tested has no bar.
    fn tip(&self, axes: &Axes) -> f64 {
        axes.point(self.statistic.max(0.0), 0.0).0
    }

    /// The text right of the bar.
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
