#include "compare/comparison.h"

#include <algorithm>

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

bool SetResult::fails(Verdict verdict) const {
    return verdict != Verdict::same && verdict != Verdict::alike && !(verdict == Verdict::added && added_allowed);
}

int SetResult::exit_code() const {
    for (const Verdict verdict : worst_first)
        if (std::ranges::any_of(images, [&](const auto& result) { return result.verdict == verdict && fails(result); }))
            return verdict == Verdict::broken ? 2 : verdict == Verdict::missing ? 3 : 1;
    return 0;
}

void forget_files_in(const std::filesystem::path& folder, SetResult& result) {
    for (ImageResult& image : result.images)
        for (std::filesystem::path* file : {&image.reference, &image.image})
            if (std::mismatch(folder.begin(), folder.end(), file->begin(), file->end()).first == folder.end())
                file->clear();
}

}  // namespace tumble
