//! glTF 2.0: `.glb`, or `.gltf` with its buffer inside as base64.
//!
//! One primitive of triangles a region and one of lines a boundary, all over one list of positions; `extras` of each say
//! `{"region": NAME}` or `{"boundary": NAME}`, and each region's material bears its name
//! and its colour in the drawing, where that has one. The root node converts to metres (a unit
//! that is not known stays as it is; `extras` say which it was) and stands +Y up: a mesh in the plane has its y upward as it is, a
//! mesh that lies in space is turned from CAD's +Z up. Its child node is shifted to the middle of the mesh, so that positions,
//! float32 by the format, keep small features far from the origin.
//!
//! MeshLab makes triangles of the lines: they can be left out (`lines` false).
//!
//! Cells of order 2 are written as straight ones between all their nodes: four a triangle, two an edge. Not held: order 2, more
//! than float32 of a coordinate, links to curves, balls. A mesh without triangles is refused: glTF has none.

use super::groups::{Groups, straight_edges, straight_triangles};
use super::unsupported;
use crate::geometry::metres;
use crate::ids::Colour;
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

/// Writes binary glTF, the boundaries as lines where asked for.
///
/// # Errors
/// Those of `out`; `Unsupported` of no triangles; `InvalidInput` where the mesh's lists do not fit together, where coordinates
/// exceed float32 or the file 4 GB.
pub fn write_glb(mesh: &Mesh, lines: bool, out: &mut impl Write) -> io::Result<()> {
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

/// Writes glTF as JSON with everything inside, the boundaries as lines where asked for.
///
/// # Errors
/// As [`write_glb`].
pub fn write_gltf(mesh: &Mesh, lines: bool, out: &mut impl Write) -> io::Result<()> {
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

/// The document as it grows, and its one buffer.
struct Scene {
    root: Root,
    buffer: Index<json::Buffer>,
    binary: Vec<u8>,
}

impl Scene {
    fn of(mesh: &Mesh, lines: bool) -> io::Result<Self> {
        let groups = Groups::of(mesh)?;
        if mesh.triangles.is_empty() {
            return unsupported("glTF has no meshes without triangles");
        }
        let mut root = Root::default();
        root.asset.generator = Some(format!("squinch {}", env!("CARGO_PKG_VERSION")));
        let (byte_length, name) = (USize64(0), None);
        let buffer = root.push(json::Buffer { byte_length, name, uri: None, extensions: None, extras: None });
        let mut scene = Self { root, buffer, binary: Vec::new() };
        let centre = centre(mesh);
        let positions = scene.positions(mesh, centre)?;
        let mut primitives = scene.regions(mesh, &groups, positions)?;
        if lines {
            primitives.extend(scene.boundaries(mesh, &groups, positions)?);
        }
        scene.nodes(mesh, primitives, centre)?;
        Ok(scene)
    }

    fn finish(mut self, uri: Option<String>) -> io::Result<(Root, Vec<u8>)> {
        self.root.buffers[0].uri = uri;
        Ok((self.root, self.binary))
    }

    /// Takes bytes into the buffer, as a view.
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

    fn positions(&mut self, mesh: &Mesh, centre: [f32; 3]) -> io::Result<Index<json::Accessor>> {
        let local = |place: [f64; 3]| std::array::from_fn(|k| (place[k] - f64::from(centre[k])) as f32);
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
    ) -> io::Result<Vec<Primitive>> {
        let mut primitives = Vec::new();
        for (i, triangles) in groups.triangles().iter().enumerate().filter(|(_, triangles)| !triangles.is_empty()) {
            let corners = triangles.iter().flat_map(|&t| straight_triangles(mesh, t)).flatten().map(|v| v.0);
            let drawn = mesh.names.find(groups.regions[i]).and_then(|name| mesh.colours.get(&name));
            let material = self.material(groups.regions[i], drawn.map_or_else(|| colour(i), |drawn| linear(*drawn)));
            let extras = extras(&json!({ "region": groups.regions[i] }))?;
            primitives.push(self.primitive(Mode::Triangles, corners.collect(), positions, material, extras));
        }
        Ok(primitives)
    }

    fn boundaries(
        &mut self,
        mesh: &Mesh,
        groups: &Groups,
        positions: Index<json::Accessor>,
    ) -> io::Result<Vec<Primitive>> {
        let mut primitives = Vec::new();
        let ink = (!mesh.edges.is_empty()).then(|| self.material("boundary", [0.02, 0.02, 0.02, 1.0]));
        for ((edges, name), ink) in groups.edges().iter().zip(&groups.boundaries).zip(ink.iter().cycle()) {
            let ends = edges.iter().flat_map(|&i| straight_edges(mesh, i)).flatten().map(|v| v.0);
            let extras = extras(&json!({ "boundary": name }))?;
            primitives.push(self.primitive(Mode::Lines, ends.collect(), positions, *ink, extras));
        }
        Ok(primitives)
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

    /// Root (metres, +Y up) and, in it, the mesh at its centre.
    fn nodes(&mut self, mesh: &Mesh, primitives: Vec<Primitive>, centre: [f32; 3]) -> io::Result<()> {
        let (name, weights) = (Some("mesh".to_owned()), None);
        let shape = self.root.push(json::Mesh { primitives, weights, name, extensions: None, extras: None });
        let child = self.root.push(json::Node {
            mesh: Some(shape),
            name: Some("mesh".into()),
            translation: Some(centre),
            ..Default::default()
        });
        let scale = mesh.unit.as_deref().and_then(metres).unwrap_or(1.0) as f32;
        let z_up = json::scene::UnitQuaternion([-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2]);
        let top = self.root.push(json::Node {
            children: Some(vec![child]),
            name: Some("squinch".into()),
            rotation: mesh.frame.map(|_| z_up),
            scale: Some([scale; 3]),
            extras: extras(&json!({ "unit": mesh.unit }))?,
            ..Default::default()
        });
        let nodes = vec![top];
        self.root.scene = Some(self.root.push(json::Scene { nodes, name: None, extensions: None, extras: None }));
        Ok(())
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

/// The middle of the mesh, as float32 holds it: what is subtracted is what the node adds.
fn centre(mesh: &Mesh) -> [f32; 3] {
    let extreme = |pick: fn(f64, f64) -> f64| -> [f64; 3] {
        mesh.places().reduce(|a, b| std::array::from_fn(|k| pick(a[k], b[k]))).unwrap_or_default()
    };
    let (low, high) = (extreme(f64::min), extreme(f64::max));
    std::array::from_fn(|k| (low[k] + (high[k] - low[k]) / 2.0) as f32)
}

/// A colour of a drawing as glTF wants it: linear, not sRGB.
fn linear(Colour([r, g, b, a]): Colour) -> [f32; 4] {
    let part = |byte: u8| {
        let value = f64::from(byte) / 255.0;
        let linear = if value <= 0.04045 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) };
        linear as f32
    };
    [part(r), part(g), part(b), f32::from(a) / 255.0]
}

/// Colours that neighbours in a list tell apart, without end: equal steps of the golden angle around the hue circle.
fn colour(i: usize) -> [f32; 4] {
    const GOLDEN: f32 = 0.618_034;
    let hue = (0.58 + i as f32 * GOLDEN).fract();
    // Hue to red, green and blue at half saturation.
    let [r, g, b] = [0.0, 2.0 / 3.0, 1.0 / 3.0].map(|shift| {
        let wave = ((hue + shift).fract() * 6.0 - 3.0).abs() - 1.0;
        0.35 + 0.4 * wave.clamp(0.0, 1.0)
    });
    [r, g, b, 1.0]
}
