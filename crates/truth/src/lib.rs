//! An independent simulator of the platform
