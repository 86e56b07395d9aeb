#include "app/cli/command.h"
#include "app/cli/run_notes.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "app/files/output_plan.h"
#include "app/threads/stage_timer.h"
#include "app/workers/frame_memory.h"
#include "core/available_memory.h"
#include "core/error.h"
#include "core/frame_rate.h"
#include "core/safe_text.h"
#include "output/table_writer.h"
#include "presimulation/impact_focus.h"
#include "scene/fields/choices.h"
#include "sim/geometry/shapes/shape.h"
#include "sim/world.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace tumble {
namespace {

struct InfoCommand {
    std::filesystem::path scene;
    SceneOverrides overrides;
    std::optional<std::filesystem::path> bodies;
};

constexpr double longest_trial = 4.0;   // s of processor time: all demo scenes but the largest are done by then
constexpr double longest_coarse = 2.0;  // s
constexpr int coarsening = 8;           // a step of the copy is as long as so many; falling bodies still come to rest

using Times = std::vector<double>;  // s of processor time, by frame

double sum(const Times& times, std::size_t first, std::size_t end) {
    return std::accumulate(times.begin() + std::ptrdiff_t(first), times.begin() + std::ptrdiff_t(end), 0.0);
}

/// The times of the first frames, at least one.
Times times_of(World& world, std::int64_t frames, double longest) {
    Times times;
    const double start = thread_seconds();
    double before = start;
    while (std::int64_t(times.size()) < frames && before - start < longest) {
        world.advance_frame();
        const double now = thread_seconds();
        times.push_back(now - before);
        before = now;
    }
    return times;
}

/// The times of a copy with longer steps; none if it fails, which a copy may do alone.
Times coarse_times(const SceneDescription& scene, std::int64_t frames) {
    FrameTiming timing = scene.timing();
    timing.steps_per_frame = std::max(1, timing.steps_per_frame / coarsening);
    try {
        World world(scene, timing, 1);
        return times_of(world, frames, longest_coarse);
    } catch (const RunError&) {
        return {};
    }
}

/// The time of `frames` frames, whose first ones took `times`.
double extrapolated(const Times& times, std::int64_t frames) {
    const std::size_t done = times.size(), last = std::max<std::size_t>(1, done / 4);
    return sum(times, 0, done) + sum(times, done - last, done) / double(last) * double(frames - std::int64_t(done));
}

double estimate(const SceneDescription& scene, const Times& times, std::int64_t frames) {
    const Times coarse = coarse_times(scene, frames);
    if (coarse.size() <= times.size()) return extrapolated(times, frames);
    const double seconds = sum(times, 0, times.size()), of_copy = sum(coarse, 0, times.size());
    return seconds + seconds / of_copy * (extrapolated(coarse, frames) - of_copy);
}

/// The processor time that a simulation will take. Steps the world, which is at time 0, for some seconds, and a coarse
/// copy of it to the end, which shows how the cost of later frames differs: heaps form, and bodies fall asleep. Says so
/// where the simulation fails.
std::string simulation_cost(const SceneDescription& scene, World& world) {
    const std::int64_t frames = scene.frame_count() - 1;
    if (frames <= 0) return "nothing to simulate";
    try {
        const Times times = times_of(world, frames, longest_trial);
        if (std::int64_t(times.size()) == frames)
            return fmt::format("{:.3g} s of processor time, on one thread", sum(times, 0, times.size()));
        return fmt::format("about {:.2g} s of processor time on one thread, estimated", estimate(scene, times, frames));
    } catch (const RunError& error) {
        return fmt::format("the simulation fails: {}", error.what());
    }
}

constexpr std::size_t listed_bodies = 24;  // a screenful; the groups summarize all bodies

/// The kind of shape, for the groups, and its dimensions, for the list.
struct ShapeText {
    std::string kind, measures;
};

ShapeText shape_text(const Shape& shape) {
    struct ShapeVisitor {
        ShapeText operator()(const PlaneShape& s) const { return {"plane", fmt::format("offset {:.4g}", s.offset)}; }
        ShapeText operator()(const BoxShape& s) const {
            return {"box", fmt::format("{:.4g} x {:.4g} x {:.4g}", s.size.x(), s.size.y(), s.size.z())};
        }
        ShapeText operator()(const SphereShape& s) const { return {"sphere", fmt::format("radius {:.4g}", s.radius)}; }
        ShapeText operator()(const MeshShape& s) const {
            const Vec3 size = s.asset->mesh.bounds().extent();
            return {"mesh", fmt::format("{:.4g} x {:.4g} x {:.4g}, {}, {} triangles", size.x(), size.y(), size.z(),
                                        safe_text(std::filesystem::path(s.asset->file).filename().native()),
                                        s.asset->mesh.triangles.size())};
        }
        ShapeText operator()(const CurvedShape& s) const {
            const std::string kind(name_of(s.kind));
            if (s.kind == CurvedKind::ellipsoid)
                return {kind, fmt::format("radii {:.4g} {:.4g} {:.4g}", s.radii.x(), s.radii.y(), s.radii.z())};
            if (s.kind == CurvedKind::cone && s.top_radius > 0.0)
                return {kind, fmt::format("radius {:.4g} to {:.4g}, height {:.4g}", s.radius, s.top_radius, s.height)};
            return {kind, fmt::format("radius {:.4g}, height {:.4g}", s.radius, s.height)};
        }
        ShapeText operator()(const CompoundShape& s) const {
            return {"compound", fmt::format("{} parts", s.parts->size())};
        }
    };
    return std::visit(ShapeVisitor{}, shape);
}

std::string vector_text(const Vec3& v) { return fmt::format("{:.4g} {:.4g} {:.4g}", v.x(), v.y(), v.z()); }

std::string count_text(std::size_t count, const char* one, const char* several) {
    return fmt::format("{} {}", count, count == 1 ? one : several);
}

std::string camera_motion(const SceneDescription& scene) {
    std::string text;
    if (!scene.camera.keyframes.empty()) text += fmt::format(", {} keyframes", scene.camera.keyframes.size());
    if (scene.camera.orbit != 0.0) text += fmt::format(", turning at {:.4g} degrees/s", scene.camera.orbit);
    if (!scene.camera.shots.empty())
        text += fmt::format(", other cameras in {}", count_text(scene.camera.shots.size(), "shot", "shots"));
    if (scene.camera.follow) text += fmt::format(", following {}", safe_text(scene.bodies[*scene.camera.follow].name));
    return text;
}

/// The things of a scene under which a body's flight has no closed form.
std::vector<std::string> driving(const SceneDescription& scene) {
    std::vector<std::string> names;
    if (scene.wind) names.push_back("wind");
    if (!scene.forces.empty()) names.push_back("forces at points");
    if (!scene.fields.empty()) names.push_back("fields");
    if (!scene.pair_forces.empty()) names.push_back("forces between bodies");
    if (scene.water) names.push_back("water");
    if (!scene.explosions.empty()) names.push_back("explosions, in their steps");
    return names;
}

void print_head(const SceneDescription& scene) {
    const std::string file = safe_path(scene.file);
    put("{}{}\n", scene.title.empty() ? file : safe_text(scene.title), scene.title.empty() ? "" : " (" + file + ")");
    const std::int64_t frames = scene.frame_count();
    const int steps = scene.simulation.steps_per_frame;
    put("  time      {:.6g} s, {} frames at {} frames/s, {} steps of {:.6g} s ({} a frame)\n",
        scene.simulation.duration, frames, fps_text(scene.output.fps), (frames - 1) * steps, scene.step(), steps);
    put("  picture   {} x {} pixels, {} samples each, shadows {}\n", scene.output.width, scene.output.height,
        scene.output.samples, scene.light.shadows ? "on" : "off");
    put("  camera    from {} to {}, {:.4g} degrees vertical field of view{}\n", vector_text(scene.camera.eye),
        vector_text(scene.camera.target), scene.camera.vertical_fov, camera_motion(scene));
    put("  gravity   {} m/s^2\n", vector_text(scene.simulation.gravity));
    if (scene.wind)
        put("  wind      {} m/s, density {:.4g} kg/m^3, drag {:.4g}\n", vector_text(scene.wind->velocity),
            scene.wind->density, scene.wind->drag);
    if (!scene.forces.empty()) put("  forces    {} at points of bodies\n", scene.forces.size());
    if (!scene.fields.empty()) put("  fields    {}\n", scene.fields.size());
    if (!scene.pair_forces.empty()) put("  forces    {} between bodies\n", scene.pair_forces.size());
    std::size_t fragile = 0, pieces = 0, bonds = 0;
    for (const BodyDescription& body : scene.bodies) {
        if (!body.fracture) continue;
        ++fragile;
        pieces += body.fracture->pieces;
        bonds += body.fracture->bonds.size();
    }
    if (fragile > 0)
        put("  fracture  {} of {}, held by {}\n", count_text(fragile, "body", "bodies"),
            count_text(pieces, "piece", "pieces"), count_text(bonds, "bond", "bonds"));
    if (!scene.explosions.empty()) put("  explosions {}\n", scene.explosions.size());
    if (scene.water)
        put("  water     below {:.4g} m, density {:.4g} kg/m^3, drag {:.4g}, {}\n", scene.water->level,
            scene.water->density, scene.water->drag, count_text(scene.water->waves.size(), "wave", "waves"));
    if (const auto names = driving(scene); scene.simulation.impacts == ImpactMode::exact && !names.empty())
        put("  exact     impacts; between them bodies move step by step where these act: {}\n", fmt::join(names, "; "));
}

/// The number of bodies before the first piece: pieces stand at the end.
std::size_t without_pieces(const SceneDescription& scene) {
    return std::size_t(std::ranges::count_if(scene.bodies, [](const BodyDescription& body) { return !body.piece_of; }));
}

void print_groups(const SceneDescription& scene, const World& world) {
    struct Group {
        std::size_t count = 0;
        double mass = 0.0;
    };
    std::map<std::pair<BodyType, std::string>, Group> groups;
    const std::size_t wholes = without_pieces(scene);
    for (std::size_t i = 0; i < wholes; ++i) {
        const BodyDescription& body = scene.bodies[i];
        Group& group = groups[{body.type, shape_text(body.shape).kind}];
        ++group.count;
        group.mass += world.report(i).mass;
    }
    put("\n{} bodies\n", wholes);
    for (const auto& [key, group] : groups) {
        put("  {:>7} {} {}", group.count, name_of(key.first), key.second);
        if (key.first == BodyType::dynamic) put(", {:.6g} kg in total", group.mass);
        put("\n");
    }
}

/// Names meshes of an unlikely size, each file once: their lengths may be in another unit.
void print_size_hints(const SceneDescription& scene) {
    constexpr double smallest = 1e-3, largest = 100.0;  // m
    std::set<std::string> named;
    for (const BodyDescription& body : scene.bodies) {
        const auto* mesh = std::get_if<MeshShape>(&body.shape);
        if (mesh == nullptr || body.piece_of) continue;
        const double length = mesh->asset->mesh.bounds().extent().maxCoeff();
        if ((length >= smallest && length <= largest) || !named.insert(mesh->asset->file).second) continue;
        put("  hint: the mesh of '{}' is {:.4g} m long: if its file is in another unit, give its shape {}\n",
            safe_text(body.name), length, length > largest ? "unit = \"mm\"" : "a scale");
    }
}

void print_bodies(const SceneDescription& scene, const World& world) {
    if (scene.bodies.empty()) return;
    put("\n  {:<16} {:<10} {:<7} {:<28} {:>10}  {:<30} {:>6}\n", "name", "type", "shape", "measures (m)", "mass (kg)",
        "principal inertia (kg m^2)", "hull");
    const std::size_t wholes = without_pieces(scene), count = std::min(wholes, listed_bodies);
    for (std::size_t i = 0; i < count; ++i) {
        const BodyDescription& body = scene.bodies[i];
        const BodyReport report = world.report(i);
        const ShapeText shape = shape_text(body.shape);
        const bool moves = body.type == BodyType::dynamic;
        put("  {:<16} {:<10} {:<7} {:<28} {:>10}  {:<30} {:>6}\n", safe_text(body.name), name_of(body.type), shape.kind,
            shape.measures, moves ? fmt::format("{:.5g}", report.mass) : "-",
            moves ? vector_text(report.principal_inertia) : "-",
            report.hull_vertices > 0 ? std::to_string(report.hull_vertices) : "-");
    }
    if (count < wholes) put("  ... and {} more\n", wholes - count);
    put("  hull: vertices of the convex shape that collides\n");
    print_size_hints(scene);
}

/// The way of all groups, or the number of groups for each.
std::string ways_text(const std::array<std::size_t, 3>& ways) {
    constexpr const char* names[] = {"in joint coordinates", "by rows", "in sweeps"};  // in the order of JointWay
    std::string text;
    for (std::size_t way = 0; way < ways.size(); ++way) {
        if (ways[way] == 0) continue;
        const bool all = ways[way] == std::accumulate(ways.begin(), ways.end(), std::size_t(0));
        if (all) return names[way];
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count_text(ways[way], "group", "groups"), names[way]);
    }
    return text;
}

void print_joints(const SceneDescription& scene, const World& world) {
    if (scene.joints.empty()) return;
    std::map<JointType, std::size_t> types;
    for (const JointDescription& joint : scene.joints) ++types[joint.type];
    put("\n{}\n", count_text(scene.joints.size(), "joint", "joints"));
    for (const auto& [type, count] : types) put("  {:>7} {}\n", count, name_of(type));
    const JointReport report = world.joint_report();
    const auto name = [&](std::size_t joint) { return safe_text(scene.joints[joint].name); };
    put("  freedom   {}{} of {}\n", report.counted ? "" : "at least ",
        count_text(report.degrees_of_freedom, "degree of freedom", "degrees of freedom"),
        count_text(report.bodies, "joined body", "joined bodies"));
    put("  groups    {}, {}, {}; {}, {}\n", count_text(report.groups, "group", "groups"),
        count_text(report.trees, "tree", "trees"), count_text(report.loops, "loop", "loops"),
        count_text(report.rows, "row", "rows"),
        report.counted ? fmt::format("{} redundant", report.redundant) : "too many to find redundant ones");
    if (report.heaviest)
        put("  masses    {:.4g} : 1 at the most, at joint '{}'\n", report.mass_ratio, name(*report.heaviest));
    put("  gap       {:.3g} m at the start{}\n", report.gap,
        report.widest ? fmt::format(", at joint '{}'", name(*report.widest)) : "");
    put("  solved    {} in flight; {} beside contacts\n", ways_text(report.in_flight), ways_text(report.in_contact));
    if (report.crowd > 0)
        put("  figures   {} joined bodies: in sweeps while {} or more of them touch something; with\n"
            "            contact_solver = \"direct\" by rows, which takes longer\n",
            report.figures, report.crowd);
    if (report.swept() > 0)
        put("  nets      {} in sweeps: loops open by millimeters under load; less with more steps_per_frame,\n"
            "            not at all with contact_solver = \"direct\", which takes longer\n",
            count_text(report.swept(), "group", "groups"));
}

void print_cost(const SceneDescription& scene, World& world) {
    const double pixels = double(scene.output.width) * scene.output.height;
    RenderWork work;
    work.clip = VideoKind::h264;
    work.outputs.video = PixelFormat::yuv420;
    work.frames = scene.frame_count();
    const RenderMemory memory = render_memory(scene, work);
    put("\ncost\n");
    put("  simulation  {}\n", simulation_cost(scene, world));
    put("  drawing     {:.4g} million pixels, {:.4g} million samples\n", 1e-6 * pixels * double(scene.frame_count()),
        1e-6 * pixels * double(scene.frame_count()) * scene.output.samples);
    put("  memory      about {} for the pictures of each render process and {} for those of ffmpeg, for any number of "
        "frames\n",
        memory_text(memory.worker), memory_text(memory.encoder));
}

void write_bodies(const std::filesystem::path& file, const SceneDescription& scene, const World& world) {
    TableWriter table(file, "body,type,mass,cx,cy,cz,ixx,iyy,izz,ixy,ixz,iyz");
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const BodyDescription& body = scene.bodies[i];
        const BodyReport report = world.report(i);
        MassProperties matter{report.mass, report.center_of_mass, report.inertia};
        if (body.piece_of) matter = mass_properties(body);  // it has none in the world before it is there
        const Vec3& c = matter.center_of_mass;
        const Mat3& inertia = matter.inertia;
        table.text(body.name).text(name_of(body.type)).number(body.type == BodyType::dynamic ? matter.mass : 0.0);
        table.number(c.x()).number(c.y()).number(c.z());
        table.number(inertia(0, 0)).number(inertia(1, 1)).number(inertia(2, 2));
        table.number(inertia(0, 1)).number(inertia(0, 2)).number(inertia(1, 2));
        table.end_row();
    }
    table.finish();
}

void run_info(const InfoCommand& command) {
    FileList inputs;
    const SceneDescription scene = focused_on_impacts(load_scene(command.scene, command.overrides, &inputs));
    OutputPlan plan;
    plan.add_inputs(inputs);
    if (command.bodies) plan.add("--bodies", *command.bodies);
    World world(scene);
    if (command.bodies) write_bodies(*command.bodies, scene, world);
    if (command.bodies == "/dev/stdout") return;
    say_text(start_notes(scene, world));
    print_head(scene);
    print_groups(scene, world);
    print_bodies(scene, world);
    print_joints(scene, world);
    print_cost(scene, world);
}

}  // namespace

void add_info(Command& command) {
    InfoCommand& c = command.keep<InfoCommand>();
    add_scene(command, c.scene);
    add_size(command, c.overrides.width, c.overrides.height, "Picture size, in place of the scene's");
    add_frames_of_time(command, c.overrides);
    command
        .add_option("--bodies", c.bodies,
                    "CSV: one row per body, with mass, center of mass and inertia tensor in 17 digits; -\nis standard "
                    "output, in place of the description")
        ->check(csv_name())
        ->transform(or_standard_output())
        ->type_name("B.csv");
    command.examples = "  tumble info scene.toml";
    command.run = [&c] {
        run_info(c);
        return 0;
    };
}

}  // namespace tumble
