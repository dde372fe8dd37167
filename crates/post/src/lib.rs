//! Labels, previews, verification and questions about finished frames.
