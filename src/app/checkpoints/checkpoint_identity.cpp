#include "app/checkpoints/checkpoint_identity.h"

#include "core/safe_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble {

std::string difference(const CheckpointIdentity& there, const CheckpointIdentity& here) {
    for (const ClipSetting& own : here) {
        const auto other =
            std::find_if(there.begin(), there.end(), [&](const ClipSetting& s) { return s.name == own.name; });
        const std::string value = other == there.end() ? "none" : other->value;
        if (value != own.value)
            return fmt::format("{}: {} there, {} here", own.name, safe_text(value), safe_text(own.value));
    }
    return there.size() == here.size() ? "" : "the number of settings";
}

}  // namespace tumble
