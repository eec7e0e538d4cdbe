//! The terms of the catalogue that a written diagnosis extends a plant by, and their place in its script.

use gyrocal_answer::Answer;

use crate::catalogue::KNEE;
use crate::description::Kind;
use crate::error::PlantError;
use crate::loaded::LoadedPlant;

/// A term of the equations.
#[derive(Clone, Debug, PartialEq)]
pub struct ExtensionTerm {
    /// Id of the effect.
    pub effect: String,
    /// Its estimated size.
    pub value: f64,
    /// Standard deviation of the size; `None` where it has only an interval.
    pub sigma: Option<f64>,
    /// Where it bends, of a term that has a knee.
    pub knee: Option<f64>,
}

/// What a diagnosis extends a plant by.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extension {
    /// Terms for the equations.
    pub terms: Vec<ExtensionTerm>,
    /// Findings that are none, with the reason.
    pub left_out: Vec<(String, &'static str)>,
}

impl Extension {
    /// The findings of a diagnosis of this plant that are terms of its catalogue. Functions of time are
    /// none: they belong to the record and not to the equations.
    #[must_use]
    pub fn of(plant: &LoadedPlant, answer: &Answer) -> Self {
        let mut extension = Self::default();
        for finding in &answer.findings {
            let mut effects = plant.description.effects.iter();
            let entry = effects.find(|entry| entry.id == finding.effect);
            let size = finding.parameters.first();
            match (entry.map(|entry| entry.kind), size) {
                (Some(kind), Some(size)) if kind.is_of_the_model() => {
                    extension.terms.push(ExtensionTerm {
                        effect: finding.effect.clone(),
                        value: size.estimate,
                        sigma: size.sigma,
                        knee: finding
                            .parameters
                            .iter()
                            .find(|own| own.name == KNEE)
                            .map(|own| own.estimate),
                    })
                }
                (kind, _) => {
                    let why = match kind {
                        None => "is no effect of this plant's catalogue",
                        Some(Kind::Play) => {
                            "is play of an input, which is no term of the equations"
                        }
                        Some(_) => "is a function of time, which is no term of the equations",
                    };
                    extension.left_out.push((finding.effect.clone(), why));
                }
            }
        }
        extension
    }
}

impl Extension {
    /// The script of a plant with these terms: a call `plant.extend("ID", SIZE)` of each before
    /// `plant.write()`. A term that the script extends already keeps its line. `origin` names the script.
    ///
    /// # Errors
    /// [`PlantError::Input`] if it has no line `NAME.write(…)`.
    pub fn script(&self, script: &str, origin: &str) -> Result<String, PlantError> {
        let call = script.lines().enumerate().find_map(|(index, line)| {
            let words = line.trim_start();
            let (name, _) = words.split_once(".write(")?;
            is_name(name).then(|| (index, &line[..line.len() - words.len()], name))
        });
        let (place, indent, name) = call.ok_or_else(|| PlantError::Input {
            origin: origin.to_owned(),
            problem: "no line calls `write()` of the plant".to_owned(),
            advice: "end the script with `plant.write()`".to_owned(),
        })?;
        let mut text = String::new();
        for (index, line) in script.lines().enumerate() {
            if index == place {
                for term in &self.terms {
                    let start = format!("{name}.extend(\"{}\"", term.effect);
                    if !script.contains(&start) {
                        let value = rounded(term.value, 6);
                        let sigma = term.sigma.map(|own| format!("  # ± {}", rounded(own, 2)));
                        let sigma = sigma.unwrap_or_default();
                        let knee = term.knee.map(|knee| format!(", knee={}", rounded(knee, 6)));
                        let knee = knee.unwrap_or_default();
                        text += &format!("{indent}{start}, {value}{knee}){sigma}\n");
                    }
                }
            }
            text += line;
            text.push('\n');
        }
        Ok(text)
    }
}

fn is_name(name: &str) -> bool {
    let mut letters = name.chars();
    let begins = letters.next();
    begins.is_some_and(|one| one.is_alphabetic() || one == '_')
        && letters.all(|one| one.is_alphanumeric() || one == '_')
}

/// A number to so many significant digits.
fn rounded(value: f64, digits: usize) -> f64 {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    text.parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_come_before_the_program_is_written() {
        let script = "p = Plant()\nif __name__ == \"__main__\":\n    p.write()\n";
        let extension = Extension {
            terms: vec![ExtensionTerm {
                effect: "v_rate.x^3".to_owned(),
                value: -0.050_142_37,
                sigma: Some(4.612e-4),
                knee: None,
            }],
            left_out: Vec::new(),
        };
        let text = extension.script(script, "plant.py").unwrap();
        assert_eq!(
            text,
            "p = Plant()\nif __name__ == \"__main__\":\n    p.extend(\"v_rate.x^3\", -0.0501424)  # ± \
             0.00046\n    p.write()\n"
        );
        assert_eq!(extension.script(&text, "plant.py").unwrap(), text);
        let error = extension.script("p = Plant()\n", "plant.py").unwrap_err();
        assert!(error.to_string().contains("end the script with"), "{error}");
    }
}
