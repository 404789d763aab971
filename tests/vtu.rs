//! VTU: what is written is read back bit for bit, other writers' encodings are understood, and no bytes do harm.

use proptest::prelude::*;
use squinch::geometry::{Frame, Point};
use squinch::ids::{CurveId, PointId, RegionId, VertexId};
use squinch::mesh::{Ball, BallReason, CurveEdge, CurveLink, Mesh};
use squinch::meshio::{self, Format, MeshError, MeshFile, WriteOptions, encode};
use squinch::picture;
use std::path::Path;

/// A grid of n × n squares, each cut in two, its left half one region; coordinates with endless digits.
fn grid(n: u32, names: [&str; 4]) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..=n {
        for j in 0..=n {
            mesh.nodes.push(Point::new(f64::from(i) / 3.0 - 1e7, f64::from(j) * 1e-7 / 7.0));
        }
    }
    let [left, right, bottom, top] = names.map(|name| mesh.names.intern(name));
    mesh.regions = vec![left, right].into();
    let node = |i: u32, j: u32| VertexId(i * (n + 1) + j);
    for i in 0..n {
        for j in 0..n {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            for triangle in [[a, b, c], [a, c, d]] {
                mesh.triangles.push(triangle);
                mesh.triangle_regions.push(RegionId(u32::from(2 * i >= n)));
            }
        }
        let t = [f64::from(i) / f64::from(n), f64::from(i + 1) / f64::from(n)];
        let link = Some(CurveLink { curve: CurveId(7), t });
        mesh.edges.push(CurveEdge { nodes: [node(i, n), node(i + 1, n)], name: top, link: None });
        mesh.edges.push(CurveEdge { nodes: [node(i, 0), node(i + 1, 0)], name: bottom, link });
    }
    mesh.points = vec![(PointId(0), node(0, 0)), (PointId(5), node(n, n))];
    mesh.balls = [BallReason::LocalFeatureSize, BallReason::Encroached, BallReason::Size]
        .map(|why| Ball { corner: PointId(5), radius: 0.1 + f64::from(why as u8) / 3.0, why })
        .to_vec();
    mesh
}

fn written(mesh: &Mesh, stamps: &[(String, String)]) -> Vec<u8> {
    encode(mesh, stamps, Format::Vtu, &WriteOptions::default()).expect("the lists fit").concat()
}

fn read(bytes: &[u8]) -> Result<MeshFile, MeshError> {
    meshio::read(bytes, Format::Vtu, &[])
}

fn stamps() -> Vec<(String, String)> {
    let pairs =
        [("version", "0.1.0"), ("tau_rad", "0.5"), ("angle_min_deg", "20.70"), ("input", "Flügel\n<1>"), ("note", "")];
    pairs.map(|(key, value)| (key.to_owned(), value.to_owned())).to_vec()
}

/// Everything but the ids of names, which a file need not keep.
fn same(a: &Mesh, b: &Mesh) {
    let bits = |m: &Mesh| m.nodes.iter().map(|p| [p.x.to_bits(), p.y.to_bits()]).collect::<Vec<_>>();
    assert_eq!(bits(a), bits(b));
    assert_eq!((&a.triangles, &a.triangle_regions), (&b.triangles, &b.triangle_regions));
    let regions = |m: &Mesh| m.regions.iter().map(|&n| m.names.text(n).to_owned()).collect::<Vec<_>>();
    assert_eq!(regions(a), regions(b));
    let edges =
        |m: &Mesh| m.edges.iter().map(|e| (e.nodes, m.names.text(e.name).to_owned(), e.link)).collect::<Vec<_>>();
    assert_eq!(edges(a), edges(b));
    assert_eq!((&a.points, &a.balls), (&b.points, &b.balls));
}

const PLAIN: [&str; 4] = ["steel", "air", "wall", "inlet"];

#[test]
fn what_is_written_is_read_back_bit_for_bit() {
    let odd = ["a & \"b\" <c>", "Flügel 翼\t\n'x'", "", "region:1 "];
    for (n, names) in [(1, PLAIN), (4, odd), (4, ["same"; 4]), (120, PLAIN)] {
        let mesh = grid(n, names);
        let bytes = written(&mesh, &stamps());
        let MeshFile { mesh: back, stamps: said, notes } = read(&bytes).expect("our own file");
        same(&mesh, &back);
        assert_eq!(said, stamps());
        assert!(notes.is_empty());
        assert_eq!(written(&back, &said), bytes, "written again, the bytes are the same");
    }
}

#[test]
fn an_empty_mesh_and_one_without_names_are_kept() {
    for mesh in [Mesh::default(), Mesh { edges: Vec::new(), balls: Vec::new(), points: Vec::new(), ..grid(2, PLAIN) }] {
        same(&mesh, &read(&written(&mesh, &[])).expect("our own file").mesh);
    }
}

/// The grid, small and on a tilted plane far from the origin.
fn tilted() -> Mesh {
    let mut mesh = grid(4, PLAIN);
    mesh.nodes = mesh.nodes.iter().map(|p| Point::new(p.x + 1e7, p.y * 1e7)).collect();
    mesh.frame = Frame::of_plane([1e3, -2e3, 5e2], [0.3, -0.2, 0.9], [1.0, 1.0, 0.0]);
    mesh
}

#[test]
fn a_mesh_in_space_is_written_where_it_lies_and_read_back_into_its_plane() {
    let mesh = tilted();
    let bytes = written(&mesh, &[]);
    let back = read(&bytes).expect("our own file").mesh;
    same(&mesh, &back);
    assert_eq!(back.frame, mesh.frame);
    // For whoever knows nothing of frames, the points are places in space: a frame of their plane is found again.
    let text = String::from_utf8(bytes).expect("text");
    let found = read(text.replace("\"frame\"", "\"fr\"").as_bytes()).expect("flat").mesh;
    for (a, b) in found.places().zip(mesh.places()) {
        assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-9), "{a:?} {b:?}");
    }
    // Where the coordinates in the plane are lost, the points are laid into it.
    let laid = read(text.replace("\"plane\"", "\"pl\"").as_bytes()).expect("flat in its frame").mesh;
    for (a, b) in laid.nodes.iter().zip(mesh.nodes.iter()) {
        assert!(a.distance(*b) < 1e-11, "{a:?} {b:?}");
    }
}

#[test]
fn coordinates_in_the_plane_count_only_where_they_are_of_the_points() {
    let mesh = tilted();
    let moved = Mesh { nodes: mesh.nodes.iter().map(|p| Point::new(p.x + 1.0, p.y)).collect(), ..mesh.clone() };
    let [text, other] = [&mesh, &moved].map(|m| String::from_utf8(written(m, &[])).expect("text"));
    let points = |text: &str| {
        let from = text.find("<Points>").expect("points");
        text[from..text.find("</Points>").expect("their end")].to_owned()
    };
    let mixed = text.replace(&points(&text), &points(&other));
    let laid = read(mixed.as_bytes()).expect("flat in its frame").mesh;
    for (a, b) in laid.nodes.iter().zip(moved.nodes.iter()) {
        assert!(a.distance(*b) < 1e-11, "{a:?} {b:?}");
    }
}

#[test]
fn frames_that_are_none_are_refused() {
    let mut mesh = tilted();
    for (frame, what) in [
        (
            Frame { origin: [0.0; 3], x: [2.0, 0.0, 0.0], y: [0.0, 1.0, 0.0] },
            "the axes of the frame are not orthonormal",
        ),
        (Frame { origin: [f64::NAN; 3], x: [1.0, 0.0, 0.0], y: [0.0, 1.0, 0.0] }, "point 0 is at (NaN, NaN, NaN)"),
    ] {
        mesh.frame = Some(frame);
        assert_eq!(read(&written(&mesh, &[])).expect_err("no frame").what, what);
    }
}

#[test]
fn lists_that_differ_in_length_are_refused() {
    let mesh = Mesh { triangle_regions: Vec::new().into(), ..grid(1, PLAIN) };
    assert!(encode(&mesh, &[], Format::Vtu, &WriteOptions::default()).is_err());
}

#[test]
fn formats_by_suffix() {
    assert_eq!(Format::to_write(Path::new("a/b.VTU")), Some(Format::Vtu));
    assert_eq!(
        (Format::to_write(Path::new("b.poly")), Format::to_read(Path::new("b.poly"))),
        (Some(Format::Triangle), None)
    );
    assert_eq!(Format::to_write(Path::new("b.vtu.png")), None);
    assert_eq!(picture::Format::of(Path::new("b.vtu.png")), Some(picture::Format::Png));
    assert_eq!(Format::to_write(Path::new("vtu")), None);
    for format in Format::ALL.into_iter().filter(|format| format.holds_planes()) {
        let files = encode(&grid(2, PLAIN), &[], format, &WriteOptions::default()).expect("written");
        assert_eq!(files.len(), format.suffixes().len());
        let begins: &[u8] = match format {
            Format::Vtu | Format::Xdmf => b"<?xml",
            Format::Vtk | Format::VtkText => b"# vtk",
            Format::Msh | Format::Msh22 => b"$MeshFormat",
            Format::Su2 => b"NDIME= 2",
            Format::Inp => b"**",
            Format::Triangle => b"9 2 0 1",
            Format::Glb => b"glTF",
            Format::Gltf => b"{",
            Format::Obj => b"#",
            Format::Stl => b"solid",
            Format::Tetgen | Format::Medit => unreachable!("of tetrahedra only"),
        };
        assert!(files[0].starts_with(begins), "{format:?}");
        assert_eq!(Format::named(format.name()), Some(format));
    }
}

// ---- other writers ----

/// How a file of two triangles and a line is put together by hand.
#[derive(Clone, Copy, Debug)]
struct Style {
    wide_header: bool,
    big_endian: bool,
    zlib: bool,
    /// 0 ascii, 1 inline, 2 appended base64, 3 appended raw.
    place: u8,
    wide_ids: bool,
    /// Uncompressed base64 with the length in a segment of its own.
    apart: bool,
}

impl Style {
    fn word(self, v: u64) -> Vec<u8> {
        if self.wide_header { self.ordered(&v.to_le_bytes()) } else { self.ordered(&(v as u32).to_le_bytes()) }
    }

    fn ordered(self, little: &[u8]) -> Vec<u8> {
        if self.big_endian { little.iter().rev().copied().collect() } else { little.to_vec() }
    }

    fn packed(self, bytes: &[u8]) -> Vec<u8> {
        use base64::Engine;
        use std::io::Write;
        let encode = |bytes: &[u8]| match self.place {
            3 => bytes.to_vec(),
            _ => base64::engine::general_purpose::STANDARD.encode(bytes).into_bytes(),
        };
        if !self.zlib {
            let length = self.word(bytes.len() as u64);
            return if self.apart {
                [encode(&length), encode(bytes)].concat()
            } else {
                encode(&[&length, bytes].concat())
            };
        }
        let blocks: Vec<Vec<u8>> = bytes
            .chunks(16)
            .map(|block| {
                let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
                encoder.write_all(block).expect("a vector");
                encoder.finish().expect("a vector")
            })
            .collect();
        let mut header = [blocks.len() as u64, 16, bytes.len() as u64 % 16].map(|w| self.word(w)).concat();
        header.extend(blocks.iter().flat_map(|b| self.word(b.len() as u64)));
        [encode(&header), encode(&blocks.concat())].concat()
    }

    fn file(self) -> Vec<u8> {
        let ids = if self.wide_ids { "Int64" } else { "UInt32" };
        let arrays: [(&str, &str, &str, &[f64]); 5] = [
            ("Points", "Points", "Float32", &[0., 0., 2.5, 1., 0., 2.5, 1., 1., 2.5, 0., 1., 2.5]),
            ("Cells", "connectivity", ids, &[0., 1., 2., 0., 2., 3., 0., 1., 3.]),
            ("Cells", "offsets", ids, &[3., 6., 8., 9.]),
            ("Cells", "types", "UInt8", &[5., 5., 3., 1.]),
            ("CellData", "gmsh:physical", "Int16", &[9., -4., 12., 0.]),
        ];
        let mut xml = String::new();
        let mut appended = Vec::new();
        for (section, name, kind, values) in arrays {
            let bytes: Vec<u8> = values.iter().flat_map(|&v| self.ordered(&little(kind, v))).collect();
            let packed = self.packed(&bytes);
            let (format, text) = match self.place {
                0 => ("ascii".to_owned(), values.iter().map(|v| format!(" {v}\n")).collect()),
                1 => ("binary".to_owned(), format!("\n  {}\n ", String::from_utf8(packed).expect("base64"))),
                _ => {
                    let offset = appended.len();
                    appended.extend(packed);
                    (format!("appended\" offset=\"{offset}"), String::new())
                }
            };
            let key = "<InformationKey name=\"x\" location=\"y\">z</InformationKey>";
            xml += &format!(
                "<{section}><DataArray type=\"{kind}\" Name=\"{name}\" format=\"{format}\">{text}{key}</DataArray>"
            );
            xml += &format!("</{section}>");
        }
        let order = if self.big_endian { "BigEndian" } else { "LittleEndian" };
        let compressor = if self.zlib { " compressor=\"vtkZLibDataCompressor\"" } else { "" };
        let header = if self.wide_header { " header_type=\"UInt64\"" } else { "" };
        let mut file = format!(
            "<VTKFile type=\"UnstructuredGrid\" byte_order=\"{order}\"{header}{compressor}><UnstructuredGrid>\
             <Piece NumberOfPoints=\"4\" NumberOfCells=\"4\"><PointData/>{xml}</Piece></UnstructuredGrid>"
        )
        .into_bytes();
        if self.place >= 2 {
            let encoding = if self.place == 2 { "base64" } else { "raw" };
            file.extend(format!("<AppendedData encoding=\"{encoding}\">\n  _").into_bytes());
            file.extend(appended);
            file.extend(b"\n</AppendedData>");
        }
        file.extend(b"</VTKFile>");
        file
    }
}

fn little(kind: &str, v: f64) -> Vec<u8> {
    match kind {
        "Float32" => (v as f32).to_le_bytes().to_vec(),
        "Int64" => (v as i64).to_le_bytes().to_vec(),
        "UInt32" => (v as u32).to_le_bytes().to_vec(),
        "Int16" => (v as i16).to_le_bytes().to_vec(),
        _ => vec![v as u8],
    }
}

fn styles() -> impl Iterator<Item = Style> {
    (0..128_u8).map(|i| {
        let bit = |k: u8| i >> k & 1 == 1;
        Style {
            wide_header: bit(0),
            big_endian: bit(1),
            zlib: bit(2),
            place: i >> 3 & 3,
            wide_ids: bit(5),
            apart: bit(6),
        }
    })
}

#[test]
fn every_encoding_of_other_writers_is_read() {
    for style in styles().filter(|s| !(s.apart && (s.zlib || s.place == 3))) {
        let MeshFile { mesh, notes, stamps } = read(&style.file()).unwrap_or_else(|e| panic!("{style:?}: {e}"));
        let corners = [[0, 1, 2], [0, 2, 3]].map(|t| t.map(VertexId));
        assert_eq!(mesh.triangles.as_slice(), corners, "{style:?}");
        assert_eq!(mesh.nodes[VertexId(2)], Point::new(1.0, 1.0));
        // Numbers ascend: −4 is the first region.
        assert_eq!(mesh.triangle_regions.as_slice(), [RegionId(1), RegionId(0)]);
        assert_eq!(mesh.regions.iter().map(|&n| mesh.names.text(n)).collect::<Vec<_>>(), ["-4", "9"]);
        let edges: Vec<_> = mesh.edges.iter().map(|e| (e.nodes, mesh.names.text(e.name), e.link)).collect();
        assert_eq!(edges, [([VertexId(0), VertexId(1)], "12", None)]);
        assert_eq!(notes, ["1 vertex cells are left out"]);
        assert!(stamps.is_empty());
    }
}

fn plain() -> String {
    let style = Style { wide_header: false, big_endian: false, zlib: false, place: 0, wide_ids: true, apart: false };
    String::from_utf8(style.file()).expect("text")
}

#[test]
fn what_cannot_be_read_is_said() {
    for (from, to, what) in [
        (" 5\n 5", " 5\n 9", "cell 1 is a quadrilateral (VTK type 9)"),
        (" 5\n 5", " 22\n 5", "cell 0 of type 22 has 3 corners"),
        (" 5\n 5", " 5\n 3", "cell 1 of type 3 has 3 corners"),
        (" 1\n 1\n 2.5", " 1\n 1\n 3", "the mesh is not flat: node 3 lies 4.472e-1 off the plane of the others"),
        (" 1\n 1\n 2.5", " 1\n nan\n 2.5", "point 2 is at (1, NaN, 2.5)"),
        (" 2\n 3\n", " 2\n 4\n", "cell 1 has a corner 4 that is not a point"),
        (" 2\n 3\n", " 2\n -1\n", "array 'connectivity' holds -1"),
        (" 3\n 6\n 8", " 3\n 2\n 8", "cell 1 has no corners"),
        ("NumberOfCells=\"4\"", "NumberOfCells=\"99999999999\"", "4 types and 4 offsets for 99999999999 cells"),
        ("NumberOfPoints=\"4\"", "NumberOfPoints=\"-4\"", "NumberOfPoints is '-4'"),
        ("type=\"UnstructuredGrid\"", "type=\"PolyData\"", "the file holds a PolyData"),
        (
            "byte_order",
            "compressor=\"vtkLZ4DataCompressor\" byte_order",
            "the file is compressed by vtkLZ4DataCompressor",
        ),
        ("<Piece", "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/><Piece", "the grid has 2 pieces"),
        ("VTKFile", "KML", "there is no VTKFile element"),
    ] {
        let text = plain();
        assert!(text.contains(from), "{from}");
        let error = read(text.replace(from, to).as_bytes()).expect_err(what);
        assert_eq!(error.what, what);
        assert!(!error.help.is_empty());
    }
}

#[test]
fn links_and_balls_out_of_range_are_refused() {
    let mut mesh = grid(2, PLAIN);
    mesh.balls[1].radius = f64::INFINITY;
    assert_eq!(read(&written(&mesh, &[])).expect_err("no radius").what, "a ball has the radius inf");
    mesh.edges[1].link = Some(CurveLink { curve: CurveId(0), t: [0.5, 1.5] });
    let error = read(&written(&mesh, &[])).expect_err("no parameter");
    assert_eq!(error.what, "array 't' holds 1.5, which is not a parameter of a curve (0 to 1)");
}

#[test]
fn a_small_file_that_unpacks_to_gigabytes_is_refused() {
    use std::io::Write;
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    encoder.write_all(&vec![0; 1 << 20]).expect("a vector");
    let block = encoder.finish().expect("a vector");
    // 4000 blocks of a megabyte: 4 GB of zeros from 4 MB.
    let mut header = vec![4000_u64, 1 << 20, 0];
    header.extend(std::iter::repeat_n(block.len() as u64, 4000));
    let mut bytes = b"<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\
        <Piece NumberOfPoints=\"170000000\" NumberOfCells=\"0\"><Points><DataArray type=\"Float64\" format=\"appended\" offset=\"0\"/>\
        </Points></Piece><AppendedData encoding=\"raw\">_"
        .to_vec();
    bytes.extend(header.into_iter().flat_map(u64::to_le_bytes));
    bytes.extend(std::iter::repeat_n(block, 4000).flatten());
    let error = read(&bytes).expect_err("too much");
    assert_eq!(error.what, "array '' is cut short, too long or garbled");
}

#[test]
fn no_beginning_of_a_file_is_a_whole_one() {
    let bytes = written(&grid(3, PLAIN), &stamps());
    let end = bytes.windows(8).rposition(|w| w == b"</VTKFil").expect("the last element");
    for n in (0..end).step_by(7) {
        assert!(read(&bytes[..n]).is_err(), "the first {n} bytes");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever is read has corners that are nodes and regions that have names: nothing later can stumble over it.
    #[test]
    fn changed_bytes_are_an_error_or_a_mesh(
        style in 0..129_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in any::<prop::sample::Index>(),
    ) {
        let mut bytes = styles().nth(style).map_or_else(|| written(&grid(3, PLAIN), &stamps()), Style::file);
        for (place, byte) in changes {
            let n = bytes.len();
            bytes[place.index(n)] = byte;
        }
        if cut.index(4) == 0 {
            bytes.remove(cut.index(bytes.len()));
        }
        if let Ok(MeshFile { mesh, .. }) = read(&bytes) {
            let n = mesh.nodes.len();
            prop_assert!(mesh.triangles.iter().flatten().all(|v| (v.0 as usize) < n));
            prop_assert!(mesh.edges.iter().flat_map(|e| e.nodes).all(|v| (v.0 as usize) < n));
            prop_assert!(mesh.points.iter().all(|(_, v)| (v.0 as usize) < n));
            prop_assert_eq!(mesh.triangles.len(), mesh.triangle_regions.len());
            prop_assert!(mesh.triangle_regions.iter().all(|&r| mesh.regions.get(r).is_some()));
            prop_assert!(mesh.nodes.iter().all(|p| p.x.is_finite() && p.y.is_finite()));
            prop_assert!(mesh.balls.iter().all(|b| b.radius.is_finite()));
            let links = mesh.edges.iter().filter_map(|e| e.link);
            prop_assert!(links.flat_map(|link| link.t).all(|t| (0.0..=1.0).contains(&t)));
        }
    }
}
