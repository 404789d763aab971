//! Every index has a type. Arithmetic on ids is done only here and in storage.

use serde::{Deserialize, Serialize};
use std::marker::PhantomData;
use std::ops::{Index, IndexMut};

/// An index into one kind of table.
pub trait Id: Copy + Eq + Ord + std::hash::Hash + std::fmt::Debug {
    /// The id of row `index` of its table.
    fn from_index(index: usize) -> Self;
    /// The row of the table, from 0.
    fn index(self) -> usize;
}

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub u32);

        impl Id for $name {
            #[inline]
            fn from_index(index: usize) -> Self {
                debug_assert!(index < u32::MAX as usize);
                Self(index as u32)
            }
            #[inline]
            fn index(self) -> usize {
                self.0 as usize
            }
        }
    )*};
}

ids! {
    /// A vertex of a triangulation or a node of a mesh.
    VertexId,
    /// A triangle of a triangulation or a mesh.
    TriangleId,
    /// A point of P, the input points of a domain.
    PointId,
    /// A curve of a domain.
    CurveId,
    /// A tetrahedron of a triangulation or a mesh.
    TetId,
    /// A segment of a solid: a straight edge between two of its points.
    SegmentId,
    /// A facet of a solid: a polygon, with holes, of one plane.
    FacetId,
    /// A subcurve: a part of a curve (or of a corner arc) in C′, the subcurves of a refinement.
    SubcurveId,
    /// A kept region of a domain.
    RegionId,
    /// A name: of boundaries, of regions, of layers.
    NameId,
    /// A filled shape of a picture.
    ShapeId,
    /// A clip of shapes and curves of a picture.
    ClipId,
    /// A list of the shapes that are painted on a face of a picture.
    SeenId,
    /// A layer of a drawing.
    LayerId,
    /// A protecting ball around an acute corner.
    BallId,
    /// A fan: curves around a sharp corner that are cut together.
    FanId,
}

/// Red, green, blue (sRGB) and opacity.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Colour(pub [u8; 4]);

/// A vector indexed by one kind of id.
#[derive(Clone, PartialEq, Debug)]
pub struct IdVec<I, T> {
    items: Vec<T>,
    kind: PhantomData<fn(I)>,
}

impl<I: Id, T> IdVec<I, T> {
    /// A vector without items.
    pub const fn new() -> Self {
        Self { items: Vec::new(), kind: PhantomData }
    }

    /// A vector without items, with room for `n` of them.
    pub fn with_capacity(n: usize) -> Self {
        Vec::with_capacity(n).into()
    }

    /// Appends an item and returns its id.
    pub fn push(&mut self, item: T) -> I {
        let id = I::from_index(self.items.len());
        self.items.push(item);
        id
    }

    /// Number of items.
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Whether there are no items.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// The item of an id; `None` where the vector is too short.
    pub fn get(&self, id: I) -> Option<&T> {
        self.items.get(id.index())
    }

    /// Every id, ascending.
    pub fn ids(&self) -> impl DoubleEndedIterator<Item = I> + ExactSizeIterator + use<I, T> {
        (0..self.items.len()).map(I::from_index)
    }

    /// The items, by ascending id.
    pub fn iter(&self) -> std::slice::Iter<'_, T> {
        self.items.iter()
    }

    /// The items by ascending id, mutable.
    pub fn iter_mut(&mut self) -> std::slice::IterMut<'_, T> {
        self.items.iter_mut()
    }

    /// The items with their ids, ascending.
    pub fn enumerate(&self) -> impl DoubleEndedIterator<Item = (I, &T)> + ExactSizeIterator {
        self.items.iter().enumerate().map(|(i, item)| (I::from_index(i), item))
    }

    /// The items by ascending id, as a slice.
    pub fn as_slice(&self) -> &[T] {
        &self.items
    }

    /// Truncates the vector to `n` items, or appends copies of `item` until it has `n`.
    pub fn resize(&mut self, n: usize, item: T)
    where
        T: Clone,
    {
        self.items.resize(n, item);
    }
}

impl<I: Id, T> Default for IdVec<I, T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<I, T> From<Vec<T>> for IdVec<I, T> {
    fn from(items: Vec<T>) -> Self {
        Self { items, kind: PhantomData }
    }
}

impl<I: Id, T> FromIterator<T> for IdVec<I, T> {
    fn from_iter<It: IntoIterator<Item = T>>(items: It) -> Self {
        items.into_iter().collect::<Vec<_>>().into()
    }
}

impl<I: Id, T> Index<I> for IdVec<I, T> {
    type Output = T;
    #[inline]
    fn index(&self, id: I) -> &T {
        &self.items[id.index()]
    }
}

impl<I: Id, T> IndexMut<I> for IdVec<I, T> {
    #[inline]
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.items[id.index()]
    }
}

/// Names by id, each text once, in the order of first use.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Names {
    texts: IdVec<NameId, String>,
    by_text: std::collections::BTreeMap<String, NameId>,
}

impl Names {
    /// The id of `text`, which is recorded if it is new.
    pub fn intern(&mut self, text: &str) -> NameId {
        if let Some(&id) = self.by_text.get(text) {
            return id;
        }
        let id = self.texts.push(text.to_owned());
        self.by_text.insert(text.to_owned(), id);
        id
    }

    /// The id of `text`; `None` where it was never recorded.
    pub fn find(&self, text: &str) -> Option<NameId> {
        self.by_text.get(text).copied()
    }

    /// The text of an id that this table gave.
    pub fn text(&self, id: NameId) -> &str {
        &self.texts[id]
    }

    /// Ids and texts, in the order of first use.
    pub fn iter(&self) -> impl Iterator<Item = (NameId, &str)> {
        self.texts.enumerate().map(|(id, text)| (id, text.as_str()))
    }
}

/// Disjoint sets of the numbers from 0 (union–find). The least number of a set is its root.
pub struct Forest {
    parent: Vec<usize>,
}

impl Forest {
    /// `n` sets of one number each.
    pub fn new(n: usize) -> Self {
        Self { parent: (0..n).collect() }
    }

    /// The root of the set of `i`.
    pub fn root(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    /// Makes one set of the sets of `a` and `b`.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b);
    }
}
