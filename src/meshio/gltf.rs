//! glTF 2.0: `.glb`, or `.gltf` with its buffer inside as base64.
//!
//! Each region has a node with a mesh of one primitive (triangles), then each boundary has one (lines), under its name.
//! All share one list of positions. `extras` of a primitive hold `{"region": NAME}` or `{"boundary": NAME}`. The
//! material of a region has its name, and its colour in the drawing if there is one. All nodes are children of the
//! root. The root converts to metres (an unknown unit is kept; `extras` name it) and to +Y up: a mesh in the plane
//! keeps its y, a mesh in space is rotated from CAD's +Z up. The root is also shifted to the middle of the mesh,
//! because positions are float32 and would lose small features far from the origin.
//!
//! MeshLab makes triangles of the lines, so they can be left out (`lines` false).
//!
//! Cells of order 2 are written as straight ones between all their nodes: four for a triangle, two for an edge. Not
//! held: order 2, more than float32 of a coordinate, links to curves, balls. A mesh without triangles is refused,
//! because glTF has none.

use super::colours;
use super::groups::{Groups, straight_edges, straight_triangles};
use super::losses::Losses;
use super::{Choice, Facts, WriteOptions, one_file};
use crate::geometry::metres;
use crate::mesh::Mesh;
use base64::Engine;
use gltf_json as json;
use json::accessor::{ComponentType, GenericComponentType, Type};
use json::buffer::Target;
use json::mesh::{Mode, Primitive, Semantic};
use json::validation::{Checked::Valid, USize64};
use json::{Index, Root};
use serde_json::json;
use std::f32::consts::FRAC_1_SQRT_2;
use std::io::{self, Write};

/// The facts of binary glTF.
pub(super) const FACTS_OF_GLB: Facts = Facts {
    name: "glb",
    suffixes: &["glb"],
    write: Some(|mesh, _, options| one_file(|out| write_glb(mesh, has_lines(options), out))),
    ..FACTS
};

/// The facts of glTF as JSON.
pub(super) const FACTS: Facts = Facts {
    name: "gltf",
    suffixes: &["gltf"],
    first_as_named: true,
    choices: &[Choice::Lines],
    straight_only: None,
    write: Some(|mesh, _, options| one_file(|out| write_gltf(mesh, has_lines(options), out))),
    write_solid: None,
    losses,
    reading: None,
};

fn has_lines(options: &WriteOptions) -> bool {
    options.lines.unwrap_or(true)
}

fn losses(losses: &mut Losses) {
    losses.interior_lines();
    losses.lines(has_lines(losses.options));
    losses.names_of_points();
    losses.order_2();
    losses.tell(true, "digits: coordinates are float32 about the middle of the mesh");
    losses.links();
}

/// Writes binary glTF, with the boundaries as lines if `lines`.
///
/// # Errors
/// Those of `out`; `Unsupported` where there are no triangles; `InvalidInput` where the lists of the mesh do not fit
/// together, where
/// a coordinate exceeds float32 or the file exceeds 4 GB.
fn write_glb(mesh: &Mesh, lines: bool, out: &mut impl Write) -> io::Result<()> {
    let (root, mut binary) = Scene::of(mesh, lines)?.finish(None)?;
    let mut text = root.to_vec().map_err(io::Error::other)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let word = |n: usize| u32::try_from(n).map_err(|_| invalid("the mesh is larger than a .glb can be (4 GB)"));
    out.write_all(b"glTF")?;
    for n in [2, word(28 + text.len() + binary.len())?, word(text.len())?] {
        out.write_all(&n.to_le_bytes())?;
    }
    out.write_all(b"JSON")?;
    out.write_all(&text)?;
    out.write_all(&word(binary.len())?.to_le_bytes())?;
    out.write_all(b"BIN\0")?;
    out.write_all(&binary)
}

/// Writes glTF as JSON with everything inside, with the boundaries as lines if `lines`.
///
/// # Errors
/// As [`write_glb`].
fn write_gltf(mesh: &Mesh, lines: bool, out: &mut impl Write) -> io::Result<()> {
    let mut scene = Scene::of(mesh, lines)?;
    let base64 = base64::engine::general_purpose::STANDARD.encode(&scene.binary);
    scene.binary.clear();
    let (root, _) = scene.finish(Some(format!("data:application/octet-stream;base64,{base64}")))?;
    root.to_writer(&mut *out).map_err(io::Error::other)?;
    writeln!(out)
}

fn invalid(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, what)
}

type Extras = json::Extras;

fn extras(value: &serde_json::Value) -> io::Result<Extras> {
    Ok(Some(json::extras::RawValue::from_string(value.to_string()).map_err(io::Error::other)?))
}

/// The document so far, and its one buffer.
struct Scene {
    root: Root,
    buffer: Index<json::Buffer>,
    binary: Vec<u8>,
}

impl Scene {
    fn of(mesh: &Mesh, lines: bool) -> io::Result<Self> {
        let groups = Groups::of(mesh)?;
        if mesh.triangles.is_empty() {
            let what = "glTF has no meshes without triangles";
            return Err(io::Error::new(io::ErrorKind::Unsupported, what));
        }
        let mut root = Root::default();
        root.asset.generator = Some(format!("squinch {}", env!("CARGO_PKG_VERSION")));
        let (byte_length, name) = (USize64(0), None);
        let buffer = root.push(json::Buffer { byte_length, name, uri: None, extensions: None, extras: None });
        let mut scene = Self { root, buffer, binary: Vec::new() };
        let placement = Placement::of(mesh);
        let positions = scene.positions(mesh, placement.origin)?;
        let mut nodes = scene.regions(mesh, &groups, positions)?;
        if lines {
            nodes.extend(scene.boundaries(mesh, &groups, positions)?);
        }
        scene.root(mesh, nodes, &placement)?;
        Ok(scene)
    }

    fn finish(mut self, uri: Option<String>) -> io::Result<(Root, Vec<u8>)> {
        self.root.buffers[0].uri = uri;
        Ok((self.root, self.binary))
    }

    /// Adds bytes to the buffer, as a view.
    fn view(&mut self, bytes: &[u8], target: Target) -> Index<json::buffer::View> {
        let offset = self.binary.len();
        self.binary.extend_from_slice(bytes);
        self.root.buffers[0].byte_length = USize64::from(self.binary.len());
        self.root.push(json::buffer::View {
            buffer: self.buffer,
            byte_length: USize64::from(bytes.len()),
            byte_offset: Some(USize64::from(offset)),
            byte_stride: None,
            name: None,
            target: Some(Valid(target)),
            extensions: None,
            extras: None,
        })
    }

    fn positions(&mut self, mesh: &Mesh, origin: [f64; 3]) -> io::Result<Index<json::Accessor>> {
        let local = |place: [f64; 3]| std::array::from_fn(|k| (place[k] - origin[k]) as f32);
        let positions: Vec<[f32; 3]> = mesh.places().map(local).collect();
        if positions.iter().flatten().any(|x| !x.is_finite()) {
            return Err(invalid("coordinates are larger than float32, which glTF has, can hold"));
        }
        let bytes: Vec<u8> = positions.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes, Target::ArrayBuffer);
        let extreme = |pick: fn(f32, f32) -> f32| -> [f32; 3] {
            positions.iter().copied().reduce(|a, b| std::array::from_fn(|k| pick(a[k], b[k]))).unwrap_or_default()
        };
        let (min, max) = (json!(extreme(f32::min)), json!(extreme(f32::max)));
        let positions = accessor(view, positions.len(), ComponentType::F32, Type::Vec3);
        Ok(self.root.push(json::Accessor { min: Some(min), max: Some(max), ..positions }))
    }

    fn regions(
        &mut self,
        mesh: &Mesh,
        groups: &Groups,
        positions: Index<json::Accessor>,
    ) -> io::Result<Vec<Index<json::Node>>> {
        let mut nodes = Vec::new();
        for (i, triangles) in groups.triangles().iter().enumerate().filter(|(_, triangles)| !triangles.is_empty()) {
            let corners = triangles.iter().flat_map(|&t| straight_triangles(mesh, t)).flatten().map(|v| v.0);
            let name = groups.regions[i];
            let material = self.material(name, colours::linear(mesh, name, i).map(|part| part as f32));
            let extras = extras(&json!({ "region": name }))?;
            let primitive = self.primitive(Mode::Triangles, corners.collect(), positions, material, extras);
            nodes.push(self.node(name, primitive));
        }
        Ok(nodes)
    }

    fn boundaries(
        &mut self,
        mesh: &Mesh,
        groups: &Groups,
        positions: Index<json::Accessor>,
    ) -> io::Result<Vec<Index<json::Node>>> {
        let mut nodes = Vec::new();
        let ink = (!mesh.edges.is_empty()).then(|| self.material("boundary", [0.02, 0.02, 0.02, 1.0]));
        for ((edges, name), ink) in groups.edges().iter().zip(&groups.boundaries).zip(ink.iter().cycle()) {
            let ends = edges.iter().flat_map(|&i| straight_edges(mesh, i)).flatten().map(|v| v.0);
            let extras = extras(&json!({ "boundary": name }))?;
            let primitive = self.primitive(Mode::Lines, ends.collect(), positions, *ink, extras);
            nodes.push(self.node(name, primitive));
        }
        Ok(nodes)
    }

    fn primitive(
        &mut self,
        mode: Mode,
        indices: Vec<u32>,
        positions: Index<json::Accessor>,
        material: Index<json::Material>,
        extras: Extras,
    ) -> Primitive {
        let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        let view = self.view(&bytes, Target::ElementArrayBuffer);
        let indices = self.root.push(accessor(view, indices.len(), ComponentType::U32, Type::Scalar));
        Primitive {
            attributes: [(Valid(Semantic::Positions), positions)].into_iter().collect(),
            indices: Some(indices),
            material: Some(material),
            mode: Valid(mode),
            targets: None,
            extensions: None,
            extras,
        }
    }

    fn material(&mut self, name: &str, colour: [f32; 4]) -> Index<json::Material> {
        let surface = json::material::PbrMetallicRoughness {
            base_color_factor: json::material::PbrBaseColorFactor(colour),
            metallic_factor: json::material::StrengthFactor(0.0),
            ..Default::default()
        };
        self.root.push(json::Material {
            name: Some(name.to_owned()),
            double_sided: true,
            alpha_mode: Valid(match colour[3] < 1.0 {
                true => json::material::AlphaMode::Blend,
                false => json::material::AlphaMode::Opaque,
            }),
            pbr_metallic_roughness: surface,
            ..Default::default()
        })
    }

    /// A node and a mesh of this name.
    fn node(&mut self, name: &str, primitive: Primitive) -> Index<json::Node> {
        let name = Some(name.to_owned());
        let (primitives, mesh_name) = (vec![primitive], name.clone());
        let mesh =
            self.root.push(json::Mesh { primitives, name: mesh_name, weights: None, extensions: None, extras: None });
        self.root.push(json::Node { mesh: Some(mesh), name, ..Default::default() })
    }

    /// The root node.
    fn root(&mut self, mesh: &Mesh, nodes: Vec<Index<json::Node>>, placement: &Placement) -> io::Result<()> {
        let z_up = json::scene::UnitQuaternion([-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2]);
        let root = self.root.push(json::Node {
            children: Some(nodes),
            name: Some("squinch".into()),
            translation: Some(placement.translation),
            rotation: mesh.frame.map(|_| z_up),
            scale: Some([placement.scale; 3]),
            extras: extras(&json!({ "unit": mesh.unit }))?,
            ..Default::default()
        });
        let nodes = vec![root];
        self.root.scene = Some(self.root.push(json::Scene { nodes, name: None, extensions: None, extras: None }));
        Ok(())
    }
}

/// The transform of the root node: a scaling, a rotation if the mesh lies in space, then a translation.
struct Placement {
    /// Metres per unit.
    scale: f32,
    /// In metres, +Y up, as float32 holds it.
    translation: [f32; 3],
    /// The place in the mesh that the translation restores, near its middle. Positions have it subtracted.
    origin: [f64; 3],
}

impl Placement {
    fn of(mesh: &Mesh) -> Self {
        let scale = mesh.unit.as_deref().and_then(metres).unwrap_or(1.0) as f32;
        let in_space = mesh.frame.is_some();
        // Subtraction from 0 gives 0, not −0.
        let upward = |[x, y, z]: [f64; 3]| if in_space { [x, z, 0.0 - y] } else { [x, y, z] };
        let back = |[x, y, z]: [f64; 3]| if in_space { [x, 0.0 - z, y] } else { [x, y, z] };
        let translation = upward(centre(mesh)).map(|part| (part * f64::from(scale)) as f32);
        let origin = back(translation.map(|part| f64::from(part) / f64::from(scale)));
        Self { scale, translation, origin }
    }
}

fn accessor(view: Index<json::buffer::View>, count: usize, component: ComponentType, kind: Type) -> json::Accessor {
    json::Accessor {
        buffer_view: Some(view),
        byte_offset: Some(USize64(0)),
        count: USize64::from(count),
        component_type: Valid(GenericComponentType(component)),
        type_: Valid(kind),
        min: None,
        max: None,
        name: None,
        normalized: false,
        sparse: None,
        extensions: None,
        extras: None,
    }
}

/// The middle of the mesh.
fn centre(mesh: &Mesh) -> [f64; 3] {
    let extreme = |pick: fn(f64, f64) -> f64| -> [f64; 3] {
        mesh.places().reduce(|a, b| std::array::from_fn(|k| pick(a[k], b[k]))).unwrap_or_default()
    };
    let (low, high) = (extreme(f64::min), extreme(f64::max));
    std::array::from_fn(|k| low[k] + (high[k] - low[k]) / 2.0)
}
