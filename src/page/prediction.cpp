#include "page/prediction.h"

#include "page/array_store.h"

#include <bit>
#include <vector>

namespace tumble {
namespace {

constexpr int highest_order = 3;

void take_differences(std::span<std::int64_t> channel) {
    for (std::size_t i = channel.size(); i-- > 1;) channel[i] -= channel[i - 1];
}

/// Bits of the numbers, roughly.
std::int64_t cost(std::span<const std::int64_t> channel) {
    std::int64_t bits = 0;
    for (const std::int64_t value : channel) bits += std::bit_width(zigzag(value));
    return bits;
}

}  // namespace

int predict(std::span<std::int64_t> channel) {
    std::vector<std::int64_t> differences(channel.begin(), channel.end());
    int best = 0;
    std::int64_t least = cost(channel);
    for (int order = 1; order <= highest_order; ++order) {
        take_differences(differences);
        if (const std::int64_t bits = cost(differences); bits < least) {
            least = bits;
            best = order;
        }
    }
    for (int order = 0; order < best; ++order) take_differences(channel);
    return best;
}

}  // namespace tumble
