// A player within a page, and its content without script or WebGL.
#pragma once

#include "core/vector.h"

#include <optional>
#include <string>
#include <vector>

namespace tumble {

struct PlayerView {
    Vec3 eye = Vec3::Zero(), target = Vec3::Zero();  // m, world frame
};

/// The attribute data-options of a player; members at their defaults are left out.
struct PlayerOptions {
    double time = 0.0;                                // s, shown at first
    int run = 0;                                      // shown at first
    std::string follow;                               // body that the camera follows
    std::string body;                                 // chosen at first
    std::optional<std::vector<std::string>> overlay;  // shown at first, instead of the scene's
    std::string plot;                                 // "energy,body.ball.y"
    std::optional<PlayerView> view;                   // instead of the scene's camera
    std::optional<std::vector<std::string>> panels;   // plots, state, impacts, source
    std::string layout;                               // "page" or "lesson"
    std::string compare;                              // of runs: single, ghost, side-by-side
    std::string alt;                                  // for readers that do not see the stage
};
std::string options_json(const PlayerOptions& options);

/// Members are plain text, except names that end in _html.
struct PlayerFigure {
    std::string clip;  // id of the ShellClip
    std::string id;    // of the figure; empty: none
    PlayerOptions options;
    std::string live;           // JSON of what a reader may change, of a live page; empty: nothing
    std::string poster;         // data address of a picture; empty: none
    std::string film;           // data address of an mp4 film; empty: none
    int width = 0, height = 0;  // of both, pixels
    std::string caption_html;
};
/// <figure class="tumble-player" ...>.
std::string figure_html(const PlayerFigure& figure);

}  // namespace tumble
