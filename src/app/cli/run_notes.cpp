#include "app/cli/run_notes.h"

#include "app/cli/say.h"
#include "core/safe_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <set>
#include <variant>

namespace tumble {
namespace {

constexpr double named_share = 0.01;  // of the smaller body's thickness: more than hand-written numbers round
constexpr std::size_t most_overlaps = 6, most_broken = 12;  // lines; the others are counted

/// The meshes of a shape and of its parts.
void add_meshes(const Shape& shape, std::vector<MeshShape>& meshes) {
    if (const auto* mesh = std::get_if<MeshShape>(&shape)) meshes.push_back(*mesh);
    if (const auto* compound = std::get_if<CompoundShape>(&shape))
        for (const CompoundPart& part : *compound->parts) add_meshes(part.shape, meshes);
}

std::string mesh_notes(const SceneDescription& scene) {
    std::vector<MeshShape> meshes;
    for (const BodyDescription& body : scene.bodies) add_meshes(body.shape, meshes);
    std::string lines;
    std::set<std::string> said;
    for (const MeshShape& mesh : meshes) {
        const std::string file = safe_text(std::filesystem::path(mesh.asset->file).filename().string());
        std::string line;
        if (mesh.asset->doubled_faces > 0)
            line += fmt::format("note: mesh \"{}\": {} faces that are listed twice were dropped\n", file,
                                mesh.asset->doubled_faces);
        if (mesh.painted)
            for (const std::string& image : mesh.paint()->missing_images)
                line += fmt::format("note: mesh \"{}\": no PNG or JPEG file for its image \"{}\": drawn without\n",
                                    file, safe_text(image));
        if (!mesh.chosen && mesh.mass_from == MassFrom::hull)
            line += fmt::format(
                "note: mesh \"{}\" is open and encloses no volume: its mass is that of its convex hull "
                "(mass_from = \"hull\"; \"shell\" takes its surface)\n",
                file);
        if (!mesh.chosen && mesh.mass_from == MassFrom::shell)
            line += fmt::format(
                "note: mesh \"{}\" is flat: its mass is that of a sheet {:.3g} m thick (mass_from = "
                "\"shell\", thickness)\n",
                file, mesh.thickness);
        if (!line.empty() && said.insert(line).second) lines += line;
    }
    return lines;
}

std::string overlap_warning(const SceneDescription& scene, const World& world) {
    std::vector<Overlap> overlaps = world.overlaps();
    std::erase_if(overlaps, [](const Overlap& overlap) { return overlap.share <= named_share; });
    if (overlaps.empty()) return "";
    std::string lines;
    for (std::size_t i = 0; i < std::min(overlaps.size(), most_overlaps); ++i) {
        const Overlap& o = overlaps[i];
        lines += fmt::format(
            "warning: bodies '{}' and '{}' overlap by {:.3g} m at the start, {:.3g} % of the smaller one's thickness\n",
            safe_text(scene.bodies[o.a].name), safe_text(scene.bodies[o.b].name), o.depth, 100.0 * o.share);
    }
    if (overlaps.size() > most_overlaps)
        lines +=
            fmt::format("warning: {} more pairs of bodies overlap at the start\n", overlaps.size() - most_overlaps);
    return lines + "         contact pushes them apart, which gives them energy: move them, or join them\n";
}

}  // namespace

std::string start_notes(const SceneDescription& scene, const World& world) {
    return mesh_notes(scene) + overlap_warning(scene, world);
}

std::vector<BrokenJoint> broken_joints(const SceneDescription& scene, const World& world) {
    std::vector<BrokenJoint> broken;
    if (scene.joints.empty()) return broken;
    const std::vector<JointState> states = world.joint_states();
    for (std::size_t k = 0; k < states.size(); ++k)
        if (states[k].broken_at) broken.push_back({*states[k].broken_at, scene.joints[k].name});
    std::stable_sort(broken.begin(), broken.end(), [](const auto& l, const auto& r) { return l.time < r.time; });
    return broken;
}

void say_broken(const std::vector<BrokenJoint>& joints) {
    if (messages().json()) {
        for (const BrokenJoint& joint : joints)
            messages().event("broke", {{"joint", safe_text(joint.name)}, {"time", joint.time}});
        return;
    }
    for (std::size_t i = 0; i < std::min(joints.size(), most_broken); ++i)
        say("joint '{}' broke at {:.4g} s\n", safe_text(joints[i].name), joints[i].time);
    if (joints.size() > most_broken) say("{} more joints broke\n", joints.size() - most_broken);
}

}  // namespace tumble
