// 3MF through assimp, which ignores the model's unit: that is read from the archive here.
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <regex>
#include <utility>

#include "io/mesh/private/formats.hpp"
#include "io/mesh/private/zip_member.hpp"

namespace vam::io {

namespace {

// 3MF core specification, table "unit": millimetre when absent.
double unit_mm(const std::string& bytes) {
  const auto head = zip_member_head(bytes, ".model", 4096);
  if (!head) throw MeshProblem{"not a whole 3MF file: no 3D model in the zip archive; it is truncated or damaged"};
  std::smatch unit;
  if (!std::regex_search(*head, unit, std::regex("<model[^>]*\\sunit\\s*=\\s*[\"']([a-z]+)[\"']"))) return 1;
  const std::pair<const char*, double> units[] = {{"micron", 1e-3}, {"millimeter", 1}, {"centimeter", 10},
                                                  {"inch", 25.4},   {"foot", 304.8},   {"meter", 1000}};
  for (const auto& [name, mm] : units) {
    if (unit[1] == name) return mm;
  }
  throw MeshProblem{"unknown 3MF unit '" + unit[1].str() + "'"};
}

void collect(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above, double unit, PolygonSoup& soup) {
  const aiMatrix4x4 placed = above * node.mTransformation;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
    const int first = static_cast<int>(soup.points.size());
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D p = placed * mesh.mVertices[v];
      soup.points.push_back(
          {unit * static_cast<double>(p.x), unit * static_cast<double>(p.y), unit * static_cast<double>(p.z)});
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      auto& face = soup.faces.emplace_back();
      for (unsigned c = 0; c < mesh.mFaces[f].mNumIndices; ++c) {
        face.push_back(first + static_cast<int>(mesh.mFaces[f].mIndices[c]));
      }
    }
  }
  for (unsigned c = 0; c < node.mNumChildren; ++c) collect(scene, *node.mChildren[c], placed, unit, soup);
}

}  // namespace

PolygonSoup parse_3mf(const std::string& bytes) {
  const double unit = unit_mm(bytes);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, "3mf");
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw MeshProblem{std::string("not a whole 3MF file: ") + importer.GetErrorString()};
  }
  PolygonSoup soup;
  collect(*scene, *scene->mRootNode, aiMatrix4x4(), unit, soup);
  return soup;
}

}  // namespace vam::io
