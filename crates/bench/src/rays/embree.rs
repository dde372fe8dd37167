//! Embree 4, loaded at run time from a file, as the hierarchy to compare with: single rays, one geometry of triangles.
//!
//! Functions and numbers are those of Embree's public C interface (`rtcore.h`, version 4).

use enfilade_math::{Ray, Vec3};
use std::ffi::{CStr, CString, c_char, c_int, c_uint, c_void};
use std::ptr::{null, null_mut};

type Handle = *mut c_void;

/// `RTCRayHit`.
#[repr(C, align(16))]
struct RayHit {
    origin: [f32; 3],
    t_near: f32,
    direction: [f32; 3],
    time: f32,
    t_far: f32,
    mask: u32,
    id: u32,
    flags: u32,
    normal: [f32; 3],
    u: f32,
    v: f32,
    triangle: u32,
    geometry: u32,
    instance: [u32; 2],
}

type Query = unsafe extern "C" fn(Handle, *mut RayHit, Handle);

/// A committed scene.
pub struct Embree {
    scene: Handle,
    intersect: Query,
    occluded: Query,
}

/// The library. It stays loaded until the program ends: closing it while its threads live would hang.
#[derive(Clone, Copy)]
pub struct Library(Handle);

unsafe extern "C" {
    fn dlopen(file: *const c_char, flags: c_int) -> Handle;
    fn dlsym(library: Handle, name: *const c_char) -> Handle;
    fn dlerror() -> *const c_char;
}

impl Library {
    /// Loads `libembree4`.
    ///
    /// # Errors
    /// When the file is no library or an older version.
    pub fn load(file: &str) -> Result<Self, String> {
        const NOW: c_int = 2;
        let path = CString::new(file).map_err(|e| format!("{file:?}: {e}"))?;
        // SAFETY: a string that ends in zero; the library's own start-up code is trusted.
        let library = unsafe { dlopen(path.as_ptr(), NOW) };
        if library.is_null() {
            // SAFETY: after a failure this is a string, or null.
            let reason = unsafe { dlerror().as_ref().map(|text| CStr::from_ptr(text).to_string_lossy().into_owned()) };
            return Err(format!("cannot load Embree from {file}: {}", reason.unwrap_or_default()));
        }
        let library = Self(library);
        let version = library.version();
        if version < 40_000 { Err(format!("{file} is Embree {version}, expected 40000 or newer")) } else { Ok(library) }
    }

    /// For example 40400.
    pub fn version(self) -> isize {
        const VERSION: c_int = 0;
        // SAFETY: the types are those of the header.
        unsafe {
            let new_device: unsafe extern "C" fn(*const c_char) -> Handle = self.function(c"rtcNewDevice");
            let property: unsafe extern "C" fn(Handle, c_int) -> isize = self.function(c"rtcGetDeviceProperty");
            property(new_device(null()), VERSION)
        }
    }

    /// A function by its name, of the type that is asked for.
    ///
    /// # Safety
    /// `F` must be the type of the function.
    unsafe fn function<F: Copy>(self, name: &CStr) -> F {
        // SAFETY: a loaded library and a string that ends in zero.
        let found = unsafe { dlsym(self.0, name.as_ptr()) };
        assert!(!found.is_null(), "Embree has no function {name:?}");
        // SAFETY: the caller vouches for the type, and functions are as large as pointers.
        unsafe { std::mem::transmute_copy(&found) }
    }
}

impl Embree {
    /// Builds the hierarchy with medium quality, the default. `robust` chooses the watertight triangle test.
    pub fn new(library: Library, triangles: &[[Vec3; 3]], robust: bool) -> Self {
        const TRIANGLES: c_int = 0;
        const INDEX: (c_int, c_int) = (0, 0x5003);
        const VERTEX: (c_int, c_int) = (1, 0x9003);
        const ROBUST: c_uint = 4;
        const BYTES: usize = 12;
        // SAFETY: the types are those of the header; Embree allocates as much as is asked for, and the buffers are filled to the end.
        unsafe {
            let new_device: unsafe extern "C" fn(*const c_char) -> Handle = library.function(c"rtcNewDevice");
            let new_scene: unsafe extern "C" fn(Handle) -> Handle = library.function(c"rtcNewScene");
            let set_flags: unsafe extern "C" fn(Handle, c_uint) = library.function(c"rtcSetSceneFlags");
            let new_geometry: unsafe extern "C" fn(Handle, c_int) -> Handle = library.function(c"rtcNewGeometry");
            let new_buffer: unsafe extern "C" fn(Handle, c_int, c_uint, c_int, usize, usize) -> Handle =
                library.function(c"rtcSetNewGeometryBuffer");
            let commit_geometry: unsafe extern "C" fn(Handle) = library.function(c"rtcCommitGeometry");
            let attach: unsafe extern "C" fn(Handle, Handle) -> c_uint = library.function(c"rtcAttachGeometry");
            let commit: unsafe extern "C" fn(Handle) = library.function(c"rtcCommitScene");

            let device = new_device(null());
            let scene = new_scene(device);
            set_flags(scene, if robust { ROBUST } else { 0 });
            let geometry = new_geometry(device, TRIANGLES);
            let corners = triangles.as_flattened();
            let vertices = new_buffer(geometry, VERTEX.0, 0, VERTEX.1, BYTES, corners.len()).cast::<f32>();
            let indices = new_buffer(geometry, INDEX.0, 0, INDEX.1, BYTES, triangles.len()).cast::<u32>();
            assert!(!vertices.is_null() && !indices.is_null(), "Embree gives no memory for {} triangles", triangles.len());
            for (i, corner) in corners.iter().enumerate() {
                corner.to_array().iter().enumerate().for_each(|(k, &x)| vertices.add(3 * i + k).write(x));
                indices.add(i).write(i as u32);
            }
            commit_geometry(geometry);
            attach(scene, geometry);
            commit(scene);
            Self { scene, intersect: library.function(c"rtcIntersect1"), occluded: library.function(c"rtcOccluded1") }
        }
    }

    /// The first hit: its parameter and triangle.
    #[inline]
    pub fn closest(&self, ray: &Ray) -> Option<(f32, u32)> {
        let mut query = RayHit::new(ray);
        // SAFETY: a committed scene and a ray of the right layout.
        unsafe { (self.intersect)(self.scene, &raw mut query, null_mut()) };
        (query.geometry != u32::MAX).then_some((query.t_far, query.triangle))
    }

    /// Whether anything is hit.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        let mut query = RayHit::new(ray);
        // SAFETY: as above; the ray is the first part of the structure.
        unsafe { (self.occluded)(self.scene, &raw mut query, null_mut()) };
        query.t_far < 0.0
    }
}

impl RayHit {
    #[inline]
    fn new(ray: &Ray) -> Self {
        Self {
            origin: ray.origin.to_array(),
            t_near: ray.t_min,
            direction: ray.direction.to_array(),
            time: 0.0,
            t_far: ray.t_max,
            mask: u32::MAX,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            u: 0.0,
            v: 0.0,
            triangle: u32::MAX,
            geometry: u32::MAX,
            instance: [u32::MAX; 2],
        }
    }
}
