#include "page/page_recorder.h"

#include "core/check.h"
#include "scene/fields/choices.h"
#include "sim/frames/clip_speed.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

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
    energy.work = ledger.work - ledger.water_loss;  // pages have no column of water
    energy.impact_loss = ledger.impact_loss;
    energy.friction_loss = ledger.friction_loss;
    energy.contacts = measured.contacts;
    energy.max_penetration = measured.max_penetration;
    return energy;
}

void keep_strongest(PageRun& run) {
    if (run.impacts.size() <= most_impacts) return;
    std::vector<double> impulses;
    for (const PageImpact& impact : run.impacts) impulses.push_back(impact.record.impulse);
    const auto last = impulses.begin() + std::ptrdiff_t(most_impacts);
    std::nth_element(impulses.begin(), last, impulses.end(), std::greater<>());
    std::erase_if(run.impacts, [&](const PageImpact& impact) { return impact.record.impulse <= *last; });
}

std::vector<Quantity> joint_quantities_of(const std::string& plot, const SceneDescription& scene) {
    if (plot.empty()) return {};
    std::vector<Quantity> quantities = parse_quantities(plot, scene);
    std::erase_if(quantities, [](const Quantity& quantity) { return !quantity.needs.joints; });
    return quantities;
}

PageRun started(const SceneDescription& scene, const PageRecording& recording, const World& world) {
    PageRun run;
    run.label = recording.label;
    run.scene = scene;
    run.integrator = name_of(scene.simulation.integrator);
    run.frames = scene.frame_count();
    if (!scene.speed.empty()) run.pace = frame_times(scene);
    run.bodies.resize(scene.bodies.size());
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) run.reports.push_back(world.report(i));
    return run;
}

}  // namespace

PageRecorder::PageRecorder(const SceneDescription& scene, const PageRecording& recording, const World& world)
    : run_(started(scene, recording, world)),
      camera_(run_.scene.camera),
      scales_(run_.scene),
      places_camera_later_(recording.places_camera_later),
      joint_quantities_(joint_quantities_of(recording.plot, run_.scene)),
      contacts_a_frame_(std::size_t(std::max<std::int64_t>(least_contacts, most_contacts / run_.frames))) {
    for (const Quantity& quantity : joint_quantities_) run_.joints.push_back({quantity.name, {}});
}

SurveyNeeds PageRecorder::needs() const {
    SurveyNeeds needs{.measurement = true};
    for (const Quantity& quantity : joint_quantities_) needs = needs | quantity.needs;
    return needs;
}

void PageRecorder::see(const Snapshot& snapshot, const Survey& survey, const ContactRecords* records) {
    add_bodies(snapshot);
    add_camera(snapshot);
    run_.energy.push_back(energy_of(survey.measurement, records->energy));
    add_impacts(*records);
    add_contacts(records->contacts);
    run_.loads.push_back(records->loads);
    if (!records->joints.empty()) run_.joint_states.push_back(records->joints);
    add_joints(snapshot, survey);
    scales_.add(snapshot, records);
}

void PageRecorder::add_camera(const Snapshot& snapshot) {
    if (frames() > 0 && !run_.scene.camera.moves()) return;
    if (places_camera_later_)
        snapshots_.push_back(snapshot);
    else
        run_.cameras.push_back(camera_.at(snapshot));
}

void PageRecorder::add_joints(const Snapshot& snapshot, const Survey& survey) {
    for (std::size_t k = 0; k < joint_quantities_.size(); ++k) {
        std::vector<double>& values = run_.joints[k].values;
        values.push_back(joint_quantities_[k].value({snapshot, survey}));
        if (joint_quantities_[k].mean_of_frame && values.size() == 2) values[0] = values[1];
    }
}

void PageRecorder::add_bodies(const Snapshot& snapshot) {
    for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
        std::vector<BodySample>& samples = run_.bodies[i].samples;
        std::vector<std::int64_t>& absent = run_.bodies[i].absent_from;
        if (snapshot.bodies[i].absent != (absent.size() % 2 == 1)) absent.push_back(std::int64_t(run_.energy.size()));
        if (samples.empty() || run_.scene.bodies[i].type != BodyType::fixed)
            samples.push_back(sample_of(snapshot.bodies[i]));
    }
}

void PageRecorder::add_impacts(const ContactRecords& records) {
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
    if (run_.impacts.size() > 4 * most_impacts) keep_strongest(run_);
}

/// The index of the body's event, which is added with the first impulse of an impact.
std::size_t PageRecorder::add_event(std::size_t index, const ImpactRecord& impact, const StruckBody& struck,
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
double PageRecorder::acting_time(const ImpactTime& when) const {
    return when.exact ? when.time : when.time - run_.scene.step();
}

void PageRecorder::add_contacts(std::vector<ContactRecord> contacts) {
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

PageRun PageRecorder::finish() {
    keep_strongest(run_);
    run_.scales = scales_.scales();
    return std::move(run_);
}

PageRun PageRecorder::so_far(const CameraDescription& placed) const {
    TUMBLE_CHECK_GT(snapshots_.size(), 0u);
    PageRun run = run_;
    run.frames = frames();
    if (std::cmp_less(run.frames, run.pace.size())) run.pace.resize(std::size_t(run.frames));
    keep_strongest(run);
    run.scene.camera = placed;
    const CameraAnimation camera(placed);
    for (const Snapshot& snapshot : snapshots_) run.cameras.push_back(camera.at(snapshot));
    run.scales = scales_.scales(placed);
    return run;
}

}  // namespace tumble
