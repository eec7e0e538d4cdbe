//! Records in, drift coefficients with covariances out
