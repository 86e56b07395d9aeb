// Bodies by name, for what else in the file names one: forces, cords, the camera.
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
    /// A body without a name has its index for one; a given name of that text comes first.
    explicit BodyIndex(const std::vector<BodyDescription>& bodies);

    /// The body that the value names; fails at its place, with the nearest name, where there is none.
    std::size_t find(const TomlValue& value) const;

private:
    std::map<std::string, std::size_t> index_;
};

}  // namespace tumble
