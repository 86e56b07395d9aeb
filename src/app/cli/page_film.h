// The film and the poster of a page, for readers without WebGL.
#pragma once

#include "app/cli/commands.h"
#include "scene/description/description.h"

#include <string>

namespace tumble {

/// Data addresses (core/html_text.h); empty: there is none.
struct PageFilm {
    std::string poster, film;
    int width = 0, height = 0;  // of both, pixels
};

/// The size with the aspect of the scene's frame whose longer side is at most `longest` pixels; even.
void set_film_size(SceneOverrides& overrides, const SceneDescription& scene, int longest);

struct FilmOptions {
    bool with_film = true;  // else the poster alone
    double fps = 60.0;      // of the scenes
    double duration = 0.0;  // s, of the longest scene
};

/// Draws the scenes of the command at its size. The film has at most 30 frames a second. Outputs and transparency of
/// the command are ignored. Without ffmpeg there is a poster only.
PageFilm draw_film(RenderCommand command, const FilmOptions& options);

}  // namespace tumble
