// The table of `tumble simulate --joints`.
#include "tumble/output.h"

#include "api/guard.h"
#include "api/record_table.h"
#include "api/scene_data.h"

#include <fmt/format.h>

namespace tumble::v0 {
namespace {

constexpr int shown = 3;  // no type of joint but 6dof has more free coordinates

void write_free(RecordTable& table, const std::array<bool, 6>& free, const std::array<double, 6>& values) {
    int count = 0;
    for (std::size_t k = 0; k < values.size() && count < shown; ++k) {
        if (!free[k]) continue;
        table.number(values[k]);
        ++count;
    }
    for (; count < shown; ++count) table.no_number();
}

}  // namespace

struct JointTable::State : Writing {
    State(const std::string& file, const Scene& whole)
        : scene(whole),
          table(file,
                "frame,time,joint,q1,q2,q3,v1,v2,v3,fx,fy,fz,tx,ty,tz,gap,limit,broken,active,broken_at,px,py,pz,"
                "mx,my,mz,move_x,move_y,move_z,turn_x,turn_y,turn_z,move_x_speed,move_y_speed,move_z_speed,"
                "turn_x_speed,turn_y_speed,turn_z_speed") {}

    Scene scene;
    RecordTable table;
};

JointTable::JointTable(const std::string& file, const Scene& scene) {
    guarded([&] { state_ = std::make_unique<State>(file, scene); });
}
JointTable::~JointTable() = default;
JointTable::JointTable(JointTable&&) noexcept = default;
JointTable& JointTable::operator=(JointTable&&) noexcept = default;

void JointTable::add(std::int64_t frame, double time, const std::vector<JointState>& joints) {
    write_with(state_, "JointTable", [&](State& state) {
        const Scene& scene = state.scene;
        RecordTable& table = state.table;
        if (joints.size() != scene.joint_count())
            throw InputError(fmt::format("the states must be those of each joint of the scene: {} (given {})",
                                         scene.joint_count(), joints.size()));
        for (std::size_t i = 0; i < joints.size(); ++i) {
            const JointState& joint = joints[i];
            table.integer(frame).number(time).text(scene.joint_name(i));
            write_free(table, joint.free, joint.position);
            write_free(table, joint.free, joint.speed);
            table.vector(joint.force).vector(joint.torque).number(joint.gap).integer(joint.limit);
            table.integer(joint.broken_at.has_value()).integer(joint.active);
            joint.broken_at ? table.number(*joint.broken_at) : table.no_number();
            table.vector(joint.point).vector(joint.moment);
            for (const double value : joint.position) table.number(value);
            for (const double value : joint.speed) table.number(value);
            table.end_row();
        }
    });
}

void JointTable::finish() {
    finish_with(state_, "JointTable", [](State& state) { state.table.finish(); });
}

}  // namespace tumble::v0
