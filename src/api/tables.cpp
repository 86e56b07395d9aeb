// Tables: one class for each table of `tumble simulate`.
#include "tumble/output.h"

#include "api/convert.h"
#include "api/guard.h"
#include "api/record_table.h"
#include "api/scene_data.h"
#include "output/table_writer.h"

#include <fmt/format.h>

namespace tumble::v0 {
namespace {

void write_vector(TableWriter& table, const Vec3& v) { table.number(v.x).number(v.y).number(v.z); }

const char* name_of(ContactFeatures features) {
    static constexpr const char* names[] = {"vertex-face", "face-vertex", "edge-edge", "face-face", "sphere", "mesh"};
    return names[std::size_t(features)];
}

const char* name_of(Contact::State state) {
    static constexpr const char* names[] = {"stick", "slip", "asleep", "open"};
    return names[std::size_t(state)];
}

}  // namespace

// -- TrajectoryTable

struct TrajectoryTable::State : Writing {
    State(const std::string& file, const Scene& whole)
        : scene(whole), table(file, "frame,time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz") {}

    Scene scene;
    TableWriter table;
};

TrajectoryTable::TrajectoryTable(const std::string& file, const Scene& scene) {
    guarded([&] { state_ = std::make_unique<State>(file, scene); });
}
TrajectoryTable::~TrajectoryTable() = default;
TrajectoryTable::TrajectoryTable(TrajectoryTable&&) noexcept = default;
TrajectoryTable& TrajectoryTable::operator=(TrajectoryTable&&) noexcept = default;

// Columns of a row after the name: position, rotation, velocity, angular velocity.
static constexpr int state_columns = 13;

void TrajectoryTable::add(const Snapshot& snapshot) {
    write_with(state_, "TrajectoryTable", [&](State& state) {
        const Scene& scene = state.scene;
        TableWriter& table = state.table;
        if (snapshot.bodies.size() != scene.body_count())
            throw InputError(fmt::format("the snapshot must hold each body of the scene: {} (given {})",
                                         scene.body_count(), snapshot.bodies.size()));
        for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
            if (scene.body_type(i) == BodyType::fixed) continue;
            const BodyState& body = snapshot.bodies[i];
            table.integer(snapshot.frame).number(snapshot.time).text(scene.body_name(i));
            if (body.absent) {
                for (int column = 0; column < state_columns; ++column) table.text("");
                table.end_row();
                continue;
            }
            write_vector(table, body.center_of_mass);
            const Quat& q = body.orientation;
            table.number(q.w).number(q.x).number(q.y).number(q.z);
            write_vector(table, body.velocity);
            write_vector(table, body.angular_velocity);
            table.end_row();
        }
    });
}

void TrajectoryTable::finish() {
    finish_with(state_, "TrajectoryTable", [](State& state) { state.table.finish(); });
}

// -- EnergyTable

struct EnergyTable::State : Writing {
    State(const std::string& file, bool of_joints, bool of_breaks, bool of_water)
        : joints(of_joints),
          breaks(of_breaks),
          water(of_water),
          table(file, std::string("frame,time,kinetic,potential,total,px,py,pz,lx,ly,lz,contacts,max_penetration,"
                                  "kinetic_linear,kinetic_angular,work,impact_loss,friction_loss,elastic") +
                          (of_joints ? ",motor_work,joint_heat" : "") + (of_breaks ? ",surface_energy" : "") +
                          (of_water ? ",water_loss" : "")) {}

    bool joints, breaks, water;
    TableWriter table;
};

EnergyTable::EnergyTable(const std::string& file) {
    guarded([&] { state_ = std::make_unique<State>(file, false, false, false); });
}
EnergyTable::EnergyTable(const std::string& file, const Scene& scene) {
    guarded(
        [&] { state_ = std::make_unique<State>(file, scene.joint_count() > 0, scene.breakable(), scene.has_water()); });
}
EnergyTable::~EnergyTable() = default;
EnergyTable::EnergyTable(EnergyTable&&) noexcept = default;
EnergyTable& EnergyTable::operator=(EnergyTable&&) noexcept = default;

void EnergyTable::add(std::int64_t frame, double time, const Energies& e) {
    write_with(state_, "EnergyTable", [&](State& state) {
        TableWriter& table = state.table;
        table.integer(frame)
            .number(time)
            .number(e.kinetic)
            .number(e.potential)
            .number(e.kinetic + e.potential + e.elastic);
        write_vector(table, e.momentum);
        write_vector(table, e.angular_momentum);
        table.integer(e.contacts).number(e.max_penetration);
        table.number(e.kinetic_linear).number(e.kinetic_angular);
        table.number(e.work).number(e.impact_loss).number(e.friction_loss).number(e.elastic);
        if (state.joints) table.number(e.motor_work).number(e.joint_heat);
        if (state.breaks) table.number(e.surface);
        if (state.water) table.number(e.water_loss);
        table.end_row();
    });
}

void EnergyTable::finish() {
    finish_with(state_, "EnergyTable", [](State& state) { state.table.finish(); });
}

// -- ImpactTable

struct ImpactTable::State : Writing {
    State(const std::string& file, const Scene& whole)
        : scene(whole),
          table(file,
                "time,exact,frame,a,b,px,py,pz,nx,ny,nz,feature,v_before,v_after,restitution,impulse,fx,fy,fz,pass,"
                "mx,my,mz") {}

    Scene scene;
    RecordTable table;
};

ImpactTable::ImpactTable(const std::string& file, const Scene& scene) {
    guarded([&] { state_ = std::make_unique<State>(file, scene); });
}
ImpactTable::~ImpactTable() = default;
ImpactTable::ImpactTable(ImpactTable&&) noexcept = default;
ImpactTable& ImpactTable::operator=(ImpactTable&&) noexcept = default;

void ImpactTable::add(const FrameContacts& contacts) {
    write_with(state_, "ImpactTable", [&](State& state) {
        RecordTable& table = state.table;
        for (const Impact& i : contacts.impacts) {
            table.number(i.time).integer(i.exact_time).integer(i.frame);
            table.text(state.scene.body_name(i.a)).text(state.scene.body_name(i.b));
            table.vector(i.point).vector(i.normal).text(name_of(i.features));
            table.number(i.speed_before).number(i.speed_after).number(i.restitution).number(i.impulse);
            table.vector(i.friction).integer(i.pass).vector(i.moment);
            table.end_row();
        }
    });
}

void ImpactTable::finish() {
    finish_with(state_, "ImpactTable", [](State& state) { state.table.finish(); });
}

// -- ContactTable

struct ContactTable::State : Writing {
    State(const std::string& file, const Scene& whole)
        : scene(whole),
          table(file, "frame,time,a,b,px,py,pz,nx,ny,nz,gap,normal_force,fx,fy,fz,torsion,sx,sy,sz,state,mx,my,mz") {}

    Scene scene;
    RecordTable table;
};

ContactTable::ContactTable(const std::string& file, const Scene& scene) {
    guarded([&] { state_ = std::make_unique<State>(file, scene); });
}
ContactTable::~ContactTable() = default;
ContactTable::ContactTable(ContactTable&&) noexcept = default;
ContactTable& ContactTable::operator=(ContactTable&&) noexcept = default;

void ContactTable::add(std::int64_t frame, double time, const FrameContacts& contacts) {
    write_with(state_, "ContactTable", [&](State& state) {
        RecordTable& table = state.table;
        for (const Contact& c : contacts.contacts) {
            table.integer(frame).number(time);
            table.text(c.a == Contact::nobody ? std::string() : state.scene.body_name(c.a));
            table.text(state.scene.body_name(c.b));
            table.vector(c.point).vector(c.normal).number(c.gap).number(c.normal_force);
            table.vector(c.tangential_force).number(c.torsion).vector(c.slip).text(name_of(c.state));
            table.vector(c.moment);
            table.end_row();
        }
    });
}

void ContactTable::finish() {
    finish_with(state_, "ContactTable", [](State& state) { state.table.finish(); });
}

// -- LoadTable

struct LoadTable::State : Writing {
    State(const std::string& file, const Scene& whole)
        : scene(whole), table(file, "frame,time,body,fx,fy,fz,mx,my,mz") {}

    Scene scene;
    RecordTable table;
};

LoadTable::LoadTable(const std::string& file, const Scene& scene) {
    guarded([&] { state_ = std::make_unique<State>(file, scene); });
}
LoadTable::~LoadTable() = default;
LoadTable::LoadTable(LoadTable&&) noexcept = default;
LoadTable& LoadTable::operator=(LoadTable&&) noexcept = default;

void LoadTable::add(std::int64_t frame, double time, const FrameContacts& contacts) {
    write_with(state_, "LoadTable", [&](State& state) {
        RecordTable& table = state.table;
        for (const ExternalLoad& load : contacts.loads) {
            table.integer(frame).number(time).text(state.scene.body_name(load.body));
            table.vector(load.force).vector(load.moment);
            table.end_row();
        }
    });
}

void LoadTable::finish() {
    finish_with(state_, "LoadTable", [](State& state) { state.table.finish(); });
}

}  // namespace tumble::v0
