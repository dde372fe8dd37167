//! Reading accessors: typed, strided, normalized, sparse, with every bound checked.

use super::container::{Document, MAX_ZEROS};
use gltf::json::Index;
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;

impl Document {
    /// The elements of an accessor of vectors of `N` components, or of 4×4 matrices column by column, as floats (normalized integers mapped
    /// to [0,1] or [−1,1]).
    ///
    /// # Errors
    /// The fault of the accessor, as the rest of a sentence.
    pub(super) fn vectors<const N: usize>(&self, index: Index<Accessor>) -> Result<Vec<[f32; N]>, String> {
        let flat = self.components(index, N)?;
        Ok(flat.chunks_exact(N).map(|c| std::array::from_fn(|i| c[i] as f32)).collect())
    }

    /// The elements of an accessor of vertex indices.
    ///
    /// # Errors
    /// The fault of the accessor, as the rest of a sentence.
    pub(super) fn indices(&self, index: Index<Accessor>) -> Result<Vec<u32>, String> {
        Ok(self.components(index, 1)?.into_iter().map(|v| v as u32).collect())
    }

    /// All components in order. Doubles represent every component type exactly.
    fn components(&self, index: Index<Accessor>, per_element: usize) -> Result<Vec<f64>, String> {
        let name = format!("accessors[{}]", index.value());
        let accessor = self
            .root
            .accessors
            .get(index.value())
            .ok_or_else(|| format!("refers to accessor {}, but there are only {}", index.value(), self.root.accessors.len()))?;
        let Checked::Valid(component) = accessor.component_type else { return Err(format!("{name} has an unknown componentType")) };
        let found = match accessor.type_ {
            Checked::Valid(Type::Scalar) => 1,
            Checked::Valid(Type::Vec2) => 2,
            Checked::Valid(Type::Vec3) => 3,
            Checked::Valid(Type::Vec4) => 4,
            Checked::Valid(Type::Mat4) => 16,
            _ => return Err(format!("{name} holds small matrices or an unknown type, expected {per_element} components")),
        };
        if found != per_element {
            return Err(format!("{name} holds {found} components an element, expected {per_element}"));
        }
        let layout = Layout { component: component.0, per_element, normalized: accessor.normalized };
        let count = accessor.count.0;
        let mut values = match accessor.buffer_view {
            Some(view) => self.elements(&name, view.value(), accessor.byte_offset.map_or(0, |o| o.0), count, layout)?,
            None => vec![0.0; self.zeros(&name, count, per_element)?],
        };
        if let Some(sparse) = &accessor.sparse {
            let Checked::Valid(kind) = sparse.indices.component_type else {
                return Err(format!("{name}.sparse.indices has an unknown componentType"));
            };
            let places = Layout { component: kind.0, per_element: 1, normalized: false };
            let (i, v) = (&sparse.indices, &sparse.values);
            let places =
                self.elements(&format!("{name}.sparse.indices"), i.buffer_view.value(), i.byte_offset.0, sparse.count.0, places)?;
            let new = self.elements(&format!("{name}.sparse.values"), v.buffer_view.value(), v.byte_offset.0, sparse.count.0, layout)?;
            for (place, element) in places.into_iter().zip(new.chunks_exact(per_element)) {
                let at = place as usize * per_element;
                let slot = values.get_mut(at..at + per_element);
                slot.ok_or_else(|| format!("{name}.sparse replaces element {place}, but there are only {count}"))?.copy_from_slice(element);
            }
        }
        Ok(values)
    }

    /// Number of components of an accessor without a bufferView, if the file may still ask for that many.
    fn zeros(&self, name: &str, count: u64, per_element: usize) -> Result<usize, String> {
        let wanted = count.checked_mul(per_element as u64).filter(|&wanted| wanted <= self.zeros_left.get());
        let wanted = wanted.ok_or_else(|| {
            format!("{name} has {count} elements and no bufferView; expected at most {MAX_ZEROS} such numbers in a file: it is damaged")
        })?;
        self.zeros_left.set(self.zeros_left.get() - wanted);
        Ok(wanted as usize)
    }

    fn elements(&self, name: &str, view: usize, offset: u64, count: u64, layout: Layout) -> Result<Vec<f64>, String> {
        let (bytes, view_json) = self.view(view).map_err(|e| format!("{name}: {e}"))?;
        let size = layout.size();
        let stride = view_json.byte_stride.map_or(size as u64, |s| s.0 as u64);
        if stride < size as u64 {
            return Err(format!("{name}: bufferViews[{view}] has a stride of {stride} bytes for elements of {size}"));
        }
        if count == 0 {
            return Ok(Vec::new());
        }
        let end = (count - 1).checked_mul(stride).and_then(|n| n.checked_add(offset)).and_then(|n| n.checked_add(size as u64));
        if end.is_none_or(|end| end > bytes.len() as u64) {
            return Err(format!(
                "{name} has {count} elements of {size} bytes from byte {offset}, but bufferViews[{view}] has only {} bytes; the file is \
                 damaged, so export it again",
                bytes.len()
            ));
        }
        let mut values = Vec::with_capacity(count as usize * layout.per_element);
        for i in 0..count {
            let element = &bytes[(offset + i * stride) as usize..][..size];
            values.extend(element.chunks_exact(layout.component_size()).map(|c| layout.value(c)));
        }
        Ok(values)
    }
}

#[derive(Clone, Copy)]
struct Layout {
    component: ComponentType,
    per_element: usize,
    normalized: bool,
}

impl Layout {
    fn component_size(self) -> usize {
        match self.component {
            ComponentType::I8 | ComponentType::U8 => 1,
            ComponentType::I16 | ComponentType::U16 => 2,
            ComponentType::U32 | ComponentType::F32 => 4,
        }
    }

    fn size(self) -> usize {
        self.component_size() * self.per_element
    }

    /// One component from exactly its bytes.
    fn value(self, b: &[u8]) -> f64 {
        let (value, largest) = match self.component {
            ComponentType::I8 => (f64::from(b[0] as i8), 127.0),
            ComponentType::U8 => (f64::from(b[0]), 255.0),
            ComponentType::I16 => (f64::from(i16::from_le_bytes([b[0], b[1]])), 32_767.0),
            ComponentType::U16 => (f64::from(u16::from_le_bytes([b[0], b[1]])), 65_535.0),
            ComponentType::U32 => (f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])), f64::from(u32::MAX)),
            ComponentType::F32 => return f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        };
        if self.normalized { (value / largest).max(-1.0) } else { value }
    }
}
