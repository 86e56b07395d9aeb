// Parameters and entry points of the commands. A function returns the exit code if the command has several outcomes;
// errors leave it as InputError (exit code 2) or RunError (1).
#pragma once

#include "app/clip/clip_request.h"
#include "app/farm/slurm_scripts.h"
#include "app/files/run_tables.h"
#include "gltf/key_track.h"
#include "output/video_format.h"
#include "render/renderer.h"
#include "scene/load.h"
#include "tumble/output.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

struct RenderCommand : ClipRequest {
    std::optional<std::filesystem::path> clip;           // without this, frames and AOVs: the first scene's name
    std::optional<std::filesystem::path> frames;         // folder
    std::optional<std::filesystem::path> report;         // .html
    std::optional<std::filesystem::path> profile;        // .json
    std::optional<std::filesystem::path> motion_record;  // .json (app/causes)
    std::optional<std::filesystem::path> aov_folder;     // instead of the frames' folder
    RenderOptions drawing;
    ClipOptions clip_options{FrameTimes::constant_rate, VideoQuality::normal};
    bool resume = false;                                    // keeps finished frames of the same clip
    std::string call;                                       // the command as it was typed, for messages
    std::optional<std::filesystem::path> from_checkpoints;  // folder; else the frames before the first are simulated
    double shutter = 0.0;                                   // degrees: 360 is always open, 0 a single moment
    int blur_samples = 8;                                   // images per frame while the shutter is open
    std::optional<int> threads;                             // of the simulation; see thread_budget.h
    int workers = 1;                                        // render processes
    bool quiet = false;
};
void run_render(const RenderCommand& command);

struct SimulateCommand {
    std::vector<std::filesystem::path> scenes;  // one, or a panel for each with checkpoints
    TableFiles tables;
    SceneOverrides overrides;
    std::optional<std::filesystem::path> checkpoints;       // folder
    double every = 1.0;                                     // s of the clip between two checkpoints
    std::optional<std::filesystem::path> from_checkpoints;  // folder to go on from
    double start = 0.0;                                     // s, scene time: earlier frames are not in the tables
    bool motion = true;                                     // is in the folder too
    RenderCommand clip;  // that is drawn from the checkpoints: only its panels and times
    int threads = 1;
    bool quiet = false;
};
void run_simulate(const SimulateCommand& command);

struct PlotCommand {
    std::vector<std::filesystem::path> scenes;
    std::string quantities;                              // names separated by commas (app/plots/quantities.h)
    std::filesystem::path output;                        // .svg, .png or .pdf
    std::optional<std::filesystem::path> motion_record;  // .json (app/causes)
    std::vector<std::string> vary;                       // "PATH=VALUE,VALUE"
    SceneOverrides overrides;
    std::optional<std::string> title;  // without this, the first scene's
    bool log = false;                  // logarithmic vertical axes
    bool difference = false;           // of each run to the first one
    int width = 900, height = 540;     // pixels, or points of a PDF
    int threads = 1;
    bool quiet = false;
};
void run_plot(const PlotCommand& command);

struct ExportCommand {
    std::filesystem::path scene;
    std::filesystem::path output;  // .glb
    KeyKind keys = KeyKind::cubic;
    SceneOverrides overrides;
    int threads = 1;
    bool quiet = false;
};
void run_export(const ExportCommand& command);

struct PageCommand {
    std::vector<std::filesystem::path> scenes;    // a run for each
    std::vector<std::string> vary;                // "PATH=VALUE,VALUE": a run for each
    std::vector<std::string> labels;              // of the runs; empty: made from the names and values
    std::optional<std::filesystem::path> output;  // without this, the first scene's name with .html
    SceneOverrides overrides;
    std::optional<std::string> title;  // without this, the first scene's
    std::string language = "en";
    std::string compare;                  // of runs: single, ghost, side-by-side; empty: single
    std::string follow;                   // body that the camera follows
    double time = 0.0;                    // s, shown at first
    bool film = true;                     // in the page, for readers without WebGL
    int film_width = 0, film_height = 0;  // pixels; 0: 640 at most, with the scene's aspect
    bool embed_glb = false;
    int threads = 1;
    int workers = 1;  // render processes of the film
    bool quiet = false;
};
void run_page(const PageCommand& command);

struct LessonCommand {
    std::vector<std::filesystem::path> lessons;  // Markdown
    std::filesystem::path site;                  // folder of the pages
    std::string title = "Lessons";               // of the contents
    bool check = false;                          // runs and checks everything, and writes nothing
    bool pictures = true;                        // of the stages, for print and for readers without WebGL
    bool films = false;                          // of the stages, for readers without WebGL
    int threads = 1;                             // runs at a time
    int workers = 1;                             // render processes of the pictures
    bool quiet = false;
};
/// Returns 0, or 2 if a lesson has mistakes, all of which are printed.
int run_lesson(const LessonCommand& command);

struct EncodeCommand {
    std::filesystem::path frames;  // folder
    std::filesystem::path clip;
    std::optional<double> fps;   // without this, that of the run that drew the frames, or 60
    bool allow_missing = false;  // frames may be missing: the others follow each other
    bool transparent = false;    // the clip keeps the alpha of the frames
    VideoQuality quality = VideoQuality::normal;
    bool quiet = false;
};
void run_encode(const EncodeCommand& command);

struct CompareCommand {
    std::filesystem::path a, b;
    std::optional<std::filesystem::path> difference;
    v0::CompareOptions options;
    std::optional<std::filesystem::path> tolerances;           // .toml
    std::optional<std::filesystem::path> report, json, junit;  // to write
    std::optional<std::string> platform;                       // of the references; "none": the general ones alone
    bool allow_added = false;                                  // a picture without a reference is no difference
    bool accept = false;                                       // pictures that are not alike become references
    SceneOverrides overrides;                                  // of a scene that is drawn; fps of clips too
    int workers = 1;                                           // pairs at a time, and render processes
    bool quiet = false;
};
/// Returns 0 if the images are alike, 1 if they differ, 2 if they cannot be compared, 3 if one is missing.
int run_compare(const CompareCommand& command);

/// The commands below `farm`.
enum class FarmAction { slurm, openjd, status };

struct FarmCommand {
    FarmAction action = FarmAction::slurm;
    RenderCommand render;  // scene, clip, and the options that decide the frames
    std::vector<std::string> simulate_options, render_options, encode_options;  // the given ones, as words
    std::optional<std::filesystem::path> folder;  // of the job; without this, the clip's name with .farm
    int parts = 0;
    int retries = 2;
    SlurmSettings slurm;
    bool write_only = false;          // does not submit the job
    std::filesystem::path job;        // of OpenJD (JSON)
    int chunk = 0;                    // frames; 0: those of about 20 parts
    std::string program = "tumble";   // on the machines of the farm
    std::filesystem::path status_of;  // folder of a job
    bool missing = false;             // only the numbers of the missing parts
};
/// Returns 0, or 3 if parts of the job are missing (`status`).
int run_farm(const FarmCommand& command);

struct InfoCommand {
    std::filesystem::path scene;
    SceneOverrides overrides;
    std::optional<std::filesystem::path> bodies;
};
void run_info(const InfoCommand& command);

struct SweepCommand {
    std::filesystem::path plan;
    std::optional<std::filesystem::path> folder;
    std::vector<std::string> set;    // "PATH=VALUE", for all samples
    std::vector<std::int64_t> only;  // samples to make again
    int workers = 1;                 // processes
    bool dry_run = false;            // prints the plan's size and first samples
    bool stop = false;               // at the first sample that fails
    bool quiet = false;
};
/// Returns 0, or 1 if a sample failed.
int run_sweep(const SweepCommand& command);

struct DoctorCommand {
    double time_limit = 30.0;  // s for each program and driver: a driver without caches takes seconds on a busy machine
};
/// Returns 0 if clips can be rendered, else 1.
int run_doctor(const DoctorCommand& command);

namespace manual {
struct CommandText;  // app/manual/command_text.h: all commands and options
}

struct CompletionCommand {
    std::string shell;  // bash, zsh, fish
};
void run_completion(const CompletionCommand& command, const manual::CommandText& program);

struct ManPagesCommand {
    std::filesystem::path folder;
};
void run_man_pages(const ManPagesCommand& command, const manual::CommandText& program);

}  // namespace tumble
