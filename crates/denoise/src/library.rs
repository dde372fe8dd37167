//! The C interface of Open Image Denoise 2, as far as it is used, found and loaded at run time.
//!
//! Names, numbers and signatures are those of `oidn.h` of version 2.

use crate::DenoiseError;
use std::ffi::{c_char, c_int, c_void};
use std::path::{Path, PathBuf};

/// An object of the library.
pub(crate) type Handle = *mut c_void;

/// `OIDN_DEVICE_TYPE_CPU`.
pub(crate) const DEVICE_CPU: c_int = 1;
/// `OIDN_FORMAT_FLOAT3`.
pub(crate) const FORMAT_FLOAT3: c_int = 3;
/// `OIDN_QUALITY_HIGH`.
pub(crate) const QUALITY_HIGH: c_int = 6;
/// `OIDN_ERROR_…` in their order; a number beyond them is unknown too.
pub(crate) const ERRORS: [&str; 7] =
    ["no error", "unknown error", "invalid argument", "invalid operation", "out of memory", "unsupported hardware", "cancelled"];

/// The library's file, by platform; the first that loads is taken.
const NAMES: &[&str] = if cfg!(target_os = "macos") {
    &["libOpenImageDenoise.2.dylib", "libOpenImageDenoise.dylib"]
} else if cfg!(windows) {
    &["OpenImageDenoise.dll"]
} else {
    &["libOpenImageDenoise.so.2", "libOpenImageDenoise.so"]
};

macro_rules! functions {
    ($($field:ident = $name:literal: fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// The functions of a loaded library. They stay valid to the end of the program.
        pub(crate) struct Functions {
            $(pub $field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }

        impl Functions {
            /// Looks up every function.
            fn of(library: &libloading::Library, path: &Path) -> Result<Self, DenoiseError> {
                Ok(Self {
                    // SAFETY: the signatures are those of the library's header.
                    $($field: *unsafe { library.get(concat!($name, "\0").as_bytes()) }
                        .map_err(|_| DenoiseError::Function { library: path.into(), function: $name })?,)*
                })
            }
        }
    };
}

functions! {
    new_device = "oidnNewDevice": fn(c_int) -> Handle;
    release_device = "oidnReleaseDevice": fn(Handle);
    set_device_bool = "oidnSetDeviceBool": fn(Handle, *const c_char, bool);
    set_device_int = "oidnSetDeviceInt": fn(Handle, *const c_char, c_int);
    device_int = "oidnGetDeviceInt": fn(Handle, *const c_char) -> c_int;
    device_error = "oidnGetDeviceError": fn(Handle, *mut *const c_char) -> c_int;
    commit_device = "oidnCommitDevice": fn(Handle);
    new_filter = "oidnNewFilter": fn(Handle, *const c_char) -> Handle;
    release_filter = "oidnReleaseFilter": fn(Handle);
    set_shared_image = "oidnSetSharedFilterImage": fn(Handle, *const c_char, *mut c_void, c_int, usize, usize, usize, usize, usize);
    set_filter_bool = "oidnSetFilterBool": fn(Handle, *const c_char, bool);
    set_filter_int = "oidnSetFilterInt": fn(Handle, *const c_char, c_int);
    commit_filter = "oidnCommitFilter": fn(Handle);
    execute_filter = "oidnExecuteFilter": fn(Handle);
}

/// Loads the library from `place`, its file or the folder that it lies in, or without a place from where the system's loader
/// looks. Gives what was loaded and its functions.
pub(crate) fn load(place: Option<&Path>) -> Result<(PathBuf, Functions), DenoiseError> {
    if cfg!(all(unix, target_feature = "crt-static")) {
        return Err(DenoiseError::Static);
    }
    let mut tried = Vec::new();
    for candidate in candidates(place) {
        // SAFETY: loading runs the library's initialisers. The user names the library or has it installed, as with every other
        // library that a program is linked to.
        match unsafe { libloading::Library::new(&candidate) } {
            Ok(library) => {
                // Its worker threads may outlive a device, so it is never unloaded.
                let library: &'static libloading::Library = Box::leak(Box::new(library));
                let functions = Functions::of(library, &candidate)?;
                return Ok((candidate, functions));
            }
            Err(error) => tried.push(format!("{} ({})", candidate.display(), answer(&error))),
        }
    }
    Err(DenoiseError::NotFound { tried })
}

fn candidates(place: Option<&Path>) -> Vec<PathBuf> {
    match place {
        Some(folder) if folder.is_dir() => NAMES.iter().map(|name| folder.join(name)).collect(),
        Some(file) => vec![file.into()],
        None => NAMES.iter().map(PathBuf::from).collect(),
    }
}

/// The system's words.
fn answer(error: &libloading::Error) -> String {
    std::error::Error::source(error).map_or_else(|| error.to_string(), ToString::to_string)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_library_that_is_not_there_is_told_with_every_name_tried() {
        let Err(DenoiseError::NotFound { tried }) = load(Some(Path::new("/nowhere/libOpenImageDenoise.so.2"))) else {
            panic!("nothing lies in /nowhere")
        };
        assert!(tried.len() == 1 && tried[0].starts_with("/nowhere/libOpenImageDenoise.so.2 ("), "{tried:?}");
        let Err(DenoiseError::NotFound { tried }) = load(Some(Path::new("."))) else { panic!("the crate's folder holds none") };
        assert_eq!(tried.len(), NAMES.len());
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn another_library_is_refused_by_the_function_that_it_lacks() {
        let Err(error) = load(Some(Path::new("libc.so.6"))) else { panic!("the C library does not denoise") };
        assert_eq!(error.to_string(), "libc.so.6 is not Open Image Denoise 2: it has no function `oidnNewDevice`");
    }
}
