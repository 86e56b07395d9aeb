#include "render/passes/plane_pass.h"

#include "render/antialiasing/surface_ids.h"
#include "render/gl/glm_conversion.h"
#include "render/passes/body_pass.h"
#include "render/scene/plane_axes.h"

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>

namespace tumble {
namespace {

// Range within which two intersecting planes occlude each other, in parts of the typical AO radius.
constexpr double corner_reach = 2.0;

constexpr int most_other_planes = 6;  // of a box-shaped room, and one more

int other_planes(const RenderScene& looks) {
    const auto planes = std::count_if(looks.bodies.begin(), looks.bodies.end(),
                                      [](const RenderBody& look) { return look.kind == DrawKind::plane; });
    return int(std::clamp<std::ptrdiff_t>(planes - 1, 0, most_other_planes));
}

std::vector<std::string> defines(Pattern pattern, int others) {
    std::vector<std::string> all;
    if (pattern == Pattern::grid) all.emplace_back("GRID");
    if (pattern == Pattern::checker) all.emplace_back("CHECKER");
    if (others > 0) all.push_back(fmt::format("OTHER_PLANES {}", others));
    return all;
}

std::vector<std::string> with(std::vector<std::string> all, const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

}  // namespace

PlanePass::PlanePass(const GlFunctions& gl, const std::filesystem::path& shaders, const RenderScene& looks,
                     bool shadows, const ShadowFilter& filter)
    : gl_(&gl),
      shaders_(shaders),
      shadows_(shadows),
      filter_(filter),
      other_planes_(other_planes(looks)),
      sky_(gl, shaders, {"sky.vert", "sky.frag", {}}),
      array_(gl, GlKind::vertex_array),
      corners_(gl, GlKind::buffer) {
    connect(sky_);
    for (const RenderBody& look : looks.bodies) {
        auto& programs = planes_[std::size_t(look.pattern)];
        if (look.kind != DrawKind::plane || programs) continue;
        programs.emplace(Programs{make(look.pattern, {}), make(look.pattern, touched()), std::nullopt});
    }
    gl.BindVertexArray(array_.name());
    gl.BindBuffer(GL_ARRAY_BUFFER, corners_.name());
    gl.EnableVertexAttribArray(0);
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
    gl.BindVertexArray(0);
}

ShaderProgram PlanePass::make(Pattern pattern, const std::vector<std::string>& more) const {
    ShaderProgram made(*gl_, shaders_, {"plane.vert", "plane.frag", with(defines(pattern, other_planes_), more)});
    connect(made);
    return made;
}

std::vector<std::string> PlanePass::touched() const {
    std::vector<std::string> all = {"TOUCHED"};
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
        if (programs) add(programs->touched, GL_LEQUAL);
    for (const auto& programs : planes_)
        if (programs) add(programs->open, GL_LESS);
    add(sky_, GL_LEQUAL);
    return all;
}

void PlanePass::draw_sky(const std::vector<PlanePatch>& planes, const Camera& view) const {
    const std::vector<glm::vec3> sky = sky_polygon(planes, view);
    sky_.use();
    if (sky.size() >= 3) draw_polygon(sky);
}

void PlanePass::draw_open(const std::vector<PlanePatch>& planes, const RenderScene& looks) const {
    // Pixels at equal depth stay: bodies and dirty regions that were drawn before. Dirty regions are drawn over each
    // other in order, so the last of several intersecting planes comes first here.
    gl_->DepthFunc(GL_LESS);
    for (std::size_t i = planes.size(); i-- > 0;) {
        set_uniforms(planes_[std::size_t(looks.bodies[planes[i].body].pattern)]->open, planes[i], planes, looks);
        draw_polygon(planes[i].corners);
    }
    gl_->DepthFunc(GL_LEQUAL);
}

void PlanePass::draw_touched(const std::vector<PlanePatch>& planes, const std::vector<std::vector<Rectangle>>& areas,
                             const RenderScene& looks, const OcclusionAtlas& atlas, const Snapshot& snapshot,
                             const Camera& view, bool far_shadows) {
    gl_->Disable(GL_CULL_FACE);
    gl_->Enable(GL_SCISSOR_TEST);
    gl_->BindVertexArray(array_.name());
    for (std::size_t i = 0; i < planes.size(); ++i) {
        if (areas[i].empty()) continue;
        const Pattern pattern = looks.bodies[planes[i].body].pattern;
        Programs& programs = *planes_[std::size_t(pattern)];
        if (far_shadows && !programs.touched_far)
            programs.touched_far.emplace(make(pattern, with(touched(), {"FAR_MAP"})));
        const ShaderProgram& program = far_shadows ? *programs.touched_far : programs.touched;
        upload_polygon(planes[i].corners);
        set_uniforms(program, planes[i], planes, looks);
        set_window(program, planes[i], atlas, looks, snapshot, view);
        for (const Rectangle& area : areas[i]) {
            gl_->Scissor(area.x, area.y, area.width, area.height);
            gl_->DrawArrays(GL_TRIANGLE_FAN, 0, GLsizei(planes[i].corners.size()));
        }
    }
    gl_->BindVertexArray(0);
    gl_->Disable(GL_SCISSOR_TEST);
}

void PlanePass::set_uniforms(const ShaderProgram& program, const PlanePatch& plane,
                             const std::vector<PlanePatch>& planes, const RenderScene& looks) const {
    const RenderBody& look = looks.bodies[plane.body];
    program.use();
    program.set("plane_normal", to_glm(plane.normal, plane.height));
    program.set("plane_u", plane.u);
    program.set("plane_v", plane.v);
    program.set("plane_color", glm::vec4(look.color, look.roughness));
    program.set("plane_look", glm::vec4(look.metallic, surface_alpha(plane.body, 0), 0.0f, 0.0f));
    if (other_planes_ == 0) return;
    std::vector<glm::vec4> others;  // planes outside the view are placed far below, where they have no effect
    for (const PlanePatch& other : planes)
        if (other.body != plane.body) others.push_back(to_glm(other.normal, other.height));
    others.resize(std::size_t(other_planes_), glm::vec4(0.0f, 0.0f, 0.0f, 1e30f));
    gl_->Uniform4fv(program.uniform("other_planes"), other_planes_, glm::value_ptr(others.front()));
    gl_->Uniform1f(program.uniform("other_reach"), float(corner_reach * looks.typical_reach));
}

void PlanePass::set_window(const ShaderProgram& program, const PlanePatch& plane, const OcclusionAtlas& atlas,
                           const RenderScene& looks, const Snapshot& snapshot, const Camera& view) const {
    const auto window = std::find_if(atlas.windows.begin(), atlas.windows.end(),
                                     [&](const PlaneOcclusionTile& w) { return w.body == plane.body; });
    if (window == atlas.windows.end()) {  // texel 0, 0 is unoccluded
        for (const char* name : {"window_u", "window_v", "window_rim"}) program.set(name, glm::vec4(0.0f));
        return;
    }
    const BodyState& state = snapshot.bodies[plane.body];
    const PlaneAxes axes = plane_axes(looks.bodies[plane.body].plane.normal);
    const Vec3 u = state.orientation * axes.u / window->cell, v = state.orientation * axes.v / window->cell;
    const Vec3 eye = view.eye() - state.origin;
    program.set("window_u", to_glm(u, u.dot(eye) - window->low_a + window->x));
    program.set("window_v", to_glm(v, v.dot(eye) - window->low_b + window->y));
    program.set("window_rim", glm::vec4(float(window->x), float(window->y), float(window->x + window->width - 1),
                                        float(window->y + window->height - 1)));
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
