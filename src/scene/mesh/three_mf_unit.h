// The unit of a 3MF file, which assimp does not read.
#pragma once

#include <string_view>

namespace tumble {

/// m per unit: the attribute `unit` of the model in the archive `bytes`; a millimeter, as the format says, if it has
/// none or cannot be found.
double three_mf_unit(std::string_view bytes);

}  // namespace tumble
