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

/// Pa, beyond all loads.
constexpr double unbreakable = 1e300;

/// A place on a body, m, in its frame from its origin, and the impulse there, N s.
struct Place {
    Vec3 point = Vec3::Zero();
    double impulse = 0.0;
};

/// A body whose focus is not known yet.
struct Search {
    int tries = 0;
    double hardest = 0.0;  // N s, blow so far
};
using Searches = std::map<std::size_t, Search>;

template <class Change>
void change(SceneDescription& scene, std::size_t body, const Change& make) {
    auto fracture = std::make_shared<FractureDescription>(*scene.bodies[body].fracture);
    make(*fracture);
    scene.bodies[body].fracture = std::move(fracture);
}

void set_focus(SceneDescription& scene, std::size_t body, const Vec3& focus) {
    change(scene, body, [&](FractureDescription& fracture) { fracture.focus = focus; });
    cut_again(scene);
}

/// The scene in which these bodies do not break, but for one, if given.
SceneDescription firm(SceneDescription scene, const Searches& searches, std::optional<std::size_t> but = std::nullopt) {
    for (const auto& [body, search] : searches)
        if (body != but)
            change(scene, body, [](FractureDescription& f) { f.strength = f.shear_strength = unbreakable; });
    return scene;
}

/// The hardest blow of a frame on each body, all points of contact at one time together.
std::map<std::size_t, Place> blows_of(const SceneDescription& scene, const ContactRecords& records) {
    std::map<std::pair<std::size_t, double>, Place> sums;  // by body and time
    for (const ImpactRecord& r : records.impacts)
        for (const auto& [body, at] : {std::pair(r.a, r.struck_a), std::pair(r.b, r.struck_b)}) {
            if (!scene.bodies[body].fracture || !(r.impulse > 0.0)) continue;
            const StruckBody& struck = records.struck[at];
            const Vec3 point = struck.rotation.conjugate() * (r.point - struck.position) +
                               mass_properties(scene.bodies[body]).center_of_mass;
            Place& sum = sums[{body, r.when.time}];
            sum.point += r.impulse * point;
            sum.impulse += r.impulse;
        }
    std::map<std::size_t, Place> hardest;
    for (const auto& [key, sum] : sums)
        if (sum.impulse > hardest[key.first].impulse) hardest[key.first] = {sum.point / sum.impulse, sum.impulse};
    return hardest;
}

/// The first bond of the body that breaks in the first frames; none if it holds.
std::optional<std::size_t> first_break(const SceneDescription& scene, std::size_t body, std::int64_t frames) {
    World world(scene);
    for (std::int64_t frame = 1; frame <= frames; ++frame) {
        world.advance_frame();
        for (const BreakRecord& r : world.breaks())
            if (r.body == body) return r.bond;
    }
    return std::nullopt;
}

/// Simulates until a blow breaks a body, which is cut about its place. Returns false if none does.
bool find_one(SceneDescription& scene, Searches& searches) {
    const SceneDescription whole = firm(scene, searches);
    World world(whole);
    world.record_contacts();
    for (std::int64_t frame = 1; frame < scene.frame_count(); ++frame) {
        world.advance_frame();
        for (const auto& [body, blow] : blows_of(whole, world.contact_records())) {
            const auto search = searches.find(body);
            if (search == searches.end() || search->second.tries == most_tries) continue;
            if (!(blow.impulse > search->second.hardest)) continue;
            search->second.hardest = blow.impulse;
            ++search->second.tries;
            set_focus(scene, body, blow.point);
            if (!first_break(firm(scene, searches, body), body, frame)) continue;
            searches.erase(search);
            return true;
        }
    }
    return false;
}

/// Loads break bodies without a blow: about the first bond.
void find_loads(SceneDescription& scene, const Searches& searches) {
    for (const auto& [body, search] : searches) {
        if (scene.bodies[body].fracture->focus) continue;
        const auto bond = first_break(scene, body, scene.frame_count() - 1);
        if (bond) set_focus(scene, body, scene.bodies[body].fracture->bonds[*bond].center);
    }
}

}  // namespace

SceneDescription focused_on_impacts(SceneDescription scene) {
    Searches searches;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        if (scene.bodies[i].fracture && scene.bodies[i].fracture->focus_at_impact) searches[i] = {};
    try {
        while (!searches.empty() && find_one(scene, searches)) {
        }
        find_loads(scene, searches);
    } catch (const RunError&) {
        // The run itself tells it, after its finished frames.
    }
    return scene;
}

}  // namespace tumble
