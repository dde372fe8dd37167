//! Instruments: programs that measure, compare, draw or make what the house needs beside its crates.
//!
//!     cargo run --release -p enfilade-bench -- NAME [ARGUMENTS]
//!
//! runs one of [`INSTRUMENTS`]; its module documents its arguments. `cargo xtask bench` runs those that measure, and fetches what they
//! compare with.

mod against_reference;
mod arguments;
mod denoise;
mod explore;
mod faults;
mod flicker;
mod homes;
mod learn;
mod measure;
mod memory;
mod network;
mod noise;
mod place;
mod plans;
mod rays;
mod showroom;
mod statistics;
mod storage;
mod store_dataset;
mod suggest;
mod swatches;
mod to_mitsuba;
mod vray_oracle;

use std::error::Error;
use std::process::ExitCode;

/// The result of an instrument.
type Outcome = Result<(), Box<dyn Error>>;

/// An instrument.
struct Instrument {
    /// The word that runs it.
    name: &'static str,
    /// Description of what it measures or makes.
    about: &'static str,
    /// Runs it with [`arguments::arguments`].
    run: fn() -> Outcome,
}

/// All instruments.
const INSTRUMENTS: [Instrument; 22] = [
    Instrument { name: "rays", about: "millions of rays per second of one thread, ours and Embree's", run: || done(rays::run()) },
    Instrument {
        name: "explore",
        about: "core-seconds of carving and walking, beside those recorded of Hypersim's programs",
        run: || done(explore::run()),
    },
    Instrument {
        name: "place",
        about: "objects placed on tables: time, how deep they are in anything, and how far they move afterwards",
        run: place::run,
    },
    Instrument { name: "noise", about: "noise that a second of rendering leaves, in the demo's room", run: || done(noise::run()) },
    Instrument { name: "memory", about: "memory for a million triangles under eight textures of 4096x4096", run: || done(memory::run()) },
    Instrument { name: "suggest", about: "how good suggested labels are on held-out scenes", run: || done(suggest::run()) },
    Instrument { name: "denoise", about: "error with and without denoising, in the demo's room", run: || done(denoise::run()) },
    Instrument { name: "flicker", about: "how much delivered surfaces change between the frames of a walk", run: || done(flicker::run()) },
    Instrument { name: "network", about: "what the denoiser costs, and how far it is from its reference", run: || done(network::run()) },
    Instrument {
        name: "measure",
        about: "cost and noise of one picture, as `oracle`, `bench render` and `bench cycles` ask for them",
        run: || done(measure::run()),
    },
    Instrument { name: "storage", about: "layers stored in several ways", run: || done(storage::run()) },
    Instrument {
        name: "statistics",
        about: "cost and contents of generated homes, beside published numbers",
        run: || done(statistics::run()),
    },
    Instrument {
        name: "faults",
        about: "what is wrong with generated homes, and what had to be moved or removed",
        run: || done(faults::run()),
    },
    Instrument { name: "homes", about: "generated homes as scene packages, and a dataset that renders them", run: || done(homes::run()) },
    Instrument { name: "plans", about: "floor plans of generated homes, drawn from above", run: || done(plans::run()) },
    Instrument { name: "showroom", about: "variants of furniture side by side, as a scene package", run: || done(showroom::run()) },
    Instrument {
        name: "swatches",
        about: "every finish as a panel with a ball before it, as scene packages",
        run: || done(swatches::run()),
    },
    Instrument { name: "to-mitsuba", about: "a scene as Mitsuba 3 reads it", run: || done(to_mitsuba::run()) },
    Instrument { name: "against-reference", about: "a picture of ours beside another renderer's", run: || done(against_reference::run()) },
    Instrument { name: "vray-oracle", about: "Hypersim's empty scene beside V-Ray's own picture", run: || done(vray_oracle::run()) },
    Instrument { name: "learn", about: "the tables of suggested labels, learned anew", run: || done(learn::run()) },
    Instrument {
        name: "store-dataset",
        about: "the stored dataset of a version, which later versions must read",
        run: || done(store_dataset::run()),
    },
];

fn main() -> ExitCode {
    let name = std::env::args().nth(1);
    let Some(instrument) = INSTRUMENTS.iter().find(|instrument| Some(instrument.name) == name.as_deref()) else {
        eprintln!("expected one of these instruments, then its arguments:");
        INSTRUMENTS.iter().for_each(|instrument| eprintln!("  {:<18} {}", instrument.name, instrument.about));
        return ExitCode::from(2);
    };
    match (instrument.run)() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// The result of an instrument, whatever its kind of error.
fn done<E: Into<Box<dyn Error>>>(result: Result<(), E>) -> Outcome {
    result.map_err(Into::into)
}
