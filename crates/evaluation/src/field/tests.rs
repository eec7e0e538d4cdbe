use std::collections::BTreeSet;

use gyrocal_record::{GimbalLimits, Gravity, SiteUncertainty};
use toml::Value;

use super::judge::{Name, is_physical};
use super::keys::EXEMPT;
use super::records::clean;
use super::*;

#[test]
fn populations_have_names_and_seeds_of_their_own() {
    let mut all = FieldPopulation::wrong_keys().unwrap();
    assert!(all.len() >= 60);
    // The tables do not run into each other.
    assert!(all.len() as u64 * APART <= KINDS - KEYS);
    assert!(FieldKind::ALL.len() as u64 * APART <= PLANTS - KINDS);
    all.extend(FieldPopulation::kinds().unwrap());
    let names: BTreeSet<&str> = all.iter().map(|one| &*one.name).collect();
    let seeds: BTreeSet<u64> = all.iter().map(|one| one.first_seed).collect();
    assert_eq!((names.len(), seeds.len()), (all.len(), all.len()));
}

fn wrong_keys() -> Vec<WrongKey> {
    WrongKey::all(&Table::read().unwrap())
}

/// Every number that a bench file can have, by table and key.
fn numeric_keys() -> BTreeSet<String> {
    let mut bench = clean(1, 0).bench();
    // Without `..`: a new field of a bench fails here to build.
    let Bench {
        identification: _,
        latitude_deg: _,
        gravity,
        uncertainty,
        magnetic_field_gauss,
        initial_angles_deg,
        initial_angles_sigma_deg: _,
        gimbal_limits,
        accel_noise_g: _,
        gyro_noise_deg_per_h: _,
        prior,
    } = &mut bench;
    assert!(initial_angles_deg.is_some());
    *magnetic_field_gauss = Some([0.2; 3]);
    *gravity = Some(Gravity {
        local_m_per_s2: 9.8,
        unit_m_per_s2: 9.8,
    });
    *uncertainty = SiteUncertainty {
        latitude_sigma_deg: Some(1e-3),
        earth_rate_relative_sigma: Some(1e-8),
        gravity_relative_sigma: Some(1e-6),
    };
    *gimbal_limits = GimbalLimits {
        deg: [Some([-90.0, 90.0]); 3],
    };
    prior.bias_sigma_deg_per_h = [2.0; 3];
    let text = bench.to_toml("bench.toml".as_ref()).unwrap();
    let file: toml::Table = text.parse().unwrap();
    let mut keys = BTreeSet::new();
    for (table, entries) in &file {
        for (key, value) in entries.as_table().unwrap() {
            assert!(matches!(value, Value::Float(_) | Value::Array(_)), "{key}");
            keys.insert(format!("{table}.{key}"));
        }
    }
    keys
}

#[test]
fn every_number_of_a_bench_file_has_a_row_or_a_reason() {
    let all = wrong_keys();
    let rows = all.iter().map(|row| &*row.key);
    let columns = ["time_s", "temperature_c"];
    let rows: BTreeSet<&str> = rows.filter(|key| !columns.contains(key)).collect();
    let exempt: BTreeSet<&str> = EXEMPT.iter().map(|(key, _)| *key).collect();
    assert!(rows.is_disjoint(&exempt));
    let covered: BTreeSet<String> = rows.union(&exempt).map(|key| (*key).to_owned()).collect();
    assert_eq!(covered, numeric_keys());
}

#[test]
fn every_row_changes_its_number_and_nothing_else() {
    for row in wrong_keys() {
        let [(record, bench), (wrong_record, wrong_bench)] = row.record(3).unwrap();
        let bench = bench.unwrap();
        let same_record = record == wrong_record;
        let is_refused = wrong_bench.is_err();
        let same_bench = wrong_bench.is_ok_and(|wrong| wrong == bench);
        assert_eq!(row.key.contains('.'), same_record, "{}", row.name());
        assert_ne!(same_record, same_bench, "{}", row.name());
        // Only gravity of no place on Earth.
        assert!(!is_refused || row.name() == "site.local_gravity_m_per_s2 x 1.01");
    }
}

#[test]
fn kinds_make_one_record_of_a_seed() {
    // Those that need no fit: they are quick.
    for name in [
        "the same, up to 30 % of the values missing",
        "noise of t3",
        "an accelerometer clipped before noise of t4",
        "the second of two records in m/s^2",
    ] {
        let mut kinds = FieldKind::ALL.iter();
        let kind = kinds.find(|kind| kind.name == name).unwrap();
        let texts = |seed: u64| {
            let records = (kind.make)(seed).unwrap().records;
            let text = |(record, _): &(Record, Bench)| record.to_csv("r.csv".as_ref()).unwrap();
            records.iter().map(text).collect::<Vec<String>>()
        };
        assert_eq!(texts(5), texts(5), "{name}");
        assert_ne!(texts(5), texts(6), "{name}");
    }
}

#[test]
fn every_kind_of_a_plant_has_what_its_name_says() {
    let all: Vec<_> = PlantKind::ALL.iter().map(|kind| kind.record(6)).collect();
    for (place, (kind, record)) in PlantKind::ALL.iter().zip(&all).enumerate().skip(1) {
        // What is hidden under a wrong name changes nothing.
        assert!(!all[..place].contains(record), "{}", kind.name);
        let mut values = record.outputs.iter().chain(&record.inputs);
        assert!(values.all(|value| value.is_finite()));
    }
}

fn latitude() -> Right {
    let latitude = "each = [['latitude', 'site.latitude']]\nnear = ['accel_i.scale']\n\
                    beside = ['accel_i.noise']\nsilent = 'faint'";
    toml::from_str(latitude).unwrap()
}

fn found(id: &str, set: &[&str]) -> Name {
    Name {
        id: id.to_owned(),
        set: set.iter().map(|id| (*id).to_owned()).collect(),
        is_physical: is_physical(id),
    }
}

fn judged(right: &Right, names: Vec<Name>) -> Judgement {
    judge(right, Some(1), false, &Told::named(names))
}

#[test]
fn a_name_is_right_by_itself_only() {
    let named = |names| judged(&latitude(), names);
    // An exact equivalent, and noise beside.
    let twin = || found("clock.rate", &[]);
    assert_eq!(named(vec![Name::plain("latitude")]), Judgement::Right);
    let beside = vec![found("accel_z.noise", &[]), twin()];
    assert_eq!(named(beside), Judgement::Right);
    for not_settled in [
        vec![twin(), found("gyro_x.ramp", &[])],
        vec![found("gyro_x.ramp", &["site.latitude"])],
        vec![found("accel_y.scale", &[])],
        vec![Name::plain("unlisted")],
    ] {
        assert_eq!(named(not_settled), Judgement::NotSettled);
    }
    let with_walk = vec![found("gyro_z.random_walk", &[]), found("gyro_x.ramp", &[])];
    assert_eq!(named(with_walk), Judgement::PhysicalAlone);
    for other in [found("gyro_z.random_walk", &[]), Name::plain("attitude")] {
        assert_eq!(named(vec![other]), Judgement::Wrong);
    }
}

#[test]
fn silence_is_right_where_the_record_shows_little() {
    for (right, faint, expected) in [
        (latitude(), false, Judgement::Wrong),
        (latitude(), true, Judgement::Right),
        (Right::nothing(), false, Judgement::Right),
    ] {
        assert_eq!(judge(&right, None, faint, &Told::default()), expected);
    }
    // Where nothing is wrong, nothing may be told.
    for (name, expected) in [
        (found("gyro_x.ramp", &[]), Judgement::PhysicalAlone),
        (found("accel_x.noise", &[]), Judgement::Wrong),
        (Name::plain("unlisted"), Judgement::NotSettled),
    ] {
        assert_eq!(judged(&Right::nothing(), vec![name]), expected);
    }
}

#[test]
fn each_of_several_needs_a_finding_of_its_own_on_its_axis() {
    let two = "each = [['gyro_i.step'], ['gyro_i.step']]\nwhole = ['unlisted']\nin_set = true";
    let two: Right = toml::from_str(two).unwrap();
    let step = || found("gyro_y.step", &[]);
    let in_set = || found("gyro_y.random_walk", &["gyro_y.step"]);
    let of = |names| judged(&two, names);
    assert_eq!(of(vec![step(), step()]), Judgement::Right);
    assert_eq!(of(vec![step(), in_set()]), Judgement::Right);
    assert_eq!(of(vec![Name::plain("unlisted")]), Judgement::Right);
    assert_eq!(of(vec![step()]), Judgement::NotSettled);
    let with_other = vec![step(), found("gyro_x.ramp", &[])];
    assert_eq!(of(with_other), Judgement::Wrong);
    let on_other_axis = vec![found("gyro_x.step", &[])];
    assert_eq!(of(on_other_axis), Judgement::PhysicalAlone);
    let words = "gyro_i.step, and gyro_i.step, or unlisted, in a set";
    assert_eq!(two.words(), words);
}

#[test]
fn a_wrong_latitude_is_judged_by_its_strength() {
    let all = FieldPopulation::wrong_keys().unwrap();
    let of = |name: &str| all.iter().find(|one| one.name == name).unwrap();
    // Times that begin at another number change nothing.
    let (same, _) = (of("time_s +- 3600").job)(4).unwrap();
    assert!(same.strength.unwrap() < 0.1, "{same:?}");
    assert_eq!((same.judgement, same.told.len()), (Judgement::Right, 0));
    let mut keys = wrong_keys().into_iter();
    let latitude = keys.find(|key| key.name() == "site.latitude_deg +- 0.5");
    let both = latitude.unwrap().record(4).unwrap();
    assert!(keys::strength(&both).unwrap().unwrap() > 20.0);
}
