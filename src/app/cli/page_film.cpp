#include "app/cli/page_film.h"

#include "app/cli/render_run.h"
#include "app/cli/say.h"
#include "app/files/frame_folder.h"
#include "core/error.h"
#include "core/html_text.h"
#include "core/safe_text.h"
#include "output/process.h"
#include "output/temporary_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <span>
#include <sstream>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr double most_fps = 30.0;            // of the film; more doubles its bytes
constexpr double poster_place = 1.0 / 3.0;   // of the clip: bodies are in motion, and near their start
constexpr const char* poster_quality = "3";  // of ffmpeg's JPEG, 2 (best) to 31

std::string address_of(const fs::path& file, const char* media_type) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    if (!stream) throw RunError(fmt::format("cannot read {}", safe_path(file)));
    return data_address(media_type, std::as_bytes(std::span(bytes.view())));
}

/// The picture of a film at a time, or a picture in another format, as JPEG.
void make_jpeg(const fs::path& ffmpeg, const fs::path& from, double time, const fs::path& jpeg) {
    Process process(ffmpeg, {"-hide_banner",
                             "-nostdin",
                             "-loglevel",
                             "error",
                             "-y",
                             "-ss",
                             fmt::format("{:.6f}", time),
                             "-threads",
                             "1",
                             "-i",
                             "file:" + from.string(),
                             "-frames:v",
                             "1",
                             "-q:v",
                             poster_quality,
                             "-pix_fmt",
                             "yuvj420p",
                             "-fflags",
                             "+bitexact",
                             "-flags:v",
                             "+bitexact",
                             "-f",
                             "mjpeg",
                             "file:" + jpeg.string()});
    const ProcessEnd end = process.finish();
    if (!end.ok() || !fs::exists(jpeg))
        throw RunError(fmt::format("ffmpeg did not make the picture of the page: {}\n{}", end.describe(),
                                   safe_lines(end.error_text)));
}

/// The time of the poster's frame, s of the clip.
double poster_time(double duration, double fps) { return std::floor(poster_place * duration * fps + 1e-9) / fps; }

}  // namespace

void set_film_size(SceneOverrides& overrides, const SceneDescription& scene, int longest) {
    const double width = scene.output.width, height = scene.output.height;
    const double scale = std::min(1.0, longest / std::max(width, height));
    const auto even = [](double side) { return std::max(2, 2 * int(std::lround(0.5 * side))); };
    overrides.width = even(scale * width);
    overrides.height = even(scale * height);
}

PageFilm draw_film(RenderCommand command, const FilmOptions& options) {
    const TemporaryFolder folder("page");
    const std::optional<fs::path> ffmpeg = find_program("ffmpeg");
    command.clip.reset();
    command.report.reset();
    command.frames.reset();
    command.aovs = {};
    command.aov_folder.reset();
    command.drawing.transparent = false;
    command.clip_options = {FrameTimes::constant_rate, VideoQuality::small};
    const fs::path jpeg = folder.path() / "poster.jpg";
    PageFilm made;
    RenderFigures figures;
    if (options.with_film && ffmpeg) {
        command.clip = folder.path() / "film.mp4";
        command.frame_step = std::max(1, int(std::ceil(options.fps / most_fps - 1e-9)));
        figures = render_to_files(command);
        make_jpeg(*ffmpeg, *command.clip, poster_time(double(figures.frames.count() - 1) / figures.fps, figures.fps),
                  jpeg);
        made.film = address_of(*command.clip, "video/mp4");
    } else {
        command.frames = folder.path();
        command.start = poster_time(options.duration, options.fps);
        command.overrides.duration = command.start;
        figures = render_to_files(command);
        const fs::path png = frame_path(folder.path(), figures.frames.first());
        if (!ffmpeg) made.poster = address_of(png, "image/png");
        if (ffmpeg) make_jpeg(*ffmpeg, png, 0.0, jpeg);
    }
    if (ffmpeg) made.poster = address_of(jpeg, "image/jpeg");
    made.width = figures.width;
    made.height = figures.height;
    if (options.with_film && !ffmpeg && !command.quiet)
        say("note: the page has no film, because the ffmpeg program is not on the PATH (apt-get install ffmpeg)\n");
    return made;
}

}  // namespace tumble
