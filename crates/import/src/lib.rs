//! Scene files to Scene: glTF, OBJ, Mitsuba XML and scene packages, with a report of what was dropped or guessed.
