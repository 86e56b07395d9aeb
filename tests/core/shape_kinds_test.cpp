// The files of src that distinguish kinds of shapes, besides those of the kinds themselves (folders named "shapes") and
// the collisions of pairs: each is listed with its reason. A new kind of shape has to be considered in these.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <istream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace tumble::shape_kinds_test {
namespace {

namespace fs = std::filesystem;

const fs::path source = fs::path(TUMBLE_SOURCE_DIR) / "src";

/// The reason of each file.
const std::map<std::string, std::string> known = {
    // A new kind does not compile without its lines in these.
    {"scene/description/description.h", "the kinds"},
    {"scene/hash/scene_hash.cpp", "the values of each kind"},
    {"scene/keys/shapes.cpp", "the keys of each kind"},
    {"app/cli/info_command.cpp", "the text of each kind"},
    {"app/causes/described_values.cpp", "the text of each kind; a plain sphere looks the same in every orientation"},
    {"gltf/scene_export.cpp", "the glTF form of each kind"},
    {"page/scene_data.cpp", "the form of each kind in the data of a page"},
    // Planes are endless: they have no bounds, and bodies fall onto them.
    {"render/aov/aov_renderer.cpp", "planes: one normal"},
    {"render/passes/plane_pass.cpp", "planes: drawn by a pass of their own"},
    {"render/scene/large_receivers.h", "planes: bodies fall onto them"},
    {"render/frame/frame_context.h", "planes: mirror the camera"},
    {"render/frame/frame_context.cpp", "planes: mirror the camera"},
    {"render/render_switches.h", "planes: mirror bodies"},
    {"render/renderer.cpp", "planes: mirror bodies"},
    {"render/shadow/shadow_cascades.cpp", "planes: hide bodies behind them"},
    {"render/scene/plane_patch.cpp", "planes: drawn as the part in view"},
    {"render/scene/plane_patch.h", "planes: drawn as the part in view"},
    {"scene/camera/camera_visibility.cpp",
     "planes: bodies fall onto them; parts of compounds; the number of triangles"},
    {"scene/description/looks.cpp", "places of a texture on each kind"},
    {"scene/keys/materials.cpp", "the look without a material; textures of meshes and of parts"},
    {"scene/camera/default_camera.cpp", "planes: bodies fall onto them"},
    {"scene/camera/throw_preview.cpp", "planes: bodies bounce off them; spheres roll"},
    {"sim/detection/broad_phase.cpp", "half-spaces: not in a tree of bounds"},
    {"sim/event_driven/local_frame.cpp", "half-spaces: sorted by their planes"},
    {"sim/event_driven/neighbor_boxes.cpp", "half-spaces: not in a tree of bounds"},
    // Compounds are taken apart; the data of meshes is shared.
    {"app/cli/run_notes.cpp", "meshes: the source of their mass"},
    {"overlay/crack_sketch.cpp", "meshes: the faces of pieces"},
    {"overlay/overlay_painter.cpp", "parts of compounds"},
    {"render/aov/visibility_buffer.cpp", "meshes: holes of their textures"},
    {"render/aov/shape_instance.cpp", "parts of compounds; copies share their mesh"},
    {"render/scene/compound_expansion.cpp", "parts of compounds"},
    {"scene/fracture/convex_parts.cpp", "the convex polyhedra of each kind"},
    {"scene/fracture/cut_body.cpp", "meshes: colors of their files, and the shape of pieces"},
    {"scene/keys/instances.cpp", "makes a compound of one sphere"},
    {"scene/keys/made_shapes.cpp", "makes meshes from numbers"},
    {"scene/mesh/curved_mesh.cpp", "the triangles of curved shapes, for drawing"},
    {"scene/mesh/curved_mesh.h", "the triangles of curved shapes, for drawing"},
    {"scene/mesh/mesh_loader.cpp", "larger copies of meshes and compounds share their data"},
    {"scene/mesh/mesh_loader.h", "larger copies of meshes and compounds share their data"},
    {"sim/contact/model/rotational_friction.cpp", "parts of compounds"},
    {"sim/fields/explosions.cpp", "solid angles in closed form"},
    {"sim/dynamics/forces.cpp", "meshes that enclose their mass: their volume in water"},
    {"sim/water/hull_parts.cpp", "balls and curved parts as triangles"},
    {"sim/fracture/breakable_body.cpp", "cells are polyhedra; pieces of several are compounds"},
    {"sim/dynamics/body_builder.cpp", "a given center of mass: a compound of one part"},
    {"sim/geometry/collide.cpp", "parts of compounds"},
    {"sim/snapshot/measurement.cpp", "parts of compounds"},
    // A ball looks and moves the same in every orientation.
    {"sim/ccd/ccd_clamp.cpp", "balls: rotation moves no point of the surface"},
    {"sim/contact/contact_solver.cpp", "balls: rotation moves no corner"},
    {"sim/contact/model/free_motion.cpp", "balls: the other body of the pair has the edge"},
    {"sim/contact/model/predicted_gap.cpp", "cylinders and cones: the ball of a rim is not fixed in the body"},
    {"sim/event_driven/event_driven_motion.cpp", "balls and half-spaces: impacts in closed form"},
    {"sim/contact/rolling/rolling_contact.cpp", "curved bodies on half-spaces and faces"},
    {"sim/contact/rolling/rolling_path.cpp", "curved bodies: their support points and its derivatives"},
    // Times of impact of pairs of kinds.
    {"sim/ccd/time_of_impact.cpp", "closed forms for balls, axes of polyhedra, parts, triangles"},
    {"sim/step/hit_stage.cpp", "pairs whose hits have their own times"},
    // Ways of drawing, DrawKind: a new kind of shape is drawn as a mesh where it gets no way of its own.
    {"render/ambient_occlusion/atlas_layout.cpp", "ways of drawing: texels"},
    {"render/ambient_occlusion/lightmap_selection.cpp", "ways of drawing: texels"},
    {"render/ambient_occlusion/occluders.cpp", "ways of drawing: occluders"},
    {"render/ambient_occlusion/occlusion_atlas.cpp", "ways of drawing: texels"},
    {"render/ambient_occlusion/overhang_heights.cpp", "ways of drawing: heights above planes"},
    {"render/antialiasing/screen_edges.cpp", "ways of drawing: silhouettes"},
    {"render/culling/occlusion_culling.cpp", "ways of drawing: faces of boxes"},
    {"render/damage/damage_tracker.cpp", "ways of drawing: faces of boxes"},
    {"render/passes/body_pass.cpp", "ways of drawing: shaders"},
    {"render/passes/draw_list.cpp", "ways of drawing: meshes and levels of detail"},
    {"render/scene/large_receivers.cpp", "ways of drawing: meshes may be hollow; planes"},
    {"render/scene/render_scene.cpp", "ways of drawing: triangles of meshes; planes"},
    {"render/shadow/caster_culling.cpp", "ways of drawing: faces of boxes"},
};

bool distinguishes_kinds(std::istream& text) {
    static const std::regex kind(
        "\\b(Plane|Box|Sphere|Mesh|Compound|Curved)Shape\\b|\\bDrawKind::(plane|box|ball|mesh)\\b|"
        "\\b(get_if|get|holds_alternative)<(HalfSpace|Ball|\\w+Ref|std::shared_ptr<const "
        "(Polyhedron|CollisionMesh|Compound|CurvedBody)>)>"),
        comment("//.*"), quoted("\"[^\"]*\"");
    for (std::string line; std::getline(text, line);)
        // Regular expressions are slow: most lines hold no such word.
        if ((line.find("Shape") != line.npos || line.find("DrawKind") != line.npos || line.find('<') != line.npos) &&
            std::regex_search(line, kind) &&
            std::regex_search(std::regex_replace(std::regex_replace(line, quoted, ""), comment, ""), kind))
            return true;
    return false;
}

TEST(ShapeKinds, AreDistinguishedInTheListedFilesOnly) {
    std::set<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(source)) {
        const fs::path& file = entry.path();
        if ((file.extension() != ".h" && file.extension() != ".cpp") || file.parent_path().filename() == "shapes")
            continue;
        std::ifstream text(file);
        if (distinguishes_kinds(text)) found.insert(file.lexically_relative(source).string());
    }
    for (const std::string& file : found)
        EXPECT_EQ(known.count(file), 1u)
            << "src/" << file
            << " distinguishes kinds of shapes: use the interface of src/sim/geometry/shapes "
               "or src/render/shapes, or list it with its reason";
    for (const auto& [file, reason] : known)
        EXPECT_EQ(found.count(file), 1u) << "src/" << file << " distinguishes no kinds: remove it from the list";
}

TEST(ShapeKinds, ASwitchIsFound) {
    const auto found = [](const char* line) {
        std::istringstream text(line);
        return distinguishes_kinds(text);
    };
    EXPECT_TRUE(found("if (std::holds_alternative<Ball>(body.collider)) return;"));
    EXPECT_TRUE(found("double size_of(const BoxShape& box);"));
    EXPECT_TRUE(found("    case DrawKind::ball:"));
    EXPECT_TRUE(found("const auto* hull = std::get_if<std::shared_ptr<const Polyhedron>>(&collider);"));
    EXPECT_FALSE(found("return std::visit([](const auto& one) { return reach(one); }, shape);  // a BoxShape"));
    EXPECT_FALSE(found("fail(\"no BoxShape\");"));
}

}  // namespace
}  // namespace tumble::shape_kinds_test
