// One parser of meshes, FUZZ_PARSE, as the child calls it.
#include "fuzz/fuzz.hpp"
#include "io/mesh/private/formats.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  try {
    (void)vam::io::FUZZ_PARSE(fuzz::text_of(bytes, size));
  } catch (const vam::io::MeshProblem&) {
    return 0;
  } catch (const std::bad_alloc&) {  // the child has bounds for that
    return 0;
  }
  return 0;
}
