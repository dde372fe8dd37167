//! The libraries that our hierarchy is compared with.

#[cfg(unix)]
use super::embree;

/// Why nothing can be measured.
pub type Failure = Box<dyn std::error::Error>;

/// The library to compare with, if there is one.
pub struct Peers {
    #[cfg(unix)]
    pub embree: Option<embree::Library>,
}

#[cfg(unix)]
impl Peers {
    /// Loads the library that `ENFILADE_EMBREE` names.
    pub fn load() -> Result<Self, Failure> {
        let file = std::env::var("ENFILADE_EMBREE").ok();
        if file.is_none() {
            println!("note: ENFILADE_EMBREE names no library; only our own hierarchy is measured");
        }
        Ok(Self { embree: file.map(|file| embree::Library::load(&file)).transpose()? })
    }

    /// Version of the library, for example "4.4.0".
    pub fn version(&self) -> Option<String> {
        let number = self.embree?.version();
        Some(format!("{}.{}.{}", number / 10_000, number / 100 % 100, number % 100))
    }
}

#[cfg(not(unix))]
impl Peers {
    /// Loads the library that `ENFILADE_EMBREE` names.
    pub fn load() -> Result<Self, Failure> {
        println!("note: Embree is loaded on Unix only; only our own hierarchy is measured");
        Ok(Self {})
    }

    /// Version of the library.
    pub fn version(&self) -> Option<String> {
        None
    }
}
