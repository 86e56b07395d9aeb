#include "app/page/record_run.h"

#include "app/survey/survey.h"
#include "render/camera/camera_animation.h"
#include "scene/keys/settings.h"
#include "sim/world.h"

#include <utility>

namespace tumble {
namespace {

BodySample sample_of(const BodyState& state) {
    return {state.center_of_mass, state.orientation, state.velocity, state.angular_velocity, state.asleep};
}

EnergySample energy_of(const Measurement& measured, const EnergyLedger& ledger) {
    EnergySample energy;
    energy.kinetic_linear = measured.kinetic_linear;
    energy.kinetic_angular = measured.kinetic_angular;
    energy.potential = measured.potential;
    energy.work = ledger.work;
    energy.impact_loss = ledger.impact_loss;
    energy.friction_loss = ledger.friction_loss;
    energy.contacts = measured.contacts;
    energy.max_penetration = measured.max_penetration;
    return energy;
}

class RunObserver : public SurveyObserver {
public:
    RunObserver(PageRun& run, const std::function<void(std::int64_t)>& progress)
        : run_(run), camera_(run.scene.camera), scales_(run.scene), progress_(progress) {}

    bool needs_measurement() const override { return true; }

    void see(const Snapshot& snapshot, const Measurement& measured, const ContactRecords* records) override {
        for (std::size_t i = 0; i < snapshot.bodies.size(); ++i)
            if (run_.bodies[i].empty() || run_.scene.bodies[i].type != BodyType::fixed)
                run_.bodies[i].push_back(sample_of(snapshot.bodies[i]));
        if (run_.cameras.empty() || run_.scene.camera.moves()) run_.cameras.push_back(camera_.at(snapshot));
        run_.energy.push_back(energy_of(measured, records->energy));
        run_.impacts.insert(run_.impacts.end(), records->impacts.begin(), records->impacts.end());
        run_.contacts.push_back(records->contacts);
        run_.loads.push_back(records->loads);
        scales_.add(snapshot, records);
        if (progress_) progress_(std::int64_t(run_.energy.size()));
    }

    void finish() { run_.scales = scales_.scales(); }

private:
    PageRun& run_;
    CameraAnimation camera_;
    ScaleSurvey scales_;
    const std::function<void(std::int64_t)>& progress_;
};

std::string integrator_name(const SimulationSettings& simulation) {
    for (const auto& choice : integrator_choices(simulation.method))
        if (choice.value == simulation.integrator) return std::string(choice.name);
    return {};
}

}  // namespace

PageRun record_run(const SceneDescription& scene, const RecordSettings& settings, Interrupt& interrupt) {
    PageRun run;
    run.label = settings.label;
    run.scene = scene;
    run.integrator = integrator_name(scene.simulation);
    run.frames = scene.frame_count();
    run.bodies.resize(scene.bodies.size());
    World world(scene, settings.threads);
    world.record_contacts();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) run.reports.push_back(world.report(i));
    RunObserver observer(run, settings.progress);
    SurveyObserver* const observers[] = {&observer};
    survey(world, {run.frames, 1}, observers, interrupt);
    observer.finish();
    return run;
}

}  // namespace tumble
