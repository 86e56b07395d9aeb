// Settings of a renderer that are no part of its interface: for tests, measurements and the render processes.
#pragma once

#include "render/renderer.h"

#include <array>
#include <cstdint>
#include <optional>

namespace tumble {

class GlDevice;
class ShaderCompileSchedule;
struct PassTimes;

struct RenderSwitches : RenderOptions {
    bool full_redraw = false;             // redraw every frame completely, with the same bytes
    bool draw_hidden = false;             // draw bodies behind boxes as well, with the same bytes
    bool keep_depths = false;             // Renderer::depths()
    bool multisample = false;             // several samples per pixel, as in scenes with cords
    double shift_x = 0.0, shift_y = 0.0;  // displacement of the frame, below 1 pixel: for averages of many frames
    std::optional<std::array<std::uint8_t, 3>> plain_background = {};  // sRGB, instead of the sky and the planes
    std::optional<PlaneShape> mirror = {};  // world frame: the camera is below it as far as it is above
    std::optional<double> cut = {};         // m, y, below which bodies are not drawn
    PassTimes* times = nullptr;             // sums of the costs of passes; must outlive the renderer
    GlDevice* device =
        nullptr;  // of another owner, with its compiled shaders; must outlive the renderer. Null: an own one
    ShaderCompileSchedule* compile_schedule = nullptr;  // shared with the other processes that draw this scene, or null
};

}  // namespace tumble
