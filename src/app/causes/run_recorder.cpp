#include "app/causes/run_recorder.h"

#include "core/fnv_hash.h"

#include <algorithm>
#include <iterator>

namespace tumble {
namespace {

constexpr std::size_t trace_bytes = 8 << 10;  // of a panel's blocks
constexpr std::size_t most_contacts = 256;    // of a panel: the first ones tell where two runs part

/// The bytes of the pose decide: one digit of any number is a difference.
std::uint32_t pose_digest(const BodyState& body, std::uint32_t before) {
    const Quat& q = body.orientation;
    const double numbers[] = {body.origin.x(), body.origin.y(), body.origin.z(), q.w(), q.x(), q.y(), q.z()};
    const std::uint64_t sum = fnv_hash(std::as_bytes(std::span(numbers)), fnv_start ^ before);
    return std::uint32_t(sum ^ (sum >> 32));
}

RecordedView view_of(const CameraDescription& camera) {
    return {camera.eye, camera.target, camera.up, camera.vertical_fov};
}

}  // namespace

PanelRecorder::PanelRecorder(const ClipPanel& panel, const std::vector<std::int64_t>& frames, std::int64_t length)
    : camera_(panel.scene->camera), frames_(frames) {
    const SceneDescription& scene = *panel.scene;
    record_.place = panel.place;
    record_.values = values_of(scene);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const BodyDescription& body = scene.bodies[i];
        BodyKind kind = kind_of(scene, body);
        const auto known = std::ranges::find(record_.kinds, kind);
        const auto index = std::size_t(known - record_.kinds.begin());
        if (known == record_.kinds.end()) record_.kinds.push_back(std::move(kind));
        const bool moves = body.type == BodyType::dynamic || !body.keyframes.empty();
        record_.bodies.push_back({body.name, index, moves});
        if (moves) moving_.push_back(i);
    }
    const std::size_t bytes = sizeof(std::uint16_t) * moving_.size() * std::size_t(std::max<std::int64_t>(length, 1));
    record_.trace.every = int((bytes + trace_bytes - 1) / trace_bytes);
    record_.trace.every = std::max(record_.trace.every, 1);
    blocks_.assign(moving_.size(), 0);
}

void PanelRecorder::see(const Snapshot& snapshot, const Survey&, const ContactRecords* records) {
    if (next_ == 0)
        for (const BodyState& body : snapshot.bodies) record_.start.push_back({body.origin, body.orientation});
    add_trace(snapshot);
    if (records != nullptr) add_contacts(snapshot, *records);
    if (next_recorded_ < frames_.size() && frames_[next_recorded_] == next_) {
        add_pose(snapshot);
        ++next_recorded_;
    }
    ++next_;
    last_ = snapshot;
}

void PanelRecorder::add_pose(const Snapshot& snapshot) {
    record_.times.push_back(snapshot.time);
    record_.views.push_back(view_of(camera_.at(snapshot)));
    std::vector<RecordedPose>& poses = record_.poses.emplace_back();
    for (const std::size_t i : moving_) poses.push_back({snapshot.bodies[i].origin, snapshot.bodies[i].orientation});
}

void PanelRecorder::add_trace(const Snapshot& snapshot) {
    std::uint32_t all = 0;
    for (std::size_t k = 0; k < moving_.size(); ++k) {
        const BodyState& body = snapshot.bodies[moving_[k]];
        all = pose_digest(body, all);
        blocks_[k] = pose_digest(body, blocks_[k]);
    }
    record_.trace.frames.push_back(all);
    if ((next_ + 1) % record_.trace.every != 0) return;
    for (std::uint32_t& block : blocks_) {
        record_.trace.blocks.push_back(std::uint16_t(block ^ (block >> 16)));
        block = 0;
    }
}

void PanelRecorder::add_contacts(const Snapshot& snapshot, const ContactRecords& records) {
    std::vector<RecordedContact> found;
    for (const ImpactRecord& impact : records.impacts)
        if (impact.impulse > 0.0)
            found.push_back(
                {float(impact.when.time), std::uint32_t(impact.a), std::uint32_t(impact.b), float(impact.impulse)});
    std::vector<std::pair<std::size_t, std::size_t>> touching;
    for (const ContactRecord& contact : records.contacts)
        if (contact.a != ContactRecord::nobody) touching.emplace_back(contact.a, contact.b);
    std::ranges::sort(touching);
    touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
    std::vector<std::pair<std::size_t, std::size_t>> begun;
    std::ranges::set_difference(touching, touching_, std::back_inserter(begun));
    for (const auto& [a, b] : begun) found.push_back({float(snapshot.time), std::uint32_t(a), std::uint32_t(b), 0.0f});
    touching_ = std::move(touching);
    std::ranges::stable_sort(found, {}, &RecordedContact::time);
    for (const RecordedContact& contact : found) {
        if (record_.contacts.size() == most_contacts) record_.all_contacts = false;
        if (!record_.all_contacts) return;
        record_.contacts.push_back(contact);
    }
}

PanelRecord PanelRecorder::finish() {
    for (; next_recorded_ < frames_.size() && next_ > 0; ++next_recorded_) add_pose(last_);
    return std::move(record_);
}

RunRecorder::RunRecorder(const Composition& composition, std::vector<std::int64_t> frames, std::int64_t length) {
    record_.values = values_of(composition);
    record_.frames = std::move(frames);
    for (const ClipPanel& panel : composition.panels) panels_.emplace_back(panel, record_.frames, length);
}

RunRecorder::RunRecorder(const std::vector<SceneDescription>& runs) {
    record_.frames = {0};
    record_.whole_run = true;
    for (const SceneDescription& run : runs)
        panels_.emplace_back(Composition(run).panels.front(), record_.frames, run.frame_count());
}

MotionRecord RunRecorder::finish() {
    for (PanelRecorder& panel : panels_) record_.panels.push_back(panel.finish());
    return std::move(record_);
}

}  // namespace tumble
