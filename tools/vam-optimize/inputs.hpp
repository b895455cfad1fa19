// What vam-optimize reads: the volumes, and projections to start from.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "io/exr_stack.hpp"
#include "io/vdb.hpp"
#include "model/stack.hpp"

namespace vam::optimize_tool {

struct Inputs {
  std::vector<io::SparseVolume> volumes;
  std::size_t target_at = 0;
  std::optional<std::size_t> insert_at;

  [[nodiscard]] const io::SparseVolume& target() const { return volumes[target_at]; }
  [[nodiscard]] const io::SparseVolume* insert() const { return insert_at ? &volumes[*insert_at] : nullptr; }
};

/// Throws Fault::data when there is no target, or an insert on another grid.
[[nodiscard]] Inputs read(const std::string& path);

/// Reads a stack slice after slice; slices in between are skipped.
class Initial {
 public:
  /// Throws Fault::data unless the stack has the size of `want`.
  Initial(const std::string& path, const model::StackInfo& want);
  Image operator()(int k);

 private:
  std::string path_;
  io::StackReader reader_;
  int next_ = 0;
};

}  // namespace vam::optimize_tool
