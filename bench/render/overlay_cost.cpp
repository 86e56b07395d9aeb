#include "render/overlay_cost.h"

#include "harness/clock.h"
#include "overlay/overlay_builder.h"
#include "overlay/overlay_painter.h"
#include "render/render_switches.h"
#include "render/scene/pose_filter.h"
#include "sim/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace tumble::bench {
namespace {

World recording_world(const SceneDescription& scene) {
    World world(scene);
    if (needs_records(scene.overlay)) world.record_contacts();
    return world;
}

const ContactRecords* records_of(const World& world) {
    return world.records_contacts() ? &world.contact_records() : nullptr;
}

PanelOverlay survey_of(const SceneDescription& scene, int end) {
    World world = recording_world(scene);
    ScaleSurvey survey(scene);
    for (int n = 0; n < end; ++n) {
        if (n > 0) world.advance_frame();
        survey.add(world.snapshot(), records_of(world));
    }
    PanelOverlay overlay;
    overlay.scales = survey.scales();
    overlay.marks = survey.marks();
    overlay.frame_height = scene.output.height;
    return overlay;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

}  // namespace

void measure_overlay(const SceneDescription& scene, int first, int end, bool full) {
    const PanelOverlay overlay = survey_of(scene, end);
    World world = recording_world(scene);
    OverlayBuilder builder(scene, overlay.scales);
    OverlayPainter painter(scene, overlay);
    PoseFilter poses(scene);
    RenderSwitches switches;
    switches.full_redraw = full;
    Renderer without(scene, switches);  // and without depths, which overlays alone need
    switches.keep_depths = true;
    Renderer renderer(scene, switches);
    std::vector<double> plain, frames, shapes, pixels, contacts;
    for (int n = 0; n < end; ++n) {
        if (n > 0) world.advance_frame();
        Snapshot snapshot = world.snapshot();
        const double start = cpu_seconds();
        const OverlayFrame& drawn = builder.next(snapshot, records_of(world));
        const double made = cpu_seconds();
        poses.follow(snapshot);
        if (n < first) continue;
        const double before = cpu_seconds();
        without.render(snapshot);
        const double between = cpu_seconds();
        const Image& image = renderer.render(snapshot);
        const double rendered = cpu_seconds();
        painter.draw({image, renderer.changed(), renderer.depths(), renderer.camera()}, drawn);
        const double painted = cpu_seconds();
        if (n == first) continue;  // excludes the initial work
        contacts.push_back(records_of(world) != nullptr ? double(world.contact_records().contacts.size()) : 0.0);
        plain.push_back(1e3 * (between - before));
        frames.push_back(1e3 * (rendered - between));
        shapes.push_back(1e3 * (made - start));
        pixels.push_back(1e3 * (painted - rendered));
    }
    const double frame = median(plain), more = median(frames) - frame + median(shapes) + median(pixels);
    fmt::print(
        "CPU ms per frame, medians: {:.0f} contacts; frame {:.2f}; depths {:+.2f}, shapes {:.2f}, pixels {:.2f}: "
        "{:.1f} % "
        "of the frame\n",
        median(contacts), frame, median(frames) - frame, median(shapes), median(pixels), 100.0 * more / frame);
}

}  // namespace tumble::bench
