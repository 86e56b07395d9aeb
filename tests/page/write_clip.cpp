// Writes the data of a clip for the tests of the player's decoder: write_clip OUT SCENE [PATH=VALUE...]. OUT gets
// base64; the sizes and errors are printed.
#include "app/page/record_run.h"
#include "core/error.h"
#include "page/clip_data.h"
#include "scene/load.h"

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

namespace {

std::string base64(const std::vector<std::byte>& bytes) {
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? unsigned(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

int write(const std::vector<std::string>& arguments) {
    tumble::SceneOverrides overrides;
    overrides.set.assign(arguments.begin() + 2, arguments.end());
    const tumble::SceneDescription scene = tumble::load_scene(arguments[1], overrides);
    tumble::Interrupt interrupt;
    tumble::PageClip clip{scene.title, "test", {{"scene.toml", "text"}}, {}};
    clip.runs.push_back(tumble::record_run(
        scene, {.threads = 2, .label = "", .progress = {}, .observers = {}, .plot = scene.overlay.plot}, interrupt));
    const tumble::ClipData data = tumble::make_clip_data(clip);
    const std::string text = base64(data.bytes);
    std::ofstream(arguments[0]) << text;
    const tumble::PageRun& run = clip.runs.front();
    std::size_t contacts = 0;
    for (const auto& frame : run.contacts) contacts += frame.size();
    std::printf(
        "%zu characters; errors %.3g m, %.3g rad, %.3g m/s, %.3g rad/s; %zu of %lld impacts, %zu of %lld contacts\n",
        text.size(), data.errors.position, data.errors.rotation, data.errors.velocity, data.errors.angular_velocity,
        run.impacts.size(), static_cast<long long>(run.all_impacts), contacts,
        static_cast<long long>(run.all_contacts));
    return 0;
}

}  // namespace

int main(int count, char** values) {
    const std::vector<std::string> arguments(values + 1, values + count);
    if (arguments.size() < 2) return 2;
    try {
        return write(arguments);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
