//! Records, bench descriptions and results: files with located errors
