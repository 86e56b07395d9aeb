// The scenes of a block, with mistakes told where they stand in the lesson.
#pragma once

#include "app/lesson/course.h"
#include "scene/description/description.h"
#include "scene/keys/overrides.h"
#include "scene/load.h"

#include <functional>
#include <string>
#include <vector>

namespace tumble {

struct LoadedScene {
    SceneDescription scene;
    SceneOverrides overrides;
    std::string label;  // tells it from the other runs of its stage; empty if it is the only one
};

/// Loads the scene with these overrides and the overrides of its `set`. Throws InputError with a place.
SceneDescription load_lesson_scene(const LessonScene& scene, const SceneOverrides& overrides, const BlockPlaces& places,
                                   FileList& read);

/// One for each combination of the varied values; checks the names and times of the stage's options with them.
std::vector<LoadedScene> load_stage(const LessonStage& stage, FileList& read);

/// The controls of a live stage, complete. Throws InputError with a place where its scene is not valid with one of
/// their ends.
std::vector<LiveControl> load_live_controls(const LessonStage& stage);

/// The same action; an InputError without a place gets this one, and `key` in its message.
void with_place(const SourceLocation& place, const std::string& key, const std::function<void()>& action);

/// Text of the scene, for the reader of the page, and its name.
std::string scene_source(const LessonScene& scene);

}  // namespace tumble
