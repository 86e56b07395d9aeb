#include "render/passes/plane_pass.h"

#include "render/antialiasing/surface_ids.h"
#include "render/environment/environment_textures.h"
#include "render/gl/glm_conversion.h"
#include "render/passes/body_pass.h"
#include "render/passes/scene_defines.h"
#include "render/scene/plane_patch.h"

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>

namespace tumble {
namespace {

// Range within which two intersecting planes occlude each other, in parts of the typical AO radius.
constexpr double corner_ao_radius = 2.0;

constexpr int most_other_planes = 6;  // of a box-shaped room, and one more
constexpr int most_with_lamps = 3;    // whose values take as many outputs of the vertex shader

int other_planes(const RenderScene& scene) {
    const auto planes = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                      [](const RenderBody& proxy) { return proxy.kind == DrawKind::plane; });
    return int(std::clamp<std::ptrdiff_t>(planes - 1, 0, scene.lamps.empty() ? most_other_planes : most_with_lamps));
}

std::vector<std::string> defines(Pattern pattern, const SurfaceLook& look, int others,
                                 const std::vector<std::string>& more) {
    std::vector<std::string> all = look_defines(look);
    if (pattern == Pattern::grid) all.emplace_back("GRID");
    if (pattern == Pattern::checker) all.emplace_back("CHECKER");
    for (const std::string& define : more) all.push_back(define);
    if (others > 0) all.push_back(fmt::format("OTHER_PLANES {}", others));
    return all;
}

std::vector<std::string> with(std::vector<std::string> all, const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

}  // namespace

PlanePass::PlanePass(GlDevice& device, const std::filesystem::path& shaders, const RenderScene& scene,
                     const ShadowFilter& filter)
    : device_(&device),
      gl_(&device.gl()),
      shaders_(shaders),
      shadows_(scene.light.shadows),
      filter_(filter),
      other_planes_(other_planes(scene)),
      sky_(device.program(shaders, {"sky.vert", "sky.frag", scene_defines(scene)})),
      planes_(4 * (3 + scene.looks.size())),
      looks_(scene.looks),
      scene_defines_(scene_defines(scene)),
      textures_(*gl_),
      array_(*gl_, GlKind::vertex_array),
      corners_(*gl_, GlKind::buffer) {
    connect(sky_);
    for (const RenderBody& proxy : scene.bodies) {
        auto& programs = planes_[index_of(proxy)];
        if (proxy.kind != DrawKind::plane || programs) continue;
        programs.emplace(Programs{make(proxy, {}), make(proxy, occluded(proxy)), nullptr});
    }
    gl_->BindVertexArray(array_.name());
    gl_->BindBuffer(GL_ARRAY_BUFFER, corners_.name());
    gl_->EnableVertexAttribArray(0);
    gl_->VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
    gl_->BindVertexArray(0);
}

/// Those without a look of the scene come first, by their pattern.
std::size_t PlanePass::index_of(const RenderBody& proxy) {
    return 4 * (proxy.look == 0 ? std::size_t(proxy.pattern) : 2 + proxy.look) + (proxy.glows() ? 2 : 0) +
           (proxy.reflection > 0.0f ? 1 : 0);
}

const ShaderProgram* PlanePass::make(const RenderBody& proxy, const std::vector<std::string>& more) const {
    const std::vector<std::string> own =
        feature_defines(looks_[proxy.look].image.maps.bits() | (proxy.glows() ? surface_feature::glowing : 0u));
    const ShaderProgram& made = device_->program(
        shaders_, {"plane.vert", "plane.frag",
                   with(with(defines(proxy.pattern, looks_[proxy.look], other_planes_, own), scene_defines_), more)});
    connect(made);
    return &made;
}

std::vector<std::string> PlanePass::occluded(const RenderBody& proxy) const {
    std::vector<std::string> all = {"OCCLUDED"};
    if (proxy.reflection > 0.0f) all.emplace_back("REFLECTIVE");
    return shadows_ ? with(with(all, {"SHADOWED"}), shadow_defines(filter_)) : all;
}

std::vector<std::function<void()>> PlanePass::compilations() const {
    std::vector<std::function<void()>> all;
    const auto add = [&](const ShaderProgram& program,
                         GLenum nearer) {  // llvmpipe compiles the shader for each such comparison
        all.emplace_back([this, &program, nearer] {
            program.use();
            gl_->DepthFunc(nearer);
            draw_polygon(std::vector<glm::vec3>(3));
            gl_->DepthFunc(GL_LEQUAL);
        });
    };
    for (const auto& programs : planes_)
        if (programs) add(*programs->occluded, GL_LEQUAL);
    for (const auto& programs : planes_)
        if (programs) add(*programs->background, GL_LESS);
    add(sky_, GL_LEQUAL);
    return all;
}

void PlanePass::draw_sky(const FrameContext& frame) const {
    const std::vector<glm::vec3> sky = sky_polygon(frame.planes, frame.camera);
    sky_.use();
    if (sky.size() >= 3) draw_polygon(sky);
}

void PlanePass::draw_background(const FrameContext& frame) const {
    // Pixels at equal depth stay: bodies and regions that were drawn before. Regions are drawn over each other in
    // order, so the last of several intersecting planes comes first here.
    gl_->DepthFunc(GL_LESS);
    for (std::size_t i = frame.planes.size(); i-- > 0;) {
        const PlanePatch& plane = frame.planes[i];
        set_uniforms(*planes_[index_of(frame.scene.bodies[plane.body])]->background, plane, frame);
        draw_polygon(plane.corners);
    }
    gl_->DepthFunc(GL_LEQUAL);
}

void PlanePass::draw_regions(const FrameContext& frame, const std::vector<std::vector<Rectangle>>& regions,
                             const OcclusionAtlas& atlas) {
    gl_->Disable(GL_CULL_FACE);
    gl_->Enable(GL_SCISSOR_TEST);
    gl_->BindVertexArray(array_.name());
    const bool far_shadows = frame.cascades.has_far;
    for (std::size_t i = 0; i < frame.planes.size(); ++i) {
        if (regions[i].empty()) continue;
        const PlanePatch& plane = frame.planes[i];
        const RenderBody& proxy = frame.scene.bodies[plane.body];
        Programs& programs = *planes_[index_of(proxy)];
        if (far_shadows && programs.occluded_far == nullptr)
            programs.occluded_far = make(proxy, with(occluded(proxy), {"FAR_MAP"}));
        const ShaderProgram& program = far_shadows ? *programs.occluded_far : *programs.occluded;
        upload_polygon(plane.corners);
        set_uniforms(program, plane, frame);
        set_tile(program, plane, atlas, frame);
        for (const Rectangle& region : regions[i]) {
            gl_->Scissor(region.x, region.y, region.width, region.height);
            gl_->DrawArrays(GL_TRIANGLE_FAN, 0, GLsizei(plane.corners.size()));
        }
    }
    gl_->BindVertexArray(0);
    gl_->Disable(GL_SCISSOR_TEST);
}

void PlanePass::set_uniforms(const ShaderProgram& program, const PlanePatch& plane, const FrameContext& frame) const {
    const RenderBody& proxy = frame.scene.bodies[plane.body];
    program.use();
    program.set("plane_normal", to_glm(plane.normal, plane.height));
    program.set("plane_u", plane.u);
    program.set("plane_v", plane.v);
    program.set("plane_color", glm::vec4(proxy.color, proxy.roughness));
    program.set("plane_material", glm::vec4(proxy.metallic, surface_alpha(plane.body, 0), proxy.reflection,
                                            float(frame.camera.width() - 1)));
    if (proxy.look != 0) {
        program.set("plane_paint", proxy.paint);
        if (const SurfaceLook& look = looks_[proxy.look]; look.has_image())
            textures_.names_of(look.image, look.image.maps.bits()).bind(*gl_);
    }
    if (proxy.glows()) program.set("plane_glow", proxy.glow);
    if (other_planes_ == 0) return;
    std::vector<glm::vec4> others;  // planes outside the view are placed far below, where they have no effect
    for (const PlanePatch& other : frame.planes)
        if (other.body != plane.body) others.push_back(to_glm(other.normal, other.height));
    others.resize(std::size_t(other_planes_), glm::vec4(0.0f, 0.0f, 0.0f, 1e30f));
    gl_->Uniform4fv(program.uniform("other_planes"), other_planes_, glm::value_ptr(others.front()));
    gl_->Uniform1f(program.uniform("other_ao_radius"), float(corner_ao_radius * frame.scene.typical_ao_radius));
}

void PlanePass::set_tile(const ShaderProgram& program, const PlanePatch& plane, const OcclusionAtlas& atlas,
                         const FrameContext& frame) const {
    const auto tile = std::find_if(atlas.plane_tiles.begin(), atlas.plane_tiles.end(),
                                   [&](const PlaneOcclusionTile& w) { return w.body == plane.body; });
    if (tile == atlas.plane_tiles.end()) {  // texel 0, 0 is unoccluded
        for (const char* name : {"tile_u", "tile_v", "tile_rim"}) program.set(name, glm::vec4(0.0f));
        return;
    }
    const BodyState& state = frame.snapshot.bodies[plane.body];
    const PlaneAxes axes = plane_axes(frame.scene.bodies[plane.body].plane.normal);
    const Vec3 u = state.orientation * axes.u / tile->cell, v = state.orientation * axes.v / tile->cell;
    const Vec3 eye = frame.camera.eye() - state.origin;
    program.set("tile_u", to_glm(u, u.dot(eye) - tile->low_a + tile->x));
    program.set("tile_v", to_glm(v, v.dot(eye) - tile->low_b + tile->y));
    program.set("tile_rim", glm::vec4(float(tile->x), float(tile->y), float(tile->x + tile->width - 1),
                                      float(tile->y + tile->height - 1)));
}

void PlanePass::draw_polygon(const std::vector<glm::vec3>& corners) const {
    gl_->Disable(GL_CULL_FACE);
    gl_->BindVertexArray(array_.name());
    upload_polygon(corners);
    gl_->DrawArrays(GL_TRIANGLE_FAN, 0, GLsizei(corners.size()));
    gl_->BindVertexArray(0);
}

void PlanePass::upload_polygon(const std::vector<glm::vec3>& corners) const {
    gl_->BindBuffer(GL_ARRAY_BUFFER, corners_.name());
    gl_->BufferData(GL_ARRAY_BUFFER, GLsizeiptr(corners.size() * sizeof(glm::vec3)), corners.data(), GL_STREAM_DRAW);
}

}  // namespace tumble
