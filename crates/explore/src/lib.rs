//! Free space by space carving, and camera trajectories by view saliency.
