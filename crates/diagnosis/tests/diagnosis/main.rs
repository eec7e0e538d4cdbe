//! Tests of the library in one program: to compile and link one for each file would take most of their time.
#![cfg(test)]

mod blocks;
mod causes;
mod extended_unit;
mod far_off;
mod gain;
mod gate;
mod hostile;
mod magnitude;
mod magnitude_test;
mod noise;
mod outliers;
mod records;
mod shapes;
mod strapdown;
mod temperature;
