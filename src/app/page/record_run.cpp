#include "app/page/record_run.h"

#include "app/plots/plotted_run.h"
#include "core/error.h"
#include "framing/motion_camera.h"
#include "render/camera/camera_animation.h"
#include "scene/fields/choices.h"
#include "sim/frames/clip_speed.h"
#include "sim/world.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

namespace tumble {
namespace {

constexpr std::size_t no_event = SIZE_MAX;
// A page with more impacts, or more contacts in a frame, has the strongest ones: they take most of its bytes, and a
// reader follows a few.
constexpr std::size_t most_impacts = 1500;
constexpr std::int64_t most_contacts = 22000, least_contacts = 40;  // of all frames; of a frame
constexpr std::size_t most_events = 300;                            // of a body

BodySample sample_of(const BodyState& state) {
    return {state.center_of_mass, state.orientation, state.velocity, state.angular_velocity, state.asleep};
}

EnergySample energy_of(const Measurement& measured, const EnergyLedger& ledger) {
    EnergySample energy;
    energy.kinetic_linear = measured.kinetic_linear;
    energy.kinetic_angular = measured.kinetic_angular;
    energy.potential = measured.potential;
    energy.elastic = measured.elastic;
    energy.work = ledger.work;
    energy.impact_loss = ledger.impact_loss;
    energy.friction_loss = ledger.friction_loss;
    energy.contacts = measured.contacts;
    energy.max_penetration = measured.max_penetration;
    return energy;
}

/// Keeps what a page has room for.
class RunObserver : public SurveyObserver {
public:
    RunObserver(PageRun& run, const std::function<void(std::int64_t)>& progress)
        : run_(run),
          camera_(run.scene.camera),
          scales_(run.scene),
          progress_(progress),
          contacts_a_frame_(std::size_t(std::max<std::int64_t>(least_contacts, most_contacts / run.frames))) {}

    SurveyNeeds needs() const override { return {.measurement = true}; }
    void see(const Snapshot& snapshot, const Survey& survey, const ContactRecords* records) override;
    void finish();

private:
    void add_bodies(const Snapshot& snapshot);
    void add_impacts(const ContactRecords& records);
    void add_contacts(std::vector<ContactRecord> contacts);
    std::size_t add_event(std::size_t body, const ImpactRecord& impact, const StruckBody& struck, std::size_t& event);
    double acting_time(const ImpactTime& when) const;
    void keep_strongest_impacts();

    PageRun& run_;
    CameraAnimation camera_;
    ScaleSurvey scales_;
    const std::function<void(std::int64_t)>& progress_;
    std::size_t contacts_a_frame_;
    std::vector<std::size_t> events_;  // of the frame, by struck body: the body's event
};

void RunObserver::see(const Snapshot& snapshot, const Survey& survey, const ContactRecords* records) {
    add_bodies(snapshot);
    if (run_.cameras.empty() || run_.scene.camera.moves()) run_.cameras.push_back(camera_.at(snapshot));
    run_.energy.push_back(energy_of(survey.measurement, records->energy));
    add_impacts(*records);
    add_contacts(records->contacts);
    run_.loads.push_back(records->loads);
    if (!records->joints.empty()) run_.joint_states.push_back(records->joints);
    scales_.add(snapshot, records);
    if (progress_) progress_(std::int64_t(run_.energy.size()));
}

void RunObserver::add_bodies(const Snapshot& snapshot) {
    for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
        std::vector<BodySample>& samples = run_.bodies[i].samples;
        if (samples.empty() || run_.scene.bodies[i].type != BodyType::fixed)
            samples.push_back(sample_of(snapshot.bodies[i]));
    }
}

void RunObserver::add_impacts(const ContactRecords& records) {
    events_.assign(records.struck.size(), no_event);
    const std::size_t first = run_.impacts.size();
    for (const ImpactRecord& r : records.impacts) run_.impacts.push_back({r, no_event, no_event});
    std::vector<std::size_t> acting(records.impacts.size());
    std::iota(acting.begin(), acting.end(), first);
    std::ranges::stable_sort(acting, {}, [&](std::size_t i) { return acting_time(run_.impacts[i].record.when); });
    for (const std::size_t i : acting) {
        PageImpact& impact = run_.impacts[i];
        const ImpactRecord& r = impact.record;
        impact.event_a = add_event(r.a, r, records.struck[r.struck_a], events_[r.struck_a]);
        impact.event_b = add_event(r.b, r, records.struck[r.struck_b], events_[r.struck_b]);
    }
    run_.all_impacts += std::int64_t(records.impacts.size());
    if (run_.impacts.size() > 4 * most_impacts) keep_strongest_impacts();
}

/// The index of the body's event, which is added with the first impulse of an impact.
std::size_t RunObserver::add_event(std::size_t index, const ImpactRecord& impact, const StruckBody& struck,
                                   std::size_t& event) {
    BodyRecord& body = run_.bodies[index];
    if (event != no_event || run_.scene.bodies[index].type == BodyType::fixed || !body.all_events) return event;
    if (body.events.size() == most_events) {
        body.all_events = false;
        return no_event;
    }
    event = body.events.size();
    body.events.push_back({acting_time(impact.when), struck, impact.when.exact});
    return event;
}

/// When the impulse of an impact acts, s: at its time, or at the start of the step that resolves it.
double RunObserver::acting_time(const ImpactTime& when) const {
    return when.exact ? when.time : when.time - run_.scene.step();
}

void RunObserver::add_contacts(std::vector<ContactRecord> contacts) {
    run_.all_contacts += std::int64_t(contacts.size());
    if (contacts.size() > contacts_a_frame_) {
        std::vector<double> forces;
        for (const ContactRecord& contact : contacts) forces.push_back(contact.normal_force);
        const auto last = forces.begin() + std::ptrdiff_t(contacts_a_frame_);
        std::nth_element(forces.begin(), last, forces.end(), std::greater<>());
        std::erase_if(contacts, [&](const ContactRecord& contact) { return contact.normal_force <= *last; });
    }
    run_.contacts.push_back(std::move(contacts));
}

void RunObserver::keep_strongest_impacts() {
    if (run_.impacts.size() <= most_impacts) return;
    std::vector<double> impulses;
    for (const PageImpact& impact : run_.impacts) impulses.push_back(impact.record.impulse);
    const auto last = impulses.begin() + std::ptrdiff_t(most_impacts);
    std::nth_element(impulses.begin(), last, impulses.end(), std::greater<>());
    std::erase_if(run_.impacts, [&](const PageImpact& impact) { return impact.record.impulse <= *last; });
}

void RunObserver::finish() {
    keep_strongest_impacts();
    run_.scales = scales_.scales();
}

std::vector<Quantity> joint_quantities_of(const std::string& plot, const SceneDescription& scene) {
    if (plot.empty()) return {};
    std::vector<Quantity> quantities = parse_quantities(plot, scene);
    std::erase_if(quantities, [](const Quantity& quantity) { return !quantity.needs.joints; });
    return quantities;
}

}  // namespace

PageRun record_run(const SceneDescription& unframed, const RecordSettings& settings, Interrupt& interrupt) {
    const SceneDescription scene = framed(unframed, settings.threads, [&] {
        if (interrupt.pending()) throw Interrupted();
    });
    PageRun run;
    run.label = settings.label;
    run.scene = scene;
    run.integrator = name_of(scene.simulation.integrator);
    run.frames = scene.frame_count();
    if (!scene.speed.empty()) run.pace = frame_times(scene);
    run.bodies.resize(scene.bodies.size());
    World world(scene, settings.threads);
    world.record_contacts();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) run.reports.push_back(world.report(i));
    RunObserver observer(run, settings.progress);
    PlottedRun joints("", joint_quantities_of(settings.plot, scene));
    std::vector<SurveyObserver*> observers{&observer, &joints};
    observers.insert(observers.end(), settings.observers.begin(), settings.observers.end());
    survey(world, {run.frames, 1}, observers, interrupt);
    observer.finish();
    for (std::size_t k = 0; k < joints.quantities.size(); ++k)
        run.joints.push_back({joints.quantities[k].name, std::move(joints.values[k])});
    return run;
}

}  // namespace tumble
