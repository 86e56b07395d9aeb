// The runs of a page: loading and checks, the simulation of each, the sources.
#pragma once

#include "app/plots/variants.h"
#include "app/threads/interrupt.h"
#include "page/clip_data.h"
#include "scene/load.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tumble {

struct PageScenes {
    std::vector<std::string> vary;  // the options
    std::vector<Variant> variants;
    std::vector<SceneDescription> scenes;  // of each variant
    FileList inputs;
    std::vector<PageSource> sources;  // the scene files, and the values of the command line

    double duration() const;    // s, of the longest
    std::string title() const;  // of the first scene, else its name
};

/// `labels`: of the runs; empty: made from the names and values. Throws InputError for a scene or plot that cannot be shown.
PageScenes load_page_scenes(std::span<const std::filesystem::path> files, const SceneOverrides& overrides,
                            std::span<const std::string> vary, std::span<const std::string> labels = {});

/// Simulates all scenes.
PageClip record_page(const PageScenes& scenes, int threads, bool quiet, Interrupt& interrupt);

}  // namespace tumble
