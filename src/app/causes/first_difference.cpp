#include "app/causes/first_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace tumble {
namespace {

constexpr std::int64_t farthest_late = 10;  // frames

std::vector<std::size_t> moving_indices(const PanelRecord& panel, std::size_t& count) {
    std::vector<std::size_t> indices;
    for (const RecordedBody& body : panel.bodies) indices.push_back(body.moves ? count++ : 0);
    return indices;
}

/// A contact as the body has it.
struct OwnContact {
    float time, impulse;
    std::string_view other;
    friend bool operator==(const OwnContact&, const OwnContact&) = default;
};

std::vector<OwnContact> contacts_of(const PanelRecord& panel, std::size_t body) {
    std::vector<OwnContact> own;
    for (const RecordedContact& c : panel.contacts)
        if (c.a == body || c.b == body) own.push_back({c.time, c.impulse, panel.bodies[c.a == body ? c.b : c.a].name});
    return own;
}

}  // namespace

FirstDifferences::FirstDifferences(const PanelRecord& before, const PanelRecord& after)
    : before_(before),
      after_(after),
      moving_before_(moving_indices(before, count_before_)),
      moving_after_(moving_indices(after, count_after_)) {}

std::optional<std::int64_t> FirstDifferences::frame(std::size_t before, std::size_t after) const {
    const MotionTrace &a = before_.trace, &b = after_.trace;
    if (!before_.bodies[before].moves || !after_.bodies[after].moves) return 0;
    if (a.every != b.every || count_before_ == 0 || count_after_ == 0) return std::nullopt;
    const std::size_t blocks = std::min(a.blocks.size() / count_before_, b.blocks.size() / count_after_);
    for (std::size_t i = 0; i < blocks; ++i)
        if (a.blocks[i * count_before_ + moving_before_[before]] != b.blocks[i * count_after_ + moving_after_[after]])
            return std::int64_t(i) * a.every;
    return std::nullopt;
}

std::optional<double> FirstDifferences::contact(std::size_t before, std::size_t after) const {
    const std::vector<OwnContact> a = contacts_of(before_, before), b = contacts_of(after_, after);
    const auto [x, y] = std::ranges::mismatch(a, b);
    if (x == a.end() && y == b.end()) return std::nullopt;
    if ((x == a.end() && !before_.all_contacts) || (y == b.end() && !after_.all_contacts)) return std::nullopt;
    if (x == a.end()) return y->time;
    if (y == b.end()) return x->time;
    return std::min(x->time, y->time);
}

std::string FirstDifferences::text(std::size_t before, std::size_t after, double seconds) const {
    std::string parts;
    if (const auto first = frame(before, after)) parts = fmt::format("first differing frame {}", *first);
    if (const auto time = contact(before, after); time && *time <= seconds)
        parts += fmt::format("{}first differing contact at {:.2f} s", parts.empty() ? "" : ", ", *time);
    return parts.empty() ? "" : fmt::format(" ({})", parts);
}

std::optional<std::int64_t> frames_late(const PanelRecord& before, const PanelRecord& after, std::int64_t frame) {
    const std::vector<std::uint32_t>&a = before.trace.frames, &b = after.trace.frames;
    const auto at = std::size_t(frame);
    if (at >= a.size() || at >= b.size() || a[at] == b[at]) return std::nullopt;
    for (std::int64_t late = 1; late <= farthest_late; ++late)
        for (const std::int64_t shift : {late, -late}) {
            const std::int64_t other = frame - shift;
            if (other >= 0 && std::size_t(other) < a.size() && a[std::size_t(other)] == b[at]) return shift;
        }
    return std::nullopt;
}

}  // namespace tumble
