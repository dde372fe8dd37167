//! The object that a part belongs to, and its parents.

use crate::{ObjectId, Part, PartId, Scene};

impl Scene {
    /// A number that all parts of one object share and no other part has: it identifies instances. A part without an object is an instance
    /// by itself.
    ///
    /// ```
    /// use enfilade_math::DAffine3;
    /// use enfilade_scene::{Object, Part, Scene};
    ///
    /// let object = |name: &str, parent| Object { name: name.into(), parent };
    /// let part = |name: &str, object| Part { name: name.into(), object, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
    /// let scene = Scene {
    ///     objects: vec![object("World", None), object("chair_1", Some(0)), object("chair_2", Some(0))],
    ///     parts: vec![part("chair_1.seat", Some(1)), part("chair_1.legs", Some(1)), part("chair_2", Some(2)), part("rug", None)],
    ///     ..Scene::default()
    /// };
    /// assert_eq!([0, 1, 2, 3].map(|part| scene.object_of(part)), [1, 1, 2, 6]);
    /// assert_eq!(scene.lineage(&scene.parts[1]), ["World", "chair_1"]);
    /// ```
    ///
    /// # Panics
    /// When there is no such part.
    pub fn object_of(&self, part: PartId) -> u32 {
        self.parts[part as usize].object.unwrap_or(self.objects.len() as u32 + part)
    }

    /// The objects that contain a part, its own first and the outermost last.
    pub fn objects_around<'a>(&'a self, part: &Part) -> impl Iterator<Item = ObjectId> + 'a {
        std::iter::successors(part.object, |&object| self.objects[object as usize].parent)
    }

    /// Names of the objects that contain a part, the outermost first and its own last.
    pub fn lineage(&self, part: &Part) -> Vec<&str> {
        let mut names: Vec<&str> = self.objects_around(part).map(|object| self.objects[object as usize].name.as_str()).collect();
        names.reverse();
        names
    }

    /// Removes the objects that contain no part; the others keep their order.
    pub fn remove_unused_objects(&mut self) {
        let mut used = vec![false; self.objects.len()];
        self.parts.iter().filter_map(|part| part.object).for_each(|object| used[object as usize] = true);
        for object in (0..self.objects.len()).rev() {
            if let Some(parent) = self.objects[object].parent.filter(|_| used[object]) {
                used[parent as usize] = true;
            }
        }
        let mut next = 0;
        let new_index: Vec<u32> = used.iter().map(|&used| (next, next += u32::from(used)).0).collect();
        let renumber = |object: &mut Option<ObjectId>| *object = object.map(|object| new_index[object as usize]);
        self.parts.iter_mut().for_each(|part| renumber(&mut part.object));
        self.objects.iter_mut().for_each(|object| renumber(&mut object.parent));
        let mut keep = used.into_iter();
        self.objects.retain(|_| keep.next().unwrap_or(false));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Object;

    #[test]
    fn objects_without_parts_go_and_parents_of_what_stays_stay() {
        let object = |name: &str, parent| Object { name: name.into(), parent };
        let part = |object| Part { name: "p".into(), object, mesh: 0, material: 0, world_from_mesh: enfilade_math::DAffine3::IDENTITY };
        let objects =
            vec![object("empty", None), object("World", None), object("camera", Some(1)), object("lamp", Some(1)), object("bulb", Some(3))];
        let mut scene = Scene { objects, parts: vec![part(Some(4)), part(None)], ..Scene::default() };
        scene.remove_unused_objects();
        assert_eq!(scene.objects, [object("World", None), object("lamp", Some(0)), object("bulb", Some(1))]);
        assert_eq!(scene.lineage(&scene.parts[0]), ["World", "lamp", "bulb"]);
        assert!(scene.lineage(&scene.parts[1]).is_empty());
    }
}
