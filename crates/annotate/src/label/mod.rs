//! Labelling the parts of a scene.
