// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "base/text/format_version.hpp"
#include "base/text/printable.hpp"
#include "io/vdb/private/facts.hpp"

namespace vam::io {

namespace {

std::string text(const openvdb::FloatGrid& sparse, const char* key) {
  const auto found = sparse.getMetadata<openvdb::StringMetadata>(key);
  return found ? found->value() : "";
}

using ActiveWords = decltype(LeafRecord::active);

ActiveWords active_of(const openvdb::FloatTree::LeafNodeType& leaf) {
  ActiveWords words{};
  for (openvdb::Index i = 0; i < words.size(); ++i) words[i] = leaf.valueMask().getWord<openvdb::Index64>(i);
  return words;
}

}  // namespace

Digest facts_digest(const openvdb::FloatGrid& sparse) {
  Sealer sealer;
  sealer.add(sparse.getName());
  sealer.add(static_cast<int>(sparse.getGridClass()));
  const openvdb::Mat4d matrix = sparse.transform().baseMap()->getAffineMap()->getMat4();
  sealer.add(matrix.asPointer(), 16 * sizeof(double));
  for (auto it = sparse.beginMeta(); it != sparse.endMeta(); ++it) {  // in the order of their names
    if (!is_sealed_name(it->first)) continue;
    sealer.add(it->first);
    sealer.add(std::string(it->second->typeName()));
    sealer.add(it->second->str());
  }
  return sealer.digest();
}

void VoxelSealer::begin(const openvdb::FloatTree& tree) {
  sealer_.add(tree.background());
  for_tiles(tree, [this](const TileRecord& tile) { sealer_.add(&tile, sizeof tile); });
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
    const ActiveWords active = active_of(*leaf);
    sealer_.add(active.data(), sizeof active);
  }
}

LeafRecord record_of(const openvdb::FloatTree::LeafNodeType& leaf, const float* values) {
  LeafRecord record;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled at once
  record.corner = {leaf.origin().x(), leaf.origin().y(), leaf.origin().z()};
  record.padding = 0;
  record.active = active_of(leaf);
  // A negative zero is a zero: OpenVDB reads the inactive ones as background.
  std::transform(values, values + record.values.size(), record.values.data(), [](float value) { return value + 0.0F; });
  return record;
}

void seal(openvdb::FloatGrid& sparse, const LeafStore& leaves) {
  VoxelSealer voxels;
  voxels.begin(sparse.constTree());
  constexpr std::size_t leaves_together = 2048;
  std::vector<const LeafStore::Leaf*> some;
  std::vector<LeafRecord> records(leaves_together);
  const auto add_some = [&] {
    parallel_for(count_of(some), [&](int n) {
      LeafStore::Values room;
      records[n] = record_of(*some[n], leaves.values(*some[n], room));
    });
    for (std::size_t n = 0; n < some.size(); ++n) voxels.add(records[n]);
    some.clear();
  };
  for (auto leaf = sparse.constTree().cbeginLeaf(); leaf; ++leaf) {
    some.push_back(leaf.getLeaf());
    if (some.size() == leaves_together) add_some();
  }
  add_some();
  sparse.insertMeta(facts_seal_key, openvdb::StringMetadata(seal_text(facts_digest(sparse))));
  sparse.insertMeta(values_seal_key, openvdb::StringMetadata(seal_text(voxels.digest())));
}

std::optional<GridSeals> judged_seals(const openvdb::FloatGrid& sparse) {
  const std::string grid = "grid " + excerpt(sparse.getName());
  if (const openvdb::Metadata::ConstPtr version = sparse[version_name]) {  // first: a later one may seal otherwise
    const std::string why = FormatKind("volume").objection(version->str());
    if (!why.empty()) throw std::runtime_error(grid + " " + why);
  }
  const std::string facts = text(sparse, facts_seal_key);
  const std::string values = text(sparse, values_seal_key);
  if (facts.empty() && values.empty()) return std::nullopt;
  GridSeals seals;
  if (!parse_seal(facts, seals.facts) || !parse_seal(values, seals.values)) {
    throw std::runtime_error(grid + " has a damaged seal; make the file again");
  }
  const Digest read = facts_digest(sparse);
  if (read != seals.facts) throw std::runtime_error(mismatch("the head of " + grid, seals.facts, read));
  return seals;
}

void add_seal(const std::optional<GridSeals>& seals, VolumeFacts& facts) {
  if (!seals) return;
  const std::string line = chain_line(seals->facts, seals->values);
  facts.seal = chained_seal(line);
  const bool named = !facts.history.empty() && !chained_seal(facts.history.back()).empty();
  if (!named) facts.history.push_back(line);
}

}  // namespace vam::io
