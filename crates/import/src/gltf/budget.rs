//! The limit on the unpacked size of a file's packed parts: a small file can claim any number of vertices that are all alike.

/// Bytes that a byte of packed data may become. Meshes in use become up to some dozens.
const RATIO: u64 = 256;

/// Bytes beyond that ratio that all packed parts of a file share, for meshes in which much is the same.
const SHARED: u64 = 1 << 26;

/// The remaining budget of a file.
pub(super) struct Budget {
    shared_left: u64,
}

impl Default for Budget {
    fn default() -> Self {
        Self { shared_left: SHARED }
    }
}

impl Budget {
    /// The most bytes that this number of packed bytes may become now.
    pub(super) fn most(&self, packed: usize) -> u64 {
        RATIO * packed as u64 + self.shared_left
    }

    /// Counts data that unpack to this number of bytes.
    ///
    /// # Errors
    /// When that is too much to be believed, as the rest of a sentence.
    pub(super) fn take(&mut self, unpacked: u64, packed: usize) -> Result<(), String> {
        let beyond = unpacked.saturating_sub(RATIO * packed as u64);
        self.shared_left = self.shared_left.checked_sub(beyond).ok_or_else(|| {
            let most = self.most(packed);
            format!(
                "would unpack {packed} bytes to {unpacked}, expected at most {most}; it is damaged, or else export it without compression"
            )
        })?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_beyond_the_ratio_is_shared_by_the_file() {
        let mut budget = Budget::default();
        assert!(budget.take(RATIO * 10, 10).is_ok() && budget.take(RATIO * 10 + SHARED - 1, 10).is_ok());
        assert_eq!(budget.most(1), RATIO + 1);
        assert!(budget.take(RATIO + 2, 1).unwrap_err().contains("expected at most 257"));
        assert!(budget.take(RATIO + 1, 1).is_ok() && budget.take(1, 0).is_err() && budget.take(u64::MAX, 0).is_err());
    }
}
