#include "app/pipeline/panel_run.h"

#include "sim/checkpoint/archive.h"

namespace tumble {

PanelRun::PanelRun(const PanelSource& source, Shutter shutter)
    : world_(source.world), sequence_(source.world, shutter), end_(source.end), overlay_(source.overlay) {}

PanelPoses PanelRun::next(std::int64_t frame) {
    if (!runs(frame)) return last_;
    PanelPoses poses = sequence_.next();
    if (frame + 1 == end_) last_.assign(1, poses.front());
    if (overlay_ != nullptr) write_bytes(overlay_->next(poses.front(), sequence_.records()), shapes_);
    return poses;
}

std::vector<std::byte> PanelRun::save() const {
    CheckpointWriter writer;
    world_.save(writer);
    writer.keep(sequence_, overlay_ != nullptr);
    if (overlay_ != nullptr) writer.keep(*overlay_);
    return {writer.bytes().begin(), writer.bytes().end()};
}

void PanelRun::restore(std::span<const std::byte> state, std::int64_t frame) {
    CheckpointReader reader(state);
    world_.restore(reader);
    bool overlay = false;
    reader.keep(sequence_, overlay);
    if (!overlay && overlay_ != nullptr) CheckpointReader::fail("has no state of the overlay");
    if (overlay_ != nullptr) {
        reader.keep(*overlay_);
        if (!reader.at_end()) CheckpointReader::fail("is longer than its content");
    }
    if (!runs(frame)) next(end_ - 1);
}

}  // namespace tumble
