#include "light/operators/make_operator.hpp"

#include <doctest/doctest.h>

#include "base/error.hpp"
#include "fault_of.hpp"
#include "lib/light/vials.hpp"
#include "lib/optimize/parts.hpp"
#include "light/operators/private/attenuated_operator.hpp"
#include "light/operators/private/parallel_operator.hpp"
#include "light/operators/private/shadowed_operator.hpp"
#include "light/operators/private/vial_operator.hpp"

using namespace vam;
using namespace vam::light;

namespace {

template <class Expected>
bool is(const std::unique_ptr<Operator>& light) {
  return dynamic_cast<const Expected*>(light.get()) != nullptr;
}

}  // namespace

TEST_CASE("the operator is that of the light: clear, absorbing, around an insert, through the vial") {
  const ParallelBeam clear{parts::turn(32, 20)};
  const ParallelBeam absorbing{parts::turn(32, 20), 0.01, 16};
  const Slab insert(32, 32);
  CHECK(is<ParallelOperator>(make_operator(clear)));
  CHECK(is<AttenuatedOperator>(make_operator(absorbing)));
  CHECK(is<ShadowedOperator>(make_operator(clear, {&insert, 1})));
  CHECK(is<ShadowedOperator>(make_operator(absorbing, {&insert, 1})));
  CHECK(is<VialOperator>(make_operator(parts::vial_setup(32, 20))));
  CHECK(is<VialOperator>(make_operator(parts::vial_setup(32, 20), {&insert, 1})));
}

TEST_CASE("the disc correction does not apply around an insert, unless nothing is absorbed") {
  const Slab insert(32, 32);
  const ParallelBeam disc{parts::turn(32, 20), 0.01, 16, Correction::disc};
  CHECK(fault_of([&] { (void)make_operator(disc, {&insert, 1}); }) == Fault::usage);
  const ParallelBeam clear{parts::turn(32, 20), 0, 16, Correction::disc};
  CHECK(is<ShadowedOperator>(make_operator(clear, {&insert, 1})));
}
