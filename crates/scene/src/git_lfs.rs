//! Pointers of Git LFS: short texts in the place of files that Git LFS keeps elsewhere and that were not fetched.

/// What such a file is and what to do about it, for messages.
pub const GIT_LFS_POINTER: &str = "a Git LFS pointer to a file that was not fetched: run `git lfs pull` in a clone of its repository";

/// Longest pointer, bytes, by Git LFS's specification.
const LONGEST: usize = 1024;

/// True for the bytes of a pointer. Their first line is the specification's address; the address used before the first release of Git LFS
/// counts too.
///
/// ```
/// use enfilade_scene::is_git_lfs_pointer;
///
/// assert!(is_git_lfs_pointer(b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n"));
/// assert!(!is_git_lfs_pointer(b"v 0 0 0\nv 1 0 0\n"));
/// ```
pub fn is_git_lfs_pointer(bytes: &[u8]) -> bool {
    let begins = |address: &str| bytes.strip_prefix(b"version ").is_some_and(|rest| rest.starts_with(address.as_bytes()));
    bytes.len() <= LONGEST && (begins("https://git-lfs.github.com/spec/") || begins("https://hawser.github.com/spec/"))
}
