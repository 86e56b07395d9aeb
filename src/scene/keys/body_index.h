// Bodies by name, for references in forces, cords and the camera.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace tumble {

class BodyIndex {
public:
    /// The name of a body without one is its index; given names take precedence.
    explicit BodyIndex(const std::vector<BodyDescription>& bodies);

    /// The body that the value names. Without one, fails at the value's position and suggests the nearest name.
    std::size_t find(const TomlValue& value) const { return find(value, value.text()); }
    /// The same for a name that is a part of the value.
    std::size_t find(const TomlValue& value, const std::string& name) const;

    bool has(const std::string& name) const { return index_.count(name) != 0; }

private:
    std::map<std::string, std::size_t> index_;
};

}  // namespace tumble
