// bench_render: the cost of drawing and the quality of edges. One process, one thread.
//   bench_render cost SCENE   [--size WxH] [--samples N] [--frames FIRST:END] [--rounds N] [--full] [--stages]
//   bench_render overlay SCENE --overlay LIST [--size WxH] [--frames FIRST:END] [--full]
//   bench_render edges SCENE  [--size WxH] [--samples N] [--frames FIRST:END] [--pictures FOLDER]
#include "harness/clock.h"
#include "output/png_writer.h"
#include "render/clip.h"
#include "render/overlay_cost.h"
#include "render/passes/pass_timer.h"
#include "render/picture_error.h"
#include "render/render_switches.h"
#include "scene/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace tumble::bench {
namespace {

struct Arguments {
    std::string command, scene, pictures;
    SceneOverrides overrides;
    int first = 0, end = 120, rounds = 1;
    bool full = false, stages = false;
};

std::pair<int, int> two_numbers(const std::string& text, char between) {
    const std::size_t at = text.find(between);
    if (at == std::string::npos) throw std::runtime_error("two numbers are expected: " + text);
    return {std::stoi(text.substr(0, at)), std::stoi(text.substr(at + 1))};
}

Arguments read_arguments(int argc, char** argv) {
    if (argc < 3) throw std::runtime_error("bench_render cost|overlay|edges SCENE [options]");
    Arguments a{argv[1], argv[2], {}, {}};
    for (int i = 3; i < argc; ++i) {
        const std::string option = argv[i];
        const auto value = [&] {
            return ++i < argc ? std::string(argv[i]) : throw std::runtime_error(option + " what?");
        };
        if (option == "--size") {
            const auto [width, height] = two_numbers(value(), 'x');
            a.overrides.width = width;
            a.overrides.height = height;
        } else if (option == "--samples") {
            a.overrides.samples = std::stoi(value());
        } else if (option == "--frames") {
            std::tie(a.first, a.end) = two_numbers(value(), ':');
        } else if (option == "--rounds") {
            a.rounds = std::stoi(value());
        } else if (option == "--full") {
            a.full = true;
        } else if (option == "--stages") {
            a.stages = true;
        } else if (option == "--overlay") {
            a.overrides.overlay = value();
        } else if (option == "--pictures") {
            a.pictures = value();
        } else {
            throw std::runtime_error("unknown option: " + option);
        }
    }
    return a;
}

// CPU ms per frame: median, mean, tenth and ninetieth percentile, and by pass; the clip is repeated.
void measure_cost(const Arguments& a) {
    const SceneDescription scene = load_scene(a.scene, a.overrides);
    const std::vector<Snapshot> clip = drawn_clip(scene, a.first, a.end);
    PassTimes times;
    RenderSwitches options;
    options.full_redraw = a.full;
    if (a.stages) options.times = &times;
    Renderer renderer(scene, options);
    std::vector<double> costs;
    double pixels = 0.0, rectangles = 0.0;
    PassTimes sum_of_times;
    for (int round = 0; round < a.rounds; ++round) {
        renderer.render(clip.front());  // excludes the initial work, and the jump back to the start
        times = {};
        for (std::size_t i = 1; i < clip.size(); ++i) {
            const double start = cpu_seconds();
            renderer.render(clip[i]);
            costs.push_back(1e3 * (cpu_seconds() - start));
            rectangles += double(renderer.changed().size());
            for (const Rectangle& r : renderer.changed()) pixels += double(r.width) * r.height;
        }
        for (std::size_t i = 0; i < pass_count; ++i) sum_of_times.seconds[i] += times.seconds[i];
    }
    double sum = 0.0;
    for (const double cost : costs) sum += cost;
    std::sort(costs.begin(), costs.end());
    const double frames = double(costs.size());
    fmt::print(
        "CPU ms per frame: median {:.2f}, mean {:.2f}, tenth {:.2f}, ninetieth {:.2f}; redrawn {:.3f} of the picture "
        "in {:.0f} rectangles\n",
        costs[costs.size() / 2], sum / frames, costs[costs.size() / 10], costs[costs.size() * 9 / 10],
        pixels / frames / (double(scene.output.width) * scene.output.height), rectangles / frames);
    if (!a.stages) return;
    for (std::size_t i = 0; i < pass_count; ++i)
        fmt::print("  {:<12} {:6.2f}\n", pass_names[i], 1e3 * sum_of_times.seconds[i] / frames);
}

Image picture(const SceneDescription& scene, const Snapshot& snapshot, int samples, bool multisample,
              double shift_x = 0.0, double shift_y = 0.0) {
    SceneDescription sampled = scene;
    sampled.output.samples = samples;
    RenderSwitches options;
    options.multisample = multisample;
    options.shift_x = shift_x;
    options.shift_y = shift_y;
    return Renderer(sampled, options).render(snapshot);
}

// Against the mean of 64 images of one sample with subpixel shifts.
void measure_edges(const Arguments& a) {
    const SceneDescription scene = load_scene(a.scene, a.overrides);
    const std::vector<Snapshot> clip = drawn_clip(scene, a.first, a.end);
    for (const Snapshot& snapshot : {clip.front(), clip.back()}) {
        PictureMean many;
        for (int i = 0; i < 64; ++i)  // an 8 x 8 lattice, sheared so that no two samples share a row or column
            many.add(picture(scene, snapshot, 1, false, ((i % 8) + (i / 8 + 0.5) / 8.0) / 8.0 - 0.5,
                             ((i / 8) + (i % 8 + 0.5) / 8.0) / 8.0 - 0.5));
        const Image reference = many.mean();
        const std::vector<bool> edges = many.edges();
        fmt::print("frame {}: {:.4f} of the pixels are edges\n", snapshot.frame,
                   double(std::count(edges.begin(), edges.end(), true)) / double(edges.size()));
        if (!a.pictures.empty()) write_png(fmt::format("{}/reference_{}.png", a.pictures, snapshot.frame), reference);
        struct Way {
            const char* name;
            int samples;
            bool multisample;
        };
        for (const Way& way : {Way{"none", 1, false}, Way{"multisampling", 4, true}, Way{"smooth edges", 4, false}}) {
            const Image image = picture(scene, snapshot, way.samples, way.multisample);
            fmt::print("  {:<14} edge RMSE {:5.2f}, RMSE {:.3f}, SSIM {:.5f}\n", way.name,
                       rms_difference(image, reference, edges),
                       rms_difference(image, reference, std::vector<bool>(edges.size(), true)),
                       structural_similarity(image, reference));
            if (!a.pictures.empty())
                write_png(fmt::format("{}/{}_{}.png", a.pictures, way.name, snapshot.frame), image);
        }
    }
}

}  // namespace
}  // namespace tumble::bench

int main(int argc, char** argv) {
    setenv("LP_NUM_THREADS", "0", 1);  // llvmpipe draws in the calling thread
    try {
        const tumble::bench::Arguments arguments = tumble::bench::read_arguments(argc, argv);
        if (arguments.command == "cost") {
            tumble::bench::measure_cost(arguments);
        } else if (arguments.command == "overlay") {
            tumble::bench::measure_overlay(tumble::load_scene(arguments.scene, arguments.overrides), arguments.first,
                                           arguments.end, arguments.full);
        } else if (arguments.command == "edges") {
            tumble::bench::measure_edges(arguments);
        } else {
            throw std::runtime_error("the first argument must be cost, overlay or edges");
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "bench_render: {}\n", error.what());
        return 1;
    }
}
