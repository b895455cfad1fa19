#include "vam-optimize/inputs.hpp"

#include "base/error.hpp"

namespace vam::optimize_tool {

Inputs read(const std::string& path) {
  Inputs in{io::read_volumes(path), 0, std::nullopt};
  const auto find = [&](const std::string& name) -> std::optional<std::size_t> {
    for (std::size_t i = 0; i < in.volumes.size(); ++i) {
      if (in.volumes[i].name() == name) return i;
    }
    return std::nullopt;
  };
  const auto target = find("target");
  if (!target) throw Error{Fault::data, path + ": has no grid 'target'; vam-slice makes one"};
  in.target_at = *target;
  in.insert_at = find("insert");
  if (in.insert() != nullptr && !(in.insert()->grid() == in.target().grid())) {
    throw Error{Fault::data,
                path + ": the insert's grid is not the target's; slice both together (vam-slice --insert)"};
  }
  return in;
}

Initial::Initial(const std::string& path, const model::StackInfo& want) : path_(path), reader_(path) {
  const auto& is = reader_.info();
  io::require(path, is, model::Kind::sinogram, want.space);
  if (is.width == want.width && is.height == want.height && is.count == want.count) return;
  const auto size = [](const model::StackInfo& s) {
    return std::to_string(s.width) + " columns x " + std::to_string(s.height) + " angles x " + std::to_string(s.count) +
           " slices";
  };
  throw Error{Fault::data, path + ": " + size(is) + ", but the target needs " + size(want) +
                               "; use the same target, --angles and --columns"};
}

Image Initial::operator()(int k) {
  Image image;
  model::ImageInfo about;
  while (next_ <= k) {
    if (!reader_.next(image, about)) throw Error{Fault::data, path_ + ": ends at slice " + std::to_string(next_)};
    ++next_;
  }
  return image;
}

}  // namespace vam::optimize_tool
