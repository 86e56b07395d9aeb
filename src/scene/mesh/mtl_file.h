// Materials of Wavefront OBJ files.
#pragma once

#include "scene/description/mesh_paint.h"
#include "scene/mesh/mesh_images.h"

#include <map>
#include <string>
#include <string_view>

namespace tumble {

/// Adds the materials of the text, by name: Kd, Ke, map_Kd, map_Ke, Pr, Pm, d, Tr, map_Bump and norm. Colors of the
/// text are sRGB. Other keywords are skipped. Throws MeshError.
void read_mtl(std::string_view text, MeshImages& images, std::map<std::string, MeshMaterial, std::less<>>& materials);

/// A color channel of sRGB, 0 to 1, in linear light.
float linear_channel(float srgb);

}  // namespace tumble
