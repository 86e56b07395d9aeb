#include "tumble/world.h"

#include "sim/world.h"

#include "api/convert.h"
#include "api/guard.h"
#include "api/scene_data.h"

#include <fmt/format.h>

namespace tumble::v0 {

struct World::State {
    State(const SceneDescription& scene, int threads) : world(scene, threads), bodies(scene.bodies.size()) {}

    tumble::World world;
    std::size_t bodies;
};

World::World(const Scene& scene, int threads) {
    guarded([&] {
        check_threads(threads);
        state_ = std::make_unique<State>(*scene.data().description, threads);
    });
}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

void World::advance_step() {
    guarded([&] { state_of(state_, "World").world.step(); });
}
void World::advance_frame() {
    guarded([&] { state_of(state_, "World").world.advance_frame(); });
}

void World::record_contacts() {
    guarded([&] { state_of(state_, "World").world.record_contacts(); });
}

FrameContacts World::contacts() const {
    return guarded([&] {
        State& state = state_of(state_, "World");
        if (!state.world.records_contacts())
            throw InputError("contacts are not recorded: call record_contacts() before the first step");
        return to_public(state.world.contact_records());
    });
}

Snapshot World::snapshot() const {
    return guarded([&] { return to_public(state_of(state_, "World").world.snapshot()); });
}

std::vector<JointState> World::joints() const {
    return guarded([&] { return to_public(state_of(state_, "World").world.joint_states()); });
}

std::vector<Break> World::breaks() const {
    return guarded([&] { return to_public(state_of(state_, "World").world.breaks()); });
}

Energies World::energies() const {
    return guarded([&] {
        State& state = state_of(state_, "World");
        return to_public(state.world.measure(), state.world.contact_records().energy);
    });
}

BodyProperties World::properties(std::size_t body) const {
    return guarded([&] {
        State& state = state_of(state_, "World");
        if (body >= state.bodies)
            throw InputError(fmt::format("a body's index must be below {} (given {})", state.bodies, body));
        const BodyReport report = state.world.report(body);
        return BodyProperties{report.mass, to_public(report.principal_inertia), to_public(report.center_of_mass)};
    });
}

}  // namespace tumble::v0
