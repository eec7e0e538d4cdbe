//! The night of figures: every part at full size on report seeds, in pieces.
//!
//! Results of records, and the figures of a finished part, are kept by the hash of the sources that can move them.
//! A night that was stopped, or another one with the same folder of results on another machine, goes on from there.
//! Each part that is finished renews its section of a page.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use gyrocal_testkit::workspace;

use super::context::{Context, Seeds, Size, Unfinished};
use super::topic::{Part, Topic};
use crate::cost::process_s;
use crate::error::Error;
use crate::figure::Figure;

/// Populations that are listed as the dearest.
const LISTED: usize = 12;

/// How a night is run.
#[derive(clap::Args, Debug)]
pub(crate) struct Night {
    /// A tenth of each population; pages stay as they are.
    #[arg(long)]
    tenth: bool,
    /// Only these topics.
    #[arg(long = "topic", value_name = "TOPIC")]
    topics: Vec<String>,
    /// Begin nothing after so many minutes; the same command goes on from there.
    #[arg(long, value_name = "MINUTES", default_value_t = 60)]
    minutes: u64,
    /// Folder of results.
    #[arg(long, value_name = "FOLDER")]
    results: Option<PathBuf>,
}

impl Night {
    /// Runs the night; the figures of all parts that are finished.
    pub(crate) fn run(&self, topics: &[Topic]) -> Result<Vec<Figure>, Error> {
        let size = if self.tenth { Size::Tenth } else { Size::Full };
        let results = self.results.clone();
        let results = results.unwrap_or_else(|| workspace().join("target/night"));
        let deadline = Instant::now().checked_add(Duration::from_secs(60 * self.minutes));
        let context = Context::new(size, Seeds::Report)
            .kept(results.clone())
            .until(deadline);
        let (mut all, mut open) = (Vec::new(), Vec::new());
        for topic in topics {
            if !self.topics.is_empty() && !self.topics.contains(&topic.name) {
                continue;
            }
            let begin_s = process_s();
            for part in &topic.parts {
                let name = format!("{} --part {}", topic.name, part.name);
                if deadline.is_some_and(|deadline| Instant::now() > deadline) {
                    open.push(name);
                    continue;
                }
                match (part.figures)(&context) {
                    Ok(figures) => {
                        if !self.tenth {
                            topic.write(
                                part,
                                &format!("cargo figures night --topic {}", topic.name),
                                &figures,
                            )?;
                        }
                        all.extend(figures);
                    }
                    Err(error) if error.is::<Unfinished>() => open.push(format!("{name}: {error}")),
                    Err(error) => all.push(unmeasured(topic, part, &error)),
                }
            }
            let name = format!("processor time of {}", topic.name);
            all.push(Figure::note(
                &name,
                format!("{:.0} s", process_s() - begin_s),
            ));
        }
        let [_, full_s] = context.costs().totals();
        let dearest = context.costs().dearest(LISTED).into_iter();
        let dearest: Vec<String> = dearest
            .map(|(name, s)| format!("{name} {:.2}", s / 3600.0))
            .collect();
        let mut hours = Figure::at_most(
            "full size of all populations by their records here",
            16.0,
            full_s / 3600.0,
            "processor hours",
        );
        hours.measured = format!("{}: {}", hours.measured, dearest.join(", "));
        all.push(hours);
        if !open.is_empty() {
            let mut figure = Figure::note("parts that are not finished", open.join("; "));
            figure.holds = Some(false);
            all.push(figure);
        }
        Ok(all)
    }
}

/// A part that ended with an error.
fn unmeasured(topic: &Topic, part: &Part, error: &Error) -> Figure {
    let name = format!("{} --part {}: measured", topic.name, part.name);
    let mut figure = Figure::truth(&name, false);
    figure.measured = format!("no: {error}");
    figure
}
