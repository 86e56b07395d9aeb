#include "plot/pango_cairo.h"

#include <array>

namespace tumble {
namespace {

constexpr std::array library_names = {"libpangocairo-1.0.so.0", "libpangocairo-1.0.so"};  // Cairo comes with it

}  // namespace

PangoCairo::PangoCairo() : library_(library_names, "the library of plots and text", "libpangocairo-1.0-0") {}

const PangoCairo& pango_cairo() {
    static const PangoCairo opened;
    return opened;
}

}  // namespace tumble
