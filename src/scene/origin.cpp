#include "scene/origin.h"

#include <fmt/format.h>

namespace tumble {

void Origin::fail(std::string_view problem) const {
    if (is_option()) throw InputError(fmt::format("{}: {}", name, problem));
    throw InputError(where, fmt::format("{} {}", name, problem));
}

}  // namespace tumble
