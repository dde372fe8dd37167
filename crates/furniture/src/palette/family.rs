//! Palettes chosen by eye, written as the sRGB codes that a colour picker shows.

use super::colors::{Palette, WHITE};
use super::tiles::{floor_tile, wall_tile};
use enfilade_math::{Rgb, Rng};
use enfilade_textures::{PaperPattern, Pattern, SlabLook, WoodTone};

/// A palette in sRGB codes.
pub(super) struct Family {
    /// Wall, accent wall.
    walls: [u32; 2],
    floor: WoodTone,
    wood: WoodTone,
    /// Sofa, armchair, curtain.
    cloth: [u32; 3],
    rug: [u32; 2],
    accents: [u32; 3],
    /// Ground, then from light to dark.
    art: [u32; 5],
    /// Lower and upper fronts.
    kitchen: [u32; 2],
    slab: SlabLook,
    leather: u32,
}

fn srgb(hex: u32) -> Rgb {
    Rgb::from_srgb8([(hex >> 16) as u8, (hex >> 8) as u8, hex as u8])
}

impl Family {
    /// The palette; `rng` chooses tiles and patterns.
    pub fn palette(&self, rng: &mut Rng) -> Palette {
        let wall = if self.walls[0] == PLAIN { WHITE } else { srgb(self.walls[0]) };
        let art = self.art.map(srgb);
        let mut palette = Palette {
            wall,
            accent_wall: srgb(self.walls[1]),
            floor: self.floor,
            wood: self.wood,
            sofa: srgb(self.cloth[0]),
            armchair: srgb(self.cloth[1]),
            rug: self.rug.map(srgb),
            curtain: srgb(self.cloth[2]),
            accents: self.accents.map(srgb),
            art,
            kitchen: self.kitchen.map(srgb),
            slab: self.slab,
            floor_tile: floor_tile(0, [art[3], art[4]], rng),
            wall_tile: wall_tile(0, [art[1], art[3]], rng),
            linen: [wall; 2],
            linen_pattern: Pattern::Plain,
            paper: PaperPattern::Grass,
            leather: srgb(self.leather),
        };
        palette.details(rng);
        palette
    }
}

/// The white of most walls.
const PLAIN: u32 = 0xe8e6e0;

pub(super) const FAMILIES: [Family; 15] = [
    // Sage wall, grey-blue sofa, mustard and rust.
    Family {
        walls: [PLAIN, 0xbcc5b2],
        floor: WoodTone::OAK,
        wood: WoodTone::OAK,
        cloth: [0x9aa3aa, 0xb9784a, 0xded6c6],
        rug: [0xd9d0bf, 0x55585c],
        accents: [0xc79a3a, 0xa65436, 0xe0d8c8],
        art: [0xece5d8, 0xd9b48a, 0xc8743f, 0x6f8a86, 0x2f4550],
        kitchen: [0x8a9a86, 0xe6e3da],
        slab: SlabLook::CARRARA,
        leather: 0x8a5430,
    },
    // Warm white, walnut, terracotta and cream.
    Family {
        walls: [0xe2d9cb, 0xc9a58c],
        floor: WoodTone::SMOKED,
        wood: WoodTone::WALNUT,
        cloth: [0xcfc4b1, 0x5e6b4f, 0xe3dccf],
        rug: [0xc7b299, 0x8c4a32],
        accents: [0xb0583a, 0x6c7a56, 0xd8bf96],
        art: [0xe9e0d0, 0xe0b890, 0xb85c3a, 0x7a8060, 0x3b3a34],
        kitchen: [0x6e7258, 0xe2d9cb],
        slab: SlabLook::CALACATTA,
        leather: 0x6b3d24,
    },
    // Scandinavian: white, pale ash, navy.
    Family {
        walls: [0xe4e4e0, 0x8fa3b3],
        floor: WoodTone::ASH,
        wood: WoodTone::ASH,
        cloth: [0x3d4f66, 0xcabfae, 0xe3e1db],
        rug: [0xe0dccf, 0x6d7f92],
        accents: [0xd9b45a, 0xdedbd2, 0x7d93a8],
        art: [0xe8e6e0, 0xb8c6d0, 0xdba95a, 0x5f7b94, 0x22344a],
        kitchen: [0xe3e2dd, 0xe3e2dd],
        slab: SlabLook::QUARTZ,
        leather: 0xa8743f,
    },
    // Sand and olive.
    Family {
        walls: [0xe0d8c6, 0xb7b38d],
        floor: WoodTone::OAK,
        wood: WoodTone::SMOKED,
        cloth: [0x6e7354, 0xc9b08a, 0xd9cfb9],
        rug: [0xd3c6ab, 0x7a6a4f],
        accents: [0xd0a24c, 0xe1d9c5, 0x8a5a3c],
        art: [0xe6dfcc, 0xd5c08e, 0xa9863f, 0x75805a, 0x3a4230],
        kitchen: [0x7d8262, 0xd8cfb8],
        slab: SlabLook::LIMESTONE,
        leather: 0x59402a,
    },
    // Greys with petrol and blush.
    Family {
        walls: [0xdcdad6, 0xd9bdb0],
        floor: WoodTone::WHITE_OAK,
        wood: WoodTone::OAK,
        cloth: [0xa7a39c, 0x2f5f66, 0xdad6cf],
        rug: [0xcfcac2, 0x9c7a70],
        accents: [0x2f6a70, 0xcf9a8a, 0xe3ddd5],
        art: [0xe7e2dc, 0xe0b8a8, 0xc97f6c, 0x4f8086, 0x24404a],
        kitchen: [0xd8d6d2, 0x9aa0a0],
        slab: SlabLook::CARRARA,
        leather: 0x4a3a30,
    },
    // Dark: ink-blue walls, walnut, brass and ochre.
    Family {
        walls: [0x2f3e4c, 0x243240],
        floor: WoodTone::SMOKED,
        wood: WoodTone::WALNUT,
        cloth: [0x8f6a3e, 0x2c4a52, 0x46525c],
        rug: [0x9c8f7a, 0x2b3844],
        accents: [0xc08b3a, 0x9c4f38, 0xcfc4b0],
        art: [0xded5c4, 0xd0a868, 0xa8603c, 0x50707c, 0x1c2833],
        kitchen: [0x2a3946, 0x2a3946],
        slab: SlabLook::CALACATTA,
        leather: 0x7a4526,
    },
    // Dark green library: bottle green, cherry, oxblood.
    Family {
        walls: [0x3a4a3e, 0x2c3a31],
        floor: WoodTone::CHERRY,
        wood: WoodTone::CHERRY,
        cloth: [0x6b2f2a, 0x8a7a52, 0x6a6a4e],
        rug: [0x7c3a30, 0x2e3a3e],
        accents: [0xb88a3c, 0x7d3530, 0xc9bb9c],
        art: [0xdcd2bc, 0xc8a468, 0x9a5038, 0x5c6e58, 0x262c24],
        kitchen: [0x36463a, 0xd6cdb8],
        slab: SlabLook::VERDE,
        leather: 0x5a2a1e,
    },
    // Colourful: white, cobalt, coral, sun yellow.
    Family {
        walls: [PLAIN, 0xe2b23a],
        floor: WoodTone::BIRCH,
        wood: WoodTone::BIRCH,
        cloth: [0x2f55a0, 0xd9604a, 0xe4dfd2],
        rug: [0xe2ddd0, 0xd04f48],
        accents: [0xe5b52e, 0x3a8f86, 0xd9604a],
        art: [0xe8e4da, 0xe8b83a, 0xdb5f48, 0x3a8f96, 0x27407c],
        kitchen: [0x3a6ea0, 0xe8e6df],
        slab: SlabLook::QUARTZ,
        leather: 0xb0642e,
    },
    // Mint and raspberry of the fifties.
    Family {
        walls: [0xdfe4d8, 0x9fc4b4],
        floor: WoodTone::OAK,
        wood: WoodTone::CHERRY,
        cloth: [0x4f8f86, 0xc24e62, 0xe2d8c6],
        rug: [0xd8d2c0, 0x5c9488],
        accents: [0xc84e66, 0xe0c060, 0x6aa698],
        art: [0xe9e4d6, 0xe8c878, 0xd0607a, 0x5a9a90, 0x2c4a50],
        kitchen: [0x8fbcae, 0xe6e2d4],
        slab: SlabLook::CARRARA,
        leather: 0x8c3a34,
    },
    // Loft: concrete greys, black, cognac.
    Family {
        walls: [0xcfcdc8, 0x8e8c88],
        floor: WoodTone::SMOKED,
        wood: WoodTone::PINE,
        cloth: [0x4a4a4c, 0x9a5a2c, 0xa8a49c],
        rug: [0x8c8880, 0x3a3a3a],
        accents: [0xa85f2c, 0x3e4c44, 0xc8c2b6],
        art: [0xdedad2, 0xbcb4a8, 0xb0642e, 0x68706c, 0x202222],
        kitchen: [0x2c2d2e, 0x6a6864],
        slab: SlabLook::ABSOLUTE_BLACK,
        leather: 0x94541f,
    },
    // Japanese quiet: rice white, pale oak, indigo, moss.
    Family {
        walls: [0xe4ddce, 0xcfc4ac],
        floor: WoodTone::WHITE_OAK,
        wood: WoodTone::WHITE_OAK,
        cloth: [0xb8ae9a, 0x39435c, 0xdcd4c2],
        rug: [0xc2b694, 0x8a8060],
        accents: [0x3b4866, 0x7c8460, 0xd8ceb8],
        art: [0xe8e2d4, 0xcabfa4, 0x8c8a66, 0x4c5876, 0x22242c],
        kitchen: [0xd8ceb8, 0xd8ceb8],
        slab: SlabLook::LIMESTONE,
        leather: 0x463228,
    },
    // Mediterranean: limewash, azure, terracotta.
    Family {
        walls: [0xe7e1d3, 0x7fa4b8],
        floor: WoodTone::PINE,
        wood: WoodTone::PINE,
        cloth: [0xe0d6c0, 0x3f7ea0, 0xe4dccb],
        rug: [0xd9c8a4, 0x4a7f9c],
        accents: [0x3b78a0, 0xc4683c, 0xe2cf8e],
        art: [0xeae3d4, 0xe4c884, 0xcc6a3e, 0x4c8aac, 0x24486a],
        kitchen: [0x6f98ae, 0xe6dfd0],
        slab: SlabLook::LIMESTONE,
        leather: 0x9c6236,
    },
    // Plum, dusty rose, brass.
    Family {
        walls: [0xdccfca, 0x7c4f5e],
        floor: WoodTone::WALNUT,
        wood: WoodTone::WALNUT,
        cloth: [0x6e4054, 0xc08a86, 0xcdbab4],
        rug: [0xc4aaa6, 0x66404e],
        accents: [0x8c4c62, 0xc69a50, 0xd9bfba],
        art: [0xe6dcd6, 0xd8b0a4, 0xb86a6c, 0x7a5a72, 0x36263a],
        kitchen: [0x8a5c6a, 0xded4ce],
        slab: SlabLook::CALACATTA,
        leather: 0x5c2c30,
    },
    // Pure white and black, one red.
    Family {
        walls: [0xe9e9e7, 0xe9e9e7],
        floor: WoodTone::BIRCH,
        wood: WoodTone::SMOKED,
        cloth: [0x28292b, 0xb02a26, 0xe6e6e3],
        rug: [0xdededa, 0x232425],
        accents: [0xb42c28, 0x2a2b2d, 0xdcdcd8],
        art: [0xe9e9e6, 0xb8b8b4, 0xb8322c, 0x626466, 0x1d1e20],
        kitchen: [0xe8e8e5, 0x26272a],
        slab: SlabLook::MARQUINA,
        leather: 0x1e1c1b,
    },
    // Children's pastels: lilac, butter, sky.
    Family {
        walls: [0xe7e3dc, 0xb9c4dc],
        floor: WoodTone::BIRCH,
        wood: WoodTone::BIRCH,
        cloth: [0xa9b4cc, 0xe0c890, 0xe4dce4],
        rug: [0xe2dcd4, 0xb0a0c4],
        accents: [0xe2c46c, 0xb09cc8, 0x94bcd0],
        art: [0xeae6e0, 0xe6cc84, 0xd89aa4, 0x88a8cc, 0x54588c],
        kitchen: [0xa4bccb, 0xe8e5df],
        slab: SlabLook::GRANITE,
        leather: 0xa06c44,
    },
];
