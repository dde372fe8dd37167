//! Cryptomatte layers after the specification 1.2.0 (Friedman and Jones, Psyop): ids are hashes of names, kept in float channels, and the
//! manifest in the header lists the hash of each name.

use enfilade_frame::Values;
use std::collections::BTreeMap;

/// One Cryptomatte layer of an image.
pub(crate) struct Cryptomatte {
    /// Name of the layer, as in `crypto_instance`; its channels are `<name>00.R` to `.A`.
    pub name: &'static str,
    /// Hashes of the names, as floats; 0 where there is none.
    pub ids: Vec<f32>,
    /// 1 where there is an id, else 0: the layers are point samples.
    pub coverage: Vec<f32>,
    manifest: BTreeMap<String, String>,
}

impl Cryptomatte {
    /// The layer whose pixels have the numbers `labels`; `name_of` gives a number's name, `None` for numbers that mean nothing.
    pub fn new(name: &'static str, labels: &Values, name_of: impl Fn(i32) -> Option<String>) -> Self {
        let mut known: BTreeMap<i32, f32> = BTreeMap::new();
        let mut manifest = BTreeMap::new();
        let mut id_of = |label: i32| {
            *known.entry(label).or_insert_with(|| {
                let Some(object) = name_of(label) else { return 0.0 };
                let id = id_from_name(&object);
                manifest.insert(object, format!("{:08x}", id.to_bits()));
                id
            })
        };
        let ids: Vec<f32> = (0..labels.len()).map(|i| id_of(labels.get(i) as i32)).collect();
        let coverage = ids.iter().map(|&id| if id == 0.0 { 0.0 } else { 1.0 }).collect();
        Self { name, ids, coverage, manifest }
    }

    /// The attributes of the header, by name.
    pub fn attributes(&self) -> [(String, String); 4] {
        let hash = murmur3(self.name.as_bytes());
        let key = |what: &str| format!("cryptomatte/{}/{what}", &format!("{hash:08x}")[..7]);
        [
            (key("name"), self.name.to_string()),
            (key("hash"), "MurmurHash3_32".to_string()),
            (key("conversion"), "uint32_to_float32".to_string()),
            (key("manifest"), serde_json::to_string(&self.manifest).expect("plain data encodes")),
        ]
    }
}

/// The float of a name: its hash, with a bit of the exponent turned where the bits would be a denormal, infinity or NaN.
fn id_from_name(name: &str) -> f32 {
    let hash = murmur3(name.as_bytes());
    let exponent = hash >> 23 & 0xff;
    f32::from_bits(if exponent == 0 || exponent == 0xff { hash ^ 1 << 23 } else { hash })
}

/// MurmurHash3_x86_32 with seed 0 (Austin Appleby, public domain).
fn murmur3(data: &[u8]) -> u32 {
    let mix = |k: u32| k.wrapping_mul(0xcc9e_2d51).rotate_left(15).wrapping_mul(0x1b87_3593);
    let word = |bytes: &[u8]| bytes.iter().rev().fold(0, |word, &byte| word << 8 | u32::from(byte));
    let whole = data.chunks_exact(4);
    let tail = whole.remainder();
    let mut hash = whole.fold(0, |hash: u32, bytes| {
        let hash = hash ^ mix(word(bytes));
        hash.rotate_left(13).wrapping_mul(5).wrapping_add(0xe654_6b64)
    });
    hash ^= mix(word(tail)) ^ data.len() as u32;
    hash = (hash ^ hash >> 16).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ hash >> 13).wrapping_mul(0xc2b2_ae35);
    hash ^ hash >> 16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_murmurs() {
        // Known answers of MurmurHash3_x86_32 with seed 0.
        let known = [("", 0), ("test", 0xba6b_d213), ("Hello, world!", 0xc036_3e43)];
        assert_eq!(known.map(|(text, _)| murmur3(text.as_bytes())), known.map(|(_, hash)| hash));
        assert_eq!(murmur3(b"The quick brown fox jumps over the lazy dog"), 0x2e4f_f723);
    }

    #[test]
    fn ids_are_ordinary_floats_and_stand_in_the_manifest() {
        let name = |i: i32| (i > 0).then(|| format!("object {i}"));
        let layer = Cryptomatte::new("crypto_instance", &Values::I16(vec![-1, 1, 2, 2]), name);
        assert_eq!((layer.ids[0], layer.coverage[0]), (0.0, 0.0));
        assert!(layer.ids[1..].iter().all(|id| id.is_normal()) && layer.ids[1] != layer.ids[2] && layer.ids[2] == layer.ids[3]);
        let [_, _, _, (key, manifest)] = layer.attributes();
        assert!(key.starts_with("cryptomatte/") && key.ends_with("/manifest"));
        assert!(manifest.contains(&format!("\"object 2\":\"{:08x}\"", layer.ids[2].to_bits())), "{manifest}");
        assert!((0..10_000).all(|i| id_from_name(&i.to_string()).is_normal()));
    }
}
