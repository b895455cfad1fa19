// SPDX-License-Identifier: GPL-3.0-or-later
// The pieces of a print whose slices are optimised apart: their doses are computed once more, in ascending order, as
// their projections are handed out. Memory: the projections of a pass, and its doses.
#pragma once

#include <deque>

#include "optimize/run/private/jobs.hpp"
#include "optimize/run/volume.hpp"
#include "optimize/target/slice_reader.hpp"
#include "verdict/print_pieces.hpp"

namespace vam::optimize {

class LightPieces {
 public:
  /// All are referred to. Not for a grey target, nor for a part of the slices.
  LightPieces(const VolumeTask& task, const light::Operator& light, const SliceReader& reader);
  /// The projections of the next slice, which that job computed.
  void add(int job, const Image& image);
  /// After the last slice.
  [[nodiscard]] verdict::PrintPieces found();

 private:
  /// Slices that follow each other and have one dose.
  struct Alike {
    Image image;
    int job, slice, count;
  };

  void count(const Pass& pass);

  const VolumeTask& task_;
  const light::Operator& light_;
  const SliceReader& reader_;
  Division division_;
  std::deque<Alike> held_;  // from number first_ on
  int first_ = 0;
  int next_ = 0;               // the number of the first that is not counted
  int slices_ = 0;             // so far
  std::vector<float> target_;  // slice
  verdict::PrintPieceCounter pieces_;
};

}  // namespace vam::optimize
