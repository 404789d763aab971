//! Angles, areas and lengths of a mesh.
