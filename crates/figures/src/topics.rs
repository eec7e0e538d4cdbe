//! The eight topics: which part measures what. `topics.toml` has what each part is, and what can move it.

use crate::harness::topic::{Introduce, Measure, Topic};
use crate::harness::{Error, Listed};
use crate::{
    any_plant, before, calibration, catalogue, comparison, diagnosis_ground, dialects, embedded,
    facts, field, fleet, gain, generator, house, kernel, logs, measured, naming, paper,
    plant_peers, real_plants, records, report, truth, watch,
};

/// Topic and part, and what measures it.
const MEASURES: [(&str, &str, Measure); 39] = [
    ("kernel", "filter", kernel::figures),
    ("kernel", "generator", generator::figures),
    ("calibration", "estimator", calibration::figures),
    ("calibration", "budget", calibration::budget::figures),
    ("calibration", "paper", paper::figures),
    ("diagnosis", "ground", diagnosis_ground::figures),
    ("diagnosis", "naming", naming::figures),
    ("diagnosis", "comparison", comparison::figures),
    ("diagnosis", "gain", gain::figures),
    ("diagnosis", "setup", truth::setup::figures),
    ("diagnosis", "hostile", truth::hostile::figures),
    ("diagnosis", "shapes", truth::shapes::figures),
    ("diagnosis", "causes", truth::causes::figures),
    ("diagnosis", "walks", truth::noise::of_walks),
    ("diagnosis", "flicker", truth::noise::of_flicker),
    ("diagnosis", "clean", truth::noise::of_clean),
    ("diagnosis", "together", truth::together::figures),
    ("diagnosis", "outside", truth::outside::figures),
    ("diagnosis", "field", field::of_records),
    ("diagnosis", "catalogue", catalogue::figures),
    ("records", "several", records::several::figures),
    ("records", "planning", records::planning::figures),
    ("records", "later", records::later::figures),
    ("instruments", "logs", logs::figures),
    ("instruments", "dialects", dialects::figures),
    ("instruments", "measured", measured::figures),
    ("plants", "simulated", any_plant::figures),
    ("plants", "field", field::of_plants),
    ("plants", "real", real_plants::figures),
    ("plants", "peers", plant_peers::figures),
    ("doors", "structure", house::figures),
    ("doors", "answers", field::of_answers),
    ("doors", "before", before::figures),
    ("doors", "facts", facts::figures),
    ("doors", "numbers", facts::numbers::figures),
    ("doors", "report", report::figures),
    ("doors", "fleet", fleet::figures),
    ("embedded", "controller", embedded::figures),
    ("embedded", "watch", watch::figures),
];

/// Topic and part, and the text above its table, where there is one.
const INTRODUCTIONS: [(&str, &str, Introduce); 3] = [
    ("kernel", "filter", |_| kernel::INTRODUCTION.to_owned()),
    ("kernel", "generator", |_| {
        generator::INTRODUCTION.to_owned()
    }),
    ("diagnosis", "comparison", comparison::side_by_side),
];

/// All topics.
///
/// # Errors
/// If the table lists a part that nothing measures, or cannot be read.
pub(crate) fn topics() -> Result<Vec<Topic>, Error> {
    let mut topics: Listed<Topic> = toml::from_str(include_str!("topics.toml"))?;
    for topic in &mut topics.all {
        for part in &mut topic.parts {
            let is_own = |of: &str, name: &str| of == topic.name && name == part.name;
            let mut measures = MEASURES.iter().filter(|(of, name, _)| is_own(of, name));
            let measure = measures.next().map(|(.., measure)| *measure);
            part.figures = measure.ok_or_else(|| format!("nothing measures `{}`", part.name))?;
            let mut texts = INTRODUCTIONS
                .iter()
                .filter(|(of, name, _)| is_own(of, name));
            part.introduction = texts.next().map(|(.., text)| *text);
        }
    }
    Ok(topics.all)
}
