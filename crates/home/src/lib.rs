//! Procedural furnished homes: the embedded default input.
