#include "render/passes/water_pass.h"

#include "core/color.h"
#include "core/deterministic_math.h"
#include "render/gl/glm_conversion.h"
#include "render/passes/body_pass.h"
#include "render/passes/scene_defines.h"

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tumble {
namespace {

// Pixels between nodes of the grid. Each triangle costs a microsecond before its first pixel.
constexpr int wave_pixels = 16, still_pixels = 128;
constexpr double grid_margin = 0.1;  // of the picture around it: waves move nodes of its border inward

/// Distance of the last row, in heights of the eye above the water: the horizon, a twentieth of a pixel high.
constexpr double horizon = 2e4;

/// Texture units of the copies, beside those of other passes.
constexpr GLuint seen_color_unit = 12, seen_depth_unit = 13;

std::vector<std::string> defines(const RenderScene& scene) {
    std::vector<std::string> all = scene_defines(scene);
    const bool floor_mirrors = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                           [](const RenderBody& body) { return body.reflection > 0.0f; });
    if (!floor_mirrors) all.emplace_back("REFLECTIVE");  // one mirror has an image
    const auto& waves = scene.surface.waves();
    if (waves.empty()) return all;
    std::string list;
    for (const WaterSurface::Wave& wave : waves)
        list += fmt::format("{}vec3({:.9e}, {:.9e}, {:.9e})", list.empty() ? "" : ", ", wave.k.x(), wave.k.z(),
                            wave.amplitude);
    all.push_back(fmt::format("WAVES {}", waves.size()));
    all.push_back("WAVE_LIST " + list);
    return all;
}

// The share of a wave that nodes of this distance (m) show.
double shown_share(double k, double spacing) {
    const double phase = 0.5 * k * spacing;
    return exponential(-phase * phase);
}

}  // namespace

WaterPass::WaterPass(GlDevice& device, const std::filesystem::path& shaders, const RenderScene& scene)
    : device_(&device),
      shaders_(shaders),
      defines_(defines(scene)),
      array_(device.gl(), GlKind::vertex_array),
      corners_(device.gl(), GlKind::buffer),
      order_(device.gl(), GlKind::buffer) {
    const GlFunctions& gl = device.gl();
    gl.BindVertexArray(array_.name());
    gl.BindBuffer(GL_ARRAY_BUFFER, corners_.name());
    gl.EnableVertexAttribArray(0);
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, order_.name());
    gl.BindVertexArray(0);
}

// Nodes where the rays of the screen meet the still surface, raised by the waves. False: no ray meets it.
bool WaterPass::make_grid(const FrameContext& frame) {
    const Camera& camera = frame.camera;
    const WaterSurface& water = frame.scene.surface;
    const double height = camera.eye().y() - water.level(), farthest = horizon * height;
    const int grid_pixels = water.still() ? still_pixels : wave_pixels;
    const int across = int(grid_margin * camera.width()) / grid_pixels + 1,
              along = int(grid_margin * camera.height()) / grid_pixels + 1;
    const int columns = (camera.width() + grid_pixels - 1) / grid_pixels + 2 * across + 1;
    const int rows = (camera.height() + grid_pixels - 1) / grid_pixels + 2 * along + 1;
    grid_.clear();
    bool any = false;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double x = double((column - across) * grid_pixels), y = double((row - along) * grid_pixels);
            const Vec3 ray = camera.ray(x, y);
            const Vec3 flat(ray.x(), 0.0, ray.z());
            const double way = flat.norm();
            Vec3 at(0.0, -height, 0.0);
            if (-ray.y() * farthest > height * way) {  // nearer than the horizon
                any = true;
                const double far = height / -ray.y();
                at = far * ray;
                const double spacing = grid_pixels * camera.pixel_size() * far * (1.0 + way / -ray.y());
                const Vec3 place = camera.eye() + at;
                for (const WaterSurface::Wave& wave : water.waves()) {
                    const double share = shown_share(wave.decay, spacing);
                    if (share < 1e-4) continue;
                    at.y() += share * wave.amplitude *
                              sincos(wave.k.x() * place.x() + wave.k.z() * place.z() - wave.rate * frame.snapshot.time +
                                     wave.phase)
                                  .cos;
                }
            } else if (way > 0.0) {
                at += farthest / way * flat;
            }
            grid_.push_back(to_glm(at));
        }
    if (!any || (columns == columns_ && rows == rows_)) return any;
    columns_ = columns;
    rows_ = rows;
    std::vector<std::uint32_t> order;
    for (std::uint32_t row = 0; row + 1 < std::uint32_t(rows); ++row)
        for (std::uint32_t column = 0; column + 1 < std::uint32_t(columns); ++column) {
            const std::uint32_t a = row * std::uint32_t(columns) + column, b = a + std::uint32_t(columns);
            order.insert(order.end(), {a, b, a + 1, a + 1, b, b + 1});
        }
    const GlFunctions& gl = device_->gl();
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, order_.name());
    gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(order.size() * sizeof(std::uint32_t)), order.data(),
                  GL_STATIC_DRAW);
    return any;
}

void WaterPass::draw(const FrameContext& frame, Framebuffer& framebuffer) {
    const GlFunctions& gl = device_->gl();
    const WaterSurface& water = frame.scene.surface;
    const Vec3& eye = frame.camera.eye();
    const double surface = water.height(eye.x(), eye.z(), frame.snapshot.time);
    const bool below = eye.y() <= surface;
    gl.BindVertexArray(array_.name());
    if (below) {
        grid_ = {{-1.0f, -1.0f, 0.5f}, {1.0f, -1.0f, 0.5f}, {1.0f, 1.0f, 0.5f}, {-1.0f, 1.0f, 0.5f}};
    } else if (!make_grid(frame)) {
        gl.BindVertexArray(0);
        return;
    }
    framebuffer.begin_over();
    std::vector<std::string> variant = defines_;
    if (below) variant.emplace_back("EYE_BELOW");
    const ShaderProgram& program = device_->program(shaders_, {"water.vert", "water.frag", variant});
    connect(program);
    program.set_sampler("seen_color", GLint(seen_color_unit));
    program.set_sampler("seen_depth", GLint(seen_depth_unit));
    const std::array<double, 3> color = to_linear(frame.scene.water->color);
    program.set("water_color",
                glm::vec4(float(color[0]), float(color[1]), float(color[2]), float(frame.near_distance)));
    program.set("water_place", glm::vec4(float(eye.y() - (below ? surface : water.level())),
                                         float(frame.camera.width()), float(frame.camera.height()), 0.0f));
    std::array<float, 16> phases{};
    for (std::size_t i = 0; i < water.waves().size(); ++i) {
        const WaterSurface::Wave& wave = water.waves()[i];
        const double turns = (wave.k.dot(eye) - wave.rate * frame.snapshot.time + wave.phase) / (2.0 * pi);
        phases[i] = float(2.0 * pi * (turns - std::floor(turns)));
    }
    gl.Uniform4fv(program.uniform("wave_phases"), 4, phases.data());
    gl.ActiveTexture(GL_TEXTURE0 + seen_color_unit);
    gl.BindTexture(GL_TEXTURE_2D, framebuffer.seen_color());
    gl.ActiveTexture(GL_TEXTURE0 + seen_depth_unit);
    gl.BindTexture(GL_TEXTURE_2D, framebuffer.seen_depth());
    gl.ActiveTexture(GL_TEXTURE0);
    gl.Disable(GL_CULL_FACE);
    gl.BindBuffer(GL_ARRAY_BUFFER, corners_.name());
    gl.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(grid_.size() * sizeof(glm::vec3)), grid_.data(), GL_STREAM_DRAW);
    if (below)
        gl.DrawArrays(GL_TRIANGLE_FAN, 0, 4);
    else
        gl.DrawElementsInstancedBaseInstance(GL_TRIANGLES, 6 * (columns_ - 1) * (rows_ - 1), GL_UNSIGNED_INT, nullptr,
                                             1, 0);
    gl.BindVertexArray(0);
}

}  // namespace tumble
