//! Colours that go together.

use crate::texture::WoodTone;
use enfilade_math::{Rgb, Rng};

/// The colours of one home, linear reflectances.
#[derive(Clone, Copy, Debug)]
pub struct Palette {
    /// Three of the walls.
    pub wall: Rgb,
    /// The wall behind the sofa.
    pub accent_wall: Rgb,
    /// The floor.
    pub floor: WoodTone,
    /// Furniture.
    pub wood: WoodTone,
    /// The sofa's cloth.
    pub sofa: Rgb,
    /// The armchair's cloth.
    pub armchair: Rgb,
    /// Ground and figure of the rug.
    pub rug: [Rgb; 2],
    /// Curtains.
    pub curtain: Rgb,
    /// Scatter cushions and the throw.
    pub accents: [Rgb; 3],
    /// Pictures: ground, then from light to dark.
    pub art: [Rgb; 5],
}

fn srgb(hex: u32) -> Rgb {
    Rgb::from_srgb8([(hex >> 16) as u8, (hex >> 8) as u8, hex as u8])
}

impl Palette {
    /// One of the curated palettes; seed 0 of the default home gets the first.
    pub fn choose(seed: u64, rng: &mut Rng) -> Self {
        let all = Self::all();
        if seed == 0 { all[0] } else { all[rng.below(all.len())] }
    }

    /// Every palette.
    pub fn all() -> [Self; 5] {
        let white = Rgb::new(0.80, 0.785, 0.75);
        [
            // Sage wall, grey-blue sofa, mustard and rust.
            Self {
                wall: white,
                accent_wall: srgb(0xbcc5b2),
                floor: WoodTone::OAK,
                wood: WoodTone::OAK,
                sofa: srgb(0x9aa3aa),
                armchair: srgb(0xb9784a),
                rug: [srgb(0xd9d0bf), srgb(0x55585c)],
                curtain: srgb(0xded6c6),
                accents: [srgb(0xc79a3a), srgb(0xa65436), srgb(0xe0d8c8)],
                art: [srgb(0xece5d8), srgb(0xd9b48a), srgb(0xc8743f), srgb(0x6f8a86), srgb(0x2f4550)],
            },
            // Warm white, walnut, terracotta and cream.
            Self {
                wall: srgb(0xe2d9cb),
                accent_wall: srgb(0xc9a58c),
                floor: WoodTone::SMOKED,
                wood: WoodTone::WALNUT,
                sofa: srgb(0xcfc4b1),
                armchair: srgb(0x5e6b4f),
                rug: [srgb(0xc7b299), srgb(0x8c4a32)],
                curtain: srgb(0xe3dccf),
                accents: [srgb(0xb0583a), srgb(0x6c7a56), srgb(0xd8bf96)],
                art: [srgb(0xefe6d6), srgb(0xe0b890), srgb(0xb85c3a), srgb(0x7a8060), srgb(0x3b3a34)],
            },
            // Scandinavian: white, pale ash, navy.
            Self {
                wall: srgb(0xe4e4e0),
                accent_wall: srgb(0x8fa3b3),
                floor: WoodTone::ASH,
                wood: WoodTone::ASH,
                sofa: srgb(0x3d4f66),
                armchair: srgb(0xcabfae),
                rug: [srgb(0xe0dccf), srgb(0x6d7f92)],
                curtain: srgb(0xe6e4de),
                accents: [srgb(0xd9b45a), srgb(0xdedbd2), srgb(0x7d93a8)],
                art: [srgb(0xf0eee8), srgb(0xb8c6d0), srgb(0xdba95a), srgb(0x5f7b94), srgb(0x22344a)],
            },
            // Sand and olive.
            Self {
                wall: srgb(0xe0d8c6),
                accent_wall: srgb(0xb7b38d),
                floor: WoodTone::OAK,
                wood: WoodTone::SMOKED,
                sofa: srgb(0x6e7354),
                armchair: srgb(0xc9b08a),
                rug: [srgb(0xd3c6ab), srgb(0x7a6a4f)],
                curtain: srgb(0xd9cfb9),
                accents: [srgb(0xd0a24c), srgb(0xe1d9c5), srgb(0x8a5a3c)],
                art: [srgb(0xeee7d4), srgb(0xd5c08e), srgb(0xa9863f), srgb(0x75805a), srgb(0x3a4230)],
            },
            // Greys with petrol and blush.
            Self {
                wall: srgb(0xdcdad6),
                accent_wall: srgb(0xd9bdb0),
                floor: WoodTone::ASH,
                wood: WoodTone::OAK,
                sofa: srgb(0xa7a39c),
                armchair: srgb(0x2f5f66),
                rug: [srgb(0xcfcac2), srgb(0x9c7a70)],
                curtain: srgb(0xdad6cf),
                accents: [srgb(0x2f6a70), srgb(0xcf9a8a), srgb(0xe6e0d8)],
                art: [srgb(0xefeae4), srgb(0xe0b8a8), srgb(0xc97f6c), srgb(0x4f8086), srgb(0x24404a)],
            },
        ]
    }
}
