#include "presimulation/impact_focus.h"

#include "core/error.h"
#include "scene/keys/fracture.h"
#include "sim/geometry/shapes/shape.h"
#include "sim/world.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace tumble {
namespace {

/// Blows that are tried as the one that breaks a body; each is harder than those before it.
constexpr int most_tries = 32;

/// A place on a body, m, in its frame from its origin, and the impulse there, N s.
struct Place {
    Vec3 point = Vec3::Zero();
    double impulse = 0.0;
};

struct Search {
    int tries = 0;
    double tried = 0.0;  // N s, the hardest blow so far
    bool found = false;
};

bool waits(const BodyDescription& body) { return body.fracture && body.fracture->focus_at_impact; }

std::size_t whole_of(const SceneDescription& scene, std::size_t body) {
    return scene.bodies[body].piece_of.value_or(body);
}

void set_focus(SceneDescription& scene, std::size_t body, const Vec3& focus) {
    auto fracture = std::make_shared<FractureDescription>(*scene.bodies[body].fracture);
    fracture->focus = focus;
    scene.bodies[body].fracture = std::move(fracture);
}

/// The hardest blow of a frame on each body, from outside.
std::map<std::size_t, Place> blows_of(const SceneDescription& scene, const ContactRecords& records) {
    std::map<std::pair<std::size_t, double>, Place> sums;  // by body and time: all points of contact together
    for (const ImpactRecord& r : records.impacts) {
        const std::size_t a = whole_of(scene, r.a), b = whole_of(scene, r.b);
        if (a == b || !(r.impulse > 0.0)) continue;
        for (const auto& [whole, own, at] : {std::tuple(a, r.a, r.struck_a), std::tuple(b, r.b, r.struck_b)}) {
            if (!waits(scene.bodies[whole])) continue;
            const StruckBody& body = records.struck[at];
            const Vec3 point = body.rotation.conjugate() * (r.point - body.position) +
                               mass_properties(scene.bodies[own]).center_of_mass;
            Place& sum = sums[{whole, r.when.time}];
            sum.point += r.impulse * point;
            sum.impulse += r.impulse;
        }
    }
    std::map<std::size_t, Place> hardest;
    for (const auto& [key, sum] : sums)
        if (Place& most = hardest[key.first]; sum.impulse > most.impulse) most = {sum.point / sum.impulse, sum.impulse};
    return hardest;
}

/// Simulates until a blow is a new try, which changes the scene. Returns false if there is none.
bool try_next(SceneDescription& scene, std::map<std::size_t, Search>& searches) {
    World world(scene);
    world.record_contacts();
    for (std::int64_t frame = 1; frame < scene.frame_count(); ++frame) {
        if (std::ranges::all_of(searches, [](const auto& one) { return one.second.found; })) return false;
        world.advance_frame();
        bool changed = false;
        for (const BreakRecord& r : world.breaks())
            if (waits(scene.bodies[r.body]) && scene.bodies[r.body].fracture->focus) searches[r.body].found = true;
        for (const auto& [body, blow] : blows_of(scene, world.contact_records())) {
            Search& search = searches[body];
            if (search.found || search.tries == most_tries || !(blow.impulse > search.tried)) continue;
            search.tried = blow.impulse;
            ++search.tries;
            set_focus(scene, body, blow.point);
            changed = true;
        }
        for (const BreakRecord& r : world.breaks()) {
            const auto& fracture = scene.bodies[r.body].fracture;
            if (!waits(scene.bodies[r.body]) || fracture->focus) continue;
            searches[r.body].found = changed = true;
            set_focus(scene, r.body, fracture->bonds[r.bond].center);  // a load broke it without a blow
        }
        if (changed) return true;
    }
    return false;
}

}  // namespace

SceneDescription focused_on_impacts(SceneDescription scene) {
    std::map<std::size_t, Search> searches;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        if (waits(scene.bodies[i])) searches[i] = {};
    try {
        while (!searches.empty() && try_next(scene, searches)) cut_again(scene);
    } catch (const RunError&) {
        // The run itself tells it, after its finished frames.
    }
    return scene;
}

}  // namespace tumble
