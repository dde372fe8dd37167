//! The installed library: a device of Open Image Denoise, and its filter for one picture behind a safe interface.

use crate::library::{DEVICE_CPU, ERRORS, FORMAT_FLOAT3, Functions, Handle, QUALITY_HIGH, load};
use crate::{DenoiseError, Noisy};
use std::ffi::{CStr, c_int};
use std::path::Path;

/// Open Image Denoise, ready to work on the processor.
pub(crate) struct Installed {
    functions: Functions,
    device: Handle,
    version: String,
}

impl Installed {
    /// See [`crate::Denoiser::open`].
    pub fn open(place: Option<&Path>, threads: usize) -> Result<Self, DenoiseError> {
        let (library, functions) = load(place)?;
        // SAFETY: the functions are called as the header says, here and below: with handles of the library that live, and
        // strings that end with 0. The device is released once, in `drop`, and filters before it.
        let device = unsafe { (functions.new_device)(DEVICE_CPU) };
        let mut denoiser = Self { functions, device, version: String::new() };
        if device.is_null() {
            return Err(denoiser.error().unwrap_or_else(|| library_error("it gives no device and no reason", 1)));
        }
        // SAFETY: the device is not null and was made by this library; the names end with a zero byte.
        unsafe {
            (denoiser.functions.set_device_int)(device, c"numThreads".as_ptr(), c_int::try_from(threads).unwrap_or(0));
            // The cores are shared with our own threads, so that pinning threads to them would slow both.
            (denoiser.functions.set_device_bool)(device, c"setAffinity".as_ptr(), false);
            (denoiser.functions.commit_device)(device);
        }
        denoiser.check()?;
        // SAFETY: as above.
        let number = |name: &CStr| unsafe { (denoiser.functions.device_int)(device, name.as_ptr()) };
        let [major, minor, patch] = [c"versionMajor", c"versionMinor", c"versionPatch"].map(number);
        denoiser.version = format!("{major}.{minor}.{patch}");
        if major != 2 {
            return Err(DenoiseError::Version { library, found: denoiser.version.clone() });
        }
        Ok(denoiser)
    }

    /// Name and version.
    pub fn name(&self) -> String {
        format!("Open Image Denoise {}", self.version)
    }

    /// Denoises one picture: the ray-tracing filter for high dynamic range at high quality, with guides that are taken to be free of noise.
    pub fn filter(&self, noisy: &Noisy<'_>) -> Result<Vec<f32>, DenoiseError> {
        let f = &self.functions;
        let (width, height) = (noisy.width as usize, noisy.height as usize);
        let mut output = vec![0.0f32; 3 * width * height];
        // The library reads inputs through the pointer that it also writes outputs through; it does not write to inputs.
        let pictures = [
            (c"color", noisy.color.as_ptr().cast_mut(), noisy.color.len()),
            (c"albedo", noisy.albedo.as_ptr().cast_mut(), noisy.albedo.len()),
            (c"normal", noisy.normal.as_ptr().cast_mut(), noisy.normal.len()),
            (c"output", output.as_mut_ptr(), output.len()),
        ];
        for (name, _, len) in pictures {
            assert_eq!(len, 3 * width * height, "{name:?} of {width}x{height}");
        }
        // SAFETY: see `open`; the pictures hold what the sizes say, and outlive the filter.
        let filter = unsafe { (f.new_filter)(self.device, c"RT".as_ptr()) };
        if !filter.is_null() {
            for (name, values, _) in pictures {
                // SAFETY: the filter is not null; each picture has the size that is told, and outlives the filter, which is released below.
                unsafe { (f.set_shared_image)(filter, name.as_ptr(), values.cast(), FORMAT_FLOAT3, width, height, 0, 0, 0) };
            }
            // SAFETY: the filter is not null; the names end with a zero byte.
            unsafe {
                (f.set_filter_bool)(filter, c"hdr".as_ptr(), true);
                (f.set_filter_bool)(filter, c"cleanAux".as_ptr(), true);
                (f.set_filter_int)(filter, c"quality".as_ptr(), QUALITY_HIGH);
                (f.commit_filter)(filter);
                (f.execute_filter)(filter);
                (f.release_filter)(filter);
            }
        }
        self.check().map(|()| output)
    }

    /// The error that waits, if one does.
    fn check(&self) -> Result<(), DenoiseError> {
        self.error().map_or(Ok(()), Err)
    }

    fn error(&self) -> Option<DenoiseError> {
        let mut message = std::ptr::null();
        // SAFETY: see `open`; the message lives until the next call.
        let code = unsafe { (self.functions.device_error)(self.device, &raw mut message) };
        if code == 0 {
            return None;
        }
        // SAFETY: a message that is not null ends with a zero byte and lives until the next call of the library.
        let text = if message.is_null() { "no reason given".into() } else { unsafe { CStr::from_ptr(message) }.to_string_lossy() };
        Some(library_error(&text, code))
    }
}

fn library_error(message: &str, code: c_int) -> DenoiseError {
    let kind = usize::try_from(code).ok().and_then(|code| ERRORS.get(code)).unwrap_or(&ERRORS[1]);
    DenoiseError::Library { message: message.into(), kind }
}

impl Drop for Installed {
    fn drop(&mut self) {
        if !self.device.is_null() {
            // SAFETY: see `open`.
            unsafe { (self.functions.release_device)(self.device) };
        }
    }
}
