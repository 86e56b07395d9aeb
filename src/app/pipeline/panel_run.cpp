#include "app/pipeline/panel_run.h"

#include "sim/checkpoint/archive.h"

namespace tumble {
namespace {

std::vector<std::byte> bytes_of(const CheckpointWriter& writer) {
    return {writer.bytes().begin(), writer.bytes().end()};
}

}  // namespace

PanelRun::PanelRun(const PanelSource& source, Shutter shutter) : source_(source) {
    if (source.recorded == nullptr) sequence_.emplace(*source.world, shutter, source.steps);
}

PanelPoses PanelRun::next(std::int64_t frame) {
    if (!runs(frame)) return last_;
    PanelPoses poses = sequence_ ? sequence_->next() : source_.recorded->next();
    if (frame + 1 == source_.end) last_.assign(1, poses.front());
    for (SurveyObserver* observer : source_.observers) observer->see(poses.front(), {}, records());
    if (source_.overlay != nullptr) write_bytes(source_.overlay->next(poses.front(), records()), shapes_);
    return poses;
}

Snapshot PanelRun::next_start() { return sequence_ ? sequence_->next_start() : source_.recorded->next_start(); }

const ContactRecords* PanelRun::records() const {
    return sequence_ ? sequence_->records() : source_.recorded->records();
}

PanelState PanelRun::save() const {
    PanelState state;
    CheckpointWriter simulation;
    source_.world->save(simulation);
    simulation.keep(*sequence_);
    state.simulation = bytes_of(simulation);
    if (source_.overlay == nullptr) return state;
    CheckpointWriter overlay;
    overlay.keep(*source_.overlay);
    state.overlay = bytes_of(overlay);
    return state;
}

void PanelRun::restore(const PanelState& state, std::int64_t frame) {
    if (sequence_) {
        CheckpointReader reader(state.simulation);
        source_.world->restore(reader);
        reader.keep(*sequence_);
        if (!reader.at_end()) CheckpointReader::fail("is longer than its content");
    }
    if (source_.overlay != nullptr) {
        CheckpointReader reader(state.overlay);
        reader.keep(*source_.overlay);
        if (!reader.at_end()) CheckpointReader::fail("is longer than its content");
    }
    if (!runs(frame)) next(source_.end - 1);
}

}  // namespace tumble
