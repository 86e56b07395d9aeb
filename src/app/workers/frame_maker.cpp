#include "app/workers/frame_maker.h"

#include "app/threads/stage_timer.h"

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

RenderSwitches switches_for(const ClipPanel& panel, RenderSwitches options) {
    options.keep_depths = panel.overlay.has_value();
    return options;
}

}  // namespace

PanelDrawing::PanelDrawing(const ClipPanel& panel, const RenderSwitches& options)
    : renderer_(*panel.scene, switches_for(panel, options)),
      mean_(options.transparent),
      whole_{{0, 0, panel.scene->output.width, panel.scene->output.height}} {
    if (panel.overlay) painter_.emplace(*panel.scene, *panel.overlay);
}

void PanelDrawing::draw_samples(const SharedFrames& memory, std::size_t panel, std::int64_t frame) {
    const std::size_t moments = memory.moments(panel);
    const bool blurred = moments > 1;
    const int count = blurred ? int(moments) - 1 : 1;
    snapshot_.frame = frame;
    if (blurred && painter_) {
        memory.read_poses(panel, 0, snapshot_);
        renderer_.render(snapshot_, {0, count});
        opening_depths_ = renderer_.depths();
        opening_camera_ = renderer_.camera();
    }
    for (std::size_t i = blurred ? 1 : 0; i < moments; ++i) {
        memory.read_poses(panel, i, snapshot_);
        image_ = &renderer_.render(snapshot_, {blurred ? int(i) - 1 : 0, count});
        if (blurred) mean_.add(*image_);
    }
    if (blurred) {
        mean_.take(blurred_);
        image_ = &blurred_;
    }
    // Between a sharp and a blurred image, the renderer does not know the changed regions.
    const bool blurred_before = std::exchange(blurred_last_, blurred);
    changed_ = blurred_before || blurred_last_ ? &whole_ : &renderer_.changed();
}

void PanelDrawing::draw(const SharedFrames& memory, std::size_t panel, std::int64_t frame) {
    draw_samples(memory, panel, frame);
    if (!painter_) return;
    read_bytes(memory.overlay(panel), shapes_);
    const DepthImage& depths = blurred_last_ ? opening_depths_ : renderer_.depths();
    const Camera& camera = blurred_last_ ? *opening_camera_ : renderer_.camera();
    image_ = &painter_->draw({*image_, *changed_, depths, camera}, shapes_);
    changed_ = &painter_->changed();
}

namespace {

template <typename Work>
WorkTime timed(const Work& work) {
    const double wall = wall_seconds(), cpu = thread_seconds();
    work();
    return {wall, wall_seconds() - wall, thread_seconds() - cpu};
}

}  // namespace

FrameMaker::FrameMaker(const Composition& composition, const RenderSwitches& options, const FrameOutputs& outputs,
                       SharedFrames& memory)
    : memory_(memory) {
    if (outputs.image()) open_panels(composition, options);
    if (outputs.image() && !composition.plain()) composer_.emplace(composition, outputs.transparent);
    if (!outputs.aovs.empty()) aovs_.emplace(*composition.aov_scene, outputs.aovs, outputs.aov_mark);
    if (outputs.video) video_.emplace(*outputs.video, composition.width, composition.height);
    if (outputs.png) png_.emplace(outputs.transparent ? PngAlpha::kept : PngAlpha::dropped, outputs.png_mark);
}

DrawnFrame FrameMaker::make(const FrameJob& job) {
    DrawnFrame drawn;
    drawn.frame = job.frame;
    if (job.image) make_image(job, drawn);
    if (job.aovs)
        drawn.aovs = timed([&] {
            memory_.read_aov_poses(aov_poses_);
            const std::span<const std::byte> file = aovs_->make(aov_poses_);
            std::ranges::copy(file, memory_.aovs(job.slot).data());
            drawn.aov_bytes = file.size();
        });
    return drawn;
}

void FrameMaker::open_panels(const Composition& composition, RenderSwitches options) {
    const auto open = [&](const ClipPanel& panel) {
        auto drawing = std::make_unique<PanelDrawing>(panel, options);
        options.compile_schedule = nullptr;  // it distributes the shaders of one renderer of each process
        return drawing;
    };
    for (const ClipPanel& panel : composition.panels) panels_.push_back(open(panel));
    for (const ClipInset& inset : composition.insets) insets_.push_back(open(inset.as_panel()));
    inset_places_ = composition.insets;
}

void FrameMaker::make_image(const FrameJob& job, DrawnFrame& drawn) {
    drawn.drawing = timed([&] { draw(job); });
    const Image& image = composer_ ? composer_->image() : panels_.front()->image();
    const std::vector<Rectangle>& changed = composer_ ? composer_->changed() : panels_.front()->changed();
    drawn.unchanged = changed.empty();
    if (video_)
        drawn.conversion = timed([&] {
            video_->update(image, changed);
            std::ranges::copy(video_->bytes(), memory_.video(job.slot).data());
        });
    if (png_)
        drawn.png = timed([&] {
            if (!changed.empty()) file_ = png_->encode(image, changed);
            std::ranges::copy(file_, memory_.png(job.slot).data());
        });
    drawn.png_bytes = file_.size();
}

void FrameMaker::draw(const FrameJob& job) {
    for (std::size_t i = 0; i < panels_.size(); ++i) panels_[i]->draw(memory_, i, job.frame);
    if (!composer_) return;
    std::vector<PanelImage> images;
    for (const auto& panel : panels_) images.push_back({panel->image(), panel->changed()});
    std::vector<std::optional<PanelImage>> insets;
    for (std::size_t i = 0; i < insets_.size(); ++i) {
        if (!inset_places_[i].shown(job.time)) {
            insets.emplace_back();
            continue;
        }
        insets_[i]->draw(memory_, inset_places_[i].panel, job.frame);
        insets.emplace_back(PanelImage{insets_[i]->image(), insets_[i]->changed()});
    }
    composer_->compose(images, insets, job.time);
}

}  // namespace tumble
