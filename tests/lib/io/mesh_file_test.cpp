#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>

#include "base/error.hpp"
#include "fault_of.hpp"
#include "io/mesh/file.hpp"
#include "io/mesh/private/formats.hpp"
#include "lib/io/scratch.hpp"
#include "lib/io/zip_writer.hpp"

using vam::io::read_mesh;
using vam::model::TriangleSoup;

using samples::Zip;
using scratch::slurp;

namespace {

// A box 1 x 2 x 3 mm as six quadrilaterals, anticlockwise from outside.
const std::vector<std::array<double, 3>> box_points{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0},
                                                    {0, 0, 3}, {1, 0, 3}, {1, 2, 3}, {0, 2, 3}};
const std::vector<std::array<int, 4>> box_faces{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

// Volume by the divergence theorem: right only when every triangle is there, once, and oriented outwards.
double volume(const TriangleSoup& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto& a = mesh.points[t[0]];
    const auto& b = mesh.points[t[1]];
    const auto& c = mesh.points[t[2]];
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}

std::string box_obj() {
  std::string text = "# box\no box\n";
  for (const auto& p : box_points)
    text += "v " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
  for (const auto& f : box_faces) {
    text += "f";
    for (const int i : f) text += " " + std::to_string(i + 1) + "//1";
    text += "\n";
  }
  return text;
}

std::string box_off(const std::string& first_vertex = "0 0 0") {
  std::string text = "OFF\n8 6 0\n" + first_vertex + "\n";
  for (std::size_t i = 1; i < 8; ++i) {
    const auto& p = box_points[i];
    text += std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
  }
  for (const auto& f : box_faces) {
    text += "4";
    for (const int i : f) text += " " + std::to_string(i);
    text += "\n";
  }
  return text;
}

std::string box_ply() {
  std::string text =
      "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 8\nproperty float x\nproperty float y\n"
      "property float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
  return text + box_off().substr(std::strlen("OFF\n8 6 0\n"));
}

TriangleSoup box() {
  TriangleSoup mesh;
  mesh.points = box_points;
  for (const auto& f : box_faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

std::string box_ascii_stl() {
  std::string text = "solid box\n";
  const auto mesh = box();
  for (const auto& t : mesh.triangles) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const int i : t) {
      const auto& p = mesh.points[i];
      text += "   vertex " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid box\n";
}

std::string box_3mf(const std::string& unit, const std::string& transform) {
  std::string model = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"" + unit +
                      "\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>"
                      "<object id=\"1\" type=\"model\"><mesh><vertices>";
  const auto mesh = box();
  for (const auto& p : mesh.points) {
    model += "<vertex x=\"" + std::to_string(p[0]) + "\" y=\"" + std::to_string(p[1]) + "\" z=\"" +
             std::to_string(p[2]) + "\"/>";
  }
  model += "</vertices><triangles>";
  for (const auto& t : mesh.triangles) {
    model += "<triangle v1=\"" + std::to_string(t[0]) + "\" v2=\"" + std::to_string(t[1]) + "\" v3=\"" +
             std::to_string(t[2]) + "\"/>";
  }
  model += "</triangles></mesh></object></resources><build><item objectid=\"1\"" +
           (transform.empty() ? "" : " transform=\"" + transform + "\"") + "/></build></model>";
  Zip zip;
  zip.add(
      "[Content_Types].xml",
      "<?xml version=\"1.0\"?><Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
      "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
      "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>");
  zip.add(
      "_rels/.rels",
      "<?xml version=\"1.0\"?><Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
      "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>");
  zip.add("3D/3dmodel.model", model);
  return zip.done();
}

std::string refusal(const scratch::Folder& folder, const std::string& bytes) {
  const std::string line = error_of([&] { (void)read_mesh(folder.write("mesh", bytes)); }, vam::Fault::data);
  CHECK(!has(line, "\n"));
  return line;
}

}  // namespace

TEST_CASE("each format of the table recognizes its files alone and gives the box back: 6 mm3, oriented outwards") {
  const scratch::Folder folder;
  const std::map<std::string, std::string> boxes{{"OBJ", box_obj()},
                                                 {"OFF", box_off()},
                                                 {"PLY", box_ply()},
                                                 {"STL", box_ascii_stl()},
                                                 {"3MF", box_3mf("millimeter", "")}};
  CHECK(vam::io::mesh_formats().size() == boxes.size());
  for (const auto& format : vam::io::mesh_formats()) {
    CAPTURE(format.name);
    for (const auto& [name, bytes] : boxes) CHECK(format.recognises(bytes) == (name == format.name));
    const auto mesh = read_mesh(folder.write("mesh", boxes.at(format.name)));
    CHECK(mesh.triangles.size() == 12);
    CHECK(volume(mesh) == doctest::Approx(6));
    CHECK(has(refusal(folder, "hello, world\n"), format.name));
  }
}

TEST_CASE("the ending of an output's name chooses its format, and one that is only read is refused") {
  const scratch::Folder folder;
  for (const auto& format : vam::io::mesh_formats()) {
    const std::string path = folder / ("box" + format.extension);
    CAPTURE(path);
    if (format.write == nullptr) {
      CHECK(has(error_of([&] { vam::io::check_mesh_output(path); }, vam::Fault::usage), "use .ply or .stl"));
      continue;
    }
    vam::io::write_mesh(path, box(), {"a comment"});
    CHECK(format.recognises(slurp(path)));
    CHECK(volume(read_mesh(path)) == doctest::Approx(6));
  }
}

TEST_CASE("binary STL comes back as written, also when its header begins with solid") {
  const scratch::Folder folder;
  vam::io::write_stl(folder / "box.stl", box());
  std::string bytes = slurp(folder / "box.stl");
  CHECK(bytes.size() == 84 + 12 * 50);
  CHECK(volume(read_mesh(folder / "box.stl")) == doctest::Approx(6));
  bytes.replace(0, 6, "solid ");
  CHECK(volume(read_mesh(folder.write("mesh", bytes))) == doctest::Approx(6));
  float normal[3];
  std::memcpy(normal, bytes.data() + 84, sizeof normal);
  CHECK(normal[2] == -1);  // the first face is the bottom
}

TEST_CASE("3MF: the unit and the place of the build item count") {
  const scratch::Folder folder;
  CHECK(volume(read_mesh(folder.write("mesh", box_3mf("inch", "")))) == doctest::Approx(6 * std::pow(25.4, 3)));
  CHECK(volume(read_mesh(folder.write("mesh", box_3mf("micron", "")))) == doctest::Approx(6e-9));
  // 3MF matrices are row by row, row vectors, translation last: a quarter turn about z, then (10, 20, 30).
  const auto mesh = read_mesh(folder.write("mesh", box_3mf("millimeter", "0 1 0 -1 0 0 0 0 1 10 20 30")));
  CHECK(volume(mesh) == doctest::Approx(6));
  std::array<double, 3> low{1e9, 1e9, 1e9};
  for (const auto& p : mesh.points) {
    for (std::size_t axis = 0; axis < 3; ++axis) low[axis] = std::min(low[axis], p[axis]);
  }
  CHECK(low[0] == doctest::Approx(8));  // x' = -y + 10, y in [0, 2]
  CHECK(low[1] == doctest::Approx(20));
  CHECK(low[2] == doctest::Approx(30));
  CHECK(has(refusal(folder, box_3mf("furlong", "")), "unknown 3MF unit 'furlong'"));
}

TEST_CASE("PLY carries quality twice, colours and comments, and reads back") {
  const scratch::Folder folder;
  vam::model::VertexData data;
  for (int i = 0; i < 8; ++i) {
    data.quality.push_back(static_cast<float>(i) / 8);
    data.colours.push_back({static_cast<std::uint8_t>(i), 2, 3});
  }
  vam::io::write_ply(folder / "box.ply", box(), data, {"vam-sdf 1", "two\nlines"});
  const std::string bytes = slurp(folder / "box.ply");
  CHECK(has(bytes, "comment vam-sdf 1\ncomment two lines\nelement vertex 8\n"));
  CHECK(has(bytes, "property float quality\nproperty float scalar_distance\nproperty uchar red\n"));
  const std::size_t body = bytes.find("end_header\n") + 11;
  CHECK(bytes.size() == body + 8 * (5 * 4 + 3) + 12 * 13);
  float second[5];  // vertex 1 = (1, 0, 0), quality 1/8
  std::memcpy(second, bytes.data() + body + 23, sizeof second);
  CHECK(second[0] == 1);
  CHECK(second[3] == 0.125F);
  CHECK(second[4] == 0.125F);
  CHECK(volume(read_mesh(folder / "box.ply")) == doctest::Approx(6));
  TriangleSoup cloud = box();
  cloud.triangles.clear();
  vam::io::write_ply(folder / "cloud.ply", cloud);
  CHECK(has(slurp(folder / "cloud.ply"), "element face 0\n"));
}

TEST_CASE("a file truncated anywhere is an error") {
  const scratch::Folder folder;
  vam::io::write_stl(folder / "box.stl", box());
  vam::io::write_ply(folder / "box.ply", box());
  const std::string stl = slurp(folder / "box.stl");
  const std::string binary_ply = slurp(folder / "box.ply");
  for (const auto& bytes : {stl, binary_ply, box_off(), box_ply(), box_ascii_stl(), box_3mf("millimeter", "")}) {
    for (std::size_t size = 0; size + 3 < bytes.size(); size += 7) {
      CAPTURE(bytes.substr(0, 12));
      CAPTURE(size);
      CHECK(refusal(folder, bytes.substr(0, size)) != "no error");
    }
  }
  CHECK(has(refusal(folder, stl.substr(0, 300)), "12 triangles (684 bytes) but the file has 300 bytes"));
}

TEST_CASE("vertices that are not finite, wrong indices, faces of two corners, no faces, foreign files") {
  const scratch::Folder folder;
  vam::io::write_stl(folder / "box.stl", box());
  std::string stl = slurp(folder / "box.stl");
  const float nan = NAN;
  std::memcpy(stl.data() + 84 + 12, &nan, sizeof nan);
  CHECK(has(refusal(folder, stl), "vertex 0 is not finite"));
  CHECK(refusal(folder, box_off("nan 0 0")) != "no error");
  CHECK(refusal(folder, box_off("1e999 0 0")) != "no error");
  std::string obj = box_obj();
  CHECK(has(refusal(folder, obj + "f 1 2 9\n"), "face 6 uses vertex 8 of 8 (counted from 0)"));
  CHECK(has(refusal(folder, obj + "f 0 1 2\n"), "face 6 uses vertex 8 of 8"));
  CHECK(has(refusal(folder, obj + "f 1 2\n"), "face 6 has 2 corners"));
  CHECK(has(refusal(folder, "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "the mesh is empty: 3 vertices, no face"));
  CHECK(has(refusal(folder, "solid nothing\nendsolid nothing\n"), "empty"));
  CHECK(has(refusal(folder, ""), "is empty"));
  CHECK(has(refusal(folder, "hello, world\n"), "not a mesh of a known format"));
  CHECK(has(refusal(folder, " BDV" + std::string(200, '\0')), "is a volume (OpenVDB), not a mesh"));
  CHECK(has(refusal(folder, "\x76\x2f\x31\x01" + std::string(200, '\0')), "is a stack (OpenEXR), not a mesh"));
  CHECK(has(refusal(folder,
                    "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
                    "property float y\nproperty float z\nend_header\n"),
            "promises 4000000000 vertex"));
  CHECK(has(refusal(folder, "OFF\n99999999999 1 0\n"), "promises 99999999999 vertices"));
  try {
    (void)read_mesh(folder / "none.stl");
    FAIL("a missing file was read");
  } catch (const vam::Error& error) {
    CHECK(error.fault == vam::Fault::no_input);
  }
}

// ---- 3MF beyond one mesh: components, several parts, what is refused ----

namespace {

constexpr const char* core_space = "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"";

std::string box_mesh() {
  std::string text = "<mesh><vertices>";
  for (const auto& p : box().points) {
    text += "<vertex x=\"" + std::to_string(p[0]) + "\" y=\"" + std::to_string(p[1]) + "\" z=\"" +
            std::to_string(p[2]) + "\"/>";
  }
  text += "</vertices><triangles>";
  for (const auto& t : box().triangles) {
    text += "<triangle v1=\"" + std::to_string(t[0]) + "\" v2=\"" + std::to_string(t[1]) + "\" v3=\"" +
            std::to_string(t[2]) + "\"/>";
  }
  return text + "</triangles></mesh>";
}

std::string object(int id, const std::string& inside) {
  return "<object id=\"" + std::to_string(id) + "\">" + inside + "</object>";
}

std::string component(int id, const std::string& more = "") {
  return "<component objectid=\"" + std::to_string(id) + "\" " + more + "/>";
}

std::string model(const std::string& objects, const std::string& build, const std::string& attributes = "") {
  return "<model " + std::string(core_space) + " " + attributes + "><resources>" + objects + "</resources><build>" +
         build + "</build></model>";
}

std::string item(int id, const std::string& more = "") {
  return "<item objectid=\"" + std::to_string(id) + "\" " + more + "/>";
}

std::string package(const std::string& root, const std::string& second = "") {
  Zip zip;
  zip.add("3D/3dmodel.model", root);
  if (!second.empty()) zip.add("3D/Objects/second.model", second);
  return zip.done();
}

}  // namespace

TEST_CASE("3MF: components are placed from the inside out, mirrored ones stay outside out, unprintable ones stay out") {
  const scratch::Folder folder;
  const std::string nested =
      object(1, box_mesh()) + object(2, "<components>" + component(1, "transform=\"2 0 0 0 1 0 0 0 1 1 0 0\"") +
                                            component(1, "transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"") + "</components>");
  const auto mesh = read_mesh(folder.write(
      "a", package(model(nested, item(2, "transform=\"0 1 0 -1 0 0 0 0 1 0 0 5\"") + item(1, "printable=\"0\"")))));
  CHECK(mesh.triangles.size() == 24);
  CHECK(volume(mesh) == doctest::Approx(12 + 6));
  double low = 1e9;
  double high = -1e9;
  for (const auto& p :
       mesh.points) {  // x of the box runs along y now: from -1 (mirrored) to 1 + 2 (stretched, shifted)
    low = std::min(low, p[1]);
    high = std::max(high, p[1]);
    CHECK(p[2] >= 5);
  }
  CHECK(low == doctest::Approx(-1));
  CHECK(high == doctest::Approx(3));
}

TEST_CASE("3MF: an object of another part, whose unit is its own") {
  const scratch::Folder folder;
  const std::string production =
      "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" "
      "requiredextensions=\"p\"";
  const std::string root =
      model(object(1, "<components>" + component(7, "p:path=\"/3D/Objects/second.model\"") + "</components>"), item(1),
            production);
  const std::string bytes = package(root, model(object(7, box_mesh()), "", "unit=\"centimeter\""));
  CHECK(volume(read_mesh(folder.write("a", bytes))) == doctest::Approx(6000));
  CHECK(has(refusal(folder, package(root)), "3D/Objects/second.model"));
}

TEST_CASE("3MF: what expands without end, or means another shape than its triangles, is refused before it is made") {
  const scratch::Folder folder;
  const auto ten = [](int id) {
    std::string text = "<components>";
    for (int i = 0; i < 10; ++i) text += component(id);
    return text + "</components>";
  };
  std::string levels = object(1, box_mesh());
  for (int id = 2; id <= 10; ++id) levels += object(id, ten(id - 1));
  CHECK(has(refusal(folder, package(model(levels, item(10)))),
            "expand to 1111111111 objects of 12000000000 triangles and 8000000000 vertices"));
  for (int id = 11; id <= 40; ++id) levels += object(id, ten(id - 1));
  CHECK(has(refusal(folder, package(model(levels, item(40)))), "more than 10^12"));
  CHECK(has(refusal(folder, package(model(object(1, "<components>" + component(2) + "</components>") +
                                              object(2, "<components>" + component(1) + "</components>"),
                                          item(1)))),
            "object 1 is a component of itself"));
  std::string chain = object(1, box_mesh());
  for (int id = 2; id <= 100; ++id) chain += object(id, "<components>" + component(id - 1) + "</components>");
  CHECK(has(refusal(folder, package(model(chain, item(100)))), "nested deeper than 64"));

  const std::string lattice = "xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\"";
  std::string beams = box_mesh();
  beams.insert(beams.find("</mesh>"),
               "<b:beamlattice radius=\"1\"><b:beams><b:beam v1=\"0\" v2=\"1\"/></b:beams></b:beamlattice>");
  CHECK(has(refusal(folder, package(model(object(3, beams), item(3), lattice))), "object 3 has a 'beamlattice'"));
  CHECK(has(refusal(folder, package(model(object(3, box_mesh()), item(3),
                                          "xmlns:v=\"http://example.com/volumes\" requiredextensions=\"v\""))),
            "needs the 3MF extension 'http://example.com/volumes'"));
  CHECK(has(refusal(folder, package(model(object(1, box_mesh()), ""))), "its build has no item"));
  CHECK(has(refusal(folder, package(model(object(1, box_mesh()), item(2)))), "refers to object 2"));
  CHECK(has(refusal(folder, package(model(object(1, box_mesh()), item(1, "transform=\"1 0 0\"")))),
            "its <item> has transform '1 0 0'"));
  CHECK(has(refusal(folder, package("<!DOCTYPE model [<!ENTITY a \"aaaa\">]>" + model(object(1, box_mesh()), item(1)))),
            "declares a document type"));
}

TEST_CASE("meshes that crashed or starved a library: one line and status 65, at once") {
  const scratch::Folder folder;
  CHECK(refusal(folder, "ply\nformat ascii 1.0\nproperty float x\nend_header\n") != "no error");
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  CHECK(volume(read_mesh(folder.write("a", header + "3 0 1 2\n"))) == doctest::Approx(0));
  const auto begun = std::chrono::steady_clock::now();
  CHECK(refusal(folder, header + "2000000000 0 1 2\n") != "no error");
  CHECK(refusal(folder, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2000000000 0 1 2\n") != "no error");
  CHECK(std::chrono::steady_clock::now() - begun < std::chrono::seconds(20));
}
