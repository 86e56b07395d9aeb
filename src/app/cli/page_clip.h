// The runs of a page, which are loaded, checked and simulated; its film and poster for readers without WebGL.
#pragma once

#include "app/cli/render_command.h"
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
    std::string title() const;  // of the first scene, otherwise its name
};

/// `labels`: of the runs; empty: made from the names and values. Throws InputError for a scene or plot that cannot be
/// shown.
PageScenes load_page_scenes(std::span<const std::filesystem::path> files, const SceneOverrides& overrides,
                            std::span<const std::string> vary, std::span<const std::string> labels = {});

/// Simulates all scenes.
PageClip record_page(const PageScenes& scenes, int threads, bool quiet, Interrupt& interrupt);

/// Data addresses (core/html_text.h); empty: there is none.
struct PageFilm {
    std::string poster, film;
    int width = 0, height = 0;  // of both, pixels
};

/// The size with the aspect of the scene's frame whose longer side is at most `longest` pixels; even.
void set_film_size(SceneOverrides& overrides, const SceneDescription& scene, int longest);

struct FilmOptions {
    bool with_film = true;  // otherwise the poster alone
    double fps = 60.0;      // of the scenes
    double duration = 0.0;  // s, of the longest scene
};

/// Draws the scenes of the command at its size. The film has at most 30 frames a second. Outputs and transparency of
/// the command are ignored. Without ffmpeg there is a poster only.
PageFilm draw_film(RenderCommand command, const FilmOptions& options);

}  // namespace tumble
