//! The night of figures: every part at full size on report seeds, in pieces.
//!
//! Results of records, and the figures of a finished part, are kept by the hash of the sources that can move them.
//! A night that was stopped, or another one with the same folder of results on another machine, goes on from there.
//! Each part that is finished renews its section of a page.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use gyrocal_testkit::workspace;

use super::context::{Context, Seeds, Size, Unfinished};
use super::topic::Topic;
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
        let context = Context {
            store: results.or_else(|| Some(workspace().join("target/night"))),
            deadline: Instant::now().checked_add(Duration::from_secs(60 * self.minutes)),
            ..Context::new(size, Seeds::Report)
        };
        let (mut all, mut open) = (Vec::new(), Vec::new());
        for topic in topics {
            if !self.topics.is_empty() && !self.topics.contains(&topic.name) {
                continue;
            }
            let begin_s = process_s();
            for part in &topic.parts {
                let name = format!("{} --part {}", topic.name, part.name);
                if context.is_over() {
                    open.push(name);
                    continue;
                }
                match (part.figures)(&context) {
                    Ok(figures) => {
                        if !self.tenth {
                            let command = format!("cargo figures night --topic {}", topic.name);
                            topic.write(part, &command, &figures)?;
                        }
                        all.extend(figures);
                    }
                    Err(error) if error.is::<Unfinished>() => open.push(format!("{name}: {error}")),
                    Err(error) => {
                        let name = format!("{name}: measured");
                        all.push(Figure::told(&name, "yes", format!("no: {error}"), false));
                    }
                }
            }
            let name = format!("processor time of {}", topic.name);
            let seconds = process_s() - begin_s;
            all.push(Figure::note(&name, format!("{seconds:.0} s")));
        }
        let dearest = context.dearest();
        let full_h = dearest.iter().map(|(_, s)| s).sum::<f64>() / 3600.0;
        let dearest = dearest.iter().take(LISTED);
        let dearest = dearest.map(|(name, s)| format!("{name} {:.2}", s / 3600.0));
        let name = "full size of all populations by their records here";
        let mut hours = Figure::at_most(name, 16.0, full_h, "processor hours");
        hours.measured += &format!(": {}", dearest.collect::<Vec<_>>().join(", "));
        all.push(hours);
        if !open.is_empty() {
            let name = "parts that are not finished";
            all.push(Figure::told(name, "", open.join("; "), false));
        }
        Ok(all)
    }
}
