// A SceneSpec as the text of a scene file: one value on a line, so that the line of an error names the element.
#pragma once

#include "api/spec_lines.h"
#include "tumble/spec.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace tumble::v0 {

/// The text, in which a mesh in memory is { type = "mesh", memory = INDEX, ... } (see scene/load.h).
struct SpecText {
    std::string text;
    std::vector<std::shared_ptr<const TriangleMesh::Arrays>> meshes;  // by their index, each once
    std::string first_mesh;                                           // element of the first one
};

/// Throws InputError for a value of an enum that has no name.
SpecText spec_text(const SceneSpec& spec);

/// The element that the line describes ("bodies[2].shape.radius"); lines count from 1. Empty for other lines.
std::string element_of_line(const SceneSpec& spec, int line);

}  // namespace tumble::v0

namespace tumble::v0 {

// The text of a joint of a SceneSpec.

void write_joint(const Joint& joint, std::size_t index, SpecLines& lines);

}  // namespace tumble::v0
