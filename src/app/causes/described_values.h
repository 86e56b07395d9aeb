// The described values of a scene as text, by their paths, for motion records.
#pragma once

#include "app/causes/motion_record.h"
#include "app/composition/composition.h"
#include "scene/description/description.h"

#include <cstddef>
#include <span>

namespace tumble {

BodyKind kind_of(const SceneDescription& scene, const BodyDescription& body);

/// Of the scene without its bodies: light, simulation, forces, ... Without the camera: a record has its views.
ValueMap values_of(const SceneDescription& scene);

/// Size, samples and text of the whole image.
ValueMap values_of(const Composition& composition);

/// FNV-1a, 64 bits.
std::uint64_t digest(std::span<const std::byte> bytes, std::uint64_t start = 0xcbf29ce484222325u);

}  // namespace tumble
