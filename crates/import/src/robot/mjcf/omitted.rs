//! What was left out of a model's geoms.

use super::forms::ENDLESS_M;
use crate::assembly::Assembly;

/// Geoms that were left out, and why.
#[derive(Default)]
pub(super) struct Omitted {
    pub groups: usize,
    pub invisible: usize,
    pub endless: usize,
    /// Geoms of collision of group 0 beside visual ones of group 1, as robosuite has them.
    pub doubled: [usize; 2],
}

impl Omitted {
    /// Says what was left out.
    pub(super) fn report(&self, a: &mut Assembly) {
        let chosen = a.options().geom_groups.clone();
        let read = if chosen.is_empty() { "0, 1 and 2, which MuJoCo's viewer shows,".into() } else { format!("{chosen:?}") };
        if self.groups > 0 {
            let message =
                format!("{} geoms of other groups were left out: those of {read} are read (geom_groups chooses others)", self.groups);
            a.warn("geoms", message);
        }
        if self.invisible > 0 {
            a.warn("geoms", format!("{} geoms have an opacity of zero and were left out", self.invisible));
        }
        if self.endless > 0 {
            a.warn(
                "geoms",
                format!("{} planes have no end; they were cut {ENDLESS_M} m from their middle (size states another)", self.endless),
            );
        }
        let [collision, visual] = self.doubled;
        if collision > 0 && visual > 0 && chosen.is_empty() {
            let message = format!(
                "{collision} geoms of group 0 collide and {visual} of group 1 are only seen, as in robosuite, which shows group 1 alone: \
                 geom_groups = [1] leaves the others out"
            );
            a.warn("geoms", message);
        }
    }
}
