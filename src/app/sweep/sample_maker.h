// Makes the samples of a plan one after the other in one process, with one OpenGL context.
#pragma once

#include "app/clip/render_scenes.h"
#include "app/sweep/sample_record.h"
#include "app/threads/interrupt.h"
#include "render/gl/gl_device.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tumble {

class SampleMaker {
public:
    /// `scene`: the text of the plan's scene; `folder`: of all samples. The plan must outlive it.
    SampleMaker(const SweepPlan& plan, std::string scene, std::filesystem::path folder);
    ~SampleMaker();

    enum class Known { kept, made_anew };

    /// Makes the sample, unless its files are already there (`kept`). True: it was made. Throws InputError or RunError
    /// with the reason.
    bool make(std::int64_t index, Known known);

    /// Loads and checks the scene of a sample, without an output.
    RenderScenes load(const SweepSample& sample) const;

    /// Where samples are while they are made.
    static std::filesystem::path hidden_folder(const std::filesystem::path& folder);

private:
    GlDevice& device();
    SampleFigures write_files(const SweepSample& sample, RenderScenes& scenes, SampleFolder& folder);

    const SweepPlan& plan_;
    std::string text_;
    std::vector<std::string> title_;
    std::filesystem::path folder_;
    Interrupt interrupt_;
    std::unique_ptr<GlDevice> device_;
};

}  // namespace tumble
