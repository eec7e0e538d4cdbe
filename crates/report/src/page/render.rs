//! From a page to HTML.

use gyrocal_record::printable;
use minijinja::context;
use serde_json::{Value, json};

use super::chart;
use super::columns::Columns;
use super::decimate::{MOST_ROWS, Row, rows};
use super::strips;
use super::templates::{environment, make_printable, of_words, template};
use crate::error::Error;
use crate::number::{count, readable_unit, with_unit};
use gyrocal_document::{Chart, Item, Page, Panel, Part, Section, Standing};

const STYLES: [&str; 2] = [
    include_str!("../../assets/uplot/uPlot.min.css"),
    include_str!("../../assets/page.css"),
];

const SCRIPTS: [&str; 4] = [
    include_str!("../../assets/uplot/uPlot.iife.min.js"),
    include_str!("../../assets/data.js"),
    include_str!("../../assets/charts.js"),
    include_str!("../../assets/page.js"),
];

/// The page as one HTML file that needs nothing else.
///
/// # Errors
/// [`Error::UnequalLengths`], [`Error::Value`] and [`Error::Empty`] of a chart that cannot be drawn;
/// [`Error::Template`].
pub fn to_html(page: &Page) -> Result<String, Error> {
    let environment = environment()?;
    let mut drawing = Drawing::default();
    let parts = page.parts.iter().enumerate();
    let parts = parts.map(|(place, part)| drawing.part(place, part));
    let parts: Vec<Value> = parts.collect::<Result<_, _>>()?;
    let data = json!({ "columns": drawing.columns.encoded, "charts": drawing.charts });
    let whole = environment.get_template("page.html").map_err(template)?;
    whole
        .render(context! {
            title => printable(&page.title),
            parts => parts,
            data => data,
            styles => STYLES.concat(),
            scripts => SCRIPTS,
        })
        .map_err(template)
}

/// Letter that stands beside the colour of a verdict.
fn sign(standing: Standing) -> &'static str {
    match standing {
        Standing::Good => "✓",
        Standing::Doubtful => "!",
        Standing::Bad => "✕",
        Standing::Neutral => "i",
    }
}

/// Charts and columns of a page.
#[derive(Default)]
struct Drawing {
    columns: Columns,
    charts: Vec<Value>,
}

impl Drawing {
    fn part(&mut self, place: usize, part: &Part) -> Result<Value, Error> {
        let sections = part.sections.iter();
        let sections = sections.map(|section| self.section(place, section));
        let sections: Vec<Value> = sections.collect::<Result<_, _>>()?;
        let mut shown = json!({
            "id": format!("part-{}", place + 1),
            "name": part.name,
            "size": part.size,
            "sign": sign(part.first.standing),
            "first": part.first,
            "sections": sections,
            "origin": part.origin,
        });
        make_printable(&mut shown);
        Ok(shown)
    }

    fn section(&mut self, place: usize, section: &Section) -> Result<Value, Error> {
        let items = section.items.iter().map(|item| self.item(item));
        let items: Vec<Value> = items.collect::<Result<_, _>>()?;
        Ok(json!({
            "id": format!("p{}-{}", place + 1, section.id),
            "title": section.title,
            "lead": section.lead,
            "items": items,
        }))
    }

    fn item(&mut self, item: &Item) -> Result<Value, Error> {
        Ok(match item {
            Item::Words(words) => of_words(words),
            Item::Bars(bars) => json!({ "kind": "bars", "bars": strips::bars(bars) }),
            Item::Estimates(estimates) => {
                json!({ "kind": "estimates", "estimates": strips::estimates(estimates) })
            }
            Item::Chart(chart) => {
                chart::check(chart)?;
                json!({ "kind": "chart", "chart": self.chart(chart) })
            }
            _ => json!({ "kind": "none" }),
        })
    }

    /// What the template needs of a chart; what the script needs is stored.
    fn chart(&mut self, chart: &Chart) -> Value {
        let id = format!("chart-{}", self.charts.len() + 1);
        let of_all = chart.panels.iter().map(Panel::largest).fold(0.0, f64::max);
        let largest = |panel: &Panel| match panel.unit {
            Some(_) => panel.largest(),
            None => of_all,
        };
        let scaled = |panel: &Panel| match chart.logarithmic {
            true => (1.0, chart.unit_of(panel).to_owned()),
            false => readable_unit(chart.unit_of(panel), largest(panel)),
        };
        let panels = || chart.panels.iter().zip(chart::halves(chart));
        let drawn_panels = panels().map(|(panel, half)| {
            let (factor, unit) = scaled(panel);
            let mut drawn = self.panel(panel, factor, &unit);
            drawn["abscissaTitle"] = abscissa_title(chart, panel).into();
            drawn["half"] = half.map(|half| factor * half).into();
            drawn
        });
        let drawn_panels: Vec<Value> = drawn_panels.collect();
        let mut drawn = json!({
            "id": &id,
            "quantity": chart.quantity,
            "logX": chart.logarithmic_abscissa,
            "logY": chart.logarithmic,
            "sameScale": chart.same_scale,
            "linked": !chart.unlinked,
            "height": chart.height_px,
            "panels": drawn_panels,
        });
        make_printable(&mut drawn);
        self.charts.push(drawn);
        let rows = chart.panels.iter().map(|panel| panel.abscissa.len());
        let most = rows.max().unwrap_or(0);
        json!({
            "id": id,
            "title": chart.title,
            "caption": chart.caption,
            "columns": chart.columns,
            "height": chart.height_px,
            "panels": panels().map(|(panel, half)| description(chart, panel, half)).collect::<Vec<_>>(),
            "legend": legend(chart),
            "decimated": (most > MOST_ROWS).then(|| count(most)),
        })
    }

    fn panel(&mut self, panel: &Panel, factor: f64, unit: &str) -> Value {
        let kept = rows(&panel.abscissa, panel.columns(), panel.no_gaps);
        let mut column = |values: &[f64], factor: f64, broken: bool| {
            self.columns.add(kept.iter().map(|row| match *row {
                Row::Of(row) => factor * values[row],
                Row::Break(at) if !broken => at,
                Row::Break(_) => f64::NAN,
            }))
        };
        let abscissa = column(&panel.abscissa, 1.0, false);
        let mut bands = Vec::new();
        for band in &panel.bands {
            bands.push(json!({
                "label": band.label,
                "tint": band.tint,
                "lower": column(&band.lower, factor, true),
                "upper": column(&band.upper, factor, true),
            }));
        }
        let mut lines = Vec::new();
        for line in &panel.lines {
            lines.push(json!({
                "label": line.label,
                "tint": line.tint,
                "kind": line.kind,
                "values": column(&line.values, factor, true),
            }));
        }
        let level = |label: &str, value: f64| json!({ "label": label, "value": value });
        let levels = panel.levels.iter();
        let levels = levels.map(|one| level(&one.label, factor * one.value));
        let marks = panel.marks.iter().map(|one| level(&one.label, one.value));
        json!({
            "name": panel.name,
            "unit": unit,
            "abscissa": abscissa,
            "bands": bands,
            "lines": lines,
            "levels": levels.collect::<Vec<_>>(),
            "marks": marks.collect::<Vec<_>>(),
            "scaleFrom": panel.scale_from,
        })
    }
}

fn abscissa_title(chart: &Chart, panel: &Panel) -> String {
    let (quantity, unit) = chart.abscissa_of(panel);
    with_unit(quantity, unit)
}

/// Name, note and the text for those who do not see the picture.
fn description(chart: &Chart, panel: &Panel, half: Option<f64>) -> Value {
    let note = chart::note(chart, panel, half);
    let lines = panel.lines.iter().map(|line| &*line.label);
    let shown: Vec<&str> = lines.collect();
    json!({
        "name": panel.name,
        "label": format!(
            "{}: {} against {}. {}. {note}",
            panel.name,
            shown.join(", "),
            abscissa_title(chart, panel),
            chart.title,
        ),
        "note": note,
    })
}

/// The entries of the legend of a chart, each once.
fn legend(chart: &Chart) -> Vec<Value> {
    let mut entries: Vec<Value> = Vec::new();
    for panel in &chart.panels {
        let lines = panel.lines.iter();
        let lines =
            lines.map(|line| json!({ "label": line.label, "tint": line.tint, "kind": line.kind }));
        let bands = panel.bands.iter();
        let bands =
            bands.map(|band| json!({ "label": band.label, "tint": band.tint, "kind": "band" }));
        let levels = panel.levels.iter();
        let levels = levels
            .map(|level| json!({ "label": level.label, "tint": "expected", "kind": "dashed" }));
        for entry in lines.chain(bands).chain(levels) {
            if entry["label"] != "" && !entries.contains(&entry) {
                entries.push(entry);
            }
        }
    }
    entries
}

#[cfg(test)]
mod tests {
    use super::super::templates::words_to_html;
    use super::*;
    use gyrocal_document::{
        Bar, BarGroup, Bars, Column, Fact, Line, LineKind, List, Origin, Screen, Table, Tint, Words,
    };

    /// A text that a page must neither obey nor drop.
    const HOSTILE: &str = "</script><own-tag>\u{202e}\u{7}";

    fn chart() -> Chart {
        let own = || HOSTILE.to_owned();
        Chart {
            title: own(),
            abscissa: own(),
            quantity: own(),
            unit: own(),
            columns: 1,
            height_px: 100,
            panels: vec![Panel {
                name: own(),
                abscissa: vec![0.0, 1.0],
                lines: vec![Line::new(
                    HOSTILE,
                    Tint::Measured,
                    LineKind::Solid,
                    vec![0.0, 1.0],
                )],
                ..Panel::default()
            }],
            ..Chart::default()
        }
    }

    #[test]
    fn words_alone_are_escaped_too() {
        let own = || HOSTILE.to_owned();
        let pieces = [
            Words::Paragraph(own()),
            Words::Command(own()),
            Words::List(List {
                title: own(),
                entries: vec![own()],
            }),
            Words::Table(Table::new(HOSTILE, vec![Column::words(HOSTILE)], [[own()]])),
        ];
        let html = words_to_html(&pieces).unwrap();
        assert!(
            !html.contains("own-tag>") && !html.contains('\u{202e}'),
            "{html}"
        );
        // Command, paragraph, title and entry of the list, title, head and cell of the table.
        assert_eq!(html.matches("own-tag&gt;").count(), 7, "{html}");
    }

    #[test]
    fn no_text_becomes_markup_or_is_hidden() {
        let own = || HOSTILE.to_owned();
        let bar = Bar {
            label: own(),
            value: 1.0,
            tint: Tint::Other,
            note: own(),
        };
        let groups = vec![BarGroup::new(HOSTILE, [bar])];
        let bars = Bars {
            threshold: Some((1.0, own())),
            omitted: own(),
            ..Bars::new(HOSTILE, HOSTILE, groups)
        };
        let items = vec![
            Item::text(own()),
            Item::command(own()),
            Item::from(List {
                title: own(),
                entries: vec![own()],
            }),
            Item::Bars(bars),
            Item::Chart(chart()),
        ];
        let part = Part {
            name: own(),
            size: own(),
            first: {
                let mut first = Screen::new(Standing::Neutral, HOSTILE, HOSTILE);
                first.fact(HOSTILE, HOSTILE);
                first.then(HOSTILE, HOSTILE);
                first
            },
            sections: vec![Section {
                id: "own".to_owned(),
                title: own(),
                lead: own(),
                items,
            }],
            origin: Origin {
                command: own(),
                identification: vec![Fact {
                    label: own(),
                    words: own(),
                }],
                foot: own(),
                ..Origin::default()
            },
        };
        let page = Page {
            title: own(),
            parts: vec![part],
        };
        let html = to_html(&page).unwrap();
        assert!(html.contains("&lt;own-tag&gt;\\u{202e}\\u{7}"));
        let (identity, _) = html.split_once("class=\"verdict").unwrap();
        let (_, identity) = identity.rsplit_once("class=\"identity").unwrap();
        assert_eq!(identity.matches("own-tag&gt;").count(), 2, "{identity}");
        for hostile in ["<own-tag>", "\u{202e}", "\u{7}"] {
            assert!(!html.contains(hostile), "{hostile:?}");
        }
    }
}
