// There is one standard input.
#pragma once

#include <string>
#include <vector>

namespace vam::io {

/// Throws Fault::usage when more than one of a tool's inputs is "-": the second would get nothing.
void refuse_two_stdins(const std::vector<std::string>& inputs);

}  // namespace vam::io
