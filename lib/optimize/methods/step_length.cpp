#include "optimize/methods/private/step_length.hpp"

#include <algorithm>
#include <cmath>

namespace vam::optimize {

namespace {
constexpr int iterations = 6;  // within 5 % by then
constexpr double spare = 1.05;
}  // namespace

// A* P A on the object side has the same eigenvalues. The start has something of every frequency: a few points.
double largest_eigenvalue(const light::Operator& light, const Problem& problem) {
  const light::Shape shape = light.object();
  Slab object(shape.width, shape.height);
  Slab sinogram(light.sinogram().width, light.sinogram().height);
  for (int y = 0; y < shape.height; ++y) {
    for (int x = 0; x < shape.width; ++x) {
      const bool point = (x * 7 + y * 13) % 31 == 0;
      *object.at(x, y) = point ? 1.0F : 0.1F;
    }
  }
  const auto& labels = problem.labels[0];
  const auto keep_inside = [&] {
    for (std::size_t i = 0; i < labels.size(); i += lanes) {
      if (labels[i] == Label::outside) std::fill_n(object.values.data() + i, lanes, 0.0F);
    }
  };
  keep_inside();
  double value = 1;
  for (int i = 0; i < iterations; ++i) {
    double norm = 0;
    for (const float v : object.values) norm += static_cast<double>(v) * static_cast<double>(v);
    const auto unit = static_cast<float>(1.0 / std::sqrt(norm));
    for (float& v : object.values) v *= unit;
    light.forward({&object, 1}, {&sinogram, 1});
    light.precondition({&sinogram, 1});
    light.adjoint({&sinogram, 1}, {&object, 1});
    keep_inside();
    value = 0;
    for (const float v : object.values) value += static_cast<double>(v) * static_cast<double>(v);
    value = std::sqrt(value);
  }
  return value * spare;
}

}  // namespace vam::optimize
