// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/negative_values.hpp"

#include "testing.hpp"

using namespace vam;
using namespace vam::tomo;

TEST_CASE("negative intensities are offset, then clipped") {
  Slab slab(3, 1);
  for (int i = 0; i < 3 * lanes; ++i) slab.at(0, 0)[i] = static_cast<float>(i % 3) - 1;  // -1, 0, 1
  CHECK(lowest(slab) == -1);
  raise_and_clip(slab, 0.5F, 0);
  for (int i = 0; i < 3 * lanes; ++i) CHECK(slab.at(0, 0)[i] == (i % 3 == 0 ? 0.0F : static_cast<float>(i % 3) - 0.5F));
}
