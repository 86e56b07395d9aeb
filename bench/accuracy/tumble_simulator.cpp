// Tumble under test, in process.
#include "accuracy/program.h"
#include "sim/world.h"

namespace {

using namespace tumble;
using bench::Demand;

constexpr unsigned flights = 1u << int(Demand::flight), impacts = 1u << int(Demand::impact) | 1u << int(Demand::crowd);
constexpr unsigned walls = 1u << int(Demand::thin_wall);
constexpr unsigned handed_on = 1u << int(Demand::row_propagating), newton = 1u << int(Demand::row_simultaneous);

// Every integrator and impact mode that World offers, and what it is asked to do: one line each.
struct Way {
    const char* name;
    IntegratorKind integrator;
    ImpactMode mode;
    ImpactLaw law;
    unsigned demands;
};
constexpr Way ways[] = {
    {"explicit-euler", IntegratorKind::explicit_euler, ImpactMode::stepped, ImpactLaw::propagating, flights | impacts},
    {"symplectic-euler", IntegratorKind::symplectic_euler, ImpactMode::stepped, ImpactLaw::propagating,
     flights | impacts | walls | handed_on},
    {"symplectic-euler, simultaneous", IntegratorKind::symplectic_euler, ImpactMode::stepped, ImpactLaw::simultaneous,
     newton},
    {"splitting", IntegratorKind::splitting, ImpactMode::stepped, ImpactLaw::propagating, flights | impacts},
    {"rk4", IntegratorKind::runge_kutta_4, ImpactMode::stepped, ImpactLaw::propagating, flights | impacts},
    {"exact", IntegratorKind::exact, ImpactMode::stepped, ImpactLaw::propagating, flights | impacts | walls},
    {"exact + exact impacts", IntegratorKind::exact, ImpactMode::exact, ImpactLaw::propagating,
     flights | impacts | walls | handed_on},
    {"exact + exact impacts, simultaneous", IntegratorKind::exact, ImpactMode::exact, ImpactLaw::simultaneous, newton},
};

Vec3 vec(const bench::Vector& v) { return {v.x, v.y, v.z}; }
bench::Vector vector(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

BodyDescription described(const bench::Body& body, std::size_t index) {
    BodyDescription d;
    d.name = std::to_string(index);
    if (!body.moves()) d.type = BodyType::fixed;
    switch (body.kind) {
        case bench::Kind::plane:
            d.shape = PlaneShape{vec(body.normal), body.offset};
            break;
        case bench::Kind::box:
            d.shape = BoxShape{vec(body.size)};
            break;
        case bench::Kind::sphere:
            d.shape = SphereShape{body.radius};
            break;
    }
    if (body.moves()) d.mass = body.mass;
    d.restitution = body.restitution;
    d.position = vec(body.position);
    d.rotation = Quat(body.orientation.w, body.orientation.x, body.orientation.y, body.orientation.z);
    d.velocity = vec(body.velocity);
    d.angular_velocity = vec(body.angular_velocity);
    return d;
}

SceneDescription described(const bench::Scene& scene, double rate, const Way& way) {
    SceneDescription d;
    d.output.fps = rate;  // a frame a step, so that step-free ways get no more help from frames than from steps
    d.simulation.steps_per_frame = 1;
    d.simulation.gravity = Vec3(0.0, 0.0, -scene.gravity);
    d.simulation.integrator = way.integrator;
    d.simulation.impacts = way.mode;
    d.simulation.impact_law = way.law;
    d.simulation.sleep = false;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) d.bodies.push_back(described(scene.bodies[i], i));
    if (scene.air) d.wind = WindDescription{vec(scene.air->velocity), scene.air->density, scene.air->drag};
    if (scene.push)
        d.forces.push_back(
            {0, vec(scene.push->point), vec(scene.push->force), true, 0.0, std::numeric_limits<double>::infinity()});
    return d;
}

class TumbleSimulator : public bench::Simulator {
public:
    TumbleSimulator(const bench::Scene& scene, double rate, const Way& way) : world_(described(scene, rate, way)) {}

    void step() override {
        world_.advance_frame();
        fresh_ = false;
    }

    bench::Motion motion(std::size_t body) const override {
        if (!fresh_) snapshot_ = world_.snapshot();
        fresh_ = true;
        const BodyState& s = snapshot_.bodies[body];
        const Quat& q = s.orientation;
        return {vector(s.center_of_mass), {q.w(), q.x(), q.y(), q.z()}, vector(s.velocity), vector(s.angular_velocity)};
    }

private:
    World world_;
    mutable Snapshot snapshot_;
    mutable bool fresh_ = false;
};

}  // namespace

int main(int argc, char** argv) {
    std::vector<bench::Variant> variants;
    for (const Way& way : ways) {
        variants.push_back({way.name, [&way](Demand demand) { return (way.demands >> int(demand) & 1u) != 0; },
                            [&way](const bench::Scene& scene, double rate) -> std::unique_ptr<bench::Simulator> {
                                return std::make_unique<TumbleSimulator>(scene, rate, way);
                            },
                            way.mode == ImpactMode::exact});
    }
    return bench::run_accuracy(argc, argv, "Tumble", variants);
}
