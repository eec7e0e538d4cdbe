//! Logs and records in files of MATLAB.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use gyrocal_instruments::{
    AllanSettings, Description, Log, Unfit, allan_file, average_file, read_any, read_record,
};
use gyrocal_statistics::allan::AllanEstimator;

use crate::typed_files::{case, map, words};

/// An element of a file of MATLAB, most significant bytes first.
fn element(kind: u32, content: &[u8]) -> Vec<u8> {
    let mut bytes = [kind, content.len() as u32].map(u32::to_be_bytes).concat();
    bytes.extend(content);
    // Compressed content ends anywhere.
    if kind != COMPRESSED {
        bytes.resize(bytes.len().next_multiple_of(8), 0);
    }
    bytes
}

/// Type of an element whose content is an element in zlib's compression.
const COMPRESSED: u32 = 15;

/// The element of a matrix, its values column by column.
fn matrix(name: &str, sizes: [u32; 2], values: &[f64]) -> Vec<u8> {
    let words = |two: [u32; 2]| two.map(u32::to_be_bytes).concat();
    let numbers: Vec<u8> = values
        .iter()
        .flat_map(|value| value.to_be_bytes())
        .collect();
    let parts = [
        element(6, &words([6, 0])),
        element(5, &words(sizes)),
        element(1, name.as_bytes()),
        element(9, &numbers),
    ];
    element(14, &parts.concat())
}

/// A file of MATLAB with some elements.
fn matlab(elements: &[Vec<u8>]) -> Vec<u8> {
    let mut file = vec![b' '; 124];
    file.extend([1, 0, b'M', b'I']);
    file.extend(elements.concat());
    file
}

#[test]
fn compressed_variables_that_fill_the_memory_are_refused() {
    let compressed = |content: &[u8]| {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(content).unwrap();
        element(COMPRESSED, &encoder.finish().unwrap())
    };
    // Of another class than numbers: read, and passed over.
    let zeros = |mib: usize| {
        let flags = element(6, &[4_u32, 0].map(u32::to_be_bytes).concat());
        compressed(&element(14, &[flags, vec![0; mib << 20]].concat()))
    };
    let rows = 24;
    let values: Vec<f64> = (0..4 * rows).map(|value| f64::from(value) / 64.0).collect();
    let log = compressed(&matrix("log", [rows, 4], &values));
    let mut seed = 1_u32;
    let noise: Vec<u8> = (0..1 << 20)
        .map(|_| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 24) as u8
        })
        .collect();
    let noise = element(2, &noise);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mat");
    let description = map(
        "column = \"log(:,1)\"",
        r#""log(:,2)", "log(:,3)", "log(:,4)""#,
    );
    // A long content, and one that is a hundred times as large as its file, are logs; both together are none.
    for (elements, is_read) in [
        (vec![log.clone(), zeros(60)], true),
        (vec![log.clone(), zeros(70), noise], true),
        (vec![log.clone(), zeros(70)], false),
        (vec![zeros(40), zeros(40), log], false),
    ] {
        std::fs::write(&path, matlab(&elements)).unwrap();
        match read_record(&path, &description) {
            Ok(file) => assert!(is_read && file.record().len() == rows as usize),
            Err(error) => {
                let refused = words(error);
                assert!(!is_read, "{refused}");
                for part in [
                    "compressed variables of 64 MiB and more in a file of ",
                    "less than 100 times the size of the file",
                    "'-v6'",
                ] {
                    assert!(refused.contains(part), "{refused} lacks {part}");
                }
            }
        }
    }
}

#[test]
fn a_log_of_six_sensors_is_read_from_a_matrix() {
    let rows = 200;
    let column = |column: usize| (0..rows).map(move |row| (row * 7 + column) as f64 / 64.0);
    let values: Vec<f64> = (0..6)
        .flat_map(column)
        .chain((0..rows).map(|row| row as f64))
        .collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mat");
    let log = matrix("log", [rows as u32, 7], &values);
    std::fs::write(&path, matlab(&[log])).unwrap();
    let text = "[time]\ncolumn = \"log(:,7)\"\n[gyro]\ncolumns = [\"log(:,1)\", \"log(:,2)\", \"log(:,3)\"]\n\
                unit = \"rad/s\"\n[accel]\ncolumns = [\"log(:,4)\", \"log(:,5)\", \"log(:,6)\"]\nunit = \"g\"\n";
    let log = Log::read(&path, &Description::parse(text, "log.toml").unwrap()).unwrap();
    assert_eq!((log.len(), log.interval_s), (rows, 1.0));
    for row in 0..rows {
        let first = (row * 7) as f64;
        assert_eq!(log.gyro[row], [0.0, 1.0, 2.0].map(|at| (first + at) / 64.0));
        assert_eq!(
            log.force().unwrap()[row],
            [3.0, 4.0, 5.0].map(|at| (first + at) / 64.0)
        );
    }
}

#[test]
fn columns_of_gyros_alone_are_analysed_by_their_names() {
    let mut state = 3_u64;
    let mut uniform = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut rates: Vec<f64> = (0..3 * 1000).map(|_| uniform()).collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mat");
    let settings = AllanSettings {
        rate_hz: 1.0,
        scale: 1.0,
        confidence: 0.683,
        estimator: AllanEstimator::Overlapping,
    };
    let names = ["gyr(:,1)", "gyr(:,2)", "gyr(:,3)"];
    let mut analysed = |change: &dyn Fn(&mut [f64])| {
        change(&mut rates);
        std::fs::write(&path, matlab(&[matrix("gyr", [1000, 3], &rates)])).unwrap();
        allan_file(&path, &names, &settings)
    };
    let columns = analysed(&|_| ()).unwrap();
    let found: Vec<&str> = columns.iter().map(|column| &*column.name).collect();
    assert_eq!(found, names);
    // White noise of 1/12 has a deviation of its root; 1000 samples tell it to 2.7 %, one sigma.
    let ratio = columns[2].points[0].deviation * 12.0_f64.sqrt();
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
    let still = analysed(&|rates| rates[1300..1340].fill(0.25)).unwrap_err();
    assert_eq!(still.kind(), Some(Unfit::Stuck));
    assert!(words(still).contains("`gyr(:,2)` at 0.25 in 40 samples from here on in record 301"),);
    let constant = analysed(&|rates| rates[..1000].fill(0.25)).unwrap_err();
    assert!(words(constant).contains("a column `gyr(:,1)` that never changes"));
}

#[test]
fn columns_that_a_file_of_matlab_lacks_are_told_with_those_that_it_has() {
    let description = map(
        "column = \"t\"",
        r#""accel(:,1)", "accel(:,2)", "accel(:,4)""#,
    );
    let refused = words(read_record(&case("matlab.mat"), &description).unwrap_err());
    for part in [
        "t, accel(:,1) to (:,3)",
        "`accel(:,4)`",
        "name columns that are there",
    ] {
        assert!(refused.contains(part), "{refused} lacks {part}");
    }
    let refused = words(read_any(&case("matlab.mat"), None).unwrap_err());
    assert!(refused.contains("a column `accel_x_g`"), "{refused}");
    let description = map(
        "column = \"log.t\"",
        r#""log.a(1,:)", "log.a(2,:)", "other(:,3)""#,
    );
    let refused = words(read_record(&case("matlab_structure.mat"), &description).unwrap_err());
    assert!(refused.contains("3 values in `other(:,3)`"), "{refused}");
}

#[test]
fn a_file_of_matlab_that_is_cut_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let description = map(
        "column = \"t\"",
        r#""accel(:,1)", "accel(:,2)", "accel(:,3)""#,
    );
    for name in ["matlab.mat", "matlab_structure.mat"] {
        let whole = std::fs::read(case(name)).unwrap();
        for length in 128..whole.len() {
            let path = folder.path().join("cut.mat");
            std::fs::write(&path, &whole[..length]).unwrap();
            assert!(read_record(&path, &description).is_err(), "{length} bytes");
        }
    }
    let path = folder.path().join("later.mat");
    std::fs::write(&path, "MATLAB 7.3 MAT-file, Platform: GLNXA64").unwrap();
    let refused = words(read_record(&path, &description).unwrap_err());
    assert!(refused.contains("'-v7'"), "{refused}");
}

#[test]
fn means_of_a_file_of_matlab_are_those_of_its_rows() {
    let description = map(
        "column = \"t\"\nunit_s = 0.05",
        r#""accel(:,1)", "accel(:,2)", "accel(:,3)""#,
    );
    let averaged = average_file(&case("matlab.mat"), &description, 6.0).unwrap();
    // Rows every 3 s: two in each mean.
    assert_eq!((averaged.rows, averaged.record.len()), (24, 12));
}
