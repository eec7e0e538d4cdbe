//! Columns of messages in files of MCAP. Messages are JSON, or those of ROS 1 and ROS 2, which carry their
//! definitions; a column is a field by its path, as `linear_acceleration.x`.

use std::collections::HashMap;
use std::io::Read;
use std::path::Path;

use gyrocal_record::{Error, open_content};
use mcap::McapError;
use mcap::records::{Channel, MessageHeader, Record};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use serde_json::Value;

use crate::cell::{Cell, OwnedCell, TakeCells, no_column, unfit};
use crate::error::InstrumentError;
use crate::ros_message::RosMessage;

/// Columns beside the fields of a message: its topic, and when it was logged and published.
const TOPIC: &str = "topic";
const LOG_TIME: &str = "log_time";
const PUBLISH_TIME: &str = "publish_time";

/// Longest part of a file that is taken into memory, bytes; messages are shorter.
const LONGEST: usize = 1 << 28;

/// Most names of fields that an error lists of a topic.
const LISTED: usize = 20;

/// Hands the cells of the columns `names` of each message that has them to `take`, in the order of the file; a
/// chunk of it is in memory at a time.
pub(crate) fn read(
    path: &Path,
    names: &[&str],
    take: &mut TakeCells<'_>,
) -> Result<(), InstrumentError> {
    let damaged = |reason: McapError| {
        let found = format!("what no reader of MCAP accepts ({reason})");
        let advice = "copy the file again; `mcap recover` of its project saves what is whole";
        unfit(&found, "a whole file", advice)
    };
    let mut content = open_content(path)?;
    let options = LinearReaderOptions::default().with_record_length_limit(LONGEST);
    let mut reader = LinearReader::new_with_options(options);
    let mut messages = Messages {
        names,
        schemas: HashMap::new(),
        topics: HashMap::new(),
        read: None,
    };
    while let Some(event) = reader.next_event() {
        match event.map_err(damaged)? {
            LinearReadEvent::ReadRequest(wanted) => {
                let read = content.read(reader.insert(wanted));
                let read = read.map_err(|reason| Error::Unreadable {
                    path: path.to_owned(),
                    reason,
                })?;
                reader.notify_read(read);
            }
            LinearReadEvent::Record { data, opcode } => {
                let record = mcap::parse_record(opcode, data).map_err(damaged)?;
                messages.add(record, take)?;
            }
        }
    }
    messages.finished()
}

/// Channels of a file so far.
struct Messages<'a> {
    names: &'a [&'a str],
    /// Encoding and definition of each schema.
    schemas: HashMap<u16, (String, Vec<u8>)>,
    topics: HashMap<u16, Topic>,
    /// The topic whose messages are the rows.
    read: Option<String>,
}

/// A channel.
struct Topic {
    name: String,
    encoding: Encoding,
    /// Whether a message had the columns.
    fits: bool,
    /// Names of its fields.
    fields: Vec<String>,
}

/// How the messages of a channel are written.
enum Encoding {
    Json,
    Ros(RosMessage),
    Other(String),
}

impl Messages<'_> {
    fn add(&mut self, record: Record<'_>, take: &mut TakeCells<'_>) -> Result<(), InstrumentError> {
        match record {
            Record::Schema { header, data } => {
                let schema = (header.encoding, data.into_owned());
                self.schemas.entry(header.id).or_insert(schema);
            }
            // The summary has them again.
            Record::Channel(channel) if !self.topics.contains_key(&channel.id) => {
                let topic = self.topic(&channel);
                self.topics.insert(channel.id, topic);
            }
            Record::Message { header, data } => self.message(&header, &data, take)?,
            _ => {}
        }
        Ok(())
    }

    fn topic(&self, channel: &Channel) -> Topic {
        let schema = self.schemas.get(&channel.schema_id);
        let definition = schema.map(|(kind, text)| (&**kind, String::from_utf8_lossy(text)));
        let ros = match (&*channel.message_encoding, &definition) {
            ("cdr", Some(("ros2msg", text))) => RosMessage::of(text, self.names, true),
            ("ros1", Some(("ros1msg", text))) => RosMessage::of(text, self.names, false),
            _ => None,
        };
        let fields = ros.as_ref().map_or(Vec::new(), RosMessage::names);
        let encoding = match (&*channel.message_encoding, ros) {
            ("json", _) => Encoding::Json,
            (_, Some(ros)) => Encoding::Ros(ros),
            (other, None) => Encoding::Other(other.to_owned()),
        };
        let is_of_message = |name: &str| ![TOPIC, LOG_TIME, PUBLISH_TIME].contains(&name);
        let mut wanted = self.names.iter().filter(|name| is_of_message(name));
        let fits = wanted.all(|name| fields.iter().any(|field| field == name));
        Topic {
            name: channel.topic.clone(),
            encoding,
            fits,
            fields,
        }
    }

    fn message(
        &mut self,
        header: &MessageHeader,
        data: &[u8],
        take: &mut TakeCells<'_>,
    ) -> Result<(), InstrumentError> {
        let Some(topic) = self.topics.get_mut(&header.channel_id) else {
            return Ok(());
        };
        let damaged = || {
            let found = format!("a message on `{}` that is not whole", topic.name);
            unfit(&found, "a message as its definition says", "")
        };
        let of_fields = match &topic.encoding {
            Encoding::Json => {
                let value: Value = serde_json::from_slice(data).map_err(|_| damaged())?;
                let found: Vec<Option<OwnedCell>> = self
                    .names
                    .iter()
                    .map(|name| of_json(&value, name))
                    .collect();
                if !topic.fits {
                    let mut all = self.names.iter().zip(&found);
                    topic.fits = all.all(|(name, value)| value.is_some() || is_stamp(name));
                    topic.fields = keys(&value);
                }
                found
            }
            Encoding::Ros(message) if topic.fits => {
                message.values(data, self.names.len()).ok_or_else(damaged)?
            }
            _ => return Ok(()),
        };
        if !topic.fits {
            return Ok(());
        }
        if !self.names.contains(&TOPIC) {
            match &self.read {
                Some(other) if *other != topic.name => {
                    return Err(two_topics([other, &topic.name]));
                }
                Some(_) => {}
                None => self.read = Some(topic.name.clone()),
            }
        }
        let values: Vec<OwnedCell> = self
            .names
            .iter()
            .zip(of_fields)
            .map(|(name, value)| match (value, *name) {
                (Some(value), _) => value,
                (None, TOPIC) => OwnedCell::Text(topic.name.clone()),
                (None, LOG_TIME) => OwnedCell::Seconds(header.log_time as f64 * 1e-9),
                (None, PUBLISH_TIME) => OwnedCell::Seconds(header.publish_time as f64 * 1e-9),
                (None, _) => OwnedCell::Missing,
            })
            .collect();
        let cells: Vec<Cell<'_>> = values.iter().map(OwnedCell::cell).collect();
        take(&cells)
    }

    /// The error of a file none of whose topics has the columns.
    fn finished(self) -> Result<(), InstrumentError> {
        if self.topics.values().any(|topic| topic.fits) {
            return Ok(());
        }
        let mut topics: Vec<&Topic> = self.topics.values().collect();
        topics.sort_by(|one, other| one.name.cmp(&other.name));
        let list: Vec<String> = topics.into_iter().map(Topic::described).collect();
        let missing = self.names.iter().find(|name| {
            let mut fields = self.topics.values().flat_map(|topic| &topic.fields);
            !is_stamp(name) && !fields.any(|field| field == *name)
        });
        let missing = missing.or(self.names.first()).copied().unwrap_or_default();
        Err(no_column(missing, &list.join("; ")))
    }
}

impl Topic {
    /// Its name and fields; of an array the first element stands for all.
    fn described(&self) -> String {
        let place = |name: &str| name.rsplit('.').next()?.parse::<usize>().ok();
        let later = |name: &&String| place(name).is_some_and(|at| at > 0);
        let names = self.fields.iter().filter(|name| !later(name));
        let names: Vec<String> = names
            .map(|name| match place(name) {
                Some(_) => format!("{name} and on"),
                None => name.clone(),
            })
            .collect();
        let fields = match &self.encoding {
            Encoding::Other(encoding) => format!("{encoding}: only JSON and ROS are read"),
            _ if names.len() > LISTED => format!("{}, …", names[..LISTED].join(", ")),
            _ => names.join(", "),
        };
        format!("of topic {} ({fields})", self.name)
    }
}

fn is_stamp(name: &str) -> bool {
    [TOPIC, LOG_TIME, PUBLISH_TIME].contains(&name)
}

fn two_topics([one, other]: [&str; 2]) -> InstrumentError {
    unfit(
        &format!("the columns on the topics `{one}` and `{other}`"),
        "one of them",
        &format!(
            "add `only = {{ column = \"{TOPIC}\", equals = \"{one}\" }}` to `[file]` of the map"
        ),
    )
}

/// The value at a path of keys and places.
fn of_json(value: &Value, name: &str) -> Option<OwnedCell> {
    let mut at = value;
    for key in name.split('.') {
        at = match at {
            Value::Array(items) => items.get(key.parse::<usize>().ok()?)?,
            other => other.get(key)?,
        };
    }
    Some(match at {
        Value::Number(number) => OwnedCell::Number(number.as_f64()?),
        Value::String(text) => OwnedCell::Text(text.clone()),
        Value::Null => OwnedCell::Missing,
        Value::Object(parts) => {
            let part = |names: [&str; 2]| names.iter().find_map(|name| parts.get(*name)?.as_f64());
            let nanoseconds = part(["nsec", "nanosec"])?;
            OwnedCell::Seconds(part(["sec", "secs"])? + nanoseconds * 1e-9)
        }
        Value::Bool(_) | Value::Array(_) => return None,
    })
}

/// Paths of the values in a message.
fn keys(value: &Value) -> Vec<String> {
    let below = |key: &str, value: &Value| -> Vec<String> {
        match keys(value) {
            inner if inner.is_empty() => vec![key.to_owned()],
            inner => inner.iter().map(|name| format!("{key}.{name}")).collect(),
        }
    };
    match value {
        Value::Object(parts) => parts.iter().flat_map(|(key, it)| below(key, it)).collect(),
        Value::Array(items) => {
            let items = items.iter().take(LISTED).enumerate();
            items
                .flat_map(|(at, it)| below(&at.to_string(), it))
                .collect()
        }
        _ => Vec::new(),
    }
}
