// Frames of a panel that are simulated already.
#pragma once

#include "sim/snapshot/contact_records.h"
#include "sim/snapshot/snapshot.h"

#include <vector>

namespace tumble {

class SimulatedFrames {
public:
    virtual ~SimulatedFrames() = default;
    // As of FrameSequence.
    virtual std::vector<Snapshot> next() = 0;
    virtual Snapshot next_start() = 0;
    virtual const ContactRecords* records() const = 0;
};

}  // namespace tumble
