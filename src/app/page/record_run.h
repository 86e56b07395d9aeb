// Simulates a scene and keeps what a page shows of it.
#pragma once

#include "app/survey/survey.h"
#include "app/threads/interrupt.h"
#include "page/page_run.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace tumble {

struct RecordSettings {
    int threads = 1;
    std::string label;                           // of the run, among several
    std::function<void(std::int64_t)> progress;  // called with the number of frames done; may be empty
    std::vector<SurveyObserver*> observers;      // that see the frames too
    // Quantities of plots, separated by commas: the page has all quantities of bodies, and the quantities of joints
    // that are named here.
    std::string plot;
};

/// Throws RunError after an interrupt, or if the simulation fails; InputError for a plot that the scene does not have.
PageRun record_run(const SceneDescription& scene, const RecordSettings& settings, Interrupt& interrupt);

}  // namespace tumble
