// An image file, as the child decodes it.
#include "fuzz/fuzz.hpp"
#include "io/image/private/decoders.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string file = fuzz::text_of(bytes, size);
  try {
    return fuzz::attempt([&] { (void)vam::io::FUZZ_DECODE(file, "image"); });
  } catch (const std::bad_alloc&) {  // the child has bounds for that
    return 0;
  }
}
