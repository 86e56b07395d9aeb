#include "core/default_floating_point.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "live/live_run.h"
#include "tumble/live.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

struct tumble_run {
    std::optional<tumble::LiveRun> run;
    tumble::SourceLocation where;
    std::string error;
    std::vector<std::byte> data;
};

namespace {

template <class Work>
void guarded(tumble_run& run, const Work& work) {
    const tumble::DefaultFloatingPoint default_floating_point;
    try {
        work();
    } catch (const tumble::InputError& error) {
        run.where = error.where();
        run.error = error.what();
    } catch (const std::bad_alloc&) {
        run.error = "memory is exhausted";
    } catch (const std::exception& error) {
        run.error = tumble::safe_lines(error.what());
    }
}

std::vector<std::string> lines_of(const char* text) {
    std::vector<std::string> lines;
    for (std::string_view rest = text == nullptr ? "" : text; !rest.empty();) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        if (end > 0) lines.emplace_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return lines;
}

}  // namespace

extern "C" {

tumble_run* tumble_open(const char* name, const char* text, const char* settings) {
    auto* const run = new (std::nothrow) tumble_run;
    if (run != nullptr) guarded(*run, [&] { run->run.emplace(name, text, lines_of(settings)); });
    return run;
}

void tumble_close(tumble_run* run) { delete run; }

int32_t tumble_frames(const tumble_run* run) { return run->run ? int32_t(run->run->all_frames()) : 0; }

int32_t tumble_advance(tumble_run* run, int32_t frames) {
    if (!run->run) return 0;
    if (run->error.empty()) guarded(*run, [&] { run->run->advance(frames); });
    return int32_t(run->run->frames());
}

const char* tumble_error(const tumble_run* run) { return run->error.c_str(); }
int32_t tumble_error_line(const tumble_run* run) { return int32_t(run->where.line); }
int32_t tumble_error_column(const tumble_run* run) { return int32_t(run->where.column); }

const unsigned char* tumble_data(tumble_run* run, size_t* size) {
    run->data.clear();
    if (run->run && run->run->frames() > 0) guarded(*run, [&] { run->data = run->run->data(); });
    *size = run->data.size();
    return run->data.empty() ? nullptr : reinterpret_cast<const unsigned char*>(run->data.data());
}

}  // extern "C"
