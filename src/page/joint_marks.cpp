#include "page/joint_marks.h"

#include "overlay/joint_sketch.h"
#include "page/prediction.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace tumble {
namespace {

using Json = ArrayStore::Json;

constexpr std::size_t most_rows = 60000;  // joints times frames: half a megabyte
constexpr double resolution = 1e-4;       // of the largest force of a joint: below a pixel of its arrow

Json point_json(const SketchPoint& point) {
    return {point.body ? Json(*point.body) : Json(-1), point.at.x(), point.at.y(), point.at.z()};
}

Json vectors_json(const PageRun& run, std::size_t joint, Vec3 JointState::*member, ArrayStore& arrays) {
    double most = 0.0;
    for (const auto& frame : run.joint_states) most = std::max(most, (frame[joint].*member).norm());
    const double quantum = most > 0.0 ? resolution * most : 1.0;
    Json columns = Json::array();
    for (int k = 0; k < 3; ++k) {
        std::vector<std::int64_t> whole;
        for (const auto& frame : run.joint_states) whole.push_back(std::llround((frame[joint].*member)[k] / quantum));
        const int order = predict(whole);
        columns.push_back({quantum, order, arrays.add(whole)});
    }
    return columns;
}

}  // namespace

Json make_joint_marks(const PageRun& run, ArrayStore& arrays) {
    Json marks = Json::array();
    const std::size_t frames = run.joint_states.size();
    if (frames == 0 || run.scene.joints.size() * frames > most_rows) return marks;
    for (const JointSketch& sketch : sketch_joints(run.scene)) {
        Json lines = Json::array();
        for (const SketchLine& line : sketch.lines) {
            Json points = Json::array();
            for (const SketchPoint& point : line.points) points.push_back(point_json(point));
            lines.push_back({{"limit", line.limit}, {"points", std::move(points)}});
        }
        std::vector<std::int64_t> states;  // 0: holds no more, 1: holds, 2: at a limit
        for (const auto& frame : run.joint_states) {
            const JointState& state = frame[sketch.joint];
            states.push_back(!state.active ? 0 : state.limit == 0 ? 1 : 2);
        }
        marks.push_back({{"name", run.scene.joints[sketch.joint].name},
                         {"marker", style::markers[std::size_t(sketch.marker)]},
                         {"anchor", point_json(sketch.anchor)},
                         {"allowance", sketch.allowance},
                         {"lines", std::move(lines)},
                         {"states", arrays.add(states)},
                         {"force", vectors_json(run, sketch.joint, &JointState::mean_force, arrays)},
                         {"torque", vectors_json(run, sketch.joint, &JointState::mean_torque, arrays)}});
    }
    return marks;
}

}  // namespace tumble
