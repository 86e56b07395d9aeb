#include "app/farm/farm_status.h"

#include "app/farm/shell_text.h"
#include "app/files/frame_folder.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <fstream>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// The first and the last bytes: a file that the loss of a machine has cut short or left empty is found, at the cost of two
/// reads. The job that makes the clip decodes every frame.
bool looks_whole(const fs::path& frame) {
    constexpr std::array<char, 8> signature{'\x89', 'P', 'N', 'G', '\r', '\n', '\x1a', '\n'};
    constexpr std::array<char, 8> end{'I', 'E', 'N', 'D', '\xae', 'B', '`', '\x82'};
    std::ifstream file(frame, std::ios::binary);
    std::array<char, 8> found{};
    if (!file.read(found.data(), found.size()) || found != signature) return false;
    return file.seekg(-std::streamoff(end.size()), std::ios::end) && file.read(found.data(), found.size()) &&
           found == end;
}

/// "48-51,60", shortened where it is long.
std::string list_of_frames(const std::vector<std::int64_t>& numbers) {
    constexpr std::size_t longest = 60;
    std::string list;
    for (std::size_t i = 0; i < numbers.size();) {
        std::size_t end = i + 1;
        while (end < numbers.size() && numbers[end] == numbers[end - 1] + 1) ++end;
        if (list.size() > longest) return list + ",...";
        list += fmt::format("{}{}", list.empty() ? "" : ",", numbers[i]);
        if (end - i > 1) list += fmt::format("-{}", numbers[end - 1]);
        i = end;
    }
    return list;
}

}  // namespace

std::vector<int> FarmStatus::incomplete() const {
    std::vector<int> numbers;
    for (std::size_t i = 0; i < missing.size(); ++i)
        if (!missing[i].empty()) numbers.push_back(int(i) + 1);
    return numbers;
}

FarmStatus look_at_farm(const FarmJob& job) {
    const fs::path folder = frames_folder(job.folder);
    FarmStatus status;
    for (const FarmPart& part : job.parts) {
        std::vector<std::int64_t>& missing = status.missing.emplace_back();
        for (std::int64_t frame = part.first; frame <= part.last; ++frame)
            if (!looks_whole(frame_path(folder, frame))) missing.push_back(frame);
        status.drawn += part.count() - std::int64_t(missing.size());
    }
    return status;
}

std::string status_text(const FarmJob& job, const FarmStatus& status) {
    const std::vector<int> incomplete = status.incomplete();
    std::string text = fmt::format("{} of {} parts are complete, {} of {} frames\n",
                                   job.parts.size() - incomplete.size(), job.parts.size(), status.drawn, job.frames);
    for (const int number : incomplete) {
        const FarmPart& part = job.parts[std::size_t(number) - 1];
        const std::vector<std::int64_t>& missing = status.missing[std::size_t(number) - 1];
        text += fmt::format("part {} (frames {}): {} of {} frames are missing: {}\n", number, part.range(),
                            missing.size(), part.count(), list_of_frames(missing));
    }
    const auto script = [&](const char* name) {
        return safe_text(shell_word((job.folder / name).string()), path_text_bytes);
    };
    if (!incomplete.empty()) {
        text +=
            fmt::format("To draw them again on the cluster:  bash {} {}\n", script("submit.sh"), part_list(incomplete));
        text += fmt::format("or here:  for part in {}; do bash {} $part; done; bash {}\n", fmt::join(incomplete, " "),
                            script("frames.sh"), script("stitch.sh"));
        return text;
    }
    std::error_code ignored;
    if (fs::exists(job.clip, ignored))
        text += fmt::format("the clip is written: {}\n", safe_path(job.clip));
    else
        text += fmt::format("the clip is not written yet: bash {}\n", script("stitch.sh"));
    return text;
}

}  // namespace tumble
