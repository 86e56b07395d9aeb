// All runs of a course: loaded first, then simulated, several at a time.
#pragma once

#include "app/lesson/convergence.h"
#include "app/lesson/course.h"
#include "app/lesson/lesson_scene.h"
#include "page/clip_data.h"

#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace tumble {

/// Makes the bytes of a stage's clip. They are all that stays of its runs.
struct StageResult {
    std::vector<std::byte> clip;
};

struct LessonResult {
    std::vector<StageResult> stages;
    std::vector<std::vector<double>> measures;  // measured numbers, by block and row
    std::vector<std::string> convergences;      // figures
};

/// The scenes of a lesson, as loaded.
struct LessonScenes {
    std::vector<std::vector<LoadedScene>> stages;
    std::vector<std::vector<LiveControl>> live;  // by stage
    std::vector<ConvergenceRuns> convergences;
};

class LessonRuns {
public:
    /// `generator`: name and version of the program. The course must outlive this. Loads every scene; mistakes are in
    /// errors().
    LessonRuns(const Course& course, std::string generator);

    /// Runs all, `threads` at a time; the results are the same for any number. Calls `progress` with the number of
    /// finished blocks. Mistakes are in errors(): stated numbers that no run gives. Throws RunError after an interrupt.
    void run(int threads, const std::function<void(std::size_t)>& progress);

    /// Checks the equations of blocks `numbers` in the runs; mistakes are in errors().
    void check_numbers(const std::filesystem::path& web_folder);

    std::size_t blocks() const;
    const std::vector<LessonScenes>& scenes() const { return scenes_; }
    const std::vector<LessonResult>& results() const { return results_; }
    const FileList& inputs() const { return inputs_; }
    /// In the order of the lessons and places.
    std::vector<InputError> errors() const;

private:
    struct Job;
    void load(const Lesson& lesson);
    /// Calls it; its mistake is kept.
    void collect(std::size_t lesson, const std::function<void()>& action);
    void run_stage(std::size_t lesson, std::size_t stage);
    void run_convergence_block(std::size_t lesson, std::size_t block);
    std::vector<Job> jobs();

    const Course& course_;
    std::string generator_;
    std::vector<LessonScenes> scenes_;
    std::vector<LessonResult> results_;
    std::vector<std::vector<InputError>> errors_;  // by lesson
    std::mutex errors_mutex_;
    FileList inputs_;
};

}  // namespace tumble
