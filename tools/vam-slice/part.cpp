#include "vam-slice/part.hpp"

#include <memory>
#include <string>
#include <utility>

#include "io/image/image_file.hpp"
#include "io/mesh/file.hpp"
#include "io/stream/input_name.hpp"

namespace vam::slice_tool {

namespace {

solid::FillMode fill_mode(const Options& options) {
  if (options.fill == "exact") return solid::FillMode::exact;
  return options.fill == "vote" ? solid::FillMode::vote : solid::FillMode::automatic;
}

solid::Part image_part(const Options& options) {
  const auto folder = std::make_shared<io::ImageFolder>(options.input);
  const GreyImage first = folder->read(0);
  solid::ImageStack stack{first.width, first.height, folder->count(), [folder](int index) {
                            const GreyImage grey = folder->read(index);
                            Image image(grey.width, grey.height);
                            for (std::size_t i = 0; i < image.size(); ++i) {
                              image.values[i] = static_cast<float>(grey.values[i]) / static_cast<float>(grey.full());
                            }
                            return image;
                          }};
  return solid::image_part(std::move(stack), options.input, options.voxel_mm.value(), options.placement.stretch_z);
}

}  // namespace

solid::Part part_of(const Options& options, const solid::Writable& room) {
  if (!options.shape.empty()) return solid::shape_part(options.shape, options.placement, room);
  if (is_folder(options.input)) return image_part(options);
  model::TriangleSoup mesh = io::read_mesh(options.input);
  const std::string subject = io::input_name(options.input);
  const solid::Affine map = solid::place(mesh, options.placement, room, subject);
  return solid::mesh_part(std::move(mesh), subject, map, fill_mode(options));
}

std::optional<solid::Part> insert_of(const Options& options, const solid::Part& part, const solid::Writable& room) {
  if (!options.insert.empty()) {
    return solid::mesh_part(io::read_mesh(options.insert), options.insert, part.map, solid::FillMode::automatic);
  }
  if (options.insert_shape.empty()) return std::nullopt;
  solid::Placement upright;
  upright.stretch_z = options.placement.stretch_z;
  return solid::shape_part(options.insert_shape, upright, room);
}

}  // namespace vam::slice_tool
