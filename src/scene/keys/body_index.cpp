#include "scene/keys/body_index.h"

#include "core/safe_text.h"

#include <fmt/format.h>

namespace tumble {

BodyIndex::BodyIndex(const std::vector<BodyDescription>& bodies) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const bool is_own_index = bodies[i].name == std::to_string(i);
        if (!is_own_index)
            index_[bodies[i].name] = i;
        else
            index_.try_emplace(bodies[i].name, i);
    }
}

std::size_t BodyIndex::find(const TomlValue& value, const std::string& name) const {
    if (const auto found = index_.find(name); found != index_.end()) return found->second;
    if (index_.count(name + ".0")) {
        value.origin().fail(
            fmt::format("\"{0}\" is many bodies: name one of its copies, \"{0}.0\" for the first", safe_text(name)));
    }
    if (const auto slash = name.rfind('/'); slash != std::string::npos && index_.count(name.substr(0, slash)))
        value.origin().fail(fmt::format("\"{}\" is a piece, which exists after a break: name the body \"{}\"",
                                        safe_text(name), safe_text(name.substr(0, slash))));
    std::vector<std::string_view> known;
    for (const auto& [other, i] : index_) known.push_back(other);
    value.origin().fail(fmt::format("\"{}\" is not the name of a body{}", safe_text(name), suggestion(name, known)));
}

}  // namespace tumble
