#include "app/checkpoints/checkpoint_identity.h"

#include "core/safe_text.h"

#include <fmt/format.h>

namespace tumble {

std::string difference(const CheckpointIdentity& there, const CheckpointIdentity& here) {
    for (const auto& [name, own] : here) {
        const std::string* const found = find_value(there, name);
        const std::string other = found == nullptr ? "none" : *found;
        if (other != own) return fmt::format("{}: {} there, {} here", name, safe_text(other), safe_text(own));
    }
    return there.size() == here.size() ? "" : "the number of settings";
}

}  // namespace tumble
