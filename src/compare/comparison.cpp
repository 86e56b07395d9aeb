#include "compare/comparison.h"

namespace tumble {

std::string_view name_of(Verdict verdict) {
    constexpr std::array<std::string_view, verdict_count> names{"same",    "alike", "different",
                                                                "missing", "added", "broken"};
    return names[std::size_t(verdict)];
}

std::array<std::int64_t, verdict_count> SetResult::counts() const {
    std::array<std::int64_t, verdict_count> numbers{};
    for (const ImageResult& result : images) ++numbers[std::size_t(result.verdict)];
    return numbers;
}

int SetResult::exit_code() const {
    if (count(Verdict::broken) > 0) return 2;
    if (count(Verdict::missing) > 0) return 3;
    if (count(Verdict::different) > 0) return 1;
    return count(Verdict::added) > 0 && !added_allowed ? 1 : 0;
}

}  // namespace tumble
