//! The sorts of cloth that people leave lying.

use enfilade_furniture::cloth::Textile;
use enfilade_furniture::shape::bevelled_box;
use enfilade_furniture::{Builder, Class, Finish};
use enfilade_math::{DAffine3, Rng, Vec3};

/// A sort of cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Textiles {
    /// A shirt, pullover or jacket.
    Shirt,
    /// A pair of trousers.
    Trousers,
    /// A bath towel.
    Towel,
    /// A blanket.
    Blanket,
}

impl Textiles {
    /// Adds an object for it to a scene, whose mesh stands for the cloth until it has fallen.
    pub fn cut(self, b: &mut Builder, rng: &mut Rng) {
        let (family, class, finish) = match self {
            Self::Shirt | Self::Trousers => ("clothes", Class::Clothes, Finish::Clothes(rng.below(8) as u8)),
            Self::Towel => ("towel", Class::Towel, Finish::Towel(rng.below(4) as u8)),
            Self::Blanket if rng.below(2) == 0 => ("blanket", Class::OtherProp, Finish::KnittedThrow),
            Self::Blanket => ("blanket", Class::OtherProp, Finish::Accent(rng.below(3) as u8)),
        };
        let object = b.object(family, class, DAffine3::IDENTITY);
        b.part(&object, "cloth", bevelled_box(Vec3::splat(0.1), 0.001), finish);
    }

    /// How large and thick one is.
    pub fn textile(self, rng: &mut Rng) -> Textile {
        match self {
            Self::Shirt => Textile::shirt(rng),
            Self::Trousers => Textile::trousers(rng),
            Self::Towel => Textile::towel(rng),
            Self::Blanket => Textile::blanket(rng),
        }
    }
}
