#![doc = include_str!("../conventions.md")]
