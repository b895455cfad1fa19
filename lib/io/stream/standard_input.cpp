#include "io/stream/standard_input.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace vam::io {

void refuse_two_stdins(const std::vector<std::string>& inputs) {
  const auto count = std::count(inputs.begin(), inputs.end(), "-");
  if (count < 2) return;
  throw Error{Fault::usage,
              std::to_string(count) + " inputs are standard input, which can be read once; name files for the others"};
}

}  // namespace vam::io
