// SPDX-License-Identifier: GPL-3.0-or-later
// A box whose bytes and volume are known, for the tests of mesh files.
#pragma once

#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

#include "io/mesh/file.hpp"
#include "lib/io/scratch.hpp"
#include "lib/io/zip_writer.hpp"
#include "model/mesh.hpp"
#include "testing.hpp"

namespace samples {

using vam::model::TriangleSoup;

// A box 1 x 2 x 3 mm as six quadrilaterals, anticlockwise from outside.
inline const std::vector<std::array<double, 3>> box_points{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0},
                                                           {0, 0, 3}, {1, 0, 3}, {1, 2, 3}, {0, 2, 3}};
inline const std::vector<std::array<int, 4>> box_faces{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                       {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

// Volume by the divergence theorem: right only when every triangle is there, once, and oriented outwards.
inline double volume(const TriangleSoup& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto& a = mesh.points[t[0]];
    const auto& b = mesh.points[t[1]];
    const auto& c = mesh.points[t[2]];
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}

inline TriangleSoup box() {
  TriangleSoup mesh{.points = box_points};
  for (const auto& f : box_faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

/// The <mesh> of a 3MF model.
inline std::string mesh_xml(const TriangleSoup& mesh) {
  std::string text = "<mesh><vertices>";
  for (const auto& p : mesh.points) {
    text += "<vertex x=\"" + std::to_string(p[0]) + "\" y=\"" + std::to_string(p[1]) + "\" z=\"" +
            std::to_string(p[2]) + "\"/>";
  }
  text += "</vertices><triangles>";
  for (const auto& t : mesh.triangles) {
    text += "<triangle v1=\"" + std::to_string(t[0]) + "\" v2=\"" + std::to_string(t[1]) + "\" v3=\"" +
            std::to_string(t[2]) + "\"/>";
  }
  return text + "</triangles></mesh>";
}

/// A whole 3MF file of the box.
inline std::string box_3mf(const std::string& unit, const std::string& transform) {
  std::string model = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"" + unit +
                      "\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>"
                      "<object id=\"1\" type=\"model\">";
  model += mesh_xml(box());
  model += "</object></resources><build><item objectid=\"1\"" +
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

/// The mesh of a file of these bytes.
inline TriangleSoup mesh_of(const std::string& bytes) {
  const scratch::Folder folder;
  return vam::io::read_mesh(folder.write("mesh", bytes));
}

/// The one line with which they are refused.
inline std::string refused(const std::string& bytes) {
  const std::string line = error_of([&] { (void)mesh_of(bytes); }, vam::Fault::data);
  CHECK(!has(line, "\n"));
  return line;
}

}  // namespace samples
