//! Integer hashes and a small generator. Randomness is always an argument: nothing here is seeded from a clock.

/// Mixes a 32-bit integer; bijective. "lowbias32" by Chris Wellons.
#[inline]
pub fn hash_u32(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// Mixes a 64-bit integer; bijective. The finaliser of SplitMix64 (Steele et al. 2014).
#[inline]
pub fn hash_u64(mut x: u64) -> u64 {
    x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Hash of a text: FNV-1a (Fowler, Noll & Vo).
pub fn hash_text(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// A stream of random numbers (SplitMix64): small, fast, and good enough wherever stratification does not matter.
///
/// The same seed gives the same stream on every machine. Streams for different purposes come from [`Rng::fork`].
///
/// ```
/// use enfilade_math::Rng;
///
/// let mut chairs = Rng::new(42).fork(1);
/// let mut lamps = Rng::new(42).fork(2);
/// assert_ne!(chairs.next_u64(), lamps.next_u64());
/// assert!(chairs.below(6) < 6);
/// assert_eq!(Rng::new(42).next_f64(), Rng::new(42).next_f64());
/// ```
#[derive(Clone, Debug)]
pub struct Rng {
    state: u64,
}

impl Rng {
    /// The stream of `seed`.
    pub fn new(seed: u64) -> Self {
        Self { state: hash_u64(seed) }
    }

    /// An independent stream named by `purpose`, without disturbing this one.
    #[must_use]
    pub fn fork(&self, purpose: u64) -> Self {
        Self { state: hash_u64(self.state ^ hash_u64(purpose.wrapping_add(0xa5a5))) }
    }

    /// Uniform 64 bits.
    #[inline]
    pub fn next_u64(&mut self) -> u64 {
        let value = hash_u64(self.state);
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        value
    }

    /// Uniform on [0,1).
    #[inline]
    pub fn next_f32(&mut self) -> f32 {
        (self.next_u64() >> 40) as f32 * (1.0 / 16_777_216.0)
    }

    /// Uniform on [0,1).
    #[inline]
    pub fn next_f64(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    /// Uniform on [`low`, `high`).
    #[inline]
    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.next_f32()
    }

    /// Uniform on 0..n by multiply-shift (bias below 2⁻³² for n below 2³²).
    ///
    /// # Panics
    /// When `n` is zero.
    #[inline]
    pub fn below(&mut self, n: usize) -> usize {
        assert!(n > 0, "cannot choose among 0 things");
        ((u128::from(self.next_u64()) * n as u128) >> 64) as usize
    }

    /// Puts a list into a random order (Fisher & Yates).
    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for i in (1..list.len()).rev() {
            list.swap(i, self.below(i + 1));
        }
    }

    /// Standard normal deviate (Box–Muller).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.next_f64()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.next_f64()).cos()
    }
}
