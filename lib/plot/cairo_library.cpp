#include "plot/private/cairo_library.hpp"

#include "base/shared_library.hpp"

namespace vam::plot {

namespace {

CairoApi load() {
  const SharedLibrary library("figure", "libpangocairo-1.0.so.0", "libpangocairo-1.0-0");
  CairoApi found{};
#define VAM_FIND(name) library.find(found.name, #name);
  VAM_CAIRO_FUNCTIONS(VAM_FIND)
#undef VAM_FIND
  return found;
}

}  // namespace

const CairoApi& cairo_api() {
  static const CairoApi loaded = load();
  return loaded;
}

}  // namespace vam::plot
