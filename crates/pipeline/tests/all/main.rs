//! Stages over folders: what is made, what is made again, what damage does.

mod cameras;
mod changes;
mod common;
mod damage;
mod deforming;
mod demo;
mod fitted_rooms;
mod gates;
mod home_joints;
mod intake;
mod motion;
mod objects;
mod places;
mod presets;
mod products;
mod rooms;
mod stored;
mod suspicions;
mod trajectories;
mod variations;
