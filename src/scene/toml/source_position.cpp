#include "scene/toml/source_position.h"

#include "core/safe_text.h"

#include <fmt/format.h>

namespace tumble {

void SourcePosition::fail(std::string_view problem) const {
    if (is_option()) throw InputError(fmt::format("{}: {}", safe_text(name), problem));
    throw InputError(where, fmt::format("{} {}", safe_text(name), problem));
}

}  // namespace tumble
