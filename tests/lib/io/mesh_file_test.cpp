// SPDX-License-Identifier: GPL-3.0-or-later
#include <cctype>
#include <chrono>
#include <cstring>
#include <map>

#include "io/mesh/file.hpp"
#include "io/mesh/private/formats.hpp"
#include "lib/io/box_mesh.hpp"
#include "lib/io/cpu_time.hpp"
#include "lib/io/scratch.hpp"
#include "lib/io/zip_writer.hpp"
#include "testing.hpp"

using vam::io::read_mesh;
using vam::model::TriangleSoup;

using namespace samples;
using scratch::slurp;

namespace {

const std::string three = "0 0 0\n1 0 0\n0 1 0\n";  // vertices

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

/// The head of a PLY file with vertices of three floats; `more`: their other properties, and other elements.
std::string ply_head(const std::string& vertices, const std::string& more, const std::string& format = "ascii") {
  return "ply\nformat " + format + " 1.0\ncomment made by hand\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\n" + more + "end_header\n";
}

std::string box_ply() {
  return ply_head("8", "element face 6\nproperty list uchar int vertex_indices\n") +
         box_off().substr(std::strlen("OFF\n8 6 0\n"));
}

/// The bytes of a file with that ending.
std::string written_box(const std::string& ending) {
  const scratch::Folder folder;
  vam::io::write_mesh(folder / ("box" + ending), box(), {});
  return slurp(folder / ("box" + ending));
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

}  // namespace

TEST_CASE("each format of the table recognizes its files alone and gives the box back: 6 mm3, oriented outwards") {
  const std::map<std::string, std::string> boxes{{"OBJ", box_obj()},
                                                 {"OFF", box_off()},
                                                 {"PLY", box_ply()},
                                                 {"STL", box_ascii_stl()},
                                                 {"3MF", box_3mf("millimeter", "")}};
  CHECK(vam::io::mesh_formats().size() == boxes.size());
  for (const auto& format : vam::io::mesh_formats()) {
    CAPTURE(format.name);
    for (const auto& [name, bytes] : boxes) CHECK(format.recognises(bytes) == (name == format.name));
    const auto mesh = mesh_of(boxes.at(format.name));
    CHECK(mesh.triangles.size() == 12);
    CHECK(volume(mesh) == doctest::Approx(6));
    CHECK(has(refused("hello, world\n"), format.name));
  }
}

TEST_CASE("the ending of an output's name chooses its format, and one that is only read is refused") {
  const scratch::Folder folder;
  for (const auto& format : vam::io::mesh_formats()) {
    const std::string path = folder / ("box" + format.extension);
    CAPTURE(path);
    if (format.write == nullptr) {
      CHECK(has(error_of([&] { vam::io::write_mesh(path, box(), {}); }, vam::Fault::usage),
                "use .3mf or .ply or .stl or .obj"));
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
  CHECK(volume(mesh_of(bytes)) == doctest::Approx(6));
  for (std::size_t face = 0; face < 12; ++face) {
    float record[4][3];  // normal and corners
    std::memcpy(record, bytes.data() + 84 + 50 * face, sizeof record);
    const auto along_normal = [&](float x, float y, float z) {
      return record[0][0] * x + record[0][1] * y + record[0][2] * z;
    };
    CHECK(along_normal(record[0][0], record[0][1], record[0][2]) == 1);
    const auto* a = record[1];
    CHECK(along_normal(a[0] - 0.5F, a[1] - 1, a[2] - 1.5F) > 0);  // outwards from the middle
    for (const auto* b : {record[2], record[3]}) CHECK(along_normal(b[0] - a[0], b[1] - a[1], b[2] - a[2]) == 0);
  }
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

TEST_CASE("PLY carries uncertainties, which are read back") {
  const scratch::Folder folder;
  vam::model::VertexData data;
  for (int i = 0; i < 8; ++i) {
    data.quality.push_back(1);
    data.colours.push_back({9, 2, 3});
    data.uncertainty.push_back(static_cast<float>(i) / 8);
  }
  vam::io::write_ply(folder / "box.ply", box(), data);
  const auto read = vam::io::read_coloured_mesh(folder / "box.ply");
  CHECK(read.uncertainty == data.uncertainty);
  CHECK(read.colours == data.colours);
  data.uncertainty[3] = -1;
  vam::io::write_ply(folder / "box.ply", box(), data);
  CHECK_THROWS_WITH_AS((void)read_mesh(folder / "box.ply"), doctest::Contains("negative"), vam::Error);
  data.uncertainty.clear();
  vam::io::write_ply(folder / "box.ply", box(), data);
  CHECK(vam::io::read_coloured_mesh(folder / "box.ply").uncertainty.empty());
}

TEST_CASE("a file truncated anywhere is an error") {
  const std::string stl = written_box(".stl");
  for (const auto& bytes :
       {stl, written_box(".ply"), box_off(), box_ply(), box_ascii_stl(), box_3mf("millimeter", "")}) {
    for (std::size_t size = 0; size + 3 < bytes.size(); size += 7) {
      CAPTURE(bytes.substr(0, 12));
      CAPTURE(size);
      CHECK(refused(bytes.substr(0, size)) != "no error");
    }
  }
  CHECK(has(refused(stl.substr(0, 300)), "12 triangles (684 bytes): it has 300 bytes"));
}

TEST_CASE("vertices that are not finite, wrong indices, faces of two corners, no faces, foreign files") {
  std::string stl = written_box(".stl");
  const float nan = NAN;
  std::memcpy(stl.data() + 84 + 12, &nan, sizeof nan);
  CHECK(has(refused(stl), "facet 0 has a corner that is not finite (counted from 0, of 12); the file is damaged"));
  const float far = 1e30F;
  std::memcpy(stl.data() + 84 + 12, stl.data() + 84 + 24, sizeof far);
  std::memcpy(stl.data() + 84 + 100 + 20, &far, sizeof far);
  CHECK(has(refused(stl), "facet 2 has a corner that is at 1e+30 (counted from 0, of 12)"));
  const auto text = [](const std::string& corner) {
    return "solid vertex\n facet normal 0 0 1\n  outer loop\r\n vertex 0 0 0\n vertex 1 0 0\n VERTEX " + corner +
           "\n  endloop\n endfacet\nendsolid vertex\n";
  };
  for (const char* corner : {"nan 0 0", "0 inf 0", "1e999 0 0", "0 0", "0,5 1 1"}) {
    CHECK(has(refused(text(corner)),
              std::string("line 6: 'vertex ") + corner + "' is no vertex of three finite coordinates; mend the line"));
  }
  CHECK(has(refused(text("1e30 0 0")), "is at 1e+30"));
  CHECK(refused(text("+0 1e-3\t0")) == "no error");
  CHECK(refused(box_off("nan 0 0")) != "no error");
  CHECK(refused(box_off("1e999 0 0")) != "no error");
  std::string obj = box_obj();
  const auto lines = std::to_string(std::count(obj.begin(), obj.end(), '\n') + 1);
  for (const char* face : {"f 0 1 2\n", "f 1 2 0", "f 1/1 0/2 3/1\n"}) {
    CHECK(has(refused(obj + face),
              "line " + lines + ": a face uses vertex 0, but vertices are counted from 1; mend the line"));
  }
  CHECK(refused(obj + "f 1/0 2/0 10/0\n") != "no error");
  CHECK(refused(obj + "f -8 -7 -6\n") == "no error");
  CHECK(has(refused(obj + "f 1 2\n"), "face 6 has 2 corners; mend it, or save the mesh again"));
  CHECK(has(refused("v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "the mesh is empty: 3 vertices, no face"));
  CHECK(has(refused("solid nothing\nendsolid nothing\n"), "empty"));
  CHECK(has(refused(""), "is empty"));
  CHECK(has(refused("hello, world\n"), "not a mesh of a known format"));
  CHECK(has(refused("PK\5\6" + std::string(18, '\0')), "is an empty zip archive, not a mesh"));
  CHECK(has(refused(std::string("\0\nv 0 0 0\n", 10)), "is damaged: byte 0 of its text (OBJ) is 0"));
  CHECK(has(refused(" BDV" + std::string(200, '\0')), "is a volume (OpenVDB), not a mesh"));
  CHECK(has(refused("\x76\x2f\x31\x01" + std::string(200, '\0')), "is a stack (OpenEXR), not a mesh"));
  CHECK(has(refused("\x93NUMPY\1" + std::string(200, '\0')), "is a NumPy array (.npy), not a mesh"));
  CHECK(has(refused("\x89HDF\r\n\x1a\n" + std::string(200, '\0')), "is an HDF5 file, not a mesh"));
  CHECK(has(refused(std::string("II*\0", 4) + std::string(200, '\0')), "is a TIFF image, not a mesh"));
  CHECK(has(refused("ISO-10303-21;\nHEADER;\n"), "is a STEP model"));
  CHECK(has(refused("\x1f\x8b\x08" + std::string(200, '\0')), "is compressed by gzip, not a mesh"));
  CHECK(has(refused(std::string(128, '\0') + "DICM" + std::string(200, '\0')), "is a DICOM image"));
  CHECK(has(refused("\xff\xfes\0o\0"), "text of 16 bits"));
  CHECK(has(refused(ply_head("4000000000", "", "binary_little_endian")), "states 4000000000 vertex"));
  CHECK(has(refused("OFF\n99999999999 1 0\n"), "states 99999999999 vertices"));
  CHECK(fault_of([] { (void)read_mesh("/no/mesh.stl"); }) == vam::Fault::no_input);
}

TEST_CASE("ASCII STL in capitals, and text behind a mark of its encoding") {
  std::string capitals = box_ascii_stl();
  for (char& c : capitals) c = static_cast<char>(std::toupper(c));
  CHECK(volume(mesh_of(capitals)) == doctest::Approx(6));
  for (const std::string& text : {box_ascii_stl(), capitals, box_obj(), box_off(), box_ply()}) {
    CHECK(volume(mesh_of("\xef\xbb\xbf" + text)) == doctest::Approx(6));
  }
}

TEST_CASE("meshes that crashed or starved a library: one line and status 65, at once") {
  CHECK(refused("ply\nformat ascii 1.0\nproperty float x\nend_header\n") != "no error");
  const std::string header = ply_head("3", "element face 1\nproperty list int int vertex_indices\n") + three;
  CHECK(volume(mesh_of(header + "3 0 1 2\n")) == doctest::Approx(0));
  const auto begun = std::chrono::steady_clock::now();
  CHECK(refused(header + "2000000000 0 1 2\n") != "no error");
  CHECK(has(refused(header + "-2 0 1 2\n"), "not a whole PLY file"));
  CHECK(refused("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2000000000 0 1 2\n") != "no error");
  CHECK(std::chrono::steady_clock::now() - begun < std::chrono::seconds(20));
}

TEST_CASE("PLY coordinates that are no floats, and OFF that is no text, are refused") {
  const auto ply = [](const std::string& type) {
    std::string text = ply_head("3", "element face 1\nproperty list uchar int vertex_indices\n") + three + "3 0 1 2\n";
    return text.replace(text.find("float y\nproperty float"), 22, type + " y\nproperty double");
  };
  for (const char* type : {"float", "double", "float32", "float64"}) {
    CHECK(mesh_of(ply(type)).triangles.size() == 1);
  }
  for (const std::string type : {"uchar", "int", "int32"}) {
    CHECK(has(refused(ply(type)), "the PLY coordinate y is of type " + type));
  }
  CHECK(has(refused(ply("list uchar float")), "the PLY coordinate y is of type list"));
  CHECK(has(refused("OFF BINARY\n" + std::string(40, '\x7f')), "is a binary OFF file"));
}

TEST_CASE("OFF with counts beside its magic word, comments, normals and colours; indices that are none") {
  const std::string faces = "3 0 2 1\n3 0 1 3 # a face\n\n3 1 2 3 0.5 0.5 0.5 1\n3 0 3 2 255 0 0\n";
  const auto off = [&](const std::string& head, const std::string& more, const std::string& first = "0 0 0") {
    return head + "# points\n" + first + more + "\n 1 0 0" + more + "\r\n0 +1 0" + more + "\n0\t0 1e0" + more + "\n";
  };
  for (const std::string& text : {off("OFF\n4 4 0\n", ""), off("OFF 4 4 6\n", ""), off("NOFF\n4 4\n", " 0 0 1"),
                                  off("COFF\n4 4 0\n", " 255 128 0 255"), off("STOFF\n#\n4 4 0\n", " 0.5 0.5")}) {
    CHECK(volume(mesh_of(text + faces)) == doctest::Approx(1.0 / 6));
  }
  const std::string points = off("OFF\n4 1 0\n", "");
  CHECK(mesh_of(points + "4 0 1 2 3\n").triangles.size() == 2);
  for (const char* face :
       {"", "3 0 1\n", "3 0 1 1.5\n", "3 0 1 -1\n", "3 0 1 4e30\n", "3 0 1 x\n", "2.5 0 1 2\n", "-3 0 1 2\n"}) {
    CAPTURE(face);
    CHECK(has(refused(points + face), "not a whole OFF file: reading stopped after 4 vertices and 0 faces"));
  }
  CHECK(has(refused(points + "3 0 1 4\n"), "face 0 uses vertex 4 of 4"));
  CHECK(has(refused("OFF\n4 1\n0 0 0\n1 0\n"), "stopped after 1 vertices and 0 faces"));
  for (const char* counts : {"", "4\n", "-4 1\n", "4 1.5\n", "x\n"}) {
    CHECK(has(refused(std::string("OFF\n") + counts), "the OFF header has no counts"));
  }
}

TEST_CASE("text of a mesh with a byte 0 is damaged, and is told where") {
  std::string stl = "Solid box\n";
  for (int i = 0; i < 4; ++i)
    stl += "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  for (const auto& [text, format] :
       std::map<std::string, std::string>{{box_obj(), "OBJ"}, {stl + "endsolid box\n", "ASCII STL"}}) {
    for (const std::size_t at : {text.size() / 3, text.size() - 1}) {
      std::string bad = text;
      bad[at] = '\0';
      CHECK(has(refused(bad), "is damaged: byte " + std::to_string(at) + " of its text (" + format + ") is 0"));
    }
  }
  CHECK(has(refused(std::string("v is for volume\n\0", 17)), "not a whole STL file"));
}

TEST_CASE("faces beyond the count of a header are refused with both numbers") {
  const std::string stl = written_box(".stl");
  for (const std::string& padding : {std::string(49, '\0'), std::string(4096, '\0'), std::string("\r\n")}) {
    CHECK(mesh_of(stl + padding).triangles.size() == 12);
  }
  for (const auto& [rest, count] : std::map<std::string, std::string>{{"x", "1"},
                                                                      {std::string(48, '\0') + "x", "49"},
                                                                      {stl.substr(84), "600"},
                                                                      {stl, "684"},
                                                                      {std::string(65537, '\0'), "65537"}}) {
    CHECK(has(refused(stl + rest), count + " bytes follow the 12 triangles that the header states; its count"));
  }
  CHECK(has(refused(box_off() + "3 0 1 2\n# end\n3 0 2 3\n"), "states 6 faces but the file has 8"));
  CHECK(has(refused(box_ply() + "3 0 1 2\n\n"), "states 6 faces but the file has 7"));
  const std::string ply = written_box(".ply");
  CHECK(has(refused(ply + ply.substr(ply.size() - 26)), "states 12 faces but the file has 14"));
  CHECK(mesh_of(ply + "\n").triangles.size() == 12);
  for (const std::string& junk : {std::string("x"), std::string("\n\n\n"), std::string(12, '\0')}) {
    CHECK(has(refused(ply + junk),
              "trailing data after the last face, from byte " + std::to_string(ply.size()) + " on; save it again"));
  }
  const std::string zip = box_3mf("millimeter", "");
  CHECK(has(refused(zip + "x"), "trailing data after the end of the 3MF archive, from byte " +
                                    std::to_string(zip.size()) + " on; save it again"));
  CHECK(has(refused(zip + zip), "the 3MF archive begins at byte " + std::to_string(zip.size()) + " only"));
  for (const std::string& junk : {box_off(), std::string("end\n"), std::string("\0", 1)})
    CHECK(has(refused(box_off() + junk), "trailing data after the last face; save it again"));
  std::string minus = box_ply();
  minus.replace(minus.find("vertex 8"), 8, "vertex -1");
  CHECK(has(refused(minus), "the PLY header states -1 vertex elements"));
  std::string obj = box_obj();
  obj.insert(obj.rfind("//1"), ".7");
  CHECK(has(refused(obj), ".7//1', which is no index of a vertex; mend the line"));
}

TEST_CASE("lines of an OBJ file are joined where they go on, and one that is no vertex is named") {
  const std::string obj = box_obj();
  std::string continued = "# C:\\parts\\\n" + obj;  // which is no line that goes on
  for (std::size_t at = continued.find("\nv "); at != std::string::npos; at = continued.find("\nv ", at + 4)) {
    continued.insert(at + 3, at % 2 == 0 ? "\\\n" : "\\\r\n \t");
  }
  continued.insert(continued.rfind("\nf ") + 2, "\\\n");
  CHECK(volume(mesh_of(continued)) == doctest::Approx(6));
  CHECK(has(refused(continued + "f 1 2.5 3\n"), ": a face has the corner '2.5', which is no index of a vertex"));
  for (const std::string bad : {"v 1 2", "v", "v 1 2 x", " v 1 nan 2", "v 1 1e400 2", "v 1 2,5 3", "v 1 # 2 3"}) {
    CAPTURE(bad);
    std::string damaged = "v\\\n 0 0 0\n" + bad + "\n" + obj;
    CHECK(has(refused(damaged),
              ": line 3: '" + bad.substr(bad.find('v')) + "' is no vertex of three coordinates; mend the line"));
  }
  CHECK(has(refused("v +1e-3 .5 -7. 1\nv\t1 2 3 # here\r\nvn 1 0\n"), "the mesh is empty: 2 vertices, no face"));
}

TEST_CASE("a corner of a face of an OBJ file that is no vertex of it is named as it is written, with its line") {
  const std::string obj = box_obj();
  const std::string line = "line " + std::to_string(std::count(obj.begin(), obj.end(), '\n') + 1) + ": a face ";
  for (const std::string corner :
       {"99999999999999999999", "x", "8x", "8e0", "6,", "/4", "0x8", "+-8", "-", "8/x", "8/1.5", "8//n", "2.5"}) {
    CAPTURE(corner);
    CHECK(has(refused(obj + "f 5 6 7 " + corner + "\n"),
              line + "has the corner '" + corner + "', which is no index of a vertex; mend the line, or save"));
  }
  for (const std::string beyond : {"9", "4294967304", "+9", "9/1/1"}) {
    CAPTURE(beyond);
    const std::string index = std::to_string(std::stoll(beyond));
    CHECK(has(refused(obj + "f 5 6 7 " + beyond + "\n"),
              line + "uses vertex " + index + ", of 8 in the file; mend the line, or save"));
  }
  CHECK(has(refused(obj + "f 5 6 7 -9\n"), line + "uses vertex -9, of 8 before it; mend the line"));
  CHECK(has(refused("v 0 0 0\nf -1 -2 1\nv 1 0 0\n"), "line 2: a face uses vertex -2, of 1 before it"));
  const std::string long_corner = "f 1 2 3/" + std::string(300, '1') + " 4";
  for (const std::string& face :
       std::initializer_list<std::string>{"f 1 2 3 4", "f 1\t2\t3 4", "f +1 2/1 3//1 4/1/1", "f 1 2 3 4 # 5 6",
                                          "f 1 2 3 4#x 5", "f -8 -7 -6 -5\r", "\tf 1  2 3\t4 #", long_corner}) {
    CAPTURE(face);
    CHECK(mesh_of(obj + face + "\n").triangles.size() == 14);
  }
  CHECK(mesh_of("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").triangles.size() == 1);
}

TEST_CASE("an element of other programs in a PLY file, a digit a line, is no promise that the file is too short for") {
  std::string ply = box_ply();
  ply.insert(ply.find("end_header"), "element mark 2000\nproperty uchar set\n");
  for (int i = 0; i < 2000; ++i) ply += "1\n";
  CHECK(volume(mesh_of(ply)) == doctest::Approx(6));
}

TEST_CASE("a PLY property without an element is reported") {
  const std::string ply = "ply\nformat ascii 1.0\n", list = "property list uchar int vertex_indices\nend_header\n";
  for (const std::string& text : {ply + "property float x\nend_header\n", ply + list, ply + "pre_end_header\n" + list,
                                  ply + "comment end_header\n" + list}) {  // of which the first lines end none
    CHECK(has(refused(text), "the PLY header has a property of no element"));
  }
  CHECK(has(refused(ply + "element vertex 0\nend_heade"), "has no end_header"));
}

TEST_CASE("PLY lists that are longer than the file, and faces of a million corners, are refused soon") {
  const std::string count = little(std::uint32_t{240'000'000});
  const std::string notes = "property list uint uchar notes\n";
  const double begun_s = cpu_s();
  for (const std::string& text : {ply_head("3", notes, "binary_little_endian") + std::string(12, '\0') + count,
                                  ply_head("3", notes) + "0 0 0 240000000 7\n"}) {
    CHECK(has(refused(text), "reading stopped after 0 vertices"));
  }
  CHECK(cpu_s() - begun_s < 2);
  std::string face = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
  for (int i = 0; i < 100'000; ++i) face += " " + std::to_string(i % 3 + 1);
  CHECK(has(refused(face + "\n"), "face 0 has 100000 corners; up to 65536 are read; cut it into triangles"));
}

TEST_CASE("a number that ends with a PLY file is whole") {
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nproperty float quality\n";
  const std::string text = ply_head("3", faces) + three + "3 0 1 2 0.5";
  CHECK(mesh_of(text).triangles.size() == 1);
}
