// Draws the surface of the water over the finished picture.
#pragma once

#include "render/frame/frame_context.h"
#include "render/gl/framebuffer.h"
#include "render/gl/gl_device.h"
#include "render/gl/gl_object.h"

#include <glm/vec3.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

class WaterPass {
public:
    /// Precondition: the scene has water.
    WaterPass(GlDevice& device, const std::filesystem::path& shaders, const RenderScene& scene);

    /// Reads the color and the depth of the whole frame and changes its color. Ids in alpha stay those of the surfaces
    /// below: their edges are seen through the water.
    void draw(const FrameContext& frame, Framebuffer& framebuffer);

private:
    bool make_grid(const FrameContext& frame);

    GlDevice* device_;
    std::filesystem::path shaders_;
    std::vector<std::string> defines_;
    GlObject array_, corners_, order_;
    std::vector<glm::vec3> grid_;  // m, from the eye, row by row
    int columns_ = 0, rows_ = 0;   // of the grid that order_ is for
};

}  // namespace tumble
