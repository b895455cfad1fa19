// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh/file.hpp"
#include "lib/io/box_mesh.hpp"
#include "lib/io/cpu_time.hpp"
#include "lib/io/scratch.hpp"
#include "lib/io/zip_writer.hpp"
#include "testing.hpp"

using namespace samples;

namespace {

constexpr const char* core_space = "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"";

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

TEST_CASE(
    "3MF: components are placed from the inside out, mirrored ones keep their orientation, unprintable ones are left "
    "out") {
  const std::string nested = object(1, mesh_xml(box())) +
                             object(2, "<components>" + component(1, "transform=\"2 0 0 0 1 0 0 0 1 1 0 0\"") +
                                           component(1, "transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"") + "</components>");
  const auto mesh = mesh_of(package(model(nested, item(2, "transform=\"0 1 0 -1 0 0 0 0 1 0 0 5\"") +
                                                      item(1, "printable=\"0\"") + item(1, "printable=\"false\""))));
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

TEST_CASE("3MF is written in mm, the same bytes for the same mesh, and comes back point by point") {
  const scratch::Folder folder;
  vam::model::TriangleSoup mesh = box();
  mesh.points[0][0] += 1.0 / 3;
  vam::model::TriangleSoup flat = mesh;
  flat.triangles.push_back({1, 1, 2});  // 3MF has no such triangle
  const std::vector<std::string> comments{"a <tag> & \"more\""};
  vam::io::write_mesh(folder / "a.3mf", mesh, comments);
  vam::io::write_mesh(folder / "b.3mf", flat, comments);
  CHECK(scratch::slurp(folder / "a.3mf") == scratch::slurp(folder / "b.3mf"));
  const vam::io::ColouredMesh back = vam::io::read_coloured_mesh(folder / "a.3mf");
  CHECK(back.in_mm);
  CHECK(back.mesh.triangles == mesh.triangles);
  REQUIRE(back.mesh.points.size() == mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      CHECK(std::abs(back.mesh.points[i][axis] - mesh.points[i][axis]) < 1e-8);  // nine digits
  }
}

TEST_CASE("3MF: supports are not printed, alone, as items or as components") {
  const auto typed = [](int id, const std::string& type) {
    return "<object id=\"" + std::to_string(id) + "\" type=\"" + type + "\">" + mesh_xml(box()) + "</object>";
  };
  const std::string objects = object(1, mesh_xml(box())) + typed(2, "support") + typed(3, "solidsupport") +
                              object(4, "<components>" + component(1) + component(2) + "</components>");
  CHECK(mesh_of(package(model(objects, item(1) + item(2) + item(3)))).triangles.size() == 12);
  CHECK(mesh_of(package(model(objects, item(4)))).triangles.size() == 12);
  CHECK(has(refused(package(model(objects, item(2)))), "its build has supports only, and no part"));
  for (const std::string type : {"other", "surface", "invalidtype"}) {
    CHECK(has(refused(package(model(typed(1, type), item(1)))), "object 1 is of type '" + type + "', which is not"));
  }
  const std::string sliced =
      "<object id=\"1\" xmlns:s=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\" "
      "s:slicestackid=\"7\">" +
      mesh_xml(box()) + "</object>";
  CHECK(has(refused(package(model(sliced, item(1)))), "object 1 consists of slices, which are not read; export it"));
}

TEST_CASE("3MF: volumes of slicers are added, taken away or left out, as PrusaSlicer, BambuStudio and Cura mean them") {
  const auto with = [](const std::string& root, const std::string& name, const std::string& settings) {
    const scratch::Folder folder;
    Zip zip;
    zip.add("3D/3dmodel.model", root);
    zip.add(name, "<config>" + settings + "</config>");
    const auto read = vam::io::read_coloured_mesh(folder.write("mesh", zip.done()));
    TriangleSoup taken_away = read.mesh;
    const auto from = std::ssize(taken_away.triangles) - static_cast<std::ptrdiff_t>(read.taken_away);
    taken_away.triangles.erase(taken_away.triangles.begin(), taken_away.triangles.begin() + from);
    return std::pair{volume(read.mesh) - volume(taken_away), volume(taken_away)};
  };
  const auto typed = [](const std::string& first, const std::string& last, const std::string& type) {
    return "<volume firstid=\"" + first + "\" lastid=\"" + last +
           "\"><metadata type=\"volume\" key=\"volume_type\" value=\"" + type + "\"/></volume>";
  };
  TriangleSoup three = box();
  for (int i = 0; i < 24; ++i) three.triangles.push_back(three.triangles[i]);
  const auto prusa = [&](const std::string& second, const std::string& third) {
    return with(model(object(4, mesh_xml(three)), item(4)), "Metadata/Slic3r_PE_model.config",
                "<object id=\"4\">" + typed("0", "11", "ModelPart") + typed("12", "23", second) +
                    typed("24", "35", third) + "</object><object id=\"5\">" + typed("0", "11", "NegativeVolume") +
                    "</object>");
  };
  CHECK(prusa("NegativeVolume", "ParameterModifier") == std::pair(6.0, 6.0));
  CHECK(prusa("SupportBlocker", "ModelPart") == std::pair(12.0, 0.0));
  const auto part = [](int id, const std::string& subtype) {
    return "<part id=\"" + std::to_string(id) + "\" subtype=\"" + subtype + "\"/>";
  };
  const std::string other = "<object id=\"2\" type=\"other\">" + mesh_xml(box()) + "</object>";  // whatever is no part
  const std::string components =
      object(1, mesh_xml(box())) + other + object(3, mesh_xml(box())) +
      object(8, "<components>" + component(1) + component(2) + component(3) + "</components>") +
      object(9, "<components>" + component(1) + component(1) + "</components>");
  CHECK(with(model(components, item(8)), "Metadata/model_settings.config",
             "<object id=\"8\">" + part(1, "normal_part") + part(2, "negative_part") + part(3, "modifier_part") +
                 "</object>") == std::pair(6.0, 6.0));
  CHECK(with(model(components, item(9)), "Metadata/model_settings.config",
             "<object id=\"9\">" + part(1, "normal_part") + part(1, "negative_part") + "</object>") ==
        std::pair(6.0, 6.0));
  const std::string cura =
      object(1, mesh_xml(box())) + object(2,
                                          "<metadatagroup><metadata name=\"cura:cutting_mesh\">\n True</metadata>"
                                          "</metadatagroup>" +
                                              mesh_xml(box()));
  CHECK(volume(mesh_of(package(model(cura, item(1) + item(2))))) == doctest::Approx(6));
}

TEST_CASE("3MF: a beam is a frustum with its caps, of the volume that geometry gives") {
  const auto beam = [](const std::string& attributes, const std::string& lattice = "") {
    const std::string beams = "<b:beamlattice radius=\"0.5\" minlength=\"0.1\" " + lattice +
                              "><b:beams><b:beam v1=\"0\" v2=\"1\" " + attributes + "/></b:beams></b:beamlattice>";
    const std::string mesh =
        "<mesh><vertices><vertex x=\"1\" y=\"2\" z=\"3\"/><vertex x=\"3\" y=\"5\" z=\"9\"/></vertices>"
        "<triangles/>" +
        beams + "</mesh>";
    return package(model(object(3, mesh), item(3),
                         "xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/"
                         "2017/02\" requiredextensions=\"b\""));
  };
  const double pi = std::acos(-1), cylinder = pi * 0.25 * 7, ball = pi / 6;  // 7 mm long, 1 mm thick
  CHECK(volume(mesh_of(beam("cap1=\"butt\" cap2=\"butt\""))) == doctest::Approx(cylinder).epsilon(1e-9));
  CHECK(volume(mesh_of(beam(""))) == doctest::Approx(cylinder + 2 * ball).epsilon(1e-9));  // half of it twice
  const double cone = pi * 7 / 3 * (0.25 + 0.5 + 1);
  CHECK(volume(mesh_of(beam("r1=\"0.5\" r2=\"1\"", "cap=\"hemisphere\""))) ==
        doctest::Approx(cone + ball / 2 + 4 * ball).epsilon(1e-9));
  CHECK(has(refused(beam("", "clippingmode=\"inside\" clippingmesh=\"1\"")),
            "has a beam lattice with clippingmode, which is not"));
  CHECK(has(refused(beam("r1=\"-1\"")), "its <beam> has r1 '-1'"));
}

TEST_CASE("3MF: an object of another part, whose unit is its own") {
  const std::string production =
      "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" "
      "requiredextensions=\"p\"";
  const std::string root =
      model(object(1, "<components>" + component(7, "p:path=\"/3D/Objects/second.model\"") + "</components>"), item(1),
            production);
  const std::string bytes = package(root, model(object(7, mesh_xml(box())), "", "unit=\"centimeter\""));
  CHECK(volume(mesh_of(bytes)) == doctest::Approx(6000));
  CHECK(has(refused(package(root)), "3D/Objects/second.model"));
}

TEST_CASE("3MF: rejects unbounded components and non-mesh geometry") {
  const auto ten = [](int id) {
    std::string text = "<components>";
    for (int i = 0; i < 10; ++i) text += component(id);
    return text + "</components>";
  };
  std::string levels = object(1, mesh_xml(box()));
  for (int id = 2; id <= 10; ++id) levels += object(id, ten(id - 1));
  CHECK(has(refused(package(model(levels, item(10)))),
            "expand to 1111111111 objects of 12000000000 triangles and 8000000000 vertices"));
  for (int id = 11; id <= 40; ++id) levels += object(id, ten(id - 1));
  CHECK(has(refused(package(model(levels, item(40)))), "more than 10^12"));
  CHECK(has(refused(package(model(object(1, "<components>" + component(2) + "</components>") +
                                      object(2, "<components>" + component(1) + "</components>"),
                                  item(1)))),
            "object 1 is a component of itself; mend it, or save"));
  std::string chain = object(1, mesh_xml(box()));
  for (int id = 2; id <= 100; ++id) chain += object(id, "<components>" + component(id - 1) + "</components>");
  CHECK(has(refused(package(model(chain, item(100)))), "nested deeper than 64; save it as a plain mesh"));

  CHECK(has(refused(package(model(object(3, mesh_xml(box())), item(3),
                                  "xmlns:v=\"http://example.com/volumes\" requiredextensions=\"v\""))),
            "needs the 3MF extension 'http://example.com/volumes'"));
  CHECK(has(refused(package(model(object(1, mesh_xml(box())), ""))), "its build has no item"));
  CHECK(has(refused(package(model(object(1, mesh_xml(box())), item(2)))), "refers to object 2"));
  CHECK(has(refused(package(model(object(1, mesh_xml(box())), item(1, "transform=\"1 0 0\"")))),
            "its <item> has transform '1 0 0'"));
  CHECK(has(refused(package("<!DOCTYPE model [<!ENTITY a \"aaaa\">]>" + model(object(1, mesh_xml(box())), item(1)))),
            "declares a document type"));
}

TEST_CASE("3MF: what a small file unpacks and expands to is bounded, and refused with numbers") {
  const auto packed_refusal = [&](const std::string& root) {
    Zip zip;
    zip.add_packed("3D/3dmodel.model", root);
    const std::string bytes = zip.done();
    const double begun_s = cpu_s();
    const std::string line = refused(bytes);
    CHECK(cpu_s() - begun_s < 2);
    return line;
  };
  const auto items = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += item(1);
    return text;
  };
  const std::string one = object(1, mesh_xml(box()));
  const std::string name = "name=\"" + std::string(3 << 20, 'x') + "\"";
  CHECK(
      has(packed_refusal(model("<object id=\"1\" " + name + "/>", item(1))), "has a tag of more than 1 MiB in line 1"));
  CHECK(has(packed_refusal(model(one, item(1)) + std::string(70 << 20, ' ')),
            "unpacks to more than 64 MiB and 64 times"));
  CHECK(has(packed_refusal(model(one, items(170'000))),
            "expand to 170000 objects of 2040000 triangles and 1360000 vertices; they need 0.16 GiB of memory, and "
            "those of a file of its size may take 0.157 GiB; save it as a plain mesh (STL)"));
  CHECK(has(packed_refusal(model(one, items((1 << 20) + 1))), "has more than 1048576 items and components"));
}

TEST_CASE("3MF: two files of a name in the archive, of which one would be read, are refused") {
  const std::string root = model(object(1, mesh_xml(box())), item(1));
  for (const char* name : {"3D/3dmodel.model", "3d/3DModel.MODEL"}) {
    Zip zip;
    zip.add("3D/3dmodel.model", root);
    zip.add(name, root);
    CHECK(has(refused(zip.done()),
              "holds two files called '3d/3dmodel.model', of which only one would be read; save it again"));
  }
}

TEST_CASE("3MF: what an object lacks or has twice is said with a remedy") {
  const std::string one = object(1, mesh_xml(box()));
  CHECK(has(refused(package(model(one + one, item(1)))), "has two objects 1; mend it, or save the mesh again"));
  std::string beyond = one;
  beyond.replace(beyond.find("v1=\"") + 4, 1, "-1");
  CHECK(has(refused(package(model(beyond, item(1)))),
            "object 1 uses vertex -1 of 8 (counted from 0); mend it, or save the mesh again"));
}

TEST_CASE("3MF: the unit and the place of the build item count") {
  CHECK(volume(mesh_of(box_3mf("inch", ""))) == doctest::Approx(6 * std::pow(25.4, 3)));
  CHECK(volume(mesh_of(box_3mf("micron", ""))) == doctest::Approx(6e-9));
  // 3MF matrices are row by row, row vectors, translation last: a quarter turn about z, then (10, 20, 30).
  const auto mesh = mesh_of(box_3mf("millimeter", "0 1 0 -1 0 0 0 0 1 10 20 30"));
  CHECK(volume(mesh) == doctest::Approx(6));
  std::array<double, 3> low{1e9, 1e9, 1e9};
  for (const auto& p : mesh.points) {
    for (std::size_t axis = 0; axis < 3; ++axis) low[axis] = std::min(low[axis], p[axis]);
  }
  CHECK(low[0] == doctest::Approx(8));  // x' = -y + 10, y in [0, 2]
  CHECK(low[1] == doctest::Approx(20));
  CHECK(low[2] == doctest::Approx(30));
  CHECK(has(refused(box_3mf("furlong", "")), "unknown 3MF unit 'furlong'"));
}

TEST_CASE("3MF: the relations name the model, wherever they are in the archive") {
  const std::string relations =
      "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
      "Target=\"/3D/part.model\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>"
      "</Relationships>";
  for (const bool first : {true, false}) {
    Zip zip;
    if (first) zip.add("_rels/.rels", relations);
    zip.add("3D/another.model", model(object(1, mesh_xml(box())), item(1) + item(1)));
    zip.add("3D/part.model", model(object(1, mesh_xml(box())), item(1)));
    if (!first) zip.add("_rels/.rels", relations);
    CHECK(mesh_of(zip.done()).triangles.size() == 12);
  }
}
