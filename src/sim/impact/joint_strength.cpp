#include "sim/impact/joint_strength.h"

#include <algorithm>

namespace tumble {
namespace {

// The changes by an impact.
struct Outcome {
    int passes = 0;
    std::vector<Contact> contacts;         // of the island
    std::vector<BodyVelocity> velocities;  // by body of the island
    std::vector<JointImpulse> joint_impulses;
    ImpactTrace trace;
};

double mix(double from, double to, double share) { return from + share * (to - from); }
Vec3 mix(const Vec3& from, const Vec3& to, double share) { return from + share * (to - from); }

// Both traces together: the impulses of each contact add up to its own.
void mix_traces(const ImpactTrace& weak, const ImpactTrace& strong, double share, ImpactTrace& trace) {
    trace = {};
    const auto add = [&](const ImpactTrace& part, double factor) {
        for (ImpactTrace::Entry entry : part.entries) {
            entry.impulse *= factor;
            entry.pass += trace.passes;
            trace.entries.push_back(entry);
        }
        trace.passes += part.passes;
    };
    add(weak, 1.0 - share);
    add(strong, share);
}

}  // namespace

void drop_loose_gears(Island& island) {
    std::erase_if(island.joints, [&](const Joint* gear) {
        return gear->gear() && std::ranges::any_of(gear->description.geared, [&](std::size_t k) {
                   return std::ranges::find(island.joints, &island.all_joints[k]) == island.joints.end();
               });
    });
}

int resolve_breaking(const Island& island, std::vector<Contact>& contacts, std::vector<Body>& bodies,
                     const ImpactSettings& settings, ImpactTrace* trace, std::vector<JointImpulse>& joint_impulses,
                     std::vector<Joint*>& broken) {
    const int passes = resolve_impacts(island, contacts, bodies, settings, trace, &joint_impulses);
    double most = 1.0;
    Island weaker = island;
    for (const JointImpulse& impulse : joint_impulses) {
        const double over = impulse.over(settings.span);
        if (!(over > 1.0)) continue;
        most = std::max(most, over);
        if (std::erase(weaker.joints, impulse.joint) > 0) broken.push_back(impulse.joint);
    }
    drop_loose_gears(weaker);
    if (most == 1.0) return passes;
    const double share = 1.0 / most;
    Outcome strong;
    strong.joint_impulses = joint_impulses;
    if (trace) strong.trace = *trace;
    for (const std::uint32_t k : island.bodies) {
        strong.velocities.push_back({bodies[k].velocity, bodies[k].angular_velocity});
        bodies[k].derive_velocities();
    }
    for (const std::uint32_t k : island.contacts) {
        strong.contacts.push_back(contacts[k]);
        contacts[k].impact = contacts[k].bounce_velocity = 0.0;
        contacts[k].impact_friction.setZero();
    }
    if (trace) *trace = {};
    joint_impulses.clear();
    const int passes_without = resolve_breaking(weaker, contacts, bodies, settings, trace, joint_impulses, broken);
    for (std::size_t i = 0; i < island.contacts.size(); ++i) {
        Contact& c = contacts[island.contacts[i]];
        const Contact& other = strong.contacts[i];
        c.impact = mix(c.impact, other.impact, share);
        c.impact_friction = mix(c.impact_friction, other.impact_friction, share);
        c.bounce_velocity = mix(c.bounce_velocity, other.bounce_velocity, share);
    }
    for (std::size_t i = 0; i < island.bodies.size(); ++i) {
        Body& body = bodies[island.bodies[i]];
        body.velocity = mix(body.velocity, strong.velocities[i].velocity, share);
        body.angular_velocity = mix(body.angular_velocity, strong.velocities[i].angular_velocity, share);
    }
    for (JointImpulse& impulse : strong.joint_impulses) {
        const auto weak = std::find_if(joint_impulses.begin(), joint_impulses.end(), [&](const JointImpulse& other) {
            return other.joint == impulse.joint && other.second == impulse.second;
        });
        const JointImpulse none;
        const JointImpulse& other = weak == joint_impulses.end() ? none : *weak;
        impulse.force = mix(other.force, impulse.force, share);
        impulse.torque = mix(other.torque, impulse.torque, share);
        impulse.lost = mix(other.lost, impulse.lost, share);
    }
    joint_impulses = std::move(strong.joint_impulses);
    for (JointImpulse& impulse : joint_impulses) {
        find_work(impulse, bodies);
        impulse.breaks = std::find(broken.begin(), broken.end(), impulse.joint) != broken.end();
    }
    if (trace) mix_traces(ImpactTrace(*trace), strong.trace, share, *trace);
    return std::max(passes, passes_without);
}

}  // namespace tumble
