//! The stages, their work directory, and how a run resumes.
