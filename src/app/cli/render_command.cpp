#include "app/cli/commands.h"
#include "app/cli/render_report.h"
#include "app/cli/render_run.h"
#include "app/cli/say.h"
#include "app/files/aov_folder.h"
#include "app/files/frame_folder.h"
#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace tumble {
namespace {

namespace fs = std::filesystem;

std::string frame_step_note(const RenderFigures& done) {
    if (done.frames_in_clip == done.frames.count()) return "";
    return fmt::format(" (one in {} of {}: the format holds no more)", done.frame_step, done.frames.count());
}

std::string stored(const RenderFigures& done) {
    if (done.frames_stored == done.frames_in_clip) return "";
    return fmt::format(", stored as {} (unchanged pictures are shown longer)", done.frames_stored);
}

void print_times(const RenderFigures& done) {
    std::string text =
        fmt::format("{:.2f} s, {:.1f} frames/s; {} drawn; CPU: simulation {:.2f} s, drawing {:.2f} s", done.seconds,
                    double(done.rendered) / done.seconds, done.drawn, done.cpu.simulation, done.cpu.drawing);
    if (done.folder) text += fmt::format(", PNG {:.2f} s", done.cpu.png);
    if (done.aov_folder) text += fmt::format(", AOVs {:.2f} s", done.cpu.aovs);
    if (done.clip) text += fmt::format(", conversion {:.2f} s, video {:.2f} s", done.cpu.conversion, done.cpu.video);
    say("{}; peak memory {} MiB\n", text, done.peak_memory);
}

/// Warns of frames of an earlier, longer clip, because `tumble encode` would append them to this one.
void print_older(const RenderFigures& done, const char* what, const std::vector<std::int64_t>& there,
                 const fs::path& where, fs::path (&path)(const fs::path&, std::int64_t)) {
    const auto older = std::lower_bound(there.begin(), there.end(), done.clip_frames);
    if (older != there.end())
        say("note: {} older {} are still in the folder, from {} on\n", there.end() - older, what,
            safe_path(path(where, *older)));
}

/// The same for programs.
void log_summary(const RenderFigures& done) {
    nlohmann::ordered_json wrote = nlohmann::ordered_json::object();
    if (done.clip) wrote["clip"] = done.clip->string();
    if (done.folder) wrote["frames"] = done.folder->string();
    if (done.aov_folder) wrote["aovs"] = done.aov_folder->string();
    wrote.update({{"width", done.width}, {"height", done.height}, {"fps", done.fps}, {"count", done.frames.count()}});
    if (done.clip) {
        const ImageSize size = stored_size(done.kind, {done.width, done.height});
        wrote.update({{"clip_width", size.width}, {"clip_height", size.height}});
    }
    messages().event("wrote", wrote);
    messages().event("times", {{"seconds", done.seconds},
                               {"cpu",
                                {{"simulation", done.cpu.simulation},
                                 {"drawing", done.cpu.drawing},
                                 {"png", done.cpu.png},
                                 {"aovs", done.cpu.aovs},
                                 {"conversion", done.cpu.conversion},
                                 {"video", done.cpu.video}}},
                               {"peak_memory", done.peak_memory},
                               {"drawn", done.drawn},
                               {"workers", done.workers},
                               {"threads", done.threads}});
}

void print_summary(const RenderFigures& done, const AovSet& aovs) {
    if (messages().json()) return log_summary(done);
    const std::int64_t first = done.frames.first(), last = done.frames.last();
    if (done.clip)
        say("wrote {}: {} frames of {}{}{}\n", safe_path(*done.clip), done.frames_in_clip,
            size_text(done.kind, {done.width, done.height}), frame_step_note(done), stored(done));
    if (done.folder)
        say("wrote {} to {}\n", safe_path(frame_path(*done.folder, first)),
            frame_path(*done.folder, last).filename().string());
    if (done.aov_folder)
        say("wrote {} to {}: {}\n", safe_path(aov_path(*done.aov_folder, first)),
            aov_path(*done.aov_folder, last).filename().string(), names_of(aovs));
    if (done.rendered < done.frames.count())
        say("kept {} of {} frames from an earlier run\n", done.frames.count() - done.rendered, done.frames.count());
    if (done.rendered > 0) print_times(done);
    if (done.folder) print_older(done, "frames", frames_in(*done.folder), *done.folder, frame_path);
    if (done.aov_folder) print_older(done, "AOVs", aovs_in(*done.aov_folder), *done.aov_folder, aov_path);
}

/// Frames in a folder carry the mark of their clip, so that any run with --frames can be continued.
std::string how_to_go_on(const RenderCommand& command) {
    const bool continues = command.resume || command.frames || command.aov_folder;
    if (!continues) return "";
    return fmt::format("; finished {} are kept. To go on:\n  {}{}",
                       command.frames || command.aov_folder ? "frames" : "segments",
                       command.call.empty() ? "the same command" : command.call,
                       command.resume         ? ""
                       : command.call.empty() ? " with --resume"
                                              : " --resume");
}

}  // namespace

void run_render(const RenderCommand& command) {
    std::optional<RenderReport> report;
    if (command.report) report.emplace(command);
    RenderFigures done;
    try {
        done = render_to_files(command);
    } catch (const Interrupted& interrupted) {
        throw RunError(interrupted.message() + how_to_go_on(command));
    }
    if (!command.quiet) print_summary(done, command.aovs);
    if (report) report->write(done);
}

}  // namespace tumble
